"""SMC of the U.S. Geological Survey: a component of text with integer and real headers."""

from __future__ import annotations

from ..component import Component, Direction, RecordFile
from ..headers import TURNED_UP, compare_peak, direction_at
from ..numbers import fixed_width_block
from ..reading import Reading

NAME = "SMC"
_TITLES = ("1 UNCORRECTED ACCELEROGRAM", "2 CORRECTED ACCELEROGRAM")
_OTHERS = ("3 VELOCITY", "4 DISPLACEMENT", "VELOCITY", "DISPLACEMENT")
_TEXT_LINES = 11
_INTEGERS, _REALS, _SAMPLES = (8, 10), (5, 15), (8, 10)  # numbers in a line, and characters of each
# positions in the headers, counted from 0
_INCLINATION, _AZIMUTH, _COMMENTS, _COUNT = 12, 13, 15, 16
_RATE, _LARGEST, _SMALLEST = 1, 29, 31
_UNKNOWN = 1.7e38


def recognizes(file: RecordFile) -> bool:
    """Whether the first line is a title of the format, and the next and the eleventh a star."""
    head = [line.strip() for line in _text(file).head[:_TEXT_LINES]]
    return (
        len(head) == _TEXT_LINES
        and head[0].startswith((*_TITLES, *_OTHERS, "*"))
        and head[1] == head[10] == "*"
    )


def read(file: RecordFile, reading: Reading) -> list[Component]:
    """Read the samples of a corrected accelerogram, in cm/s^2.

    Raises
    ------
    ValueError
        If the accelerogram is uncorrected (a time with each value, at uneven steps), of velocities or
        displacements, or damaged.
    """
    file = _text(file)
    title = file.head[0].strip()
    if not title.startswith(_TITLES):
        raise ValueError(
            f"{file.name} ({NAME}) says {title[:40]!r}: give the file of 2 CORRECTED ACCELEROGRAM"
        )
    if title.startswith(_TITLES[0]):
        raise ValueError(
            f"{file.name} ({NAME}) is an uncorrected accelerogram with a time for each value, unevenly: "
            "give the file of 2 CORRECTED ACCELEROGRAM"
        )
    integers = fixed_width_block(file, _TEXT_LINES, 48, _INTEGERS)
    reals = fixed_width_block(file, _TEXT_LINES + 6, 50, _REALS)
    count, rate, comments = int(integers[_COUNT]), float(reals[_RATE]), int(integers[_COMMENTS])
    if count < 2 or not 0.0 < rate < 1e5 or not 0 <= comments < 1000:
        raise ValueError(
            f"{file.name} ({NAME}): the headers must state samples, their rate and lines of comments, got "
            f"{count}, {rate:g} and {comments}"
        )
    values = fixed_width_block(file, _TEXT_LINES + 16 + comments, count, _SAMPLES)
    direction, azimuth, down = _orientation(int(integers[_INCLINATION]), int(integers[_AZIMUTH]))
    peaks = [
        abs(float(reals[place])) for place in (_LARGEST, _SMALLEST) if abs(reals[place]) < 0.5 * _UNKNOWN
    ]
    notes = compare_peak(file.name, values, max(peaks, default=None), "cm/s2", 0.01)
    return [
        Component(
            path=file.path,
            values=-values if down else values,
            time_step=1.0 / rate,
            unit="cm/s2",
            format=NAME,
            label="vertical" if direction == "z" else f"{azimuth:g} deg" if azimuth is not None else "",
            direction=direction,
            azimuth=azimuth,
            notes=(TURNED_UP, *notes) if down else notes,
        )
    ]


def _text(file: RecordFile) -> RecordFile:
    """File without the null bytes that some have in the station code."""
    if file.lines is not None or not file.content[:26].startswith((b"1 UNCORRECTED", b"2 CORRECTED")):
        return file
    return RecordFile(file.path, file.content.replace(b"\0", b" "))


def _orientation(inclination: int, azimuth: int) -> tuple[Direction | None, float | None, bool]:
    """Direction, azimuth [deg] and whether the sensor points down; an inclination of 0 is up."""
    if inclination in (0, 180):
        return "z", None, inclination == 180
    if inclination == 90 and 0 <= azimuth <= 360:
        return direction_at(azimuth % 360.0), azimuth % 360.0, False
    return None, None, False
