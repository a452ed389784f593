"""The tendon of a scene: a spring between points, whatever the column does.

It runs from an anchor a little below the origin O to the centre of the base, up the axis, and under a slab
on to an anchor in the slab as far above its underside. Inside the column its forces cancel.

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

from rockwobble.models.shown import Brief
from rockwobble.models.tendon import Tendon

Array = NDArray[np.float64]

# of b: a release in MuJoCo is off by 7e-7 alpha at 1e-4, by 7e-8 at 1e-5 and at 1e-6, where 5e-8 remain
# without a tendon; at 1e-7 it uplifts too early
ANCHOR_DEPTH = 1e-5
# the least depth in roundings of b, so that the direction of v at rest is not noise: Rapier (2^-24) uplifts
# by 26 ms too early at 1e-5 b, by 6 ms at this depth of 1e-3 b, by 4 ms without a tendon
_ROUNDINGS = 2.0**14


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class SceneTendon(Brief):
    """A tendon at the size of a scene, whose column has unit mass.

    Attributes
    ----------
    prestress : float
        P0 [m/s^2].
    stiffness : float
        kt [1/s^2].
    gaps : int
    depth : float
        Depth of the anchor below the ground, and above the underside of a slab [m].
    yield_elongation : float
        Elongation at which the tendon yields [m]; infinite where it does not.
    """

    prestress: float
    stiffness: float
    gaps: int
    depth: float
    yield_elongation: float = math.inf

    def pull(self, x: float, y: float, z: float) -> tuple[float, float, float]:
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
        a, b, c = self.pull(x - height * axis_x, y - height * axis_y, z - height * axis_z)
        arm = self.gaps * height
        return (a, b, c), (
            arm * (b * axis_z - c * axis_y),
            arm * (c * axis_x - a * axis_z),
            arm * (a * axis_y - b * axis_x),
        )

    def elongation(self, base_centre: Array) -> Array:
        """Return the elongations (n,) where the centre of the base is at places (n, 3) [m]."""
        x, y, z = base_centre.T
        return np.asarray(self.gaps * (np.sqrt(x * x + y * y + (z + self.depth) ** 2) - self.depth))

    def energy(self, elongation: Array) -> Array:
        """Return the energy that elongations (n,) [m] store, per unit mass of the column [m^2/s^2]."""
        return np.asarray((self.prestress + 0.5 * self.stiffness * elongation) * elongation)

    def pulls(self, base_centre: Array, elongation: Array) -> Array:
        """Return the forces (3, n) on the base at places (n, 3) [m], and on the slab [m/s^2]."""
        way = base_centre.T + np.array([[0.0], [0.0], [self.depth]])
        tension = self.prestress + self.stiffness * elongation
        return np.asarray(-tension / np.linalg.norm(way, axis=0) * way)


def scaled_tendon(
    tendon: Tendon, gaps: int, base_radius: float, gravity: float, rounding: float = 0.0
) -> SceneTendon:
    """Return a tendon at the size of a scene of a base radius [m] and a gravity [m/s^2].

    `rounding` is that of the engine, relative: its anchor lies deep enough for it.
    """
    stiffness, force = tendon.stiffness * gravity / base_radius, tendon.yield_force
    yields = math.inf
    if force is not None and stiffness > 0.0:
        yields = (force - tendon.prestress) * gravity / stiffness
    return SceneTendon(
        prestress=tendon.prestress * gravity,
        stiffness=stiffness,
        gaps=gaps,
        depth=max(ANCHOR_DEPTH, _ROUNDINGS * rounding) * base_radius,
        yield_elongation=yields,
    )
