"""Events inside a step: turning points of the tilt, impact of the base, overturning.

A step is given by its method (`stepping.Stepper`) and what that keeps of it: ``work`` and ``path``.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .._compile import inlined, jit
from ..body import Body
from .record import Vector, ground
from .result import MAXIMUM, MINIMUM, OVERTURNED_TILT, State
from .stepping import Stepper
from .systems import System, make_is_flat

TAKEN, REPEATED = range(2)  # fate of a step
NO_TURN = 0.0  # beside MAXIMUM and MINIMUM
# trial evaluations before the last one, which moves a turning point by so small a share of the step
_FEWEST, _CLOSE = 2, 1e-7
_TANGENTS = 20  # evaluations in search of a reversal
_RETRY = 1.0 / 32.0  # factor on the length of a failed step; the next may be four times as long


class Turn(NamedTuple):
    """A turning point of the tilt inside a step."""

    kind: float  # MAXIMUM, MINIMUM or NO_TURN
    at: float  # time since the beginning of the step [s]
    tilt: float
    angle: float  # rolling angle


NONE = Turn(NO_TURN, 0.0, 0.0, 0.0)


class Trial(NamedTuple):
    """A trial step."""

    verdict: int  # TAKEN, or REPEATED with the length `h_next`
    h: float  # its length [s]
    h_next: float  # length proposed for the next one [s]
    trials: int  # number of trials of its method
    y: State  # state at its end
    k: State  # values handed to the next step, with ``path``
    path: object
    turn: Turn
    flat: bool  # motion without spin and twist rate: exactly planar


class Ending(NamedTuple):
    """End of a step: its full length, or earlier, where the base or the side meets the ground."""

    h: float  # its length [s]
    y: State
    lands: bool  # whether the base lands, in planar motion
    overturns: bool  # the side
    turns: bool  # the turning point lies before this end


class Events(NamedTuple):
    """The compiled functions that find the events inside a step."""

    tried: Callable[..., Trial]  # (body, rtol, y, k, work, h, length, a, slope)
    ending_of: Callable[..., Ending]  # (body, work, y, trial)


def make_events(system: System, stepper: Stepper) -> Events:
    """Return the search for events in the steps that `stepper` takes."""
    _, restarted, advance, partial, acceleration = stepper
    is_flat = make_is_flat(system.momenta)

    @jit
    def turning_point(
        body: Body, work: NDArray[np.float64], path: object, y: State, h: float, rate_at_end: float
    ) -> tuple[float, float, float]:
        """Return the time of a zero tilt rate in a step of length `h`, and tilt and rolling angle there.

        Newton's method on partial steps, kept inside the bracket by bisection: of a rate that bends, a
        tangent may lead elsewhere. What it leaves is of second order in the tilt.
        """
        low, high = 0.0, h
        at = h * y[1] / (y[1] - rate_at_end)
        tilt, angle = y[0], y[2]
        for count in range(80):
            y_at, k_at = partial(body, work, path, at)
            if y_at[1] * y[1] > 0.0:
                low = at
            else:
                high = at
            change = -y_at[1] / k_at[1]
            if not low <= at + change <= high:
                change = 0.5 * (low + high) - at
            tilt, angle = y_at[0] + 0.5 * y_at[1] * change, y_at[2] + k_at[2] * change
            at += change
            if count >= _FEWEST and abs(change) <= _CLOSE * h:
                break
        return at, tilt, angle

    @jit
    def crossing(
        body: Body, work: NDArray[np.float64], path: object, y: State, first: float, last: float, level: float
    ) -> tuple[float, State]:
        """Return the time from `first` to `last` at which the tilt reaches `level`, and the state there.

        The tilt sinks to 0 or rises to any other level. Newton's method on partial steps, kept inside
        the bracket by bisection.
        """
        low, high = first, last
        side = 1.0 if level == 0.0 else -1.0
        at = 0.5 * (first + last)
        y_at = y
        for _ in range(80):
            y_at, _ = partial(body, work, path, at)
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

    @jit
    def reversal(
        body: Body, work: NDArray[np.float64], path: object, y: State, h: float, rate_at_end: float
    ) -> float:
        """A time in a step at which the tilt rate has the opposite sign of that at both ends; 0 if none.

        Where the rate is least in size is sought by its tangents, above which it stays between a time at
        which it falls in size and one at which it grows.
        """
        sign = 1.0 if y[1] > 0.0 else -1.0
        _, k_at = partial(body, work, path, h)
        low, rate_low, slope_low = 0.0, sign * y[1], sign * acceleration(work, path)
        high, rate_high, slope_high = h, sign * rate_at_end, sign * k_at[1]
        for _ in range(_TANGENTS):
            if slope_high <= 0.0:
                break
            # intersection of the tangents at both ends
            at = (rate_high - rate_low + slope_low * low - slope_high * high) / (slope_low - slope_high)
            if rate_low + slope_low * (at - low) > 0.0:
                break
            y_at, k_at = partial(body, work, path, at)
            rate, slope = sign * y_at[1], sign * k_at[1]
            if rate < 0.0:
                return float(at)
            if slope < 0.0:
                low, rate_low, slope_low = at, rate, slope
            else:
                high, rate_high, slope_high = at, rate, slope
        return 0.0

    @inlined
    def turn_in(
        body: Body, work: NDArray[np.float64], path: object, y: State, h: float, y_new: State
    ) -> Turn:
        """Return the turning point of the tilt in a step from `y` to `y_new`."""
        if not y[1] * y_new[1] < 0.0:
            return NONE
        at, tilt, angle = turning_point(body, work, path, y, h, y_new[1])
        return Turn(MAXIMUM if y[1] > 0.0 else MINIMUM, at, tilt, angle)

    @inlined
    def attempt(
        body: Body,
        rtol: float,
        y: State,
        k: State,
        work: NDArray[np.float64],
        h: float,
        length: float,
        a: Vector,
        slope: Vector,
    ) -> Trial:
        """Try a step from `y`, as `stepping.Stepper.advance`.

        One that does not fit or that jumped the centrifugal barrier and came back is to be repeated.
        """
        h, h_next, count, y_new, k, path = advance(body, rtol, y, k, work, h, length, a, slope)
        if h == 0.0:
            return Trial(REPEATED, h, h_next, count, y_new, k, path, NONE, False)
        if y[1] * y_new[1] > 0.0 and y[1] * (y[1] + acceleration(work, path) * h) < 0.0:
            at = reversal(body, work, path, y, h, y_new[1])
            if at > 0.0:  # two turning points in one step: it ends between them
                h, (y_new, _) = at, partial(body, work, path, at)
                k = restarted(body, y_new, ground(a, slope, at), work)
        flat = is_flat(y) and is_flat(y_new)
        turn = turn_in(body, work, path, y, h, y_new)
        if turn.kind != NO_TURN and not flat and min(turn.tilt, y_new[0]) <= 0.0:
            return Trial(REPEATED, h, _RETRY * h, count, y_new, k, path, turn, flat)
        return Trial(TAKEN, h, h_next, count, y_new, k, path, turn, flat)

    @inlined
    def ending_of(body: Body, work: NDArray[np.float64], y: State, trial: Trial) -> Ending:
        """Return the end of a step from `y`."""
        h, y_new, turn = trial.h, trial.y, trial.turn
        turns = turn.kind != NO_TURN
        # a body without a balance may turn back just beyond pi/2, within the step
        beyond = turn.kind == MAXIMUM and turn.tilt >= OVERTURNED_TILT
        overturns = beyond or y_new[0] >= OVERTURNED_TILT
        # with spin the tilt stays positive; without spin the base meets the ground
        lands = trial.flat and not beyond and (y_new[0] <= 0.0 or (turns and turn.tilt <= 0.0))
        if not (lands or overturns):
            return Ending(h, y_new, lands, overturns, turns)
        # a hop within one step lands after its highest point, a dip before its lowest
        hops = lands and turns and turn.tilt > 0.0
        first = turn.at if hops else 0.0
        last = turn.at if beyond or (lands and turns and not hops) else h
        h, y_new = crossing(body, work, trial.path, y, first, last, OVERTURNED_TILT if overturns else 0.0)
        return Ending(h, y_new, lands, overturns, hops)

    return Events(attempt, ending_of)
