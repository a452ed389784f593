"""The rigid body as an engine needs it, at the size at which it is simulated.

b     base radius                              [m]
h     height of the mass centre above the base [m]
I1    transverse inertia about the mass centre [m^2], per unit mass, equation (16)
I2    axial inertia                            [m^2], per unit mass, equation (16)

A column of a frame carries its share of a slab, whose mass is `slab_mass_ratio` times its own. Where neither
end slips, the slab has the velocity of the highest point of the top, twice that of the mass centre.
"""

from __future__ import annotations

from dataclasses import dataclass

from rockwobble.models import Cylinder


@dataclass(frozen=True, slots=True, kw_only=True)
class Body:
    """A body of revolution on a circular base; everything per unit mass."""

    base_radius: float
    mass_centre_height: float
    height: float
    transverse_inertia: float
    axial_inertia: float
    slab_mass_ratio: float = 0.0

    @property
    def driven_mass(self) -> float:
        """Mass that gravity and the ground move at the mass centre: the slab goes twice as far [-]."""
        return 1.0 + 2.0 * self.slab_mass_ratio

    @property
    def moved_mass(self) -> float:
        """Mass at the mass centre with the kinetic energy of column and slab [-]."""
        return 1.0 + 4.0 * self.slab_mass_ratio

    @property
    def tan_alpha(self) -> float:
        """b/h [-]."""
        return self.base_radius / self.mass_centre_height


def scaled_body(cylinder: Cylinder, length: float) -> Body:
    """Return the body of `cylinder` with every length divided by `length`.

    Inertias that the cylinder leaves out are those of a homogeneous solid cylinder of its outline,
    I1 = (3 b^2 + height^2)/12 and I2 = b^2/2.
    """
    radius = cylinder.base_radius / length
    height = 2.0 * cylinder.half_height / length
    transverse, axial = cylinder.transverse_inertia, cylinder.axial_inertia
    return Body(
        base_radius=radius,
        mass_centre_height=cylinder.mass_centre_height / length,
        height=height,
        transverse_inertia=(3.0 * radius**2 + height**2) / 12.0
        if transverse is None
        else transverse / length**2,
        axial_inertia=0.5 * radius**2 if axial is None else axial / length**2,
        slab_mass_ratio=cylinder.slab_mass_ratio,
    )
