"""A column with a tendon, alone or under a slab, from places and springs in space.

The column is a rigid body of revolution whose rim rolls without slip, and the recess keeps its twist at
zero. The tendon is a spring between points: from its anchor on the ground to the centre of the base, and
from the centre of the top to its anchor in the slab; inside the column it does no work. Energies come from
places, velocities and the angular velocity, all derivatives from differences.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class Pier:
    """A homogeneous column of unit mass; forces in N for 1 kg."""

    b: float
    h: float
    slab: float = 0.0  # mass of its share of the slab over its own
    prestress: float = 0.0  # [N]
    stiffness: float = 0.0  # [N/m]
    g: float = 9.81


def _frame(tilt: float, azimuth: float) -> tuple[Array, Array, Array, Array]:
    """Return the axis, the radial, the tangential direction, and from base centre to contact."""
    radial = np.array([np.cos(azimuth), np.sin(azimuth), 0.0])
    across = np.array([-np.sin(azimuth), np.cos(azimuth), 0.0])
    up = np.array([0.0, 0.0, 1.0])
    axis = np.sin(tilt) * radial + np.cos(tilt) * up
    rim = np.cos(tilt) * radial - np.sin(tilt) * up
    return axis, radial, across, rim


def _places(pier: Pier, tilt: float, azimuth: float) -> tuple[Array, Array, Array]:
    """Return base centre, mass centre and top centre; the contact is b (cos azimuth, sin azimuth, 0)."""
    axis, radial, _, rim = _frame(tilt, azimuth)
    base = pier.b * radial - pier.b * rim
    return base, base + pier.h * axis, base + 2.0 * pier.h * axis


def _slab_rise(pier: Pier, tilt: float, azimuth: float) -> Array:
    """Displacement of the slab, which rolls on the top as the column on the ground: twice that of S."""
    return 2.0 * (_places(pier, tilt, azimuth)[1] - np.array([0.0, 0.0, pier.h]))


def potential(pier: Pier, tilt: float, azimuth: float = 0.0) -> float:
    """Return the potential energy, from places in space alone [J]."""
    base, centre, top = _places(pier, tilt, azimuth)
    rise = _slab_rise(pier, tilt, azimuth)
    energy = pier.g * ((centre[2] - pier.h) + pier.slab * rise[2])
    stretch = float(np.linalg.norm(base))  # from the anchor at O
    if pier.slab:
        anchor = np.array([0.0, 0.0, 2.0 * pier.h]) + rise
        stretch += float(np.linalg.norm(anchor - top))
    return float(energy + pier.prestress * stretch + 0.5 * pier.stiffness * stretch**2)


def _kinetic(pier: Pier, tilt: float, rate: float, spin: float) -> float:
    """Return the kinetic energy, from velocities of places and the angular velocity [J]."""
    axis, radial, across, _ = _frame(tilt, 0.0)
    up = np.array([0.0, 0.0, 1.0])
    # the contact turns at `spin`; without twist psi' = -spin about the axis
    w = rate * across + spin * (up - axis)
    centre = _places(pier, tilt, 0.0)[1]
    velocity = np.cross(w, centre - pier.b * radial)
    transverse, axial = (3.0 * pier.b**2 + 4.0 * pier.h**2) / 12.0, 0.5 * pier.b**2
    along = float(w @ axis)
    turning = transverse * float(w @ w - along**2) + axial * along**2
    slab = 2.0 * velocity
    return 0.5 * (float(velocity @ velocity) + turning + pier.slab * float(slab @ slab))


def accelerations(pier: Pier, tilt: float, rate: float, spin: float, ground: Array, azimuth: float) -> Array:
    """Return tilt and azimuth accelerations by Lagrange's equations.

    The ground acceleration acts as a body force on column and slab.
    """
    d = 2e-6

    def mass(at: float) -> tuple[float, float]:
        return 2.0 * _kinetic(pier, at, 1.0, 0.0), 2.0 * _kinetic(pier, at, 0.0, 1.0)

    def pushed(at: float, around: float) -> float:
        centre, rise = _places(pier, at, around)[1], _slab_rise(pier, at, around)
        return float(ground @ centre + pier.slab * ground @ rise)

    inertia, turning = mass(tilt)
    slope = (mass(tilt + d)[1] - mass(tilt - d)[1]) / (2 * d)
    force = -(potential(pier, tilt + d) - potential(pier, tilt - d)) / (2 * d)
    force -= (pushed(tilt + d, azimuth) - pushed(tilt - d, azimuth)) / (2 * d)
    torque = -(pushed(tilt, azimuth + d) - pushed(tilt, azimuth - d)) / (2 * d)
    return np.array([(0.5 * slope * spin**2 + force) / inertia, (torque - slope * rate * spin) / turning])


def inertia_about_the_vertical(pier: Pier, tilt: float) -> float:
    """Return the inertia of the azimuth at a tilt [kg m^2]."""
    return 2.0 * _kinetic(pier, tilt, 0.0, 1.0)
