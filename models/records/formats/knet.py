"""K-NET and KiK-net of NIED, Japan: counts in text, a file a component."""

from __future__ import annotations

import re

from ..component import Component, Direction, RecordFile
from ..headers import compare_peak
from ..numbers import block_of_numbers
from ..reading import Reading

NAME = "K-NET/KiK-net"
_HEADER_LINES = 17
_KEY_WIDTH = 18  # [characters]
_SCALE = re.compile(r"(\d{1,9}(?:\.\d{1,9})?)\s*\(gal\)\s*/\s*(\d{1,12})", re.IGNORECASE)
_DECIMAL = re.compile(r"\d{1,6}(?:\.\d{1,6})?")
_RATE = re.compile(r"(\d{1,6}(?:\.\d{1,6})?)\s*Hz", re.IGNORECASE)
# KiK-net numbers its six sensors: 1 to 3 in the borehole, 4 to 6 at the surface
_DIRECTIONS: dict[str, tuple[Direction, str]] = {
    "E-W": ("x", "E-W"),
    "N-S": ("y", "N-S"),
    "U-D": ("z", "U-D"),
    "1": ("y", "N-S borehole"),
    "2": ("x", "E-W borehole"),
    "3": ("z", "U-D borehole"),
    "4": ("y", "N-S surface"),
    "5": ("x", "E-W surface"),
    "6": ("z", "U-D surface"),
}


def recognizes(file: RecordFile) -> bool:
    """Whether the header is that of NIED: origin time first, then the sampling frequency."""
    head = file.head[:_HEADER_LINES]
    titled = bool(head) and head[0].startswith("ORIGIN TIME") and "," not in head[0]  # else a derived CSV
    return titled and any("(HZ)" in line for line in head)


def read(file: RecordFile, reading: Reading) -> list[Component]:
    """Read counts times the scale factor, in gal, with the offset of the sensor.

    NIED states the largest acceleration after the mean was taken off, and leaves the mean in the counts.

    Raises
    ------
    ValueError
        If a line of the header is missing, or the samples are fewer or more than it announces.
    """
    header = {
        line[:_KEY_WIDTH].strip().upper(): line[_KEY_WIDTH:].strip() for line in file.text[:_HEADER_LINES]
    }
    rate = _number(file, header, "SAMPLING FREQ(HZ)", _RATE, "100Hz")[0]
    numerator, denominator = _number(file, header, "SCALE FACTOR", _SCALE, "3920(gal)/6182761")
    code = header.get("DIR.", "")
    if code.upper() not in _DIRECTIONS:
        raise ValueError(
            f"{file.name} ({NAME}): 'Dir.' must be one of {', '.join(_DIRECTIONS)}, got {code[:20]!r}"
        )
    direction, label = _DIRECTIONS[code.upper()]
    values = block_of_numbers(file, _HEADER_LINES) * (numerator / denominator)
    if len(values) < 2:
        raise ValueError(f"{file.name} ({NAME}): no counts follow the header")
    duration = _DECIMAL.fullmatch(header.get("DURATION TIME(S)", ""))
    # the duration is printed in whole seconds
    if duration and abs(len(values) - float(duration[0]) * rate) > rate:
        raise ValueError(
            f"{file.name} ({NAME}): announces {duration[0]} s at {rate:g} Hz, "
            f"{float(duration[0]) * rate:.0f} samples, the file holds {len(values)}"
        )
    peak = _DECIMAL.fullmatch(header.get("MAX. ACC. (GAL)", ""))
    notes = compare_peak(file.name, values - values.mean(), float(peak[0]) if peak else None, "gal", 0.001)
    return [
        Component(
            path=file.path,
            values=values,
            time_step=1.0 / rate,
            unit="cm/s2",
            format=NAME,
            label=label,
            direction=direction,
            notes=("offset of the sensor not removed", *notes),
        )
    ]


def _number(
    file: RecordFile, header: dict[str, str], key: str, pattern: re.Pattern[str], example: str
) -> list[float]:
    match = pattern.match(header.get(key, ""))
    numbers = [float(number) for number in match.groups()] if match else [0.0]
    if not all(numbers):
        raise ValueError(
            f"{file.name} ({NAME}): its header must have '{key.capitalize()}' as in {example}, got "
            f"{header.get(key, 'none')[:30]!r}"
        )
    return numbers
