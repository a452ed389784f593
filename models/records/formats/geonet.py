"""GeoNet, New Zealand, V1A and V2A: three components in one file of text, in mm/s^2."""

from __future__ import annotations

import re

from ..component import Component, RecordFile
from ..headers import TURNED_UP, azimuth_of, compare_peak, direction_at, direction_of
from ..numbers import fixed_width_block
from ..reading import Reading

NAME = "GeoNet V1A/V2A"
_TEXT_LINES, _NUMBER_LINES = 16, 10  # lines in the header of a component
_SHAPE = (10, 8)  # numbers in a line, and characters of each
_COUNT = re.compile(r"NUMBER OF POINTS\s+(\d{1,9})")
_STEP = re.compile(r"(?:AT INTERVALS OF|DATA AT)\s+(\d{0,3}\.\d{1,9})\s*S")
_FACTOR = re.compile(r"RAW READINGS IN UNITS OF\s+(\d{0,6}\.?\d{1,9})\s*MM/S/S")
_PEAK = re.compile(r"ACCELERATION:\s+PEAK\s+([-+]?\d{0,9}\.\d{1,9})\s*MM/S/S")


def recognizes(file: RecordFile) -> bool:
    """Whether the first line is the title of an accelerogram of GNS Science."""
    return bool(file.head) and "CORRECTED ACCELEROGRAM" in file.head[0] and "GNS SCIENCE" in file.head[0]


def read(file: RecordFile, reading: Reading) -> list[Component]:
    """Acceleration of each component; velocities and displacements of V2A are skipped.

    Raises
    ------
    ValueError
        If a header lacks the number of points, the step or the component, or the file ends early.
    """
    titles = [
        at for at, line in enumerate(file.text) if len(line) > 40 and "orrected accelerogram" in line[:40]
    ]
    return [_component(file, at) for at in titles]


def _component(file: RecordFile, at: int) -> Component:
    header = [line[:120].upper() for line in file.text[at : at + _TEXT_LINES]]
    count, step = int(_number(file, at, header, _COUNT)), _number(file, at, header, _STEP)
    raw = next((match for line in header if (match := _FACTOR.search(line))), None)
    factor = 0.1 * (float(raw[1]) if raw else 1.0)  # cm/s^2 for each reading
    line = next((line for line in header if line.startswith("COMPONENT")), "")
    name = [*line.split(), "", ""][1]
    azimuth, down = azimuth_of(name), name == "DOWN"
    if azimuth is None and direction_of(name) is None and not down:
        raise ValueError(
            f"{file.name} ({NAME}): expected 'Component N10E' or 'Component Up', got {line[:60]!r}"
        )
    values = factor * fixed_width_block(file, at + _TEXT_LINES + _NUMBER_LINES, count, _SHAPE)
    peak = next((match for line in header if (match := _PEAK.search(line))), None)
    notes = compare_peak(
        f"{file.name}, {name}", values, 0.1 * float(peak[1]) if peak else None, "cm/s2", 0.01
    )
    return Component(
        path=file.path,
        values=-values if down else values,
        time_step=step,
        unit="cm/s2",
        format=NAME,
        label=name.capitalize() if azimuth is None else name,
        direction="z" if down else direction_at(azimuth) or direction_of(name),
        azimuth=azimuth,
        notes=(TURNED_UP, *notes) if down else notes,
    )


def _number(file: RecordFile, at: int, header: list[str], pattern: re.Pattern[str]) -> float:
    match = next((match for line in header if (match := pattern.search(line))), None)
    if match is None or not float(match[1]) > 0.0:
        raise ValueError(
            f"{file.name} ({NAME}), line {at + 1}: its header must have 'Number of points 5800' and "
            "'data at 0.020 sec intervals'"
        )
    return float(match[1])
