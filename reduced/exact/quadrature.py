"""Angle and time between the two turning tilts, by quadrature.

With the symbols of `_shape` and t = t1 + (t2 - t1) sin^2(u/2) both roots of the radicand cancel against dt:

    dphi = (t1/t) sqrt(A sigma12 H1 G2 n^3/(H q)) du,    dtime = sqrt(A n1 n2 beta12 G/(g n q)) du.

What is left is smooth but for two poles beyond the ends: upright t = 0 behind the minimum, and the
far side of the overturning barrier behind the maximum. u = eps sinh v from either end resolves each
on its own logarithmic scale, at any spin.
"""

from __future__ import annotations

import math
from functools import cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..body import Body
from ..restoring import sigma
from ._shape import base_inertia, beta, deflate
from ._turning import Turning

_NODES = 64  # nodes on each side; measured: 40 leave 1e-10 at the narrowest passes, 48 1e-12, 64 rounding
_NARROWEST = 1e-20  # t1/t2: narrower passes differ from this one by less than rounding
_WIDEST = 2.0  # eps: a pole farther away needs no clustering
_ROUNDING = 8.0 * 2.0**-52  # rounding of the difference of the two terms of q


class HalfCycle(NamedTuple):
    """Rolling angle and time from a tilt minimum to the next maximum."""

    turn: float  # rolling angle, unsigned [rad]
    time: float  # [s]


def half_cycle(body: Body, R: float, turning: Turning) -> HalfCycle | None:
    """Return angle and time from minimum to maximum, None if the maximum is on the overturning barrier."""
    t2, gap2 = turning.t2, turning.gap2
    t1 = max(turning.t1, _NARROWEST * t2)
    span = t2 - t1
    behind = _behind_maximum(body, R, gap2, t1, t2)
    if behind is None:
        return None
    # a pole at distance d behind an end of the span lies at u = 2i sqrt(d/span) from it
    u_min, du_min = _clustered_nodes(t1, span)
    u_max, du_max = _clustered_nodes(behind, span)
    u = np.concatenate([u_min, u_max])  # distance from the nearer end
    near, far = span * np.sin(0.5 * u) ** 2, span * np.cos(0.5 * u) ** 2
    at_minimum = np.arange(u.size) < u_min.size
    t = t1 + np.where(at_minimum, near, far)
    drop = np.where(at_minimum, far, near)
    du = np.concatenate([du_min, du_max])

    n, n1, n2 = 1.0 + t * t, 1.0 + t1 * t1, 1.0 + t2 * t2
    H, H1, H2 = base_inertia(body, t), base_inertia(body, t1), base_inertia(body, t2)
    positive, negative = deflate(body, R, gap2, t1, t2, t, drop)
    q = positive - negative
    sigma12, beta12 = sigma(body, R, gap2, t2, span), beta(body, t1, t2)
    turn = t1 * t2 * np.sqrt(body.A * sigma12 * H1 * H2 * n * n * n / (H * q)) / t
    time = t * np.sqrt(body.A * n1 * n2 * beta12 * H / (body.g * n * q))
    return HalfCycle(float(np.sum(turn * du)), float(np.sum(time * du)))


def half_period(body: Body, R: float, t2: float, gap2: float) -> float:
    """Return the time of planar motion from upright to its maximum [s]; NaN on the balance."""
    half = half_cycle(body, R, Turning(0.0, t2, gap2))
    return math.nan if half is None else half.time


def _behind_maximum(body: Body, R: float, gap2: float, t1: float, t2: float) -> float | None:
    """Return the distance in t from the maximum to the zero of q behind it, None if there is no room.

    The zero is where the radicand turns positive again on the far side of the barrier. Only its
    order of magnitude matters, and only when it is close: q is then linear.
    """
    positive, negative = deflate(body, R, gap2, t1, t2, t2, 0.0)
    q2 = positive - negative
    if q2 <= _ROUNDING * positive:
        return None
    step = 0.125 * (t2 - t1)
    inside, outside = deflate(body, R, gap2, t1, t2, t2 - step, step)
    fall = inside - outside - q2
    return step * q2 / fall if fall > 0.0 else math.inf


def _clustered_nodes(distance: float, span: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return nodes and weights in u on (0, pi/2), clustered at 0 on the scale of a pole behind it."""
    eps = _WIDEST if span * _WIDEST**2 <= 4.0 * distance else 2.0 * math.sqrt(distance / span)
    nodes, weights = _gauss()
    end = math.asinh(0.5 * math.pi / eps)
    v = end * nodes
    return eps * np.sinh(v), eps * end * weights * np.cosh(v)


@cache
def _gauss() -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return the nodes and weights of Gauss and Legendre on (0, 1), to rounding also at the ends.

    The clustering leans on the outermost weights, where the usual formulas leave 1e-12. As functions
    of psi, with x = cos psi, they lose nothing: w = 2/(dP/dpsi)^2 at the zeros of P(cos psi).
    """
    psi = np.arccos(np.polynomial.legendre.leggauss(_NODES)[0][_NODES // 2 :])
    slope = np.ones_like(psi)
    for _ in range(2):  # Newton; the second step is below rounding
        versine = 2.0 * np.sin(0.5 * psi) ** 2
        P, rise = 1.0 - versine, -versine
        for k in range(1, _NODES):
            rise = (k * rise - (2 * k + 1) * versine * P) / (k + 1)
            P = P + rise
        # P of the order below is P - rise
        slope = -_NODES * (versine * P - rise) / np.sin(psi)
        psi = psi - P / slope
    near, weights = np.sin(0.5 * psi) ** 2, 1.0 / slope**2
    return np.concatenate([near, np.cos(0.5 * psi) ** 2]), np.concatenate([weights, weights])
