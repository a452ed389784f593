"""Records as text of two columns, time and acceleration, separated by blanks, commas or semicolons."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from .component import NUMBER, Component, parse_number
from .units import stated_unit

_COMMENT_MARKS = "#%!"
# printed times are rounded, as 0.0167 for 1/60: a sample may stand this much of a step off its place
_UNEVENNESS = 0.05


def read_columns(path: Path, lines: list[str]) -> Component:
    """Read lines of two numbers, time [s] and acceleration, after any header and between comments.

    Raises
    ------
    ValueError
        If a line holds something else, or the times do not rise in even steps.
    """
    header: list[str] = []
    rows: list[tuple[float, float]] = []
    numbers: list[int] = []
    for number, line in enumerate(lines, start=1):
        text = line.replace('"', "").strip()
        cells = _cells(text)
        is_data = text[:1] not in _COMMENT_MARKS and (rows or any(map(_is_number, cells)))
        if not is_data:
            if not rows:
                header.append(text)
            continue
        if len(cells) != 2 or not all(map(_is_number, cells)):
            raise ValueError(
                f"{path.name}, line {number}: expected two numbers, time [s] and acceleration, "
                f"got {text[:60]!r}"
            )
        rows.append((parse_number(path, number, cells[0]), parse_number(path, number, cells[1])))
        numbers.append(number)
    if len(rows) < 2:
        raise ValueError(f"{path.name} must hold at least two samples, got {len(rows)}")
    time, values = np.array(rows).T
    return Component(path, values, _even_step(path, time, numbers), stated_unit(path, header), float(time[0]))


def _cells(text: str) -> list[str]:
    text = text.rstrip(",;\t ")
    return re.split(r"\s*[,;]\s*", text) if re.search("[,;]", text) else text.split()


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
