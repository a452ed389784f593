"""Options and result of a time integration, and the log from which the tables of the result are made."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import pi
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .._compile import jit
from ..body import Body

State = tuple[float, ...]

REST, COMPLETED, OVERTURNED, OVER_BUDGET, STALLED = range(5)  # how a time integration ends
UNDECIDED = 6  # rounding decides whether it falls (`balance`)
TURNED = 5  # while it runs: the tilt has reached its first maximum after the duration
MAXIMUM, MINIMUM = 1.0, -1.0
# copy of the bound in `models.bounds`: the cache of machine code knows the content of this folder alone
OVERTURNED_TILT = 0.5 * pi


class Options(NamedTuple):
    """Options of a time integration."""

    rtol: float  # relative tolerance of one step
    rest_tilt: float  # tilt of the rest rule over alpha; 0 leaves the rule out
    restitution: float  # ratio of tilt rates where the base meets the ground in planar motion
    duration: float  # [s]
    step_budget: int
    record_steps: bool


class Task(NamedTuple):
    """Motion to integrate."""

    record: NDArray[np.float64]  # (m, 3) samples of the ground acceleration [m/s^2]; m = 0 for still ground
    time_step: float  # their spacing [s]
    initial: State  # state at time zero; zero tilt stands at rest
    times: NDArray[np.float64]  # (n,) increasing, at which states are wanted [s]; they influence no step
    # (m, 2) from each sample on, the largest |a| and the least az of the record [m/s^2], by which a fall that
    # nothing can stop ends the integration early; m = 0 goes on until the side is down
    later: NDArray[np.float64]


class IntegrationResult(NamedTuple):
    """Result of a time integration; `size` is the number of variables of the model."""

    status: int
    end: float  # end of the run [s]; later than the duration only where it overturns after it
    followed_until: float  # end of the motion followed after the duration [s]; NaN if none was
    peak: float  # largest tilt up to that time [rad]
    uplift_time: float  # first uplift, or 0 for a release [s]; NaN if there is none
    uplift_direction: float  # rolling angle there [rad]
    samples: NDArray[np.float64]  # (n, size) state at the times asked for
    moving: NDArray[np.bool_]  # (n,) False where the cylinder stands
    reached: int  # number of samples reached
    final: NDArray[np.float64]  # (size,) state at the end
    extrema: NDArray[np.float64]  # (k, 4) time, tilt, rolling angle, MAXIMUM or MINIMUM
    rests: NDArray[np.float64]  # (r, 2) times of rest after motion, and of the next motion or NaN [s]
    steps: NDArray[np.float64]  # (j, 1 + size) time and state after each step, if recorded
    step_count: int


Driver = Callable[[Body, Options, Task], IntegrationResult]


# Loops instead of slice assignment: that carries shape checks with formatted messages, which double
# the time to compile.
@jit
def write(source: State, target: NDArray[np.float64]) -> None:
    """Copy a tuple to an array of its length."""
    for i in range(len(source)):
        target[i] = source[i]


class Log(NamedTuple):
    """Rows of the tables that a time integration returns (`IntegrationResult`).

    Lists, typed by a row and emptied: a growing array would have its references counted in each step.
    """

    extrema: list[tuple[float, float, float, float]]
    rests: list[tuple[float, float]]
    steps: list[tuple[float, ...]]


class Mark(NamedTuple):
    """State at the end of the duration, from which a motion is followed on."""

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
def as_table(rows: Sequence[State], count: int, width: int) -> NDArray[np.float64]:
    """Return the first `count` tuples of a list as an array (count, width)."""
    table = np.empty((count, width))
    for i in range(count):
        write(rows[i], table[i])
    return table
