r"""Recess with clearance: settings and geometry of its walls, and the clearance that is needed.

symbol    name          unit  meaning
b, H                    m     base radius, height of the outline; eta = H/b
theta                   rad   tilt; s, c its sine and cosine, t = tan(theta/2)
phi                     rad   azimuth of the contact point
delta     inclination   rad   of a wall, outward from the vertical
beta                    rad   azimuth of a wall
kappa     clearance     b     distance of the foot of the walls from the original circle

A wall is the half-space m.x > b (1 + kappa) cos(delta) with m = (cos(delta) e_beta, -sin(delta)): it
leans outward, its foot on the ground is at b (1 + kappa), and it has no end.

The point of a cylinder furthest along m lies on the rim of the base, or on that of the top where m has a
component a = m.e along its axis e that is positive. With the base centre b [(1 - c) e_phi + s e_z] of
equation (10), e = s e_phi + c e_z and u = cos(phi - beta), its reach along m is

    b [(1 - c) cos(delta) u - s sin(delta) + sqrt(1 - a^2) + eta max(a, 0)]
    with a = s cos(delta) u - c sin(delta)

* u = 1 without the top gives b cos(delta) at every tilt: the contact point stays at the foot of the wall.
* Written in a, which is linear in u, the reach is b [t a - t sin(delta) + sqrt(1 - a^2)], and eta + t in
  place of the first t where a > 0. For the base alone it rises with a up to sin(theta/2). While the wall
  leans by delta >= theta, a <= sin(theta - delta) <= 0, so that the largest is that of u = 1: such a wall
  needs no clearance.
* A steeper wall meets the side of the cylinder. Its largest a is sin(theta - delta), or that at which the
  reach is stationary, a/sqrt(1 - a^2) = eta + t, where that is smaller (squat cylinders):

      (1 + kappa) cos(delta) = (eta + t) a + sqrt(1 - a^2) - t sin(delta)

  which for the first is kappa = eta sin(theta - delta)/cos(delta): a vertical wall as high as the cylinder
  must stand back H sin(theta), one of height w = H cos(theta) therefore w tan(theta).

A wall between two heights is not a half-space, and asks for less: the rim of the base reaches furthest out
of the original circle at the height b t, by b (1/cos(theta/2) - 1), about b theta^2/8. That is another
form of b (sqrt(1 + (1-c)((1-c) + c^2/(1+c))) - 1), the square under whose root is 1 + t^2.

All this is for the motion of the recess model, in which the contact point stays on the original circle. A
cylinder that rolls out touches a ring when it has gone as far as the clearance.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, fields
from typing import Annotated

import numpy as np

from rockwobble.models import RockingBody
from rockwobble.models.bounds import OVERTURNED_TILT
from rockwobble.models.support import Support

from .kinematics import axis_of
from .protocol import Settings
from .scene import Array, Scene
from .settings import EngineSettings, positive, whole

_ROUNDING = 1e-12  # [b] of a tilt computed back from a quaternion
STEEPEST = 1.5  # [rad] a wall with a larger inclination is a floor


@dataclass(frozen=True, slots=True, kw_only=True)
class RingSettings(EngineSettings):
    """A ring of facets around the base, each an infinite half-space.

    Attributes
    ----------
    ring_clearance : float
        Distance of the foot of the walls from the base circle, in base radii. 1e-3 is not touched by a
        slender cylinder in free response; a tighter ring takes energy from it and holds it no better.
    ring_inclination : float
        Inclination of the walls, outward from the vertical [rad]. Default alpha: the side of a cylinder
        that leans less than to its balance does not meet such a wall. Steeper walls hold better.
    ring_facets : int
        Number of walls. The rim of a squat cylinder bumps from wall to wall and loses energy, the more the
        fewer there are; a slender one sees no difference. Each wall costs some per cent of a step.
    ring_friction : float
        Coulomb coefficient of the pair wall and cylinder [-]. 0.5 is that of concrete or steel; without
        friction a cylinder rolls out and twists several times as far.

    Raises
    ------
    ValueError
        If a value is out of range.
    """

    ring_clearance: Annotated[float, positive(most=100.0, or_zero=True)] = 1e-3
    ring_inclination: Annotated[float, positive(most=STEEPEST, or_zero=True)]
    ring_facets: Annotated[int, whole(least=3, most=1000)] = 128
    ring_friction: Annotated[float, positive(most=100.0, or_zero=True)] = 0.5


def take_ring(given: Settings, support: Support, tan_alpha: float) -> tuple[Settings, RingSettings | None]:
    """Settings other than those of the ring, and the ring; None for every other support.

    The inclination is arctan(tan_alpha) unless given.

    Raises
    ------
    ValueError
        If a setting of the ring is given for another support, or is out of range.
    """
    names = {field.name for field in fields(RingSettings)}
    others = {name: value for name, value in given.items() if name not in names}
    walls = {name: value for name, value in given.items() if name in names}
    if support.walls:
        return others, RingSettings(**{"ring_inclination": min(math.atan(tan_alpha), STEEPEST), **walls})
    if walls:
        raise ValueError(f"{', '.join(walls)} is for support 'ring' only, got support {support!r}")
    return others, None


def clearance_needed(cylinder: RockingBody, tilt: float, inclination: float) -> float:
    """Clearance of a ring without any contact up to a tilt, in base radii.

    For walls that are half-spaces, and the motion of the recess model.

    Parameters
    ----------
    cylinder : Cylinder or WobblingFrame
    tilt : float
        The largest, from 0 to pi/2 [rad].
    inclination : float
        Inclination of the walls, outward from the vertical, from 0 to below pi/2 [rad].

    Raises
    ------
    ValueError
        If an angle is out of range.

    Examples
    --------
    >>> from rockwobble.models import Cylinder
    >>> pier = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    >>> clearance_needed(pier, tilt=0.1, inclination=0.2)
    0.0
    >>> round(clearance_needed(pier, tilt=0.1, inclination=0.0), 3)  # 2h/b sin(0.1)
    0.998
    """
    if not 0.0 <= tilt <= OVERTURNED_TILT:
        raise ValueError(f"tilt must be from 0 to pi/2 [rad], got {tilt!r}")
    if not 0.0 <= inclination < 0.5 * math.pi:
        raise ValueError(f"inclination must be from 0 to below pi/2 [rad], got {inclination!r}")
    return _need(2.0 * cylinder.half_height / cylinder.base_radius, tilt, inclination)


def check_start(ring: RingSettings, scene: Scene) -> None:
    """Refuse a release that starts inside a wall.

    Raises
    ------
    ValueError
        Saying which clearance or inclination the release needs.
    """
    axis = axis_of(scene.start.quaternion[None])[0]
    tilt = math.atan2(math.hypot(axis[0], axis[1]), axis[2])
    needed = _need(scene.body.height / scene.body.base_radius, tilt, ring.ring_inclination)
    if needed > ring.ring_clearance + _ROUNDING:
        raise ValueError(
            f"a release at a tilt of {tilt:.4g} rad needs walls that lean by as much or stand back by "
            f"{needed:.4g} base radii, got ring_inclination {ring.ring_inclination:g} and ring_clearance "
            f"{ring.ring_clearance:g}"
        )


def _need(eta: float, tilt: float, inclination: float) -> float:
    if tilt <= inclination:
        return 0.0
    t = math.tan(0.5 * tilt)
    slope = eta + t
    a = min(math.sin(tilt - inclination), slope / math.hypot(1.0, slope))
    reach = slope * a + math.sqrt(1.0 - a * a) - t * math.sin(inclination)
    return max(reach / math.cos(inclination) - 1.0, 0.0)


def rim_overhang(tilt: float) -> tuple[float, float]:
    """Return the overhang of the rim of the base over the original circle, and its height, in b.

    That is the clearance of a vertical wall of this height or more, but lower than meets the side of the
    cylinder: at a height w the side reaches out by w tan(tilt).

    Examples
    --------
    >>> overhang, height = rim_overhang(0.2)
    >>> round(overhang / (0.2**2 / 8), 2), round(height, 3)
    (1.0, 0.1)
    """
    return 1.0 / math.cos(0.5 * tilt) - 1.0, math.tan(0.5 * tilt)


def wall_orientations(ring: RingSettings) -> Array:
    """Return quaternions (facets, 4), scalar first, that turn z into the normals towards the cylinder.

    The first wall is east of it. A wall is turned about y by delta - pi/2, then about z by its azimuth.
    """
    half = math.pi * np.arange(ring.ring_facets) / ring.ring_facets
    lean = 0.25 * math.pi - 0.5 * ring.ring_inclination
    across, along = math.sin(lean), math.cos(lean)
    return np.column_stack(
        [np.cos(half) * along, np.sin(half) * across, -np.cos(half) * across, np.sin(half) * along]
    )


def wall_feet(ring: RingSettings, base_radius: float) -> Array:
    """Return the point of each wall on the ground that is nearest to O, shape (facets, 3) [m]."""
    azimuth = 2.0 * math.pi * np.arange(ring.ring_facets) / ring.ring_facets
    distance = base_radius * (1.0 + ring.ring_clearance)
    return np.asarray(distance * np.column_stack([np.cos(azimuth), np.sin(azimuth), np.zeros(len(azimuth))]))
