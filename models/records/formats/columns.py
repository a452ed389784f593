"""Columns of text or CSV: time [s] and one, two or three accelerations."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..component import Component, ReadingOptions, RecordFile
from ..numbers import NUMBER, parse_number
from ..units import require_seconds, stated_unit

NAME = "columns"
_COMMENT_MARKS = "#%!"
# printed times are rounded, as 0.0167 for 1/60: a sample may stand this much of a step off its place
_UNEVENNESS = 0.05
_COMMA_NUMBER = r"[-+]?\d+,\d+(?:[Ee][-+]?\d+)?"


def recognizes(file: RecordFile) -> bool:
    """Return whether a file is text: what no other format claims is taken for columns."""
    return file.lines is not None


def read(file: RecordFile, options: ReadingOptions) -> list[Component]:
    """Read lines of time [s] and accelerations, after any header and between comments.

    Where a line of the header names the columns x, y, z, their order is that of the names.

    Raises
    ------
    ValueError
        If a line holds something else, the names are others, or the times do not rise in even steps.
    """
    path, lines = file.path, list(file.text)
    if not options.alone:
        header, rows, numbers = _rows(path, lines, (2,), "two numbers, time [s] and acceleration")
        return [_component(path, header, rows, numbers, 1)]
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
    return Component(
        path=path,
        values=values,
        time_step=_even_step(path, time, numbers),
        unit=stated_unit(path, header),
        start=float(time[0]),
        format=NAME,
    )


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
