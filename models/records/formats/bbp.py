"""SCEC Broadband Platform, .bbp: time, north-south, east-west and up-down, of acceleration or velocity."""

from __future__ import annotations

import re
from itertools import takewhile

import numpy as np
from numpy.typing import NDArray

from ..component import Component, RecordFile
from ..headers import direction_of
from ..numbers import table_of_numbers
from ..reading import Reading
from ..units import stated_unit

NAME = "SCEC BBP"
_COLUMN = re.compile(r"([A-Z]{1,5}(?:-[A-Z])?)\s*\(([^()]{1,20})\)", re.IGNORECASE)
# "# Column 2: North-south acceleration (cm/s/s) (+ is northward)"
_NUMBERED = re.compile(
    r"COLUMN ([2-9]): ([A-Z]{1,9}-[A-Z]{1,9}) [A-Z]{1,20} \(([^()]{1,20})\)", re.IGNORECASE
)
_VELOCITY = re.compile(r"\((c?m/s(?:ec)?)\)", re.IGNORECASE)
_SEQUENCE = ("N-S", "E-W", "U-D")  # order of components in the platform's format


def recognizes(file: RecordFile) -> bool:
    """Whether the file name ends in .bbp."""
    return file.name.lower().endswith(".bbp") and file.lines is not None


def read(file: RecordFile, reading: Reading) -> list[Component]:
    """Read the three components of an acceleration file.

    Raises
    ------
    ValueError
        If the columns are velocities, the file says neither, a row is damaged, or the times are uneven.
    """
    header = list(takewhile(lambda line: line.strip()[:1] in ("#", "%", ""), file.text))
    columns = _columns(header)
    names, words = [name for name, _ in columns], {unit.strip() for _, unit in columns}
    if len(words) > 1 or len(set(map(direction_of, names))) != 3 or not all(map(direction_of, names)):
        raise ValueError(
            f"{file.name} ({NAME}): expected N-S, E-W and U-D in one unit behind the time, got "
            f"{', '.join(f'{name} ({unit})' for name, unit in columns)[:100]}"
        )
    unit = _unit(file, words.pop(), reading)
    table = table_of_numbers(file, len(header), 4)
    time_step = _even_step(file, table[:, 0])
    return [
        Component(
            path=file.path,
            values=values,
            time_step=time_step,
            unit=unit,
            start=float(table[0, 0]),
            format=NAME,
            label=name,
            direction=direction_of(name),
        )
        for name, values in zip(names, table.T[1:], strict=True)
    ]


def _columns(header: list[str]) -> list[tuple[str, str]]:
    """Names and unit of the columns after the time; the format's defaults where none are named."""
    for line in header:
        if len(cells := _COLUMN.findall(line[:200])) == 4:
            return cells[1:]
    numbered = sorted(match.groups() for line in header if (match := _NUMBERED.search(line[:200])))
    if [number for number, _, _ in numbered] == ["2", "3", "4"]:
        return [(name, unit) for _, name, unit in numbered]
    velocity = next((match[1] for line in header if (match := _VELOCITY.search(line[:200]))), "")
    return [(name, velocity) for name in _SEQUENCE]


def _unit(file: RecordFile, word: str, reading: Reading) -> str | None:
    """Unit of acceleration, by the columns, else by the name of the file."""
    acceleration = file.name.lower().endswith(".acc.bbp")
    if re.fullmatch(r"c?m/s(ec)?", word, re.IGNORECASE):
        but = ", though its name says acceleration" if acceleration else ""
        raise ValueError(
            f"{file.name} ({NAME}) holds velocities in {word}{but}: give the .acc.bbp of the station"
        )
    if word:
        return stated_unit(file.path, [f"unit: {word}"])
    if acceleration:
        return "cm/s2"
    if reading.units is None:
        raise ValueError(
            f"{file.name} ({NAME}) names no columns, which may be velocities: give the .acc.bbp of the "
            "station, or the unit of its accelerations (--units)"
        )
    return None


def _even_step(file: RecordFile, time: NDArray[np.float64]) -> float:
    step = float(time[-1] - time[0]) / max(len(time) - 1, 1)
    uneven = np.flatnonzero(np.abs(time - time[0] - step * np.arange(len(time))) > 0.1 * step)
    if not step > 0.0 or len(uneven):
        raise ValueError(f"{file.name} ({NAME}): times must rise in even steps [s]")
    return float(f"{step:.9g}")
