"""The rigid body as an engine needs it, at the size at which it is simulated.

b     base radius                              [m]
h     height of the mass centre above the base [m]
I1    transverse inertia about the mass centre [m^2], per unit mass, equation (16)
I2    axial inertia                            [m^2], per unit mass, equation (16)
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
    )
