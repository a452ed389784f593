"""PEER AT2, with each form of its header."""

from __future__ import annotations

import re

from ..column_names import column_name
from ..component import Component, RecordFile
from ..numbers import NUMBER, block_of_numbers, parse_number, without_fill
from ..reading import Reading
from ..units import stated_unit

NAME = "PEER AT2"
# titles of the forms in circulation are three lines long, those of rotated components six
_HEADER_LINES = 7
_AZIMUTH = re.compile(r"\bAZIMUTH\s{0,9}=\s{0,9}(\d{1,3}(?:\.\d{0,3})?)(?![\d.])")
_END = re.compile(r"\s*\*{3}[^\d*]{1,60}\*{3}\s*")  # "*** End Data ***" of the examples of OpenSees
_WORDS_OF_TITLE = 3  # event, date, station and component
_MOST_FILLED = 10  # numbers; no line of the forms in circulation has more
_LONGEST_HEADER = 200  # the line has 80 characters; bounds what a pattern can cost on one that is damaged


def recognizes(file: RecordFile) -> bool:
    """Whether a header line states a number of points (NPTS)."""
    return any("NPTS" in line for line in file.head[:_HEADER_LINES])


def read(file: RecordFile, reading: Reading) -> list[Component]:
    """Read the lines of an AT2 file.

    Raises
    ------
    ValueError
        If the header, a line of values or the number of samples is not as the format has it.
    """
    at = next(index for index, line in enumerate(file.head) if "NPTS" in line)
    count, time_step = _counts(file, at)
    if time_step > 0.0:
        reading.settled_step(file.name, time_step)
    unit = stated_unit(file.path, list(file.text[:at]))
    ended = len(file.text) > at + 1 and _END.fullmatch(file.text[-1]) is not None
    values = block_of_numbers(file, at + 1, len(file.text) - ended)
    rest = values[count:]
    # the last line may be padded with zeros or 9999, and the ground is still after the record anyway
    filled = without_fill(rest)[0] if len(rest) < _MOST_FILLED else rest
    if len(values) < count or filled.any():
        raise ValueError(
            f"{file.name}, line {at + 1}: announces {count} samples, the file holds {len(values)}"
        )
    azimuth, sense = _orientation(file, at)
    return [
        Component(
            path=file.path,
            values=values[:count] if sense >= 0.0 else -values[:count],
            time_step=time_step,
            unit=unit,
            format=NAME,
            azimuth=azimuth,
            direction="z" if sense else None,
            notes=("down is turned up",) if sense < 0.0 else (),
        )
    ]


def _orientation(file: RecordFile, at: int) -> tuple[float | None, float]:
    """Azimuth [deg], and 1 up or -1 down, by "azimuth = 310.0" or the title "event, date, station, 180"."""
    stated = {float(match[1]) % 360.0 for line in file.head[:at] if (match := _AZIMUTH.search(line))}
    if stated:  # in a rotated component the other lines describe the two original components
        return (stated.pop() if len(stated) == 1 else None), 0.0
    for line in file.head[:at]:
        words = [word.strip() for word in line.split(",")]
        if len(words) < _WORDS_OF_TITLE or "ROTATION" in line:
            continue
        if re.fullmatch(r"\d{1,3}", words[-1]) and int(words[-1]) <= 360:
            return float(words[-1]) % 360.0, 0.0
        name = column_name(words[-1])
        if name.direction == "z":
            return None, name.sign
        east = {"x": 90.0, "y": 0.0}.get(name.direction or "")
        return name.azimuth if east is None else (east if name.sign > 0.0 else east + 180.0), 0.0
    return None, 0.0


def _counts(file: RecordFile, at: int) -> tuple[int, float]:
    """Number of samples and time step, from "NPTS= 4000, DT= .0100 SEC" or "4000 .0100 NPTS, DT"."""
    line = file.text[at][:_LONGEST_HEADER]
    named = re.search(rf"NPTS\s*[=:]?\s*(\d{{1,9}})\b.*?DT\s*[=:]?\s*({NUMBER})", line, re.IGNORECASE)
    bare = re.match(rf"\s*(\d{{1,9}})[\s,]+({NUMBER})\s*,?\s*NPTS", line, re.IGNORECASE)
    match = named or bare
    if match is None:
        raise ValueError(
            f"{file.name}, line {at + 1}: expected 'NPTS= n, DT= step SEC' or 'n step NPTS, DT', "
            f"got {line.strip()[:60]!r}"
        )
    return int(match.group(1)), parse_number(file.path, at + 1, match.group(2))
