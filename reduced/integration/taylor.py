"""One step of the recess model as a Taylor series in time, of the order that the tolerance asks for.

The radius of convergence is the time to upright, about theta/speed, so a sample of a record takes order 5
to 7 far from upright and more steps of a high order near it. `recurrences` has the series of the
equations. See A. Jorba and M. Zou, "A software package for the numerical integration of ODEs by means of
high-order Taylor methods", Experimental Mathematics 14 (2005) 99-117.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from .._compile import inlined, jit
from ..body import Body
from .recurrences import AIM, LAST_BUT_ONE, expand, fits
from .series import STEPS_LEFT, Path, acceleration, partial, state_at, workspace
from .tsit5 import State, Vector

__all__ = ["acceleration", "advance", "partial", "restarted", "workspace"]

_SAFETY = 0.9  # on the length of a step that the order limits
_GROWTH = 4.0  # bound on the growth of the step from one to the next
_SHRINK = 1.0 / 32.0  # of a step not taken; the next trial is _GROWTH times as long


@jit
def restarted(body: Body, y: State, a: Vector, work: NDArray[np.float64]) -> State:
    """Forget the sine and cosine of the last step: the state has jumped."""
    work[STEPS_LEFT] = 0.0
    return y


@jit
def fitting_share(order: int, last: float, before: float) -> float:
    """Return the share of the unit of time at which a series with these last two terms fits."""
    by_remainder = (AIM * before / (last * last)) ** (1.0 / (order + 1))
    by_term = (LAST_BUT_ONE / before) ** (1.0 / (order - 1))
    return float(_SAFETY * min(1.0, by_remainder, by_term))


@inlined
def advance(
    body: Body,
    rtol: float,
    y: State,
    k: State,
    work: NDArray[np.float64],
    h: float,
    length: float,
    a: Vector,
    slope: Vector,
) -> tuple[float, float, int, Any, Any, Path]:
    """Take one step from `y`, of about length `h` and `length` at the most; see `stepping.Stepper`.

    The series is never repeated: where its highest order does not reach, the step is as long as it
    reaches. Only one that would pass through theta = 0 with spin, or that overflows, is not taken.
    """
    unit = min(_GROWTH * h, length)
    order, last, before, y_new = expand(body, rtol, y, unit, a, slope, work)
    taken, proposed = unit, max(unit, h)
    if not fits(last, before):
        share = fitting_share(order, last, before)
        if share > 0.5 and unit == length:
            share = 0.5  # two even steps instead of a long and a short one
        taken = proposed = share * unit
        y_new = state_at(work, order, share)
        work[STEPS_LEFT] = 0.0
    if y_new[0] > 0.0 or (y[3] == 0.0 and y_new[3] == 0.0 and y_new[0] > -np.inf):
        return taken, proposed, 1, y_new, y_new, (unit, order)
    work[STEPS_LEFT] = 0.0
    return 0.0, _SHRINK * unit, 1, y, y, (unit, order)
