"""AFAD, Turkey (earlier NSMN): text of three columns under a header."""

from __future__ import annotations

import re

from ..component import Component, RecordFile
from ..headers import compare_peak, direction_of
from ..numbers import table_of_numbers
from ..reading import Reading

NAME = "AFAD text"
_HEADER_LINES = 30
_PEAK = re.compile(r"\(\s*([NSEWUD]-[NSEWUD])\s*\)\s*([-+]?\d{1,6}(?:\.\d{1,9})?)")


def recognizes(file: RecordFile) -> bool:
    """Whether the header has the words of AFAD: strong ground motion records of Turkey."""
    return any("STRONG GROUND MOTION RECORDS OF TURK" in line for line in file.head[:_HEADER_LINES])


def read(file: RecordFile, reading: Reading) -> list[Component]:
    """Read the three columns, in gal.

    Raises
    ------
    ValueError
        If the sampling interval, the number of samples or the names of the columns are missing, or there are
        fewer samples than announced.
    """
    header = file.head[:_HEADER_LINES]
    names_at = next((at for at, line in enumerate(header) if _names(line)), None)
    if names_at is None:
        raise ValueError(f"{file.name} ({NAME}): no line names the columns, as 'N-S E-W U-D'")
    time_step = _value(file, header, "SAMPLING INTERVAL", r"\d{0,3}\.?\d{1,9}")
    count = int(_value(file, header, "NUMBER OF DATA", r"\d{1,9}"))
    peaks_line = next((line for line in header if "PGA" in line and "GAL" in line), "")
    if not peaks_line:
        raise ValueError(
            f"{file.name} ({NAME}): its header must state the unit, as in 'RAW PGA VALUES (gal)'"
        )
    peaks = {name: float(peak) for name, peak in _PEAK.findall(peaks_line)}
    names = _names(header[names_at])
    table = table_of_numbers(file, names_at + 1, len(names), count=count)
    return [
        Component(
            path=file.path,
            values=values,
            time_step=time_step,
            unit="cm/s2",
            format=NAME,
            label=name,
            direction=direction_of(name),
            # offset of the raw samples, whose mean AFAD subtracts
            notes=compare_peak(f"{file.name}, {name}", values, peaks.get(name), "gal", 1e-3),
        )
        for name, values in zip(names, table.T, strict=True)
    ]


def _names(line: str) -> list[str]:
    """Names of the columns if a line holds nothing else, else none."""
    words = line.split()
    return words if len(words) == 3 and all(map(direction_of, words)) else []


def _value(file: RecordFile, header: tuple[str, ...], key: str, number: str) -> float:
    line = next((line for line in header if line.startswith(key)), "")
    match = re.match(number, line.partition(":")[2].strip())
    if match is None or float(match[0]) <= 0.0:
        raise ValueError(f"{file.name} ({NAME}): '{key} : ...' must be a positive number, got {line[:60]!r}")
    return float(match[0])
