"""Restraint of a scene: the forces besides the weight that hold a body down, for recorder and engines.

A `Restraint` answers what scene, kinematics and recorder ask of everything that holds the body down: couple
and its slope, forces on a closed base, energy and the pull on what the ends carry. A term that is new adds
fields to it, and a part to each answer. Engines take the fields, one by one.

The tendon is a spring between points, whatever the column does. It runs from an anchor a little below the
origin O to the centre of the base, up the axis, and under a slab on to an anchor in the slab as far above its
underside. Inside the column its forces cancel.

======= ======= ==================================================================
symbol  unit    meaning
======= ======= ==================================================================
v       m       from the anchor in the ground to the centre of the base
d       m       depth of the anchor; |v| = d at rest, where v must have a direction
n       -       gaps: 1, or 2 under a slab
e       m       elongation since rest, n (|v| - d)
T       m/s^2   tension per unit mass of the column, P0 + kt e
======= ======= ==================================================================

The ground pulls at the base with -T v/|v|. Where neither end slips, the top is the mirror image of the base
through the mass centre, so the way from the centre of the top to the anchor in the slab is v again: the slab
is pulled by -T v/|v| as well, and the column by T v/|v| at the top. On the column that is a couple.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rockwobble.models import Case
from rockwobble.models.shown import CompactRepr

Array = NDArray[np.float64]

# depth of the anchor over b: a release in MuJoCo is off by 7e-7 alpha at 1e-4, by 7e-8 at 1e-5 and at 1e-6,
# where 5e-8 remain without a tendon; at 1e-7 it uplifts too early
ANCHOR_DEPTH = 1e-5
# least depth in roundings of b, so that the direction of v at rest is not noise: Rapier (2^-24) uplifts 26 ms
# too early at 1e-5 b, 6 ms at this depth of 1e-3 b, 4 ms without a tendon
_ROUNDINGS = 2.0**14


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class Restraint(CompactRepr):
    """Forces that hold the body of a scene down besides its weight; by default none.

    Per unit mass of the column. Where an answer takes poses, they are n places of the mass centre (n, 3) [m],
    axes (n, 3), and the height of the mass centre above the base [m].

    Attributes
    ----------
    prestress : float
        P0 of a tendon along the axis [m/s^2].
    stiffness : float
        kt [1/s^2].
    gaps : int
    depth : float
        Depth of the anchor below the ground, and above the underside of a slab [m]; 0 without a tendon.
    yield_elongation : float
        Elongation at which the tendon yields [m]; infinite where it does not.
    """

    prestress: float = 0.0
    stiffness: float = 0.0
    gaps: int = 1
    depth: float = 0.0
    yield_elongation: float = math.inf

    @property
    def is_active(self) -> bool:
        """Whether a force besides the weight holds the body down."""
        return self.depth > 0.0

    def force(self, x: float, y: float, z: float) -> tuple[float, float, float]:
        """Return the force on the base whose centre is at (x, y, z) [m], and on the slab [m/s^2]."""
        z += self.depth
        length = math.sqrt(x * x + y * y + z * z)
        share = -(self.prestress + self.gaps * self.stiffness * (length - self.depth)) / length
        return share * x, share * y, share * z

    def loads(
        self, place: Sequence[float], axis: Sequence[float], height: float
    ) -> tuple[tuple[float, float, float], tuple[float, float, float]]:
        """Return force on the base and torque on the column about its mass centre [m/s^2], [m^2/s^2].

        The mass centre is at `place` (3,) [m], and by `height` [m] above the base along the axis (3,). Under
        a slab the force at the top is the opposite of that on the base, which the slab has as well.
        """
        x, y, z = place
        axis_x, axis_y, axis_z = axis
        a, b, c = self.force(x - height * axis_x, y - height * axis_y, z - height * axis_z)
        arm = self.gaps * height
        return (a, b, c), (
            arm * (b * axis_z - c * axis_y),
            arm * (c * axis_x - a * axis_z),
            arm * (a * axis_y - b * axis_x),
        )

    def couple(self, tilt: float, base_radius: float) -> float:
        """Return the couple on the column at a tilt [rad] in a plane, towards upright [m^2/s^2]."""
        elongation = 2.0 * self.gaps * base_radius * math.sin(0.5 * tilt)
        tension = self.prestress + self.stiffness * elongation
        return tension * self.gaps * base_radius * math.cos(0.5 * tilt)

    def couple_slope(self, tilt: float, base_radius: float) -> float:
        """Return the derivative of the couple by the tilt [m^2/s^2]."""
        slope = self.gaps**2 * self.stiffness * base_radius * base_radius * math.cos(tilt)
        return slope - 0.5 * self.gaps * self.prestress * base_radius * math.sin(0.5 * tilt)

    def elongation(self, place: Array, axis: Array, height: float) -> Array:
        """Return the elongation of the tendon at poses, shape (n,) [m]."""
        x, y, z = (place - height * axis).T
        return np.asarray(self.gaps * (np.sqrt(x * x + y * y + (z + self.depth) ** 2) - self.depth))

    def energy(self, place: Array, axis: Array, height: float) -> Array:
        """Return the energy that is stored at poses, shape (n,) [m^2/s^2]."""
        elongation = self.elongation(place, axis, height)
        return np.asarray((self.prestress + 0.5 * self.stiffness * elongation) * elongation)

    def forces(self, place: Array, axis: Array, height: float) -> Array:
        """Return the force (3, n) on the base at poses, and on a slab [m/s^2]; a couple is none."""
        way = (place - height * axis).T + np.array([[0.0], [0.0], [self.depth]])
        tension = self.prestress + self.stiffness * self.elongation(place, axis, height)
        return np.asarray(-tension / np.linalg.norm(way, axis=0) * way)


WEIGHT_ALONE = Restraint()


def scaled_restraint(case: Case, base_radius: float, gravity: float, rounding: float = 0.0) -> Restraint:
    """Restraint of a case at the size of a scene, with a base radius [m] and a gravity [m/s^2].

    `rounding` is that of the engine, relative: an anchor lies deep enough for it.
    """
    tendon = case.tendon
    if tendon is None:
        return WEIGHT_ALONE
    stiffness, force = tendon.stiffness * gravity / base_radius, tendon.yield_force
    yields = math.inf
    if force is not None and stiffness > 0.0:
        yields = (force - tendon.prestress) * gravity / stiffness
    return Restraint(
        prestress=tendon.prestress * gravity,
        stiffness=stiffness,
        gaps=tendon.gaps(case.cylinder),
        depth=max(ANCHOR_DEPTH, _ROUNDINGS * rounding) * base_radius,
        yield_elongation=yields,
    )
