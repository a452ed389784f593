"""Restoring couples of a body: weight, and a tendon along its axis.

The tendon runs from an anchor in the foundation, at O, up the axis to the top of the column, or through
a second gap into the slab: n gaps, of which a tilt opens each by 2 b sin(theta/2). So its elongation is
e = 2 n b sin(theta/2) in the recess and in a plane, its tension P0 + kt e, and the couple

    V'(theta) = w m g (b cos theta - h sin theta) + (P0 + kt e) n b cos(theta/2).

All is per unit of the mass w m, w = 1 + 2 gamma under a slab (`body`):

======= ======== ==============================================================
symbol  unit     meaning
======= ======== ==============================================================
V'      m^2/s^2  restoring couple; r = V'/R is what the equations take
q       m/s^2    n P0/(w m), `prestress`
k       m/s^2    n^2 kt b/(w m), `stiffness`
r       m/s^2    (g + az) sin(alpha - theta) + sin(alpha) [q u + k s]
u       -        cos(theta/2)
V       m^2/s^2  g (b s - h v) + b [2 q sin(theta/2) + k v], v = 1 - cos theta
T       m/s^2    n times the tension, q + 2 k sin(theta/2)
======= ======== ==============================================================

At the base the tendon pulls from the base centre B to O, which is 2 b sin(theta/2) away in the direction
theta/2 from the vertical: down with T cos(theta/2)/n and inward with T sin(theta/2)/n. At the top it does the
mirror image of that to the slab; inside the column its forces cancel. It never goes slack.

What the tendon adds is there twice, for a body without one and for one with it (`_compile.by_body`).
"""

from __future__ import annotations

from math import cos, inf, pi, sin, sqrt
from typing import NamedTuple, TypeVar, cast

import numpy as np
from numpy.typing import NDArray

from rockwobble.models import RockingBody
from rockwobble.models.number_checks import require_positive
from rockwobble.models.tendon import Tendon

from ._compile import by_body, inlined, jit
from .body import Body, body_of

T = TypeVar("T", float, NDArray[np.float64])


class TiedBody(NamedTuple):
    """Constants of a body that a tendon holds, with those of `Body` first.

    Its prestress n P0 and its stiffness n^2 kt b over w m [m/s^2], the number n of its gaps, the balance tilt
    [rad], and the fastest rate of the couple near upright [1/s].
    """

    b: float
    h: float
    I1: float
    I2: float
    A: float
    J: float
    C: float
    E: float
    g: float
    p2: float
    sin_alpha: float
    cos_alpha: float
    alpha: float
    p: float
    mu: float
    nu: float
    delta: float
    balance: float
    fastest: float
    prestress: float
    stiffness: float
    gaps: float


@inlined
def _no_couple(body: Body, arm: float, s: float, u: float) -> float:
    """Zero couple or force of an absent tendon.

    Without a tendon it is -0.0, which a compiler leaves out of a sum: +0.0 it would have to add.
    """
    return -0.0


@inlined
def _couple(body: TiedBody, arm: float, s: float, u: float) -> float:
    return arm * (body.prestress * u + body.stiffness * s)


tendon_couple = by_body(_no_couple, _couple)


@inlined
def restoring(body: Body, s: float, c: float, gravity: float) -> float:
    """Return r [m/s^2] under `gravity` = g + az [m/s^2], from sine and cosine of the tilt."""
    weight = gravity * (body.sin_alpha * c - body.cos_alpha * s)
    return weight + tendon_couple(body, body.sin_alpha, s, sqrt(0.5 * (1.0 + c)))


@inlined
def restoring_moment(body: Body, s: float, c: float, gravity: float) -> float:
    """Return V' [m^2/s^2] under `gravity`, as a moment about the rim."""
    return gravity * (body.b * c - body.h * s) + tendon_couple(body, body.b, s, sqrt(0.5 * (1.0 + c)))


@inlined
def acceleration_back(body: Body, theta: float) -> float:
    """Return the acceleration back to upright over still ground, without spin [rad/s^2]."""
    p2 = body.p * body.p
    tendon = tendon_couple(body, p2 * body.sin_alpha / body.g, sin(theta), cos(0.5 * theta))
    return p2 * sin(body.alpha - theta) + tendon


@inlined
def _no_energy(body: Body, c: float) -> float:
    """Zero energy where there is no tendon."""
    return -0.0


@inlined
def _energy(body: TiedBody, c: float) -> float:
    half = 0.5 * (1.0 - c)
    return 2.0 * body.b * (body.prestress * sqrt(max(0.0, half)) + body.stiffness * half)


tendon_energy = by_body(_no_energy, _energy)


@inlined
def stored_energy(body: Body, s: float, c: float, t: float) -> float:
    """Return V [m^2/s^2], zero upright; t is tan(theta/2)."""
    return body.g * s * (body.b - body.h * t) + tendon_energy(body, c)


@inlined
def _no_pull(body: Body, c: float) -> tuple[float, float]:
    """Zero force on the base where there is no tendon."""
    return 0.0, 0.0


@inlined
def _pull(body: TiedBody, c: float) -> tuple[float, float]:
    s_half, u = sqrt(max(0.0, 0.5 * (1.0 - c))), sqrt(0.5 * (1.0 + c))
    force = (body.prestress + 2.0 * body.stiffness * s_half) * (body.nu / body.gaps)
    return force * u, force * s_half


tendon_pull = by_body(_no_pull, _pull)


@inlined
def standing_force(body: Body, az: float) -> float:
    """Return the normal force on a body that stands, at base and top together [m/s^2]."""
    return body.g + az + tendon_couple(body, 1.0, 0.0, 1.0)


@inlined
def growth_at_uplift(body: Body, az: float, widened: float) -> float:
    """Return the growth of theta'' with the tilt at uplift [1/s^2].

    Without rolling resistance `widened` is 1; it widens the base, and adds to the inertia.
    """
    # |a| = (g + az + q)(b + delta)/h, and r of the tendon grows by k sin(alpha); delta adds to b and to A
    of_both = (1.0 + body.delta / body.b) / (1.0 + body.delta * body.mu * body.b / body.A)
    of_tendon = tendon_couple(
        body, body.p2 / body.g * body.sin_alpha * of_both, -1.0, body.sin_alpha / body.cos_alpha
    )
    return body.p2 * (1.0 + az / body.g) / body.cos_alpha * widened + of_tendon


@jit
def surely_overturns(body: Body, theta: float, strongest: float, lightest: float) -> bool:
    """Return whether a tilt beyond the balance that does not decrease is bound to reach pi/2, without twist.

    `strongest` is the largest |a| and `lightest` the least g + az to come: beyond the equilibrium tilt
    under these two and the couple of rolling resistance, theta'' is positive and grows with theta. Spin
    only adds to it, (18); a twist rate, which the flat-ground model has, may hold a cylinder up. With a
    tendon the couple must also fall with the tilt: its slope is at most -[cos(theta) (g' cos(alpha) - k
    sin(alpha)) + sin(theta) g' sin(alpha)], g' = `lightest`, and stays negative once this is; rolling
    resistance takes delta/b of what holds the body down besides.
    """
    beyond, s, c = theta - body.alpha, sin(theta), cos(theta)
    resisted = body.delta / body.b
    falling = lightest * cos(beyond) - tendon_couple(body, (1.0 + resisted) * body.sin_alpha * c, 1.0, 0.0)
    tendon = tendon_couple(body, (1.0 + resisted) * body.sin_alpha, s, sqrt(0.5 * (1.0 + c)))
    outward = lightest * (sin(beyond) - resisted * body.sin_alpha) - tendon
    return lightest > 0.0 and falling >= 0.0 and outward > strongest * cos(beyond)


# time integration by Taylor series, with u u = 1 - v/2


@inlined
def _one(body: Body, v: float) -> float:
    """1 in place of u, which is not used without a tendon: a root would change the rounding."""
    return 1.0


@inlined
def _half_cosine(body: TiedBody, v: float) -> float:
    return sqrt(1.0 - 0.5 * v)


half_cosine = by_body(_one, _half_cosine)


@inlined
def _coefficient_alone(
    body: Body, weight: float, s: float, v: float, u0: float, order: int, c: NDArray[np.float64], place: int
) -> float:
    """Coefficient of `order` of r: that of the weight; with a tendon from those of s and of v, too.

    With a tendon that of u is written to `c` behind `place`, after those of lower order; `u0` is that of
    order 0.
    """
    return weight


@inlined
def _coefficient_tied(
    body: TiedBody,
    weight: float,
    s: float,
    v: float,
    u0: float,
    order: int,
    c: NDArray[np.float64],
    place: int,
) -> float:
    product = 0.0
    for j in range(1, order):
        product += c[place + j] * c[place + order - j]
    u = -(0.5 * v + product) / (2.0 * u0)
    c[place + order] = u
    return weight + _couple(body, body.sin_alpha, s, u)


with_tendon_coefficient = by_body(_coefficient_alone, _coefficient_tied)


# closed forms (`exact`), in t = tan(theta/2), of a number or an array; R is the semidiagonal, and `gap` is
# alpha - theta, which keeps its digits next to alpha


def couple(body: Body, R: float, t: T, gap: T) -> T:
    """Return V' [m^2/s^2]."""
    weight: T = body.g * R * np.sin(gap)
    if not isinstance(body, TiedBody):
        return weight
    n = 1.0 + t * t
    return weight + body.b * (body.prestress / np.sqrt(n) + body.stiffness * 2.0 * t / n)


def couple_slope(body: Body, R: float, t: T, gap: T) -> T:
    """Return V'' [m^2/s^2]."""
    weight: T = -body.g * R * np.cos(gap)
    if not isinstance(body, TiedBody):
        return weight
    n = 1.0 + t * t
    return weight + body.b * (body.stiffness * (1.0 - t * t) / n - 0.5 * body.prestress * t / np.sqrt(n))


def potential(body: Body, R: float, tilt: float) -> float:
    """Return V [m^2/s^2], zero upright."""
    s_half = sin(0.5 * tilt)
    weight = 2.0 * body.g * R * s_half * sin(body.alpha - 0.5 * tilt)
    if not isinstance(body, TiedBody):
        return weight
    return weight + 2.0 * body.b * s_half * (body.prestress + body.stiffness * s_half)


def sigma(body: Body, R: float, gap: float, y: float, drop: T) -> T:
    """Return sigma(x, y) [m] at x = y - drop, where `gap` is that at y.

    V(y) - V(x) = 2 g (y - x) sigma/(n_x n_y), n = 1 + t^2. The weight has R sqrt(n_x n_y) sin((gap_x +
    gap_y)/2): gap and drop enter as they are, and do not have to be recovered from tilts next to alpha. In
    the part of a tendon, (b/g)(x + y)[q/(sin(theta_x/2) + sin(theta_y/2)) + k], all is positive.
    """
    weight: T = R * (sin(gap) * (1.0 + y * (y - drop)) + cos(gap) * drop)
    if not isinstance(body, TiedBody):
        return weight
    x = y - drop
    halves = x / np.sqrt(1.0 + x * x) + y / sqrt(1.0 + y * y)
    return weight + body.b / body.g * (x + y) * (body.prestress / halves + body.stiffness)


def sigma_slope(body: Body, z: float, y: float, x: T) -> T | float:
    """Return [sigma(z, y) - sigma(x, y)]/(x - z) [m]; of the weight, sigma is linear in x."""
    weight = body.h + body.b * y
    if not isinstance(body, TiedBody):
        return weight
    n_x, n_y, n_z = 1.0 + x * x, 1.0 + y * y, 1.0 + z * z
    r_x, r_y, r_z = np.sqrt(n_x), sqrt(n_y), sqrt(n_z)
    X, Y, Z = x / r_x, y / r_y, z / r_z  # sin(theta/2)
    # (x + y)/(X + Y) - (z + y)/(Z + Y) over x - z, its differences of roots by their squares
    by_z = x * (z * z * (1.0 + n_z) * n_x + (x - y) * (x + y)) / (n_z * r_x + r_y)
    by_x = z * (x * x * (1.0 + n_x) * n_z + (z - y) * (z + y)) / (n_x * r_z + r_y)
    secant = X * Z * (x + z) / (r_x + r_z) + y * (by_z + by_x) / (r_y * n_x * n_z * (X + Z))
    secant = secant / ((X + Y) * (Z + Y))
    return weight - body.b / body.g * (body.prestress * secant + body.stiffness)


def balance_tilt(body: TiedBody) -> float:
    """Tilt beyond which r stays negative [rad]; infinite where r is positive up to pi/2.

    Beyond alpha: at alpha the weight has no couple, and the tendon has one. Only shaking or spin overturns
    a body that has none.
    """

    def r(theta: float) -> float:
        tendon = body.prestress * cos(0.5 * theta) + body.stiffness * sin(theta)
        return body.g * sin(body.alpha - theta) + body.sin_alpha * tendon

    low, high = body.alpha, 0.5 * pi
    if r(high) >= 0.0:
        return inf
    while low < (middle := 0.5 * (low + high)) < high:
        low, high = (middle, high) if r(middle) > 0.0 else (low, middle)
    return low


# terms of a case that the reduced models have, see `constants_of`
TERMS = frozenset({"rolling_resistance", "tendon"})


def constants_of(
    cylinder: RockingBody,
    gravity: float,
    *,
    rolling_resistance: float = 0.0,
    tendon: Tendon | None = None,
) -> Body:
    """Return the constants of `cylinder` under `gravity` [m/s^2], with the terms of a case (`Case.terms`).

    Those of a `TiedBody`, which has more, where a tendon pulls. Raises ValueError unless gravity is positive
    and finite.
    """
    body = body_of(cylinder, require_positive("gravity", gravity, "m/s^2"), rolling_resistance)
    if tendon is None or tendon.prestress == tendon.stiffness == 0.0:  # to the bit
        return body
    return cast("Body", _tied_body(body, cylinder, tendon))


def _tied_body(body: Body, cylinder: RockingBody, tendon: Tendon) -> TiedBody:
    gaps, w = tendon.gaps(cylinder), 1.0 + 2.0 * cylinder.slab_mass_ratio
    stiffness = gaps**2 * tendon.stiffness * body.g / w
    whole = TiedBody(
        *body,
        prestress=gaps * tendon.prestress * body.g / w,
        stiffness=stiffness,
        gaps=float(gaps),
    )
    fastest = sqrt(body.p2 * (1.0 + stiffness * body.sin_alpha / body.g))
    return whole._replace(balance=balance_tilt(whole), fastest=fastest)
