"""Input and output of a time integration, and its access to the record."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .._compile import inlined, jit
from .tsit5 import State, Vector

REST, COMPLETED, OVERTURNED, OVER_BUDGET, STALLED = range(5)  # how a march ends
DECIDED = 5  # while it runs: it is known that it does not overturn after the duration
MAXIMUM, MINIMUM = 1.0, -1.0


class Options(NamedTuple):
    """Options of a time integration."""

    rtol: float  # tolerance of one step, relative
    rest_tilt: float  # tilt of the rest rule over alpha; 0 leaves the rule out
    restitution: float  # of the tilt rate where the base meets the ground in planar motion
    duration: float  # [s]
    step_budget: int
    record_steps: bool


class March(NamedTuple):
    """Output of a time integration; `size` is the number of variables of the model."""

    status: int
    end: float  # time reached [s]; later than the duration only where it overturns after it
    peak: float  # largest tilt until the duration [rad]
    uplift_time: float  # first uplift, or 0 for a release [s]; NaN if there is none
    uplift_direction: float  # rolling angle there [rad]
    samples: NDArray[np.float64]  # (n, size) state at the times asked for
    moving: NDArray[np.bool_]  # (n,) False where the cylinder stands
    reached: int  # how many samples were reached
    final: NDArray[np.float64]  # (size,) state at the end
    extrema: NDArray[np.float64]  # (k, 4) time, tilt, rolling angle, MAXIMUM or MINIMUM
    rests: NDArray[np.float64]  # (r, 2) when it came to rest after moving, and moved again or NaN [s]
    steps: NDArray[np.float64]  # (j, 1 + size) time and state after each step, if recorded
    step_count: int


Driver = Callable[..., March]


# Loops instead of slice assignment: that carries shape checks with formatted messages, which double
# the time to compile.
@jit
def write(source: State, target: NDArray[np.float64]) -> None:
    """Copy a tuple to an array of its length."""
    for i in range(len(source)):
        target[i] = source[i]


class Piece(NamedTuple):
    """A stretch of linear ground motion, from one sample of the record to the next."""

    begin: float  # [s]
    finish: float  # [s]
    length: float  # [s]
    a: Vector  # acceleration at its beginning [m/s^2]
    slope: Vector  # its rate [m/s^3]


@inlined
def piece_of_record(
    record: NDArray[np.float64], time_step: float, index: int, begin: float, last: float
) -> Piece:
    """Return the stretch behind sample `index`, from `begin` and to `last` at the latest [s]."""
    if index >= len(record) - 1:  # the ground is still after the record
        return Piece(begin, last, last - begin, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
    end = index + 1
    a = (record[index, 0], record[index, 1], record[index, 2])
    slope = (
        (record[end, 0] - a[0]) / time_step,
        (record[end, 1] - a[1]) / time_step,
        (record[end, 2] - a[2]) / time_step,
    )
    finish = min(end * time_step, last)
    return Piece(begin, finish, finish - begin, a, slope)
