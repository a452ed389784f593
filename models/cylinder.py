"""The body: a rigid cylinder on its rim, or any body of revolution; alone, or one of several under a slab."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field, fields
from numbers import Real

from .number_checks import quoted, require_finite, require_positive
from .plain_json import Facts
from .shown import CompactRepr, brief, line

_UNITS = {"semidiagonal": "m", "tan_alpha": "", "height": "m"}
_UNITS |= dict.fromkeys(("transverse_inertia", "axial_inertia"), "m^2")
# quantities in m^2 and m^4 are shown as plain numbers
_SMALLEST, _LARGEST = 1e-70, 1e70  # [m]


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class RockingBody(CompactRepr):
    """Interface of a body for models and engines: dimensions of one column, and its load."""

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

    @property
    def carries_slab(self) -> bool:
        """Whether a slab, even of mass 0, lies on the body, so that it rocks on both its ends."""
        return isinstance(self, WobblingFrame)

    @property
    def slab_mass_ratio(self) -> float:
        """Mass of the slab over that of the columns under it [-]: 0 without a slab."""
        return 0.0

    @property
    def columns(self) -> int:
        """Number of columns that move together."""
        return 1


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class Cylinder(RockingBody):
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

    @classmethod
    def from_dimensions(
        cls,
        *,
        base_radius: float | None = None,
        diameter: float | None = None,
        height: float,
        mass_centre_height: float | None = None,
        transverse_inertia: float | None = None,
        axial_inertia: float | None = None,
    ) -> Cylinder:
        """Make a cylinder from its outline.

        Parameters
        ----------
        base_radius, diameter : float
            b or 2b [m], one of them.
        height : float
            2h, height of the outline [m].
        mass_centre_height : float, optional
            Height of the mass centre above the base [m]. Default: half the height.
        transverse_inertia, axial_inertia : float, optional
            I1/m and I2/m about the mass centre [m^2]. Default: the homogeneous solid cylinder.

        Raises
        ------
        ValueError
            If a value is not a positive finite number, or unless one of base_radius and diameter is given.
        """
        if base_radius is not None and diameter is None:
            b = require_positive("base_radius", base_radius, "m")
        elif diameter is not None and base_radius is None:
            b = 0.5 * require_positive("diameter", diameter, "m")
        else:
            pair = "neither" if base_radius is None else "both"
            raise ValueError(f"base_radius or diameter must be given [m], one of them, got {pair}")
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


# largest mass ratio: beyond it the mass of the columns is rounding, and the slab moves alone
LARGEST_SLAB_MASS_RATIO = 1e15


@dataclass(frozen=True, slots=True, repr=False, init=False)
class WobblingFrame(RockingBody):
    """A rigid slab on equal cylinders that rock and wobble together: a deck on piers, a podium.

    It stands where a `Cylinder` stands, and gives the dimensions of one of its columns. The columns
    make one motion, over which the slab moves twice as far as their mass centres and does not turn:
    neither their plan nor their number enters the reduced models.

    Parameters
    ----------
    cylinder : Cylinder
        One of the columns, with its mass centre at half its height.
    slab_mass_ratio : float, optional
        gamma, mass of the slab over that of all columns [-]; 0 is the cylinder alone.
    columns : int, optional
        Number of columns: three or more, or 1 for a slab that is held from turning. Engines run one
        column under a slab that only translates, whatever the number, and say so ("one_column").

    Raises
    ------
    ValueError
        If the ratio is negative or above `LARGEST_SLAB_MASS_RATIO`, the columns are no whole number or too
        few to carry a slab, or the cylinder is itself a frame or has its mass centre elsewhere.

    Examples
    --------
    >>> pier = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    >>> WobblingFrame(pier, slab_mass_ratio=2.0)
    WobblingFrame(Cylinder(semidiagonal=6, tan_alpha=0.2), slab_mass_ratio=2, columns=3)
    """

    # `field()` without a default, as the body has a property of this name
    slab_mass_ratio: float = field()
    columns: int = field()

    def __init__(self, cylinder: Cylinder, slab_mass_ratio: float = 1.0, columns: int = 3) -> None:
        if not isinstance(cylinder, Cylinder):
            raise ValueError(  # noqa: TRY004 (bad input)
                f"cylinder must be a Cylinder, got {quoted(cylinder)}"
            )
        if not math.isclose(cylinder.mass_centre_height, cylinder.half_height, rel_tol=1e-12):
            raise ValueError(
                f"cylinder must have its mass centre at half its height in a frame, got "
                f"{cylinder.mass_centre_height:g} of {2.0 * cylinder.half_height:g} m"
            )
        ratio = require_finite("slab_mass_ratio", slab_mass_ratio, "")
        if not 0.0 <= ratio <= LARGEST_SLAB_MASS_RATIO:
            raise ValueError(
                f"slab_mass_ratio must be from 0 to {LARGEST_SLAB_MASS_RATIO:g}, got {slab_mass_ratio!r}"
            )
        whole = isinstance(columns, Real) and columns % 1 == 0 and not isinstance(columns, bool)
        if not whole or columns < 1 or columns == 2:
            raise ValueError(
                f"columns must be 3 or more, or 1 under a slab that cannot turn, got {quoted(columns)}"
            )
        for each in fields(Cylinder):
            object.__setattr__(self, each.name, getattr(cylinder, each.name))
        object.__setattr__(self, "slab_mass_ratio", ratio)
        object.__setattr__(self, "columns", int(columns))

    def __repr__(self) -> str:
        ratio = f"slab_mass_ratio={brief(self.slab_mass_ratio)}"
        return line("WobblingFrame", [repr(self.cylinder), ratio, f"columns={self.columns}"])

    @property
    def cylinder(self) -> Cylinder:
        """One of its columns."""
        return Cylinder(**{each.name: getattr(self, each.name) for each in fields(Cylinder)})


# the pier at which engines and studies are measured; others scale from it (Froude)
PIER = Cylinder(semidiagonal=6.0, tan_alpha=0.2)


def cylinder_of(values: Facts, make: Callable[..., Cylinder] = Cylinder) -> RockingBody:
    """Body from stored values: `make` builds the cylinder, in a frame where there are values of a slab."""
    slab = {name: values[name] for name in ("slab_mass_ratio", "columns") if name in values}
    cylinder = make(**{name: value for name, value in values.items() if name not in slab})
    return WobblingFrame(cylinder, **slab) if slab else cylinder
