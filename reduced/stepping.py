"""Accepted steps and the events inside them, for one system of equations.

All functions share a `Work` space, so that a march allocates once. Nothing here knows of records:
the ground acceleration is a + slope t, t from the start of the step.
"""

from __future__ import annotations

from collections.abc import Callable
from math import sqrt
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ._compile import jit
from .body import Body
from .tsit5 import STAGES, Derivative, make_step

_SAFETY = 0.9  # aims below the tolerance, so that few steps are repeated
_ROUNDING = float(np.finfo(np.float64).eps)
_GROWTH, _SHRINK = 5.0, 0.2  # bounds on the change of the step from one to the next


class Work(NamedTuple):
    """Scratch arrays of a march; shapes (7, size) and (size,)."""

    k: NDArray[np.float64]  # stages of the last accepted step; k[0] belongs to its start
    y_new: NDArray[np.float64]
    error: NDArray[np.float64]
    k_aside: NDArray[np.float64]  # stages of partial steps, which leave k alone
    aside: NDArray[np.float64]


class Stepper(NamedTuple):
    """The compiled functions that `make_stepper` returns."""

    advance: Callable[..., tuple[float, float, int]]
    partial: Callable[..., None]
    turning_point: Callable[..., float]
    crossing: Callable[..., float]


@jit
def work_space(size: int) -> Work:
    """Return the scratch arrays for `size` variables."""
    return Work(
        np.empty((STAGES, size)), np.empty(size), np.empty(size), np.empty((STAGES, size)), np.empty(size)
    )


# Loops instead of slice assignment and array expressions: those carry shape checks with formatted
# messages, which triple the time to compile.
@jit
def copy(source: NDArray[np.float64], target: NDArray[np.float64]) -> None:
    """Copy `source` to `target`, both (n,)."""
    for i in range(len(source)):
        target[i] = source[i]


@jit
def ground(a: NDArray[np.float64], slope: NDArray[np.float64], t: float, out: NDArray[np.float64]) -> None:
    """Write the ground acceleration a + slope t to `out`; all (3,)."""
    for i in range(3):
        out[i] = a[i] + slope[i] * t


@jit
def is_flat(y: NDArray[np.float64]) -> bool:
    """Return whether a state has neither spin nor twist rate: exactly planar motion."""
    if len(y) > 4:
        return bool(y[3] == 0.0 and y[5] == 0.0)
    return len(y) == 3 or bool(y[3] == 0.0)


@jit
def error_ratio(
    body: Body, rtol: float, y: NDArray[np.float64], error: NDArray[np.float64], flat: bool
) -> float:
    """Return the error of a step from `y` over what the relative tolerance allows.

    Near the apex the motion is that of a point at the polar distance theta, with one speed in all
    directions: theta and phi are held to theta, and the rates to that speed. Planar motion goes
    through theta = 0, so there the tilt is held to what the speed makes of it in the time 1/p. Near
    theta = alpha, where every difference grows as exp(p t), the distance from alpha takes the place
    of theta. An error below the rounding of the tilt cannot be told from none.
    """
    tilt = float(abs(y[0]))
    p = sqrt(body.p2)
    from_alpha = abs(body.alpha - tilt)
    speed = float(abs(y[1]))
    if not flat:
        speed += abs(y[3]) / (body.J * tilt)
    velocity = speed + p * min(sqrt(body.sin_alpha * tilt), from_alpha)
    distance = min(tilt + velocity / p if flat else tilt, from_alpha + speed / p)
    least = _ROUNDING * tilt / rtol
    distance, velocity = max(distance, least), max(velocity, p * least)
    ratio = max(abs(error[0]) / distance, abs(error[1]) / velocity)
    if not flat:
        ratio = max(ratio, abs(error[2]), abs(error[3]) / (body.J * tilt * velocity))
    if len(y) > 4:
        M = body.C - body.E * body.E / body.J
        ratio = max(ratio, abs(error[4]), abs(error[5]) / (sqrt(body.A * M) * velocity))
        ratio = max(ratio, abs(error[6]) / body.b, abs(error[7]) / body.b)
    return float(ratio / rtol)


def make_stepper(derivative: Derivative, size: int) -> Stepper:
    """Return the compiled functions for a system of `size` variables; see `tsit5.make_step`."""
    step = make_step(derivative, size)

    @jit
    def advance(
        body: Body,
        rtol: float,
        y: NDArray[np.float64],
        work: Work,
        h: float,
        length: float,
        a: NDArray[np.float64],
        slope: NDArray[np.float64],
    ) -> tuple[float, float, int]:
        """Take one accepted step from `y`, of length `h` at first and `length` at the most.

        Returns the length taken, the length proposed for the next step, and the number of trials;
        the new state is in work.y_new. A step that would pass through theta = 0 with spin is
        repeated: the centrifugal barrier cannot be crossed. After 200 trials the length is 0.
        """
        proposed = h
        for trial in range(1, 201):
            h = min(proposed, length)
            if proposed < length < 2.0 * proposed:
                h = 0.5 * length  # two even steps instead of a long and a short one
            lowest = step(body, y, work.k, h, a, slope, work.y_new, work.error)
            flat = is_flat(y) and is_flat(work.y_new)
            ratio = error_ratio(body, rtol, y, work.error, flat)
            if ratio <= 1.0 and (lowest > 0.0 or flat):
                longer = h * min(_GROWTH, _SAFETY * max(ratio, 1e-30) ** -0.2)
                # a step cut short by the length says nothing against the longer one proposed
                return h, (longer if h == proposed else max(longer, proposed)), trial
            proposed = h * _SHRINK
            if lowest > 0.0 and 1.0 < ratio < np.inf:
                proposed = h * max(_SHRINK, _SAFETY * ratio**-0.2)
        return 0.0, proposed, trial

    @jit
    def partial(
        body: Body,
        y: NDArray[np.float64],
        work: Work,
        h: float,
        a: NDArray[np.float64],
        slope: NDArray[np.float64],
        out: NDArray[np.float64],
    ) -> None:
        """Write to `out` the state `h` after `y`: a step of its own, so as accurate as the march."""
        copy(work.k[0], work.k_aside[0])
        step(body, y, work.k_aside, h, a, slope, out, work.error)

    @jit
    def turning_point(
        body: Body,
        y: NDArray[np.float64],
        work: Work,
        h: float,
        a: NDArray[np.float64],
        slope: NDArray[np.float64],
    ) -> float:
        """Return when, in a step of length `h`, the tilt rate is zero; the state is in work.aside.

        Newton's method on partial steps. What it leaves is of second order in the tilt.
        """
        at = float(h * y[1] / (y[1] - work.y_new[1]))
        change = 0.0
        for _ in range(3):
            partial(body, y, work, at, a, slope, work.aside)
            change = -work.aside[1] / work.k_aside[STAGES - 1, 1]
            if not 0.0 <= at + change <= h:
                change = 0.0
                break
            at += change
        work.aside[0] += 0.5 * work.aside[1] * change
        work.aside[2] += work.k_aside[STAGES - 1, 2] * change
        return at

    @jit
    def crossing(
        body: Body,
        y: NDArray[np.float64],
        work: Work,
        h: float,
        a: NDArray[np.float64],
        slope: NDArray[np.float64],
        level: float,
    ) -> float:
        """Return when, within `h`, the tilt reaches `level`; the state there is in work.aside.

        Newton's method on partial steps, kept inside the bracket by bisection.
        """
        low, high = 0.0, h
        side = y[0] - level
        at = 0.5 * h
        for _ in range(80):
            partial(body, y, work, at, a, slope, work.aside)
            miss = work.aside[0] - level
            if miss * side > 0.0:
                low = at
            else:
                high = at
            guess = at - miss / work.aside[1]
            if not low < guess < high:
                guess = 0.5 * (low + high)
            if abs(guess - at) <= 1e-15 * h:
                break
            at = guess
        return at

    return Stepper(advance, partial, turning_point, crossing)
