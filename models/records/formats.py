"""Formats of record files: PEER AT2 with each form of its header, and text of columns."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from .units import require_seconds, stated_unit

# one way to match each text, so that no line takes more than linear time;
# columns may touch: in "1.2E-031.4E-03" the exponent ends where the next number needs its digit
NUMBER = r"[-+]?(?:\d+(?:\.\d*)?|\.\d+)(?:[EeDd][-+]?(?:\d\d(?=\d?\.)|\d+))?"

# over a whole record two components may drift apart by this part of a step, the rounding of printed times
DRIFT = 0.05
_MOST_PARTS = 20  # of the smallest step: a record of more samples by that is a mistake, not a common step


@dataclass(frozen=True, slots=True, eq=False)
class Component:
    """Samples of one component, in the unit that the file states.

    Parameters
    ----------
    path : Path
        The file, for messages.
    values : ndarray, shape (n,)
        Acceleration [`unit`]; n >= 2, finite.
    time_step : float
        [s]
    unit : str or None
        None where the file is silent.
    start : float or None
        Time of the first sample [s]; None where the file gives no times.

    Raises
    ------
    ValueError
        If there are fewer than two samples, or the time step is not positive and finite.
    """

    path: Path
    values: NDArray[np.float64]
    time_step: float
    unit: str | None
    start: float | None = None

    def __post_init__(self) -> None:
        if len(self.values) < 2:
            raise ValueError(f"{self.path.name} must hold at least two samples, got {len(self.values)}")
        if not 0.0 < self.time_step < math.inf:
            raise ValueError(
                f"{self.path.name}: the time step must be positive and finite [s], got {self.time_step:g}"
            )


def resampled(components: Sequence[Component]) -> list[Component]:
    """Return components at the largest time step that divides the steps of all, linear between samples.

    That changes no record: each is linear between its samples, and all of them stay.

    Raises
    ------
    ValueError
        If no such step is at least a twentieth of the smallest one.
    """
    finest = min(components, key=lambda each: each.time_step)
    for parts in range(1, _MOST_PARTS + 1):
        step = finest.time_step / parts
        counts = [round(each.time_step / step) for each in components]
        drifts = [
            abs(each.time_step - count * step) * len(each.values)
            for each, count in zip(components, counts, strict=True)
        ]
        if max(drifts) <= DRIFT * step:
            return [_refined(each, count, step) for each, count in zip(components, counts, strict=True)]
    coarsest = max(components, key=lambda each: each.time_step)
    raise ValueError(
        f"components are resampled to a step that divides all, at least 1/{_MOST_PARTS} of the smallest: "
        f"{finest.time_step:g} s in {finest.path.name} and {coarsest.time_step:g} s in {coarsest.path.name} "
        "have none"
    )


def _refined(component: Component, count: int, step: float) -> Component:
    """Return a component with each of its time steps cut into `count` of `step` [s]."""
    values = component.values
    places = np.arange((len(values) - 1) * count + 1) / count
    return replace(component, values=np.interp(places, np.arange(len(values)), values), time_step=step)


def parse_number(path: Path, line_number: int, token: str) -> float:
    """Parse a finite number; Fortran writes D for the exponent of a double.

    Raises
    ------
    ValueError
        If the token is not a number, or not a finite one.
    """
    try:
        value = float(re.sub("[Dd](?=[-+0-9])", "E", token))
    except ValueError:
        raise ValueError(f"{path.name}, line {line_number}: expected a number, got {token[:60]!r}") from None
    if not math.isfinite(value):
        raise ValueError(
            f"{path.name}, line {line_number}: a sample must be a finite number, got {token[:60]!r}"
        )
    return value


# titles of the forms in circulation are three lines long; one comment more does no harm
_HEADER_LINES = 6
_LONGEST_HEADER = 200  # the line has 80 characters; bounds what a pattern can cost on one that is damaged


def is_at2(lines: list[str]) -> bool:
    """Return whether a header line announces a number of points (NPTS)."""
    return any("NPTS" in line.upper() for line in lines[:_HEADER_LINES])


def read_at2(path: Path, lines: list[str]) -> Component:
    """Read the lines of an AT2 file.

    Raises
    ------
    ValueError
        If the header, a line of values or the number of samples is not as the format has it.
    """
    at = next(index for index, line in enumerate(lines) if "NPTS" in line.upper())
    count, time_step = _counts(path, at + 1, lines[at])
    unit = stated_unit(path, lines[:at])
    values: list[float] = []
    for number, line in enumerate(lines[at + 1 :], start=at + 2):
        if not line.strip():
            continue
        # what is left between the numbers: columns of fixed width may touch, so blanks do not part them
        if re.sub(NUMBER, "", line).strip():
            raise ValueError(f"{path.name}, line {number}: expected accelerations, got {line.strip()[:60]!r}")
        values.extend(parse_number(path, number, token) for token in re.findall(NUMBER, line))
    # the last line may be filled up with zeros, and the ground is still after the record anyway
    if len(values) < count or any(values[count:]):
        raise ValueError(
            f"{path.name}, line {at + 1}: announces {count} samples, the file holds {len(values)}"
        )
    return Component(path, np.array(values[:count]), time_step, unit)


def _counts(path: Path, number: int, line: str) -> tuple[int, float]:
    """Number of samples and time step, from "NPTS= 4000, DT= .0100 SEC" or "4000 .0100 NPTS, DT"."""
    line = line[:_LONGEST_HEADER]
    named = re.search(rf"NPTS\s*[=:]?\s*(\d{{1,9}})\b.*?DT\s*[=:]?\s*({NUMBER})", line, re.IGNORECASE)
    bare = re.match(rf"\s*(\d{{1,9}})[\s,]+({NUMBER})\s*,?\s*NPTS", line, re.IGNORECASE)
    found = named or bare
    if found is None:
        raise ValueError(
            f"{path.name}, line {number}: expected 'NPTS= n, DT= step SEC' or 'n step NPTS, DT', "
            f"got {line.strip()[:60]!r}"
        )
    return int(found.group(1)), parse_number(path, number, found.group(2))


_COMMENT_MARKS = "#%!"
# printed times are rounded, as 0.0167 for 1/60: a sample may stand this much of a step off its place
_UNEVENNESS = 0.05
_COMMA_NUMBER = r"[-+]?\d+,\d+(?:[Ee][-+]?\d+)?"


def read_columns(path: Path, lines: list[str]) -> Component:
    """Read lines of two numbers, time [s] and acceleration, after any header and between comments.

    Raises
    ------
    ValueError
        If a line holds something else, or the times do not rise in even steps.
    """
    header, rows, numbers = _rows(path, lines, (2,), "two numbers, time [s] and acceleration")
    return _component(path, header, rows, numbers, 1)


def read_table(path: Path, lines: list[str]) -> list[Component]:
    """Read lines of time [s] and the accelerations x, y and, where there is one, z.

    Where a line of the header names the columns x, y, z, their order is that of the names.

    Raises
    ------
    ValueError
        If a line holds something else, the names are others, or the times do not rise in even steps.
    """
    what = (
        "three or four numbers, time [s] and the accelerations x, y and perhaps z (a file of one component "
        "needs another beside it, or zero for planar motion)"
    )
    header, rows, numbers = _rows(path, lines, (3, 4), what)
    return [_component(path, header, rows, numbers, place) for place in _places(path, header, len(rows[0]))]


def _rows(
    path: Path, lines: list[str], widths: tuple[int, ...], what: str
) -> tuple[list[str], list[list[float]], list[int]]:
    """Return the header, the rows of numbers, and the line of each row."""
    header: list[str] = []
    rows: list[list[float]] = []
    numbers: list[int] = []
    for number, line in enumerate(lines, start=1):
        text = line.replace('"', "").strip()
        cells = _cells(text)
        is_data = text[:1] not in _COMMENT_MARKS and (rows or _begins_data(cells))
        if _has_decimal_comma(text) and (is_data or not rows):
            raise ValueError(
                f"{path.name}, line {number}: numbers must have a decimal point, got a comma in {text[:60]!r}"
            )
        if not is_data:
            if not rows:
                header.append(text)
            continue
        wide = len(cells) in widths and len(cells) == len(rows[0] if rows else cells)
        if not (wide and all(map(_is_number, cells))):
            raise ValueError(f"{path.name}, line {number}: expected {what}, got {text[:60]!r}")
        rows.append([parse_number(path, number, cell) for cell in cells])
        numbers.append(number)
    if len(rows) < 2:
        raise ValueError(f"{path.name} must hold at least two samples, got {len(rows)}")
    return header, rows, numbers


def _component(
    path: Path, header: list[str], rows: list[list[float]], numbers: list[int], place: int
) -> Component:
    require_seconds(path, header)
    time, values = np.array([row[0] for row in rows]), np.array([row[place] for row in rows])
    return Component(path, values, _even_step(path, time, numbers), stated_unit(path, header), float(time[0]))


def _places(path: Path, header: list[str], width: int) -> list[int]:
    """Return the columns of x, y and z: by their names where the header has them, else by their order."""
    for line in reversed(header):
        names = _names(line, width)
        axes = set(names[1:]) & set("xyz")
        # a sentence further up may hold an x, too
        if len(names) == width and axes and (axes == set(names[1:]) or line is header[-1]):
            break
    else:
        return list(range(1, width))
    wanted = "xyz"[: width - 1]
    if sorted(names[1:]) != list(wanted):
        raise ValueError(
            f"{path.name}: its columns must be time, {', '.join(wanted)}, got {', '.join(names)}"
        )
    return [names.index(axis) for axis in wanted]


def _names(line: str, width: int) -> list[str]:
    """Return the first words of the cells of a header line, without units in brackets."""
    cells = _cells(re.sub(r"\[[^\]]*\]|\([^)]*\)", " ", line.lower()))
    names = [re.split(r"[\s\[(]", cell)[0] for cell in cells]
    return names[1:] if len(names) > width and not names[0].strip(_COMMENT_MARKS) else names


def _begins_data(cells: list[str]) -> bool:
    """Return whether a line is the first of the data, even if damaged, and no heading with a year in it."""
    numbers = [_is_number(cell) for cell in cells]
    return any(numbers) and (numbers[0] or 2 * sum(numbers) >= len(numbers))


def _cells(text: str) -> list[str]:
    text = text.rstrip(",;\t ")
    return re.split(r"\s*[,;]\s*", text) if re.search("[,;]", text) else text.split()


def _has_decimal_comma(text: str) -> bool:
    """Return whether semicolons or blanks separate the numbers of a line, with commas inside the numbers."""
    parts = [part.strip() for part in (text.split(";") if ";" in text else text.split())]
    commas = [re.fullmatch(_COMMA_NUMBER, part) is not None for part in parts]
    return (
        len(parts) > 1 and any(commas) and all(c or _is_number(p) for c, p in zip(commas, parts, strict=True))
    )


def _is_number(cell: str) -> bool:
    return re.fullmatch(NUMBER, cell) is not None or cell.lower().lstrip("+-") in ("nan", "inf", "infinity")


def _even_step(path: Path, time: NDArray[np.float64], numbers: list[int]) -> float:
    # halves, because the difference of two large floats overflows
    step = 2.0 * float(0.5 * time[-1] - 0.5 * time[0]) / (len(time) - 1)
    if not 0.0 < step < np.inf:
        raise ValueError(f"{path.name}: times must rise [s], got {time[0]:g} s first and {time[-1]:g} s last")
    with np.errstate(over="ignore"):  # an infinite distance is refused like any other
        off = np.abs((time - time[0]) / step - np.arange(len(time)))
        # the place where the step changes, not the one where the error has grown largest
        jump = np.abs(np.diff(time) / step - 1.0)
    if off.max() > _UNEVENNESS or jump.max() > 2.0 * _UNEVENNESS:
        at = int(jump.argmax())
        raise ValueError(
            f"{path.name}, line {numbers[at + 1]}: times must rise in even steps, got {time[at + 1]:g} s "
            f"after {time[at]:g} s where the mean step is {step:.6g} s"
        )
    return float(f"{step:.12g}")  # 0.01 and not 0.010000000000000002
