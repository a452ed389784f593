"""The two tilts between which a release rocks and wobbles; symbols in `_shape`.

Energy and momentum confine the tilt where

    theta'^2 A/2 = A theta0'^2/2 - 2 (t - t0) [g sigma(t, t0)/(n n0) - beta(t, t0) G0 phi0'^2/(n0^4 G)]

is positive. With theta0' = 0 the factor (t - t0) is divided out, so that the other turning tilt is a
simple root however near or far it is. Steady wobble at t has the momentum

    L^2 = 8 V' t^3 H^2/(n^2 K),

V' = g R sin(gap), which rises from zero to its one maximum and falls to zero at alpha: on the falling side
steady wobble is unstable, and is the top of the barrier beyond which a release of that momentum overturns.
That the maximum is the only one is not proved; tests check it over all slendernesses and inertias. With a
tendon V' is zero at the balance tilt instead, or positive up to pi/2, where the side is down; then the
momentum may rise all the way.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

from rockwobble.models.bounds import OVERTURNED_TILT

from ..body import Body
from ..restoring import couple, couple_slope, sigma
from ._shape import T, base_inertia, beta, inertia_growth

_SMALLEST = 2.0**-1022  # absolute tolerance of the root finder: none, so that small tilts keep their digits
_RTOL = 4.0 * 2.0**-52  # smallest tolerance that the root finder allows
_STRIDE = 4.0  # growth of the bracket in the search; a few strides, wherever the root lies


class Turning(NamedTuple):
    """Turning tilts, with the distance of the larger one from alpha stored besides, not as a difference."""

    t1: float  # tan(theta/2) at the minimum
    t2: float  # tan(theta/2) at the maximum
    gap2: float  # alpha - theta at the maximum [rad]


def turning_tilts(body: Body, R: float, tilt: float, tilt_rate: float, rolling_rate: float) -> Turning | None:
    """Return the turning tilts of a release with `rolling_rate` not zero, None where it overturns."""
    if tilt >= _edge(body):  # beyond it both moments drive the tilt outward
        return None
    t0, gap0 = math.tan(0.5 * tilt), body.alpha - tilt
    kinetic = 0.5 * body.A * tilt_rate**2
    if kinetic == 0.0 and _outward_push(body, R, t0, gap0, rolling_rate) <= 0.0:
        return Turning(_inner(body, R, t0, gap0, kinetic, rolling_rate), t0, gap0)
    barrier = _barrier(body, R, t0, rolling_rate)
    if barrier is None or t0 >= barrier:
        return None
    rise = _rise(body, R, t0, gap0, kinetic, rolling_rate, barrier - t0)
    if rise is None:
        return None
    t1 = _inner(body, R, t0, gap0, kinetic, rolling_rate) if kinetic else t0
    t2 = t0 + rise
    return Turning(t1, t2, gap0 - 2.0 * math.atan(rise / (1.0 + t0 * t2)))


def _outward_push(body: Body, R: float, t: float, gap: float, rolling_rate: float) -> float:
    """Return A theta'' [m^2/s^2] in t."""
    n = 1.0 + t * t
    return 2.0 * t * inertia_growth(body, t) * rolling_rate**2 / n**2 - couple(body, R, t, gap)


def _inner(body: Body, R: float, t0: float, gap0: float, kinetic: float, rolling_rate: float) -> float:
    """Return the largest turning tilt that is not above `t0`, as t."""
    n0 = 1.0 + t0 * t0
    G0 = t0 * t0 * base_inertia(body, t0)

    # both over phi0'^2/t^2: the root is proportional to the spin, whose square may underflow
    def drive(x: float) -> float:
        fall = body.g * sigma(body, R, gap0, t0, t0 - x) / ((1.0 + x * x) * n0)
        return base_inertia(body, x) * (kinetic + 2.0 * (t0 - x) * fall if kinetic else fall)

    def centrifugal(x: float) -> float:
        barrier = beta(body, x, t0) * G0 / n0**4
        return 2.0 * (t0 - x) * barrier if kinetic else barrier

    def excess(x: float) -> float:
        return (x / spin) ** 2 * drive(x) - centrifugal(x)

    spin = abs(rolling_rate)
    guess = spin * math.sqrt(centrifugal(0.0) / drive(0.0))
    root = _first_root(excess, guess, t0)
    return t0 if root is None else root  # rounding may hide the change of sign at t0 itself


def _rise(
    body: Body, R: float, t0: float, gap0: float, kinetic: float, rolling_rate: float, limit: float
) -> float | None:
    """Return t - t0 at the smallest turning tilt that is not below t0, None if it is beyond `limit`."""
    n0, H0 = 1.0 + t0 * t0, base_inertia(body, t0)

    def excess(rise: float) -> float:
        x = t0 + rise
        G_ratio = (t0 / x) ** 2 * H0 / base_inertia(body, x)
        climb = body.g * sigma(body, R, gap0, t0, -rise) / ((1.0 + x * x) * n0)
        climb -= beta(body, x, t0) * G_ratio * rolling_rate**2 / n0**4
        return 2.0 * rise * climb - kinetic if kinetic else climb

    return _first_root(excess, min(t0, limit), limit)


def highest_without_spin(body: Body, R: float, tilt: float, tilt_rate: float) -> tuple[float, float] | None:
    """Return the largest tilt of planar motion and its distance from alpha [rad], None if it overturns."""
    t0, gap0 = math.tan(0.5 * tilt), body.alpha - tilt
    rise = _rise(body, R, t0, gap0, 0.5 * body.A * tilt_rate**2, 0.0, math.tan(0.5 * _edge(body)) - t0)
    if rise is None:
        return None
    risen = 2.0 * math.atan(rise / (1.0 + t0 * (t0 + rise)))
    return tilt + risen, gap0 - risen


def _edge(body: Body) -> float:
    """Return the tilt beyond which nothing comes back [rad]: the balance, or where the side is down."""
    return min(body.balance, OVERTURNED_TILT)


def _barrier(body: Body, R: float, t0: float, rolling_rate: float) -> float | None:
    """Return tan(theta/2) at the top of the barrier, None if nothing holds a release with this spin."""
    momentum = (t0 * t0 * base_inertia(body, t0) * rolling_rate / (1.0 + t0 * t0) ** 2) ** 2  # L^2/16

    def gap(x: float) -> float:
        return body.alpha - 2.0 * math.atan(x)

    def surplus(x: float) -> float:
        H, n, K = base_inertia(body, x), 1.0 + x * x, inertia_growth(body, x)
        return 0.5 * couple(body, R, x, gap(x)) * x**3 * H * H / (n * n * K) - momentum

    def growth(x: float) -> float:
        return momentum_growth(body, R, x, gap(x))

    edge = math.tan(0.5 * _edge(body))
    crest = edge if growth(edge) >= 0.0 else _root(growth, 0.0, edge)
    if surplus(crest) <= 0.0:
        return None
    return edge if surplus(edge) >= 0.0 else _root(surplus, crest, edge)


def momentum_growth(body: Body, R: float, t: T, gap: T) -> T:
    """Return the logarithmic derivative of the momentum L^2 of steady wobble by t, times t V' [m^2/s^2]."""
    H, n, K = base_inertia(body, t), 1.0 + t * t, inertia_growth(body, t)
    H_slope = 2.0 * (body.E + body.C * t)
    K_slope = body.E * 3.0 * (1.0 - t * t) + 2.0 * t * (2.0 * body.C - body.J)
    powers = 3.0 + t * (2.0 * H_slope / H - 4.0 * t / n - K_slope / K)
    return couple(body, R, t, gap) * powers + couple_slope(body, R, t, gap) * 2.0 * t / n


def _first_root(f: Callable[[float], float], guess: float, limit: float) -> float | None:
    """First root of `f`, which is negative at 0; None if there is none before `limit`."""
    lower = upper = min(max(guess, _SMALLEST), limit)
    while f(upper) < 0.0:
        if upper == limit:
            return None
        lower, upper = upper, min(_STRIDE * upper, limit)
    while f(lower) > 0.0:
        if lower < _SMALLEST:
            return 0.0
        lower, upper = lower / _STRIDE, lower
    return _root(f, lower, upper)


def _root(f: Callable[[float], float], lower: float, upper: float) -> float:
    """Return the root of `f` between two points of different sign, to rounding."""
    from scipy.optimize import brentq

    return float(brentq(f, lower, upper, xtol=_SMALLEST, rtol=_RTOL))
