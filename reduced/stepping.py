"""Accepted steps of a system, and the events inside them.

Nothing here knows of records: the ground acceleration is a + slope t, t from the start of the step.
A state is passed with its derivative, which the step before has left.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from ._compile import jit
from .body import Body
from .systems import System
from .tsit5 import State, Vector, make_step

_SAFETY = 0.9  # aims below the tolerance, so that few steps are repeated
_GROWTH, _SHRINK = 5.0, 0.2  # bounds on the change of the step from one to the next
_SMALL = (_SAFETY / _GROWTH) ** 5  # error ratio below which the step grows by _GROWTH
_MOST_TRIALS = 200  # each shortens the step: enough to come down from any length to none


class Stepper(NamedTuple):
    """The compiled functions that `make_stepper` returns."""

    advance: Callable[..., Any]
    partial: Callable[..., Any]
    turning_point: Callable[..., Any]
    crossing: Callable[..., Any]
    is_flat: Callable[..., Any]


def make_stepper(system: System) -> Stepper:
    """Return the compiled functions for one system."""
    step = make_step(system.derivative, system.combine)
    momenta, error_ratio = system.momenta, system.error_ratio

    @jit
    def is_flat(y: State) -> bool:
        """Return whether a state has neither spin nor twist rate: exactly planar motion."""
        L, S = momenta(y)
        return bool(L == 0.0 and S == 0.0)

    @jit
    def advance(
        body: Body, rtol: float, y: State, k: State, h: float, length: float, a: Vector, slope: Vector
    ) -> tuple[float, float, int, State, State]:
        """Take one accepted step from `y`, of length `h` at first and `length` at the most.

        Returns the length taken, the length proposed for the next step, the number of trials, the
        new state and its derivative. A step that would pass through theta = 0 with spin is
        repeated: the centrifugal barrier cannot be crossed. If no trial is accepted the length is 0.
        """
        proposed = h
        y_new, k_new = y, k
        for trial in range(1, _MOST_TRIALS + 1):
            h = min(proposed, length)
            if proposed < length < 2.0 * proposed:
                h = 0.5 * length  # two even steps instead of a long and a short one
            y_new, k_new, error, lowest = step(body, y, k, h, a, slope)
            flat = is_flat(y) and is_flat(y_new)
            ratio = error_ratio(body, rtol, y, error, flat)
            if ratio <= 1.0 and (lowest > 0.0 or flat):
                longer = h * (_GROWTH if ratio < _SMALL else _SAFETY * ratio**-0.2)
                # a step cut short by the length says nothing against the longer one proposed
                return h, (longer if h == proposed else max(longer, proposed)), trial, y_new, k_new
            shorter = _SHRINK
            if lowest > 0.0 and 1.0 < ratio < np.inf:
                shorter = max(_SHRINK, _SAFETY * ratio**-0.2)
            proposed = h * shorter
        return 0.0, proposed, _MOST_TRIALS, y_new, k_new

    @jit
    def partial(body: Body, y: State, k: State, h: float, a: Vector, slope: Vector) -> tuple[State, State]:
        """Return the state `h` after `y` and its derivative: a step, as accurate as those of the march."""
        y_new, k_new, _, _ = step(body, y, k, h, a, slope)
        return y_new, k_new

    @jit
    def turning_point(
        body: Body, y: State, k: State, h: float, rate_at_end: float, a: Vector, slope: Vector
    ) -> tuple[float, float, float]:
        """Return when, in a step of length `h`, the tilt rate is zero, and tilt and rolling angle there.

        Newton's method on partial steps. What it leaves is of second order in the tilt.
        """
        at = h * y[1] / (y[1] - rate_at_end)
        tilt, angle = y[0], y[2]
        for _ in range(3):
            y_at, k_at = partial(body, y, k, at, a, slope)
            change = -y_at[1] / k_at[1]
            tilt, angle = y_at[0] + 0.5 * y_at[1] * change, y_at[2] + k_at[2] * change
            if not 0.0 <= at + change <= h:
                break
            at += change
        return at, tilt, angle

    @jit
    def crossing(
        body: Body, y: State, k: State, first: float, last: float, a: Vector, slope: Vector, level: float
    ) -> tuple[float, State]:
        """Return when, from `first` to `last`, the tilt reaches `level`, and the state there.

        The tilt sinks to 0 or rises to any other level. Newton's method on partial steps, kept inside
        the bracket by bisection.
        """
        low, high = first, last
        side = 1.0 if level == 0.0 else -1.0
        at = 0.5 * (first + last)
        y_at = y
        for _ in range(80):
            y_at, _ = partial(body, y, k, at, a, slope)
            miss = y_at[0] - level
            if miss * side > 0.0:
                low = at
            else:
                high = at
            guess = at - miss / y_at[1]
            if not low < guess < high:
                guess = 0.5 * (low + high)
            if abs(guess - at) <= 1e-15 * last:
                break
            at = guess
        return at, y_at

    return Stepper(advance, partial, turning_point, crossing, is_flat)
