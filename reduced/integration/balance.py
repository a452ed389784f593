"""Balance of a body over still ground: until when its motion is followed, and where rounding decides it.

Next to a balance, or to an unstable steady wobble, every distance d grows by exp(p t), and what comes there
slows down alike. A motion that stays for longer than `LONGEST` is nearer than 1e-14 of its tilt: there the
rounding of the equations decides whether it falls. And of the maxima over still ground the first is the
largest (`driver`): a solution that rises above it has passed the balance by its own error.
"""

from __future__ import annotations

from collections.abc import Callable
from math import cos, inf, log, sin

from .._compile import inlined, jit
from ..body import Body
from ..equations import energy
from ..restoring import acceleration_back
from .result import COMPLETED, MAXIMUM, OVERTURNED_TILT, UNDECIDED, IntegrationResult, Log, State

# time in 1/p between the balance and the tilt alpha on either side of it: log(2e14) and a little
LONGEST = 34.0
# tilt acceleration over p^2 alpha of a release at rest that is rounding: it neither falls nor turns back
_ROUNDING = 3e-15
_NEARBY = 1e-6  # relative step of the numerical derivative by the tilt
_ABOVE = 1e-6  # relative margin over a maximum, more than rounding of the tilt there


def decide(body: Body, result: IntegrationResult) -> IntegrationResult:
    """Mark a result as undecided where its peak is the balance itself, so that rounding decides.

    Here and not in the kernel, whose last bits hang on how much there is to compile.
    """
    on_balance = abs(result.peak - body.balance) <= _ROUNDING * body.alpha
    if on_balance and result.status == COMPLETED:
        return result._replace(status=UNDECIDED)
    return result


@jit
def longest_stay(body: Body) -> float:
    """Longest time that a motion may stay by its balance, and then fall from there [s]."""
    return (LONGEST + log(OVERTURNED_TILT / body.alpha)) / body.p


@inlined
def can_exceed_peak(
    body: Body, momenta: Callable[[State], tuple[float, float]], y: State, peak: float
) -> bool:
    """Return whether over still ground the energy of a state lets the tilt rise above `peak` later."""
    L, S = momenta(y)
    return energy(body, y[0], y[1], L, S) > energy(body, min(peak, body.balance), 0.0, 0.0, 0.0)


@jit
def turns_back(body: Body, acceleration: float) -> bool:
    """Return whether a body released at rest with this tilt acceleration [rad/s^2] is at a maximum."""
    return acceleration < -_ROUNDING * body.p * body.p * body.alpha


@jit
def turn_since(rows: Log, since: float, last: float) -> tuple[float, float, float]:
    """Summary of the log from a time [s] to the first maximum after it.

    Returns
    -------
    longest : float
        Longest time between two turning points on that way, or to the time `last` where there is none [s].
    before : float
        Last turning point before it, or `since` [s].
    tilt : float
        The maximum [rad]; infinite if there is none.
    """
    longest, before = 0.0, since
    for i in range(len(rows.extrema)):
        time, tilt, _, kind = rows.extrema[i]
        if time < since:
            continue
        longest = max(longest, time - before)
        if kind == MAXIMUM:
            return longest, before, tilt
        before = time
    return max(longest, last - before), before, inf


@jit
def free_acceleration(body: Body, theta: float, L: float) -> float:
    """Tilt acceleration over still ground, without twist and losses, (18) [rad/s^2].

    Its own formula, not the one of the model: one more call of that changes the last bits of all runs, by
    where the compiler fuses a multiplication with an addition.
    """
    acceleration = -acceleration_back(body, theta)
    if L != 0.0:
        s, c = sin(theta), cos(theta)
        t = s / (1.0 + c)
        H = body.J + 2.0 * body.E * t + body.C * t * t
        B = s * s * H
        B_theta = 2.0 * s * c * H + s * s * (body.E + body.C * t) * (1.0 + t * t)
        acceleration += 0.5 * B_theta / body.A * (L / B) ** 2
    return acceleration


@jit
def departs(body: Body, theta: float, L: float) -> bool:
    """Whether a small distance from a tilt grows, as it does not in a stable steady wobble."""
    beyond = free_acceleration(body, theta * (1.0 + _NEARBY), L)
    return beyond > free_acceleration(body, theta, L)


@jit
def is_undecided(
    body: Body, theta: float, L: float, rows: Log, since: float, last: float, falls: bool, grows: bool
) -> bool:
    """Whether rounding, or the error of the solution, decided between a fall and a return.

    `theta` and `L` are its tilt and spin at the end, `since` is when the ground began to keep still, `last`
    the time reached [s], `falls` says that the side came to the ground, and `grows` that a later maximum may
    be larger than the first.
    """
    longest, _, top = turn_since(rows, since, last)
    beyond = theta > top * (1.0 + _ABOVE) and free_acceleration(body, theta, L) > 0.0
    if not grows and top < inf and (falls or beyond):
        return True
    return longest > longest_stay(body) and (falls or departs(body, min(theta, top), L))
