"""Free response of the recess model, by quadrature between its two turning tilts.

Without excitation energy and the momentum L = B phi' are conserved (equations 18 and 19), and the
tilt oscillates between a minimum and a maximum with

    A theta'^2/2 = e - V(theta) - L^2/(2 B(theta)),    phi' = L/B(theta).

No step is taken in time: the results depend on nothing but rounding, and serve as reference for
everything that integrates.

With the symbols of `_shape` and t = t1 + (t2 - t1) sin^2(u/2) both roots of the radicand cancel against dt:

    dphi = (t1/t) sqrt(A sigma12 H1 G2 n^3/(H q)) du,    dtime = sqrt(A n1 n2 beta12 G/(g n q)) du.

What is left is smooth but for two poles beyond the ends: upright t = 0 behind the minimum, and the
far side of the overturning barrier behind the maximum. u = eps sinh v from either end resolves each
on its own logarithmic scale, at any spin.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rockwobble.models import Cylinder, InitialState
from rockwobble.models.shown import Brief

from ..body import Body
from ._shape import base_inertia, beta, body_under, deflated, sigma
from ._turning import Turning, turning_tilts
from .periods import quarter_period


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class FreeResponse(Brief):
    """Free response to a release on still ground, recess model, undamped.

    Attributes
    ----------
    minimum_tilt, maximum_tilt : float
        The turning tilts [rad], equal in steady wobble.
    half_period : float
        Time from tilt maximum to minimum [s].
    period : float
        Time from tilt maximum to next maximum [s].
    angle_of_turn : float
        Change of the rolling angle from tilt maximum to next maximum, with the sign of the spin [rad].
    energy : float
        e, relative to standing at rest, per unit mass [m^2/s^2].
    angular_momentum : float
        L = B phi', the conserved momentum of the rolling angle, per unit mass [m^2/s].

    Examples
    --------
    >>> can = Cylinder(semidiagonal=5.0**0.5, tan_alpha=0.5)
    >>> found = free_response(can, InitialState(0.5 * can.alpha, rolling_rate=0.1))
    >>> round(found.period, 6), round(math.degrees(found.angle_of_turn), 4)
    (1.455319, 204.0166)
    """

    minimum_tilt: float
    maximum_tilt: float
    half_period: float = field(repr=False)
    period: float
    angle_of_turn: float
    energy: float
    angular_momentum: float


def free_response(cylinder: Cylinder, initial: InitialState, *, gravity: float = 9.81) -> FreeResponse:
    """Solve the free response of the recess model exactly.

    Parameters
    ----------
    cylinder : Cylinder
        The body.
    initial : InitialState
        The release, at any point of the cycle; its rolling angle does not matter.
    gravity : float, optional
        g [m/s^2].

    Returns
    -------
    FreeResponse

    Raises
    ------
    ValueError
        If the release has no next tilt maximum: it stands upright at rest, it overturns, or it is on
        the overturning barrier to within rounding. Also if gravity is not positive.

    Notes
    -----
    With exactly zero spin the motion is planar: the minimum tilt is zero, the pivot changes by pi and
    the period is half that of the rocking cycle. The limit of vanishing spin has the same times but
    the angle of turn `limiting_angle_of_turn`, larger than pi: however small the spin, the rim rolls
    through a near pass. That is the mechanics of the model, not a numerical error.

    In steady wobble, period and angle of turn are those of a vanishing oscillation about it.

    Examples
    --------
    >>> from rockwobble.models import Cylinder, InitialState
    >>> pier = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    >>> response = free_response(pier, InitialState(tilt=0.5 * pier.alpha, rolling_rate=1e-3))
    >>> round(response.period, 6), round(response.angle_of_turn, 6)
    (2.37841, 3.193531)
    """
    body = body_under(cylinder, gravity)
    tilt, tilt_rate, rolling_rate = initial.tilt, initial.tilt_rate, initial.rolling_rate
    if tilt == 0.0:
        raise ValueError("initial must have a tilt above 0 for a free response, got 0: the cylinder stands")
    t, n = math.tan(0.5 * tilt), 1.0 + math.tan(0.5 * tilt) ** 2
    momentum = 4.0 * t * t * base_inertia(body, t) * rolling_rate / (n * n)
    potential = (
        2.0 * body.g * cylinder.semidiagonal * math.sin(0.5 * tilt) * math.sin(body.alpha - 0.5 * tilt)
    )
    energy = 0.5 * (body.A * tilt_rate**2 + momentum * rolling_rate) + potential
    if rolling_rate == 0.0:
        planar = _planar_maximum(body, initial)
        if planar is None:
            raise _overturns(body, initial)
        maximum, gap = planar
        half_period = float(quarter_period(body, np.asarray(maximum), np.asarray(gap)))
        return FreeResponse(
            minimum_tilt=0.0,
            maximum_tilt=maximum,
            half_period=half_period,
            period=2.0 * half_period,
            angle_of_turn=math.pi,
            energy=energy,
            angular_momentum=momentum,
        )
    turning = turning_tilts(body, cylinder.semidiagonal, tilt, tilt_rate, rolling_rate)
    if turning is None:
        raise _overturns(body, initial)
    half = half_cycle(body, cylinder.semidiagonal, turning)
    if half is None:
        raise ValueError(
            f"{initial!r} is on the overturning barrier to within rounding: "
            "the time it stays there is undetermined"
        )
    return FreeResponse(
        minimum_tilt=2.0 * math.atan(turning.t1),
        maximum_tilt=2.0 * math.atan(turning.t2),
        half_period=half.time,
        period=2.0 * half.time,
        angle_of_turn=math.copysign(2.0 * half.turn, rolling_rate),
        energy=energy,
        angular_momentum=momentum,
    )


def angle_of_turn(cylinder: Cylinder, initial: InitialState, *, gravity: float = 9.81) -> float:
    """Return the exact angle of turn of the recess model in free response.

    Parameters
    ----------
    cylinder : Cylinder
        The body.
    initial : InitialState
        The release, at any point of the cycle.
    gravity : float, optional
        g [m/s^2].

    Returns
    -------
    float
        Change of the rolling angle from tilt maximum to next tilt maximum, with the sign of the spin
        [rad]. At exactly zero spin the motion is planar and the pivot changes by pi, while the limit of
        vanishing spin is `limiting_angle_of_turn`: see `free_response`.

    Raises
    ------
    ValueError
        If the release has no next tilt maximum, see `free_response`.

    Examples
    --------
    >>> can = Cylinder(semidiagonal=5.0**0.5, tan_alpha=0.5)
    >>> round(math.degrees(angle_of_turn(can, InitialState(0.5 * can.alpha, rolling_rate=0.1))), 4)
    204.0166
    """
    return free_response(cylinder, initial, gravity=gravity).angle_of_turn


def limiting_angle_of_turn(cylinder: Cylinder) -> float:
    """Return the angle of turn in the limit of vanishing spin.

    Parameters
    ----------
    cylinder : Cylinder
        The body.

    Returns
    -------
    float
        pi sqrt(A/J) [rad], where A and J are the transverse inertias about a point of the rim and about
        the centre of the base (Srinivasan and Ruina, 2008). It depends on neither gravity nor release.

    Examples
    --------
    >>> from math import degrees
    >>> from rockwobble.models import Cylinder
    >>> round(degrees(limiting_angle_of_turn(Cylinder(semidiagonal=6.0, tan_alpha=0.2))), 4)
    182.6602
    """
    body = body_under(cylinder, 1.0)
    return math.pi * math.sqrt(body.A / body.J)


def _planar_maximum(body: Body, initial: InitialState) -> tuple[float, float] | None:
    """Return the largest tilt of a release without spin and its distance from alpha [rad]."""
    if initial.tilt >= body.alpha:
        return None
    if initial.tilt_rate == 0.0:
        return initial.tilt, body.alpha - initial.tilt
    # energy conservation, once for sin(gap/2) and once for the tilt: each keeps its digits where it is small
    kinetic = 0.5 * initial.tilt_rate**2 / body.p2
    half_gap_squared = math.sin(0.5 * (body.alpha - initial.tilt)) ** 2 - 0.5 * kinetic
    if half_gap_squared <= 0.0:
        return None
    gap = 2.0 * math.asin(math.sqrt(half_gap_squared))
    height = 2.0 * math.sin(0.5 * initial.tilt) * math.sin(body.alpha - 0.5 * initial.tilt) + kinetic
    return 2.0 * math.atan(height / (math.sin(body.alpha) + math.sin(gap))), gap


def _overturns(body: Body, initial: InitialState) -> ValueError:
    return ValueError(
        f"{initial!r} overturns a cylinder of alpha = {body.alpha!r} rad: it has no tilt maximum below "
        "the barrier; give less tilt or less speed"
    )


_NODES = 64  # on each side; measured: 40 leave 1e-10 at the narrowest passes, 48 1e-12, 64 rounding
_NARROWEST = 1e-20  # t1/t2: narrower passes differ from this one by less than rounding
_WIDEST = 2.0  # eps: a pole farther away needs no clustering
_ROUNDING = 8.0 * 2.0**-52  # of the difference of the two terms of q


class HalfCycle(NamedTuple):
    """From tilt minimum to tilt maximum."""

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
    u_min, du_min = _clustered(t1, span)
    u_max, du_max = _clustered(behind, span)
    u = np.concatenate([u_min, u_max])  # from the nearer end
    near, far = span * np.sin(0.5 * u) ** 2, span * np.cos(0.5 * u) ** 2
    at_minimum = np.arange(u.size) < u_min.size
    t = t1 + np.where(at_minimum, near, far)
    drop = np.where(at_minimum, far, near)
    du = np.concatenate([du_min, du_max])

    n, n1, n2 = 1.0 + t * t, 1.0 + t1 * t1, 1.0 + t2 * t2
    H, H1, H2 = base_inertia(body, t), base_inertia(body, t1), base_inertia(body, t2)
    positive, negative = deflated(body, R, gap2, t1, t2, t, drop)
    q = positive - negative
    sigma12, beta12 = sigma(R, gap2, t2, span), beta(body, t1, t2)
    turn = t1 * t2 * np.sqrt(body.A * sigma12 * H1 * H2 * n * n * n / (H * q)) / t
    time = t * np.sqrt(body.A * n1 * n2 * beta12 * H / (body.g * n * q))
    return HalfCycle(float(np.sum(turn * du)), float(np.sum(time * du)))


def _behind_maximum(body: Body, R: float, gap2: float, t1: float, t2: float) -> float | None:
    """Return the distance in t from the maximum to the zero of q behind it, None if there is no room.

    The zero is where the radicand turns positive again on the far side of the barrier. Only its
    order of magnitude matters, and only when it is close: q is then linear.
    """
    positive, negative = deflated(body, R, gap2, t1, t2, t2, 0.0)
    q2 = positive - negative
    if q2 <= _ROUNDING * positive:
        return None
    step = 0.125 * (t2 - t1)
    inside, outside = deflated(body, R, gap2, t1, t2, t2 - step, step)
    fall = inside - outside - q2
    return step * q2 / fall if fall > 0.0 else math.inf


def _clustered(distance: float, span: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
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
