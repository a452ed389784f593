"""The radicand of free response with its roots divided out, in t = tan(theta/2).

In t the potential energy and the inertia of the rolling angle are rational. Their differences between
two tilts carry the difference of the tilts as an explicit factor, so nothing cancels when two tilts
meet (steady wobble), at vanishing tilt (a near pass) or where the restoring moment vanishes (theta
near alpha). What holds the body down, sigma among it, is `rockwobble.reduced.restoring`'s. Per unit mass,
with the constants of `rockwobble.reduced.body` and

====== ======== ==========================================================================
symbol unit     meaning
====== ======== ==========================================================================
t      -        tan(theta/2); t1 at the minimum, t2 at the maximum of tilt
n      -        1 + t^2
H      m^2      J + 2 E t + C t^2; the inertia of the rolling angle is B = 4 t^2 H/n^2, (19)
G      m^2      t^2 H
K      m^2      dB/dtheta = 4 t K/n^2
gap    rad      alpha - theta
sigma  m        V(y) - V(x) = 2 g (y - x) sigma(x, y)/(n_x n_y), V the potential energy, (17)
beta   m^2      B(y) - B(x) = 4 (y - x) beta(x, y)/(n_x^2 n_y^2)
====== ======== ==========================================================================

With t1, t2 in place of energy and momentum, free response is

    (dt/dtime)^2 = g (t2 - t) (t - t1) n q(t)/(A n1 n2 G beta(t1, t2)),
    L^2 = 16 g sigma(t1, t2) G1 G2/(n1 n2 beta(t1, t2)).
"""

from __future__ import annotations

from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from ..body import Body
from ..restoring import sigma, sigma_slope

T = TypeVar("T", float, NDArray[np.float64])


def base_inertia(body: Body, t: T) -> T:
    """Return H [m^2]."""
    return body.J + (2.0 * body.E + body.C * t) * t


def inertia_growth(body: Body, t: T) -> T:
    """Return K [m^2], positive for t < 1: dB/dtheta = 4 t K/n^2."""
    return body.J * (1.0 - t * t) + t * (body.E * (3.0 - t * t) + 2.0 * body.C * t)


def _beta_in_first(body: Body, y: float) -> tuple[float, float, float, float]:
    """Return the coefficients of 1, x, x^2 and x^3 in beta(x, y) [m^2]."""
    J, E2, C = body.J, 2.0 * body.E, body.C
    y2 = y * y
    return (
        y * (J + y * (E2 + C * y)),
        J + y * (E2 + C * y),
        E2 + y * (C + y * (2.0 * E2 + y * (2.0 * C - J))),
        C + y2 * (2.0 * C - J - E2 * y),
    )


def beta(body: Body, x: float, y: float) -> float:
    """Return beta(x, y) = beta(y, x) [m^2]."""
    c0, c1, c2, c3 = _beta_in_first(body, y)
    return c0 + x * (c1 + x * (c2 + x * c3))


def deflate(body: Body, R: float, gap2: float, t1: float, t2: float, t: T, drop: T) -> tuple[T, T]:
    """Return q(t) [m^5], where drop = t2 - t, as two terms: the positive less the negative one.

    q is what remains of the radicand when both turning tilts are divided out. Its two terms are
    equal only where the motion has no period: on the overturning barrier.
    """
    J, E2, C = body.J, 2.0 * body.E, body.C
    n1 = 1.0 + t1 * t1
    beta12 = beta(body, t1, t2)
    # divided difference of G between t1 and t
    G_slope = J * (t + t1) + E2 * (t * (t + t1) + t1 * t1) + C * (t + t1) * (t * t + t1 * t1)
    # divided difference of n beta(., t2) between t1 and t, by synthetic division
    c0, c1, c2, c3 = _beta_in_first(body, t2)
    e3 = c2 + t1 * c3
    e2 = c3 + c1 + t1 * e3
    e1 = c2 + c0 + t1 * e2
    e0 = c1 + t1 * e1
    beta_slope = e0 + t * (e1 + t * (e2 + t * (e3 + t * c3)))
    G1 = t1 * t1 * base_inertia(body, t1)
    sigma12 = sigma(body, R, gap2, t2, t2 - t1)
    positive = sigma(body, R, gap2, t2, drop) * G_slope * beta12 * n1
    negative = G1 * (sigma_slope(body, t1, t2, t) * beta12 * n1 + sigma12 * beta_slope)
    return positive, negative
