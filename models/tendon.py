"""The restraint: an unbonded tendon along the axis of a column, as practical rocking piers have it."""

from __future__ import annotations

import math
from dataclasses import dataclass

from .bounds import OVERTURNED_TILT
from .cylinder import RockingBody
from .number_checks import require_finite, require_not_negative, require_positive
from .shown import CompactRepr


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class Tendon(CompactRepr):
    """An unbonded elastic tendon along the axis, anchored in the foundation and at the top or in the slab.

    Its duct guides it, so it bends only at the gaps: one at the base of a column alone, two under a slab in
    which it is anchored. A tilt theta opens each by 2 b sin(theta/2), and the tension is the prestress and
    the stiffness times the sum of both. It is linear up to yield; what comes after that, friction in the
    duct, losses of prestress and rupture are not modelled.

    Parameters
    ----------
    prestress : float, optional
        Tension at rest over the weight of one column, P0/(m g) [-].
    stiffness : float, optional
        Axial stiffness over the weight of one column per base radius, kt b/(m g) [-].
    yield_force : float, optional
        Tension at which it yields over the weight of one column [-]; above the prestress. A tension beyond
        it is a diagnostic, and its run tests no stability, see `beyond_yield` of `compare.metrics.pair`.
    unit_stress : float, optional
        Stress of its steel at a tension of the weight of one column [MPa]; None: not known.

    Raises
    ------
    ValueError
        If a value is negative or not finite, or the tendon yields at its prestress.

    Examples
    --------
    >>> Tendon(prestress=0.5, stiffness=2.0)
    Tendon(prestress=0.5, stiffness=2)
    >>> Tendon.from_steel(
    ...     prestress=400e3, axial_rigidity=30e6, length=10.0, column_mass=45e3, base_radius=0.8
    ... )
    Tendon(prestress=0.906105, stiffness=5.43663)
    """

    prestress: float = 0.0
    stiffness: float = 0.0
    yield_force: float | None = None
    unit_stress: float | None = None

    def __post_init__(self) -> None:
        for name in ("prestress", "stiffness"):
            value = require_not_negative(f"{name} of a tendon", getattr(self, name))
            object.__setattr__(self, name, value)
        if self.yield_force is not None:
            force = require_positive("yield_force", self.yield_force)
            if force <= self.prestress:
                raise ValueError(
                    f"yield_force must be above the prestress, {self.prestress:g} weights, got {force:g}"
                )
            object.__setattr__(self, "yield_force", force)
        if self.unit_stress is not None:
            object.__setattr__(self, "unit_stress", require_positive("unit_stress", self.unit_stress, "MPa"))

    @classmethod
    def from_steel(
        cls,
        *,
        prestress: float = 0.0,
        axial_rigidity: float,
        length: float,
        column_mass: float,
        base_radius: float,
        yield_force: float | None = None,
        area: float | None = None,
        gravity: float = 9.81,
    ) -> Tendon:
        """Tendon from the data of a drawing.

        Parameters
        ----------
        prestress : float, optional
            P0, tension at rest [N].
        axial_rigidity : float
            E A of the steel [N].
        length : float
            Free length between the anchors [m].
        column_mass : float
            Mass of one column, without a slab [kg].
        base_radius : float
            b [m].
        yield_force : float, optional
            [N]
        area : float, optional
            Of the steel [m^2], for its stress.
        gravity : float, optional
            g [m/s^2].

        Raises
        ------
        ValueError
            If a value is out of range.
        """
        weight = require_positive("column_mass", column_mass, "kg") * require_positive(
            "gravity", gravity, "m/s^2"
        )
        rigidity = require_finite("axial_rigidity", axial_rigidity, "N")
        stiffness = rigidity / require_positive("length", length, "m")
        return cls(
            prestress=require_finite("prestress", prestress, "N") / weight,
            stiffness=stiffness * require_positive("base_radius", base_radius, "m") / weight,
            yield_force=None
            if yield_force is None
            else require_finite("yield_force", yield_force, "N") / weight,
            unit_stress=None if area is None else 1e-6 * weight / require_positive("area", area, "m^2"),
        )

    def gaps(self, body: RockingBody) -> int:
        """Number of gaps that the tendon crosses: 1, or 2 under a slab."""
        return 2 if body.slab_mass_ratio > 0.0 else 1

    def initial_stiffness(self, body: RockingBody) -> float:
        """Return the slope of the static couple against the tilt just after uplift [m g b].

        n^2 kt b^2 - w m g h over m g b, w = 1 + 2 slab_mass_ratio: negative where the couple falls with the
        tilt, as without a tendon.
        """
        w = 1.0 + 2.0 * body.slab_mass_ratio
        return self.gaps(body) ** 2 * self.stiffness - w / body.tan_alpha

    def uplift_factor(self, body: RockingBody) -> float:
        """Return the horizontal acceleration at uplift over g tan(alpha): 1 + n P0/(w m g) [-]."""
        return 1.0 + self.gaps(body) * self.prestress / (1.0 + 2.0 * body.slab_mass_ratio)

    def tension(self, body: RockingBody, tilt: float) -> float:
        """Return the tension at a tilt [rad] over the weight of one column [-]."""
        return self.prestress + self.stiffness * self.gaps(body) * 2.0 * math.sin(0.5 * tilt)

    def tilt_at(self, body: RockingBody, tension: float) -> float:
        """Tilt at a tension in weights of one column [rad]; inf if not below 90 deg.

        Examples
        --------
        >>> import rockwobble as rw
        >>> pier = rw.Cylinder.from_dimensions(base_radius=0.8, height=9.0)
        >>> strands = rw.Tendon(prestress=4.186, stiffness=59.37)
        >>> round(math.degrees(strands.tilt_at(pier, 6.357)), 2)
        2.1
        """
        if tension <= self.prestress:
            return 0.0
        if tension > self.tension(body, OVERTURNED_TILT):
            return math.inf
        return 2.0 * math.asin((tension - self.prestress) / (2.0 * self.stiffness * self.gaps(body)))

    def yield_tilt(self, body: RockingBody) -> float:
        """Tilt at which the tendon yields [rad]; inf if not below 90 deg."""
        return math.inf if self.yield_force is None else self.tilt_at(body, self.yield_force)
