"""CSMNC, the strong-motion network of China: a component of text under a header in English."""

from __future__ import annotations

import re

from ..component import Component, RecordFile
from ..headers import azimuth_of, compare_peak, direction_at, direction_of
from ..numbers import block_of_numbers
from ..reading import Reading
from ..units import stated_unit

NAME = "CSMNC text"
_HEADER_LINES = 20
_POINTS = re.compile(
    r"NO\. OF POINTS:\s{0,20}(\d{1,9})\s{1,20}EQUALLY SPACED INTERVALS OF:\s{0,20}(\d{0,3}\.?\d{1,9})"
)
_UNIT = re.compile(r"UNIT:\s{0,20}(\S{1,20})")
_PEAK = re.compile(r"PEAK VALUE:\s{0,20}([-+]?\d{0,9}\.\d{1,9})")
_NUMBERS = re.compile(r"[-+.\d\s]{1,200}")


def recognizes(file: RecordFile) -> bool:
    """Whether a header line states the number and the equal spacing of the points."""
    return any("EQUALLY SPACED INTERVALS OF:" in line for line in file.head[:_HEADER_LINES])


def read(file: RecordFile, reading: Reading) -> list[Component]:
    """Read the samples of a component.

    Raises
    ------
    ValueError
        If the file holds velocities or displacements, lacks the points or the component, or holds fewer
        samples than it announces.
    """
    header = file.head[:_HEADER_LINES]
    points = next((match for line in header if (match := _POINTS.match(line.strip()))), None)
    if points is None or not int(points[1]) or not float(points[2]):
        raise ValueError(
            f"{file.name} ({NAME}): expected 'NO. OF POINTS: 30000 EQUALLY SPACED INTERVALS OF: .005 SEC'"
        )
    unit_line = next((line for line in header if "UNIT:" in line), "")
    if not re.search("ACC+ELERATION", unit_line):
        raise ValueError(f"{file.name} ({NAME}) holds {unit_line.strip()[:60]!r}, no acceleration")
    word = _UNIT.search(unit_line)
    unit = stated_unit(file.path, [f"unit: {word[1]}" if word else ""])
    name = next((line.strip()[5:].strip(" :.") for line in header if line.strip().startswith("COMP.")), "")
    count, begin = int(points[1]), _first_line_of_numbers(file)
    values = block_of_numbers(file, begin)
    if len(values) != count:
        raise ValueError(f"{file.name} ({NAME}): announces {count} samples, the file holds {len(values)}")
    peak = next((match for line in header if (match := _PEAK.search(line))), None)
    azimuth = azimuth_of(name)
    return [
        Component(
            path=file.path,
            values=values,
            time_step=float(points[2]),
            unit=unit,
            format=NAME,
            label=name[:20],
            direction=direction_at(azimuth) or direction_of(name),
            azimuth=azimuth,
            notes=compare_peak(file.name, values, float(peak[1]) if peak else None, unit or "", 1e-3),
        )
    ]


def _first_line_of_numbers(file: RecordFile) -> int:
    """Number, counted from 0, of the line after that of the peak, with the first samples."""
    peak_at = next((at for at, line in enumerate(file.head[:_HEADER_LINES]) if "PEAK VALUE" in line), 0)
    for at, line in enumerate(file.text[peak_at + 1 : peak_at + 12], start=peak_at + 1):
        if line.strip() and _NUMBERS.fullmatch(line[:200]):
            return at
    raise ValueError(f"{file.name} ({NAME}): no samples follow the header")
