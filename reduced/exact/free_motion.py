"""Free response of the recess model, by quadrature between its two turning tilts.

Without excitation energy and the momentum L = B phi' are conserved (equations 18 and 19), and the
tilt oscillates between a minimum and a maximum with

    A theta'^2/2 = e - V(theta) - L^2/(2 B(theta)),    phi' = L/B(theta).

No step is taken in time: the results depend on nothing but rounding, and serve as reference for
everything that integrates.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np

from rockwobble.models import InitialState, RockingBody, Tendon
from rockwobble.models.shown import CompactRepr

from ..body import Body
from ..restoring import TiedBody, constants_of, potential
from ._shape import base_inertia
from ._turning import highest_without_spin, turning_tilts
from .periods import quarter_period
from .quadrature import half_cycle


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class FreeResponse(CompactRepr):
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
    >>> from rockwobble.models import Cylinder
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


def free_response(
    cylinder: RockingBody, initial: InitialState, *, gravity: float = 9.81, tendon: Tendon | None = None
) -> FreeResponse:
    """Solve the free response of the recess model exactly.

    Parameters
    ----------
    cylinder : Cylinder or WobblingFrame
        The body.
    initial : InitialState
        The release, at any point of the cycle; its rolling angle does not matter.
    gravity : float, optional
        g [m/s^2].
    tendon : Tendon, optional
        Along the axis.

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
    body = constants_of(cylinder, gravity, tendon=tendon)
    tilt, tilt_rate, rolling_rate = initial.tilt, initial.tilt_rate, initial.rolling_rate
    if tilt == 0.0:
        raise ValueError("initial must have a tilt above 0 for a free response, got 0: the cylinder stands")
    t, n = math.tan(0.5 * tilt), 1.0 + math.tan(0.5 * tilt) ** 2
    momentum = 4.0 * t * t * base_inertia(body, t) * rolling_rate / (n * n)
    energy = 0.5 * (body.A * tilt_rate**2 + momentum * rolling_rate)
    energy += potential(body, cylinder.semidiagonal, tilt)
    if rolling_rate == 0.0:
        planar = _planar_maximum(body, cylinder.semidiagonal, initial)
        if planar is None:
            raise _overturns(body, initial)
        maximum, gap = planar
        half_period = float(quarter_period(body, cylinder.semidiagonal, np.asarray(maximum), np.asarray(gap)))
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


def angle_of_turn(
    cylinder: RockingBody, initial: InitialState, *, gravity: float = 9.81, tendon: Tendon | None = None
) -> float:
    """Return the exact angle of turn of the recess model in free response.

    Parameters
    ----------
    cylinder : Cylinder or WobblingFrame
        The body.
    initial : InitialState
        The release, at any point of the cycle.
    gravity : float, optional
        g [m/s^2].
    tendon : Tendon, optional
        Along the axis.

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
    >>> from rockwobble.models import Cylinder
    >>> can = Cylinder(semidiagonal=5.0**0.5, tan_alpha=0.5)
    >>> round(math.degrees(angle_of_turn(can, InitialState(0.5 * can.alpha, rolling_rate=0.1))), 4)
    204.0166
    """
    return free_response(cylinder, initial, gravity=gravity, tendon=tendon).angle_of_turn


def limiting_angle_of_turn(cylinder: RockingBody) -> float:
    """Return the angle of turn in the limit of vanishing spin.

    Parameters
    ----------
    cylinder : Cylinder or WobblingFrame
        The body.

    Returns
    -------
    float
        pi sqrt(A/J) [rad], where A and J are the transverse inertias about a point of the rim and about
        the centre of the base (Srinivasan and Ruina, 2008). It depends on neither gravity nor release, and
        neither on a tendon: near upright any couple is the same in all directions.

    Examples
    --------
    >>> from math import degrees
    >>> from rockwobble.models import Cylinder
    >>> round(degrees(limiting_angle_of_turn(Cylinder(semidiagonal=6.0, tan_alpha=0.2))), 4)
    182.6602
    """
    body = constants_of(cylinder, 1.0)
    return math.pi * math.sqrt(body.A / body.J)


def _planar_maximum(body: Body, R: float, initial: InitialState) -> tuple[float, float] | None:
    """Return the largest tilt of a release without spin and its distance from alpha [rad]."""
    if initial.tilt >= body.balance:
        return None
    if initial.tilt_rate == 0.0:
        return initial.tilt, body.alpha - initial.tilt
    if isinstance(body, TiedBody):
        return highest_without_spin(body, R, initial.tilt, initial.tilt_rate)
    # energy conservation, once for sin(gap/2) and once for the tilt: each keeps its digits where it is small
    kinetic = 0.5 * initial.tilt_rate**2 / body.p2
    half_gap_squared = math.sin(0.5 * (body.alpha - initial.tilt)) ** 2 - 0.5 * kinetic
    if half_gap_squared <= 0.0:
        return None
    gap = 2.0 * math.asin(math.sqrt(half_gap_squared))
    height = 2.0 * math.sin(0.5 * initial.tilt) * math.sin(body.alpha - 0.5 * initial.tilt) + kinetic
    return 2.0 * math.atan(height / (math.sin(body.alpha) + math.sin(gap))), gap


def _overturns(body: Body, initial: InitialState) -> ValueError:
    tendon = " with this tendon" if isinstance(body, TiedBody) else ""
    return ValueError(
        f"{initial!r} overturns a cylinder of alpha = {body.alpha!r} rad{tendon}: it has no tilt maximum "
        "below the barrier; give less tilt or less speed"
    )
