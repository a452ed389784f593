"""The body: a rigid cylinder on its rim, or any body of revolution with a circular base."""

from __future__ import annotations

import math
from dataclasses import dataclass

from .number_checks import require_positive
from .shown import Brief

_UNITS = {
    "semidiagonal": "m",
    "tan_alpha": "",
    "height": "m",
    "transverse_inertia": "m^2",
    "axial_inertia": "m^2",
}
# what is in m^2 and in m^4 stays a number
_SMALLEST, _LARGEST = 1e-70, 1e70  # [m]


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class Cylinder(Brief):
    """A rigid body of revolution that stands on a circular base.

    Size and slenderness are those that govern rocking: they locate the mass centre S against the
    rim. For the homogeneous solid cylinder of the paper, the default, they are also those of its
    outline. A hollow column, a chimney or a pier that carries a deck is the same body with other
    inertias; per unit mass, because the mass itself cancels everywhere.

    Parameters
    ----------
    semidiagonal : float
        R = sqrt(b^2 + h^2), distance from the rim to the mass centre [m]. Equation (20).
    tan_alpha : float
        b/h, base radius over height of the mass centre; alpha is the slenderness [-].
    height : float, optional
        Height of the outline [m]. Default: twice the height of the mass centre.
    transverse_inertia : float, optional
        I1/m about a horizontal axis through the mass centre [m^2]. Default: (3 b^2 + height^2)/12,
        equation (16).
    axial_inertia : float, optional
        I2/m about the axis of revolution [m^2]. Default: b^2/2, equation (16).

    Raises
    ------
    ValueError
        If a value is not a positive finite number, or the inertias belong to no real body
        (I2 > 2 I1).

    Examples
    --------
    >>> pier = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    >>> round(pier.base_radius, 4), round(pier.half_height, 4)
    (1.1767, 5.8835)
    """

    semidiagonal: float
    tan_alpha: float
    height: float | None = None
    transverse_inertia: float | None = None
    axial_inertia: float | None = None

    def __post_init__(self) -> None:
        for name, unit in _UNITS.items():
            value = getattr(self, name)
            if value is not None or name in ("semidiagonal", "tan_alpha"):
                object.__setattr__(self, name, require_positive(name, value, unit))
        if not _SMALLEST <= self.semidiagonal <= _LARGEST:
            raise ValueError(
                f"semidiagonal must be from {_SMALLEST:g} to {_LARGEST:g} m, got {self.semidiagonal!r}"
            )
        if not (self.base_radius > 0.0 and self.mass_centre_height > 0.0):
            raise ValueError(
                f"tan_alpha must leave a base and a height above rounding, got {self.tan_alpha!r} "
                f"with a semidiagonal of {self.semidiagonal!r} [m]"
            )
        self._require_real_inertias()

    def _require_real_inertias(self) -> None:
        b = self.base_radius
        transverse, axial = self.transverse_inertia, self.axial_inertia
        if transverse is None:
            transverse = (3.0 * b**2 + (2.0 * self.half_height) ** 2) / 12.0
        if axial is None:
            axial = 0.5 * b**2
        # I2 = 2 I1 is the limit of a flat plate; beyond it no distribution of mass exists
        if axial > 2.0 * transverse * (1.0 + 1e-12):
            raise ValueError(
                f"axial_inertia must not exceed twice transverse_inertia, "
                f"got {axial:g} and {transverse:g} [m^2]"
            )

    @classmethod
    def from_dimensions(
        cls,
        *,
        base_radius: float,
        height: float,
        mass_centre_height: float | None = None,
        transverse_inertia: float | None = None,
        axial_inertia: float | None = None,
    ) -> Cylinder:
        """Make a cylinder from its outline.

        Parameters
        ----------
        base_radius : float
            b [m].
        height : float
            2h, height of the outline [m].
        mass_centre_height : float, optional
            Height of the mass centre above the base [m]. Default: half the height.
        transverse_inertia, axial_inertia : float, optional
            I1/m and I2/m about the mass centre [m^2]. Default: the homogeneous solid cylinder.

        Raises
        ------
        ValueError
            If a value is not a positive finite number.
        """
        b = require_positive("base_radius", base_radius, "m")
        outline = require_positive("height", height, "m")
        h = 0.5 * outline
        if mass_centre_height is not None:
            h = require_positive("mass_centre_height", mass_centre_height, "m")
        return cls(
            semidiagonal=math.hypot(b, h),
            tan_alpha=b / h,
            height=None if mass_centre_height is None else outline,
            transverse_inertia=transverse_inertia,
            axial_inertia=axial_inertia,
        )

    @property
    def alpha(self) -> float:
        """Slenderness: angle at the mass centre between the axis and the rim [rad]."""
        return math.atan(self.tan_alpha)

    @property
    def base_radius(self) -> float:
        """Base radius b [m]."""
        return self.semidiagonal * (self.tan_alpha / math.hypot(1.0, self.tan_alpha))

    @property
    def mass_centre_height(self) -> float:
        """Height h of the mass centre above the base [m]."""
        return self.semidiagonal / math.hypot(1.0, self.tan_alpha)

    @property
    def half_height(self) -> float:
        """Half the height of the outline [m]; h of the paper where the body is homogeneous."""
        return self.mass_centre_height if self.height is None else 0.5 * self.height
