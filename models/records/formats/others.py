"""Known formats without a reader: each is refused by its name, with advice."""

from __future__ import annotations

import re

from ..component import Component, RecordFile
from ..reading import Reading

NAME = "format that is not read"
_LINES = 16  # lines of a header that names its format
# common name of each format: its first bytes
_BYTES: dict[str, tuple[bytes, ...]] = {
    # archives, also those of Excel, MATLAB, HDF5, Parquet, Arrow, arrays of Python, TDMS, SEG-2, pickles
    "packed or binary, as a spreadsheet of Excel": (
        *(
            b"PK\x03\x04",
            b"PK\x05\x06",
            b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1",
            b"\x1f\x8b",
            b"BZh",
            b"\xfd7zXZ\0",
        ),
        *(b"7z\xbc\xaf\x27\x1c", b"Rar!", b"MATLAB ", b"\x89HDF\r\n\x1a\n", b"PAR1", b"ARROW1", b"\x93NUMPY"),
        *(b"TDSm", b"\x55\x3a", b"\x3a\x55", *(bytes((128, protocol)) for protocol in range(2, 6))),
    ),
    "a PDF or a picture": (b"%PDF-", b"\x89PNG", b"\xff\xd8\xff", b"GIF8"),
    "K-NET/KiK-net WIN32 (NIED has ASCII: .EW, .NS, .UD)": (b"\x0a\x02\x00\x00",),
}
# the ending
_ENDINGS = {
    ".evt": "Kinemetrics EVT",
    **dict.fromkeys((".vt2", ".dt2"), "velocities or displacements of PEER (VT2, DT2)"),
    **dict.fromkeys((".vol", ".vol1", ".vol2"), "GeoNet .vol (GeoNet has V1A and V2A)"),
}
# text in the first lines, in capitals
_WORDS = {
    "TIMESERIES text (SLIST, TSPAIR)": r"\ATIMESERIES .*SAMPLE",
    "GSE2/IMS": r"^WID[12] ",
    "USC or Caltech Volume I or II": r"UNCORRECTED ACCELEROGRAM DATA OF VOL|DATA OF VOL(UME)? ?I|STATION USC|"
    r"CORRECTED ACCELEROGRAM +I{1,3}[A-Z]{1,3}\d",
    "processed text of the USGS (SAMPLES/SEC, DATA TYPE)": r"SAMPLES/SEC ?= ?\d.*DATA TYPE ?=",
    "RENADIC (University of Chile)": "RENADIC",
    "BHRC of Iran": r"^\* ?VOL1DS|VOL[12]DS FILE|\(BHRC",
    "UNAM of Mexico (ASA 2.0)": "ARCHIVO ESTANDAR DE ACELERACION|INSTITUTO DE INGENIERIA, UNAM",
    "a response spectrum": "^RESPONSE SPECTR|^ELASTIC RESPONSE SPECTR",
    "a list of a program": r"\bSET\s+\w+\s+[{\"]|-VALUES\s+\{|=\s*(?:\w+\.)?(?:ARRAY\(|\[\s*[-+.\d])|"
    r"\A:\s?DIANA DATAFILE",
    "JSON, XML or a web page": r"\A\s*(?:\{\s*(?:\"|$)|\[\s*[{\[]|<[?!Q]|<HTML|<FDSN)",
}


def _name_of(file: RecordFile) -> str | None:
    head, ending = "\n".join(file.head[:_LINES]), file.path.suffix.lower()
    if file.content[257:262] == b"ustar":  # a tar
        return next(iter(_BYTES))
    names = [name for name, marks in _BYTES.items() if file.content.startswith(marks)]
    names += [name for end, name in _ENDINGS.items() if end == ending]
    names += [name for name, words in _WORDS.items() if re.search(words, head, re.MULTILINE)]
    return next(iter(names), None)


def recognizes(file: RecordFile) -> bool:
    """Whether a file is in one of these formats."""
    return _name_of(file) is not None


def read(file: RecordFile, reading: Reading) -> list[Component]:
    """Refuse the file by the name of its format.

    Raises
    ------
    ValueError
        Always.
    """
    raise ValueError(
        f"{file.name} is {_name_of(file)}, which is not read here: give another product of its source, such "
        "as AT2, or write its accelerations as columns 'time [s], E, N, Z' (CSV) with their unit"
    )
