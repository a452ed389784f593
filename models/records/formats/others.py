"""Formats that are known and not read: each is refused by its name, with what to do."""

from __future__ import annotations

import re
from collections.abc import Callable

from ..component import Component, RecordFile
from ..reading import Reading

NAME = "format that is not read"
_COLUMNS = "write its accelerations as columns 'time [s], E, N, Z' (CSV) and give their unit"
_XLS = b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1"
_ITSELF = "give the file of the record itself"
_CORRECTED = "give the record in AT2 of PEER, or write its corrected accelerations as columns"
_VALUES = "write its accelerations alone, one in a line, and give their step (--record-step) and unit"
# archives, MATLAB, HDF5, Parquet, Arrow, pickles and arrays of Python, TDMS, SEG-2
_BINARY = (
    *(b"PK\x03\x04", b"PK\x05\x06", b"\x1f\x8b", b"BZh", b"\xfd7zXZ\0", b"7z\xbc\xaf\x27\x1c", b"Rar!"),
    *(b"MATLAB ", b"\x89HDF\r\n\x1a\n", b"PAR1", b"ARROW1", b"\x93NUMPY", b"TDSm", b"\x55\x3a", b"\x3a\x55"),
    *(bytes((128, protocol)) for protocol in range(2, 6)),
)


def _begins(*marks: bytes) -> Callable[[RecordFile], bool]:
    return lambda file: file.content.startswith(marks)


def _says(pattern: str, lines: int = 16) -> Callable[[RecordFile], bool]:
    """Return a test of the first lines, in capitals."""
    compiled = re.compile(pattern)
    return lambda file: any(compiled.search(line) for line in file.head[:lines])


def _ends(*endings: str) -> Callable[[RecordFile], bool]:
    return lambda file: file.name.lower().endswith(endings)


# name as its users know it, what tells it, what to do
_FORMATS: tuple[tuple[str, Callable[[RecordFile], bool], str], ...] = (
    (
        "a spreadsheet of Excel",
        lambda file: (_ends(".xlsx", ".xlsm")(file) and _begins(b"PK")(file)) or _begins(_XLS)(file),
        "save it as CSV",
    ),
    (
        "packed or binary",
        lambda file: _begins(*_BINARY)(file) or file.content[257:262] == b"ustar",
        f"unpack it, or {_COLUMNS}",
    ),
    (
        "a PDF or a picture",
        _begins(b"%PDF-", b"\x89PNG", b"\xff\xd8\xff", b"GIF8"),
        _ITSELF,
    ),
    ("K-NET/KiK-net WIN32", _begins(b"\x0a\x02\x00\x00"), "give the ASCII files (.EW, .NS, .UD) of NIED"),
    (
        "Kinemetrics EVT",
        _ends(".evt"),
        "convert it to COSMOS V1, SAC or miniSEED (Kinemetrics: kw2cosmos, kw2asc)",
    ),
    (
        "TIMESERIES text (SLIST, TSPAIR)",
        _says("^TIMESERIES .*SAMPLE", 1),
        "convert it to SAC or miniSEED (obspy)",
    ),
    ("GSE2/IMS", _says(r"^WID[12] "), "convert it to SAC or miniSEED of accelerations (obspy)"),
    (
        "USC or Caltech Volume I",
        lambda file: _says(r"UNCORRECTED ACCELEROGRAM DATA OF VOL(UME)? ?I", 1)(file),
        _CORRECTED,
    ),
    (
        "USC or Caltech Volume II",
        _says(r"DATA OF VOL(UME)? ?I|CORRECTED ACCELEROGRAM +I{1,3}[A-Z]{1,3}\d|STATION USC", 8),
        _CORRECTED,
    ),
    (
        "processed text of the USGS (SAMPLES/SEC, DATA TYPE)",
        _says(r"SAMPLES/SEC ?= ?\d.*DATA TYPE ?="),
        "give the record in COSMOS V2 or SMC, or write its accelerations as columns",
    ),
    ("RENADIC (University of Chile)", _says("RENADIC"), _COLUMNS),
    ("BHRC of Iran", _says(r"^\* ?VOL1DS|VOL[12]DS FILE|\(BHRC"), _COLUMNS),
    (
        "UNAM of Mexico (ASA 2.0)",
        _says("ARCHIVO ESTANDAR DE ACELERACION|INSTITUTO DE INGENIERIA, UNAM"),
        _COLUMNS,
    ),
    (
        "velocities or displacements of PEER (VT2, DT2)",
        lambda file: _ends(".vt2", ".dt2")(file) and _says("NPTS", 8)(file),
        "give the AT2 of the component",
    ),
    (
        "GeoNet .vol (volumes I to III of DSIR)",
        _ends(".vol", ".vol1", ".vol2"),
        "give the V1A or V2A file of GeoNet",
    ),
    ("a response spectrum", _says(r"^RESPONSE SPECTR|^ELASTIC RESPONSE SPECTR"), _ITSELF),
    (
        "QuakeML or StationXML",
        _says(r"^<\?XML|^<Q:QUAKEML|^<FDSNSTATIONXML", 2),
        "give the waveforms: SAC or miniSEED",
    ),
    (
        "a list of a program",
        _says(r"\bSET\s+\w+\s+[{\"]|-VALUES\s+\{|=\s*(?:\w+\.)?(?:ARRAY\(|\[\s*[-+.\d])"),
        _VALUES,
    ),
    ("an input of DIANA", _says(r"^:\s?DIANA DATAFILE", 1), _VALUES),
    ("JSON", _says(r"^\s*(?:\{\s*(?:\"|$)|\[\s*[{\[])", 1), _COLUMNS),
    ("a web page", _says(r"^\s*<(!DOCTYPE HTML|HTML)", 3), _ITSELF),
)


def _name_and_advice(file: RecordFile) -> tuple[str, str] | None:
    return next(((name, advice) for name, tells, advice in _FORMATS if tells(file)), None)


def recognizes(file: RecordFile) -> bool:
    """Return whether a file is of one of these formats."""
    return _name_and_advice(file) is not None


def read(file: RecordFile, reading: Reading) -> list[Component]:
    """Refuse the file by the name of its format.

    Raises
    ------
    ValueError
        Always.
    """
    match = _name_and_advice(file)
    assert match is not None
    raise ValueError(f"{file.name} is {match[0]}, which is not read here: {match[1]}")
