"""Options and result of a time integration."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .._compile import jit
from .tsit5 import State

REST, COMPLETED, OVERTURNED, OVER_BUDGET, STALLED = range(5)  # how a time integration ends
TURNED = 5  # while it runs: the tilt has reached its first maximum after the duration
MAXIMUM, MINIMUM = 1.0, -1.0


class Options(NamedTuple):
    """Options of a time integration."""

    rtol: float  # tolerance of one step, relative
    rest_tilt: float  # tilt of the rest rule over alpha; 0 leaves the rule out
    restitution: float  # of the tilt rate where the base meets the ground in planar motion
    duration: float  # [s]
    step_budget: int
    record_steps: bool


class IntegrationResult(NamedTuple):
    """Result of a time integration; `size` is the number of variables of the model."""

    status: int
    end: float  # time reached [s]; later than the duration only where it overturns after it
    followed_until: float  # time to which it was followed after the duration [s]; NaN if it did not move then
    peak: float  # largest tilt, until then [rad]
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


Driver = Callable[..., IntegrationResult]


# Loops instead of slice assignment: that carries shape checks with formatted messages, which double
# the time to compile.
@jit
def write(source: State, target: NDArray[np.float64]) -> None:
    """Copy a tuple to an array of its length."""
    for i in range(len(source)):
        target[i] = source[i]
