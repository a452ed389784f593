"""Options of the studies, kept apart from the runs so that help imports nothing heavy."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

from rockwobble.compare.runs.plan import Plan, option

if TYPE_CHECKING:
    from rockwobble.models import Case, Tendon

_COPIES = "Number of perturbed copies."
_SEED = "Random seed of the perturbations."
GRAVITY = "Gravitational acceleration g, in m/s2."
_SIZES = "Semidiagonals R, in m: a list 1,2,6 or an even range FROM:TO:COUNT. Default: 0.5:30:100."
SLAB = "Mass of a rigid slab / total mass of the columns that carry it."
PRESTRESS = "Prestress of a tendon along the axis / weight of one column."
STIFFNESS = "Stiffness of the tendon, in weights of one column per base radius."
ROLLING = "Rolling resistance length, in m, below every base radius. 0: no loss."
MASS = "Mass of the cylinder, or of one column without its slab, in t: forces in kN, moments in kNm."
YIELD = "Yield force of the tendon / weight of one column"
FRICTION = "Friction coefficient between cylinder and ground."
# name and words of each support that an engine may have; written out, as help loads no models
SUPPORT_WORDS = "recess (ideal recess), flat (flat ground) or ring (recess with clearance)"
_PLANE = "Azimuth of the plane of a planar motion, in rad. Default: motion in three dimensions."
_RESTITUTION = "Tilt rate after / before an impact of planar motion; momentum: that of Housner. Default: 1."


@dataclass(frozen=True, slots=True, kw_only=True)
class ModelPlan(Plan):
    """Settings of a reduced model."""

    plane: float | None = option(None, _PLANE, group="Reduced model", least=-math.tau, most=math.tau)
    restitution: float | str | None = option(None, _RESTITUTION, group="Reduced model", form="restitution")
    rest_tilt: float | None = option(
        None, "Tilt / alpha below which the cylinder comes to rest. 0: never.", group="Reduced model"
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class Copies(Plan):
    """Perturbed copies of a case: number and relative perturbation."""

    copies: int = option(20, _COPIES, group="Members", least=2)
    perturbation: float = option(
        0.01,
        "Relative standard deviation of both horizontal components, or of tilt and rolling rate at release.",
        group="Members",
        above=0.0,
        most=0.1,
    )
    seed: int = option(0, _SEED, group="Members", least=0)

    def perturbed(self, case: Case, count: int | None = None) -> list[Case]:
        """Perturbed copies of a case, `count` of them or the number of the plan."""
        from rockwobble.models import perturbed_copies

        copies = self.copies if count is None else count
        return perturbed_copies(case, copies, perturbation=self.perturbation, seed=self.seed)


@dataclass(frozen=True, slots=True, kw_only=True)
class AdvicePlan(Copies):
    """Options of an advice on one case: number of copies (5 % must be at least one run) and support."""

    copies: int = option(100, _COPIES, group="Members", least=20, most=10_000)
    seed: int = option(1, _SEED, group="Members", least=0)
    support: str = option("recess", f"Support: {SUPPORT_WORDS}.", group="Method")
    gap: float | None = option(
        None,
        "Gap to a neighbour on flat ground, in m: how often a slide uses it up.",
        group="Method",
        least=0.0,
    )
    mass: float | None = option(None, MASS, group="Cylinder", above=0.0)

    def __post_init__(self) -> None:
        from rockwobble.models.support import support_named  # imports numpy, which help can do without

        Plan.__post_init__(self)
        support_named(self.support)


def tendon_of(prestress: float, stiffness: float, yield_force: float | None = None) -> Tendon | None:
    """Tendon from option values, see `Tendon`; None without force."""
    from rockwobble.models import Tendon  # imports numpy, which help can do without

    if not prestress and not stiffness:
        if yield_force is not None:
            raise ValueError("tendon_yield needs a prestress or a stiffness of the tendon, got none")
        return None
    return Tendon(prestress=prestress, stiffness=stiffness, yield_force=yield_force)


@dataclass(frozen=True, slots=True, kw_only=True)
class TendonPlan(Plan):
    """Options of a tendon, relative to weight and base radius of each body."""

    tendon_prestress: float = option(0.0, PRESTRESS, group="Tendon", least=0.0)
    tendon_stiffness: float = option(0.0, STIFFNESS, group="Tendon", least=0.0)

    @property
    def tendon(self) -> Tendon | None:
        """The tendon; None without force."""
        return tendon_of(self.tendon_prestress, self.tendon_stiffness)


@dataclass(frozen=True, slots=True, kw_only=True)
class YieldPlan(TendonPlan):
    """Options of a tendon with a yield force."""

    tendon_yield: float | None = option(
        None, f"{YIELD}; runs that pass it are no answer. Default: none.", group="Tendon", above=0.0
    )

    def __post_init__(self) -> None:
        Plan.__post_init__(self)
        _ = self.tendon  # refuses what is none

    @property
    def tendon(self) -> Tendon | None:
        """The tendon; None where it does not pull."""
        return tendon_of(self.tendon_prestress, self.tendon_stiffness, self.tendon_yield)


@dataclass(frozen=True, slots=True, kw_only=True)
class FragilityPlan(YieldPlan):
    """Options of a fragility: intensities, limits, statistics, and common terms of its methods."""

    measure: str = option(
        "peak_acceleration",
        "Intensity measure: peak_acceleration (/ g tan alpha), peak_over_friction (the same / g friction), "
        "peak_velocity (times p / g tan alpha), pga, pgv, sa or sa_mean.",
        group="Intensity",
        choices=("peak_acceleration", "peak_over_friction", "peak_velocity", "pga", "pgv", "sa", "sa_mean"),
    )
    levels: Sequence[float] | None = option(
        None,
        "Intensities of all motions: 1,2,3 or logarithmic FROM:TO:COUNT. Default: 20, uplift to overturning.",
        group="Intensity",
        form="levels",
    )
    scales: Sequence[float] | None = option(
        None,
        "Scale factors for the unscaled motions, instead of --levels: 1, or 0.5,1,2.",
        group="Intensity",
        form="numbers",
        flag="--scale",
    )
    period: float = option(1.0, "Period of sa and sa_mean, in s.", group="Intensity", above=0.0)
    limits: Sequence[str] | None = option(
        None,
        'Limit state: uplift, "0.1 alpha", "0.25 alpha", "0.5 alpha", "1 alpha", overturned, contact_lost, '
        '"tendon yields" or slides (more than --gap); may be repeated. Default: all but contact_lost.',
        group="Statistics",
        choices=(
            *("uplift", "0.1 alpha", "0.25 alpha", "0.5 alpha", "1 alpha"),
            *("overturned", "contact_lost", "tendon yields", "slides"),
        ),
        flag="--limit",
    )
    margin: float = option(
        0.1,
        "Equivalence margin: relative difference within which two medians count as equivalent.",
        group="Statistics",
        above=0.0,
    )
    resamples: int = option(
        1000, "Number of bootstrap resamples for the intervals.", group="Statistics", least=2
    )
    seed: int = option(0, "Random seed of resamples and synthetic motions.", group="Statistics", least=0)
    restitution: float | str = option(1.0, _RESTITUTION, form="restitution")
    step_factor: float = option(
        1.0,
        "Multiplies the default time step of the engines; probabilities need less accuracy than traces.",
        above=0.0,
    )
    friction: float = option(1.0, FRICTION, least=0.0)
    gap: float | None = option(
        None, "Displacement on flat ground that the limit state slides asks for, in m.", least=0.0
    )
    rolling_resistance: float = option(0.0, ROLLING, least=0.0)
    gravity: float = option(9.81, GRAVITY, above=0.0)

    def __post_init__(self) -> None:
        # imports numpy, which help can do without
        from rockwobble.models.number_checks import require_increasing

        YieldPlan.__post_init__(self)
        if self.levels is not None and self.scales is not None:
            raise ValueError("levels scale the motions, scales take them as they are: got both")
        for name in ("levels", "scales"):
            if getattr(self, name) is not None:
                require_increasing(name, getattr(self, name))
        if "slides" in (self.limits or ()) and self.gap is None:
            raise ValueError("the limit slides needs a gap, got none")
        if self.limits is not None and not list(self.limits):
            raise ValueError("a fragility needs at least one limit, got none")


# Finest step of a search, over the intensity at which the peak of the horizontal resultant is g tan(alpha):
# no peak acceleration is known to such a step.
STEP = 0.015
# Intensities drawn below each lowest. Where 0.6 % of all overturn, none of so many does once in twenty
# times; with them a spectrum takes some five times as many runs as without.
PROBES = 500


@dataclass(frozen=True, slots=True, kw_only=True)
class SpectrumPlan(YieldPlan):
    """Options of an overturning spectrum: grid, run of a cell, and search for the lowest intensities."""

    SIZES: ClassVar = (0.5, 30.0, 100)  # [m]; with the intensities figure 6 of the paper
    INTENSITIES: ClassVar = (1.0, 12.0, 100)  # [g tan alpha]
    _MOST: ClassVar = 2000  # a map of more cells than a screen has pixels is a slip of the hand

    semidiagonals: Sequence[float] | None = option(
        None, _SIZES, group="Grid", form="numbers", flag="--semidiagonal"
    )
    intensities: Sequence[float] | None = option(
        None,
        "Peaks of the horizontal resultant, in g tan alpha: a list or an even range. Default: 1:12:100.",
        group="Grid",
        form="numbers",
        flag="--intensity",
    )
    slab_mass_ratio: float = option(0.0, SLAB, group="Cylinder", least=0.0)
    gravity: float = option(9.81, GRAVITY, group="Ground motion", above=0.0)
    rolling_resistance: float = option(0.0, ROLLING, group="Ground motion", least=0.0)
    friction: float | None = option(
        None,
        "Friction coefficient, which decides the mode of motion. Default: enough.",
        group="Ground motion",
        least=0.0,
    )
    support: str = option("recess", "Support of the 3D model: recess or flat.", choices=("recess", "flat"))
    search_step: float = option(
        STEP,
        "Resolution of the overturning boundary, in g tan alpha.",
        least=1e-5,  # a search in smaller steps would take a day
    )
    probes: int = option(
        PROBES,
        "Random intensities below each boundary, which bound the missed share (most of the time). 0: none.",
        least=0,
    )

    def __post_init__(self) -> None:
        from rockwobble.models.number_checks import require_increasing

        YieldPlan.__post_init__(self)
        for name in ("semidiagonals", "intensities"):
            given = getattr(self, name)
            if given is not None and len(require_increasing(name, given)) > self._MOST:
                raise ValueError(f"{name} must be at most {self._MOST} numbers, got {len(given)}")


@dataclass(frozen=True, slots=True, kw_only=True)
class ValidityPlan(TendonPlan):
    """Options of the validity study: its extent, and slab and tendon of its cylinders."""

    quick: bool = option(
        False,
        "Coarser maps, fewer points, members and conditions: about two minutes on two idle cores.",
        flag="--quick",
    )
    slab_mass_ratio: float = option(
        0.0,
        "Mass of a rigid slab that only translates / mass of the column under it. 0: no slab.",
        group="Cylinder",
        least=0.0,
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class GridPlan(TendonPlan):
    """Options of a grid of reduced runs from rest: its axes, and common terms of all runs."""

    # [m], [-], [-]: from, to and count
    DEFAULTS: ClassVar = {
        "semidiagonals": (0.5, 30.0, 100),
        "tan_alphas": (0.2, 0.2, 1),
        "scales": (0.5, 6.0, 100),
    }

    semidiagonals: Sequence[float] | None = option(
        None, _SIZES, group="Grid", form="numbers", flag="--semidiagonal"
    )
    tan_alphas: Sequence[float] | None = option(
        None,
        "Slenderness b/h: a list or a range. Default: 0.2.",
        group="Grid",
        form="numbers",
        flag="--tan-alpha",
    )
    scales: Sequence[float] | None = option(
        None,
        "Scale factors of the records: a list or a range. Default: 0.5:6:100.",
        group="Grid",
        form="numbers",
        flag="--scale",
    )
    gravity: float = option(9.81, GRAVITY, group="Ground motion", above=0.0)
    slab_mass_ratio: float = option(0.0, SLAB, group="Cylinder", least=0.0)
    plane: float | None = option(None, _PLANE, group="Reduced models", least=-math.tau, most=math.tau)
    restitution: float | str | None = option(None, _RESTITUTION, group="Reduced models", form="restitution")
