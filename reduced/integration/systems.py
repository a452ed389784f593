"""The three models as systems of first order: their variables, derivatives and error norms.

States are tuples whose first three entries are tilt, tilt rate and rolling angle:

======== ============================================================================
planar   theta, theta', phi; the plane is x z, so phi is 0 or pi
recess   theta, theta', phi, L
flat     theta, theta', phi, Lambda, tau, S, X, Y; the rim rolls on the circle about
         (X, Y), so the contact point is (X + b cos phi, Y + b sin phi), and moves
         at the speed b psi'
======== ============================================================================
"""

from __future__ import annotations

from collections.abc import Callable
from math import sqrt
from typing import NamedTuple

import numpy as np

from .._compile import inlined, jit
from ..body import Body
from ..equations import flat_rhs, planar_rhs, recess_rhs
from ..trigonometry import sin_cos
from .record import Vector
from .result import State

_ROUNDING = float(np.finfo(np.float64).eps)

Weights = tuple[float, ...]


@jit
def identity(body: Body, rtol: float, y: State, a: Vector, slope: Vector) -> State:
    """Return the state."""
    return y


@jit
def in_motion(body: Body, y: State) -> bool:
    """Always False: nothing holds a tilted body."""
    return False


class System(NamedTuple):
    """The compiled functions of one model."""

    derivative: Callable[[Body, State, Vector], State]  # (body, y, a) -> y'
    momenta: Callable[[State], tuple[float, float]]  # y -> (L or Lambda, S)
    placed: Callable[..., State]  # (body, y, theta, omega, phi, L) -> y with these, and without twist rate
    prepares: bool = False  # whether `ready` changes a state before each step
    ready: Callable[..., State] = identity  # (body, rtol, y, a, slope) -> y before a step
    creeps: Callable[[Body, State], bool] = in_motion  # whether rolling resistance holds it, tilted
    grows: bool = False  # whether over still ground a later maximum of the tilt may exceed the first


def make_is_flat(momenta: Callable[[State], tuple[float, float]]) -> Callable[[State], bool]:
    """Return the test whether a state has neither spin nor twist rate: exactly planar motion."""

    @inlined
    def is_flat(y: State) -> bool:
        L, S = momenta(y)
        return bool(L == 0.0 and S == 0.0)

    return is_flat


@inlined
def scales(
    body: Body, rtol: float, tilt: float, rate: float, spin_rate: float, flat: bool
) -> tuple[float, float]:
    """Return the scales of the errors of tilt and of tilt rate: both inverses over the tolerance.

    Near upright the motion is that of a point at the polar distance theta, with one speed in all
    directions (`spin_rate` is its part across): the tilt is held to itself, and the rates to that
    speed. Planar motion goes through theta = 0, so there the tilt is held to what the speed makes of
    it in the time 1/p. Near the balance, where every difference grows as exp(p t), the distance from it
    takes the place of theta. An error below the rounding of the tilt cannot be told from none.
    """
    tilt = abs(tilt)
    from_balance = abs(body.balance - tilt)
    speed = abs(rate) + spin_rate
    velocity = speed + body.p * min(sqrt(body.sin_alpha * tilt), from_balance)
    distance = min(tilt + velocity / body.p if flat else tilt, from_balance + speed / body.p)
    least = _ROUNDING * tilt
    return 1.0 / max(rtol * distance, least), 1.0 / max(rtol * velocity, body.p * least)


@jit
def _planar_derivative(body: Body, y: State, a: Vector) -> State:
    return y[1], planar_rhs(body, y[0], sin_cos(y[2])[1], a[0], a[2]), 0.0


@jit
def planar_combine(y: State, h: float, weights: Weights, slopes: tuple[State, ...]) -> State:
    """Weighted sum y + h sum(weights slopes) of a step."""
    a = b = c = 0.0
    for j in range(len(weights)):
        w, k = weights[j], slopes[j]
        a += w * k[0]
        b += w * k[1]
        c += w * k[2]
    return y[0] + h * a, y[1] + h * b, y[2] + h * c


@jit
def _planar_momenta(y: State) -> tuple[float, float]:
    return 0.0, 0.0


@jit
def _planar_placed(body: Body, y: State, theta: float, omega: float, phi: float, L: float) -> State:
    return theta, omega, phi


@jit
def planar_ratio(
    body: Body, rtol: float, h: float, y: State, y_new: State, error: State, flat: bool
) -> float:
    """Largest error of a component over the error allowed."""
    per_tilt, per_rate = scales(body, rtol, y[0], y[1], 0.0, True)
    return max(abs(error[0]) * per_tilt, abs(error[1]) * per_rate)


@jit
def _recess_derivative(body: Body, y: State, a: Vector) -> State:
    return recess_rhs(body, y[0], y[1], y[2], y[3], a[0], a[1], a[2])


@jit
def _recess_momenta(y: State) -> tuple[float, float]:
    return y[3], 0.0


@jit
def _recess_placed(body: Body, y: State, theta: float, omega: float, phi: float, L: float) -> State:
    return theta, omega, phi, L


@jit
def _flat_derivative(body: Body, y: State, a: Vector) -> State:
    rates = flat_rhs(body, y[0], y[1], y[2], y[3], y[4], y[5], a[0], a[1], a[2])
    sin_phi, cos_phi = sin_cos(y[2])
    drift = body.b * rates[4]
    return rates[0], rates[1], rates[2], rates[3], rates[4], rates[5], drift * sin_phi, -drift * cos_phi


@jit
def flat_combine(y: State, h: float, weights: Weights, slopes: tuple[State, ...]) -> State:
    """Weighted sum y + h sum(weights slopes) of a step."""
    a = b = c = d = e = f = x = z = 0.0
    for j in range(len(weights)):
        w, k = weights[j], slopes[j]
        a += w * k[0]
        b += w * k[1]
        c += w * k[2]
        d += w * k[3]
        e += w * k[4]
        f += w * k[5]
        x += w * k[6]
        z += w * k[7]
    return (
        y[0] + h * a,
        y[1] + h * b,
        y[2] + h * c,
        y[3] + h * d,
        y[4] + h * e,
        y[5] + h * f,
        y[6] + h * x,
        y[7] + h * z,
    )


@jit
def _flat_momenta(y: State) -> tuple[float, float]:
    return y[3], y[5]


@jit
def _flat_placed(body: Body, y: State, theta: float, omega: float, phi: float, L: float) -> State:
    return theta, omega, phi, L, y[4], 0.0, y[6], y[7]


@jit
def flat_ratio(body: Body, rtol: float, h: float, y: State, y_new: State, error: State, flat: bool) -> float:
    """Largest error of a component over the error allowed."""
    per_lever = 0.0 if flat else 1.0 / (body.J * y[0])
    per_tilt, per_rate = scales(body, rtol, y[0], y[1], abs(y[3]) * per_lever, flat)
    ratio = max(abs(error[0]) * per_tilt, abs(error[1]) * per_rate)
    ratio = max(ratio, abs(error[2]) * (1.0 / rtol), abs(error[3]) * per_lever * per_rate)
    M = body.C - body.E * body.E / body.J
    ratio = max(ratio, abs(error[4]) / rtol, abs(error[5]) * per_rate / sqrt(body.A * M))
    return max(ratio, max(abs(error[6]), abs(error[7])) / (rtol * body.b))


PLANAR = System(_planar_derivative, _planar_momenta, _planar_placed)
RECESS = System(_recess_derivative, _recess_momenta, _recess_placed)
FLAT = System(_flat_derivative, _flat_momenta, _flat_placed)
