"""Log of a time integration: rows of its tables, and its state at one moment."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .._compile import jit
from .result import MAXIMUM, write
from .tsit5 import State


class Log(NamedTuple):
    """Rows of the tables that a time integration returns (`IntegrationResult`).

    Lists, typed by a row and emptied: a growing array would have its references counted in each step.
    """

    extrema: list[tuple[float, float, float, float]]
    rests: list[tuple[float, float]]
    steps: list[tuple[float, ...]]


class Mark(NamedTuple):
    """State at the end of the duration, from which the motion is followed."""

    y: State
    counts: tuple[int, int, int]  # rows of the log


@jit
def empty_log(y: State) -> Log:
    """Return a log without rows."""
    log = Log([(0.0, 0.0, 0.0, 0.0)], [(0.0, 0.0)], [(0.0, *y)])
    log.extrema.clear()
    log.rests.clear()
    log.steps.clear()
    return log


@jit
def mark_of(y: State, log: Log) -> Mark:
    """Return the present state."""
    return Mark(y, (len(log.extrema), len(log.rests), len(log.steps)))


@jit
def has_turned(log: Log, since: float) -> bool:
    """Return whether the tilt has had a maximum since a time [s]."""
    for i in range(len(log.extrema) - 1, -1, -1):
        if log.extrema[i][0] < since:
            return False
        if log.extrema[i][3] == MAXIMUM:
            return True
    return False


@jit
def as_table(rows: Any, count: int, width: int) -> NDArray[np.float64]:
    """Return the first `count` tuples of a list as an array (count, width)."""
    table = np.empty((count, width))
    for i in range(count):
        write(rows[i], table[i])
    return table
