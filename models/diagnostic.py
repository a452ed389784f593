"""Diagnostics of a motion by code: its end, its limits, its demands on ground and recess."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from types import MappingProxyType

from .argument_kinds import with_argument_kinds
from .finding import Finding, Findings
from .shown import CompactRepr

# units of size and bound, where they have one
_UNITS = {
    "weights": "weightless tension tendon_yield unlikely_tendon",
    "steps": "step_budget solver",
    "passes": "unresolved_pass missed_pass",
    "alpha": "settled unsettled extrapolated",
    "g": "large_peak gravity_in_record",
    **{"rad": "turning_slide", "columns": "one_column", "g or m/s": "large_hazard", "s": "unlikely_step"},
    **{"m": "unlikely_length", "m/s2": "unlikely_gravity", "t/m3": "unlikely_mass"},
}
_UNIT_OF = {code: unit for unit, codes in _UNITS.items() for code in codes.split()}


def _with_units(codes: str) -> Mapping[str, str]:
    return MappingProxyType({code: _UNIT_OF.get(code, "") for code in codes.split()})


# code: units of size and bound, for reasons why a run failed
FAILURES = _with_units(
    "not_finite energy_gain penetration wall_penetration guide warning died step_budget tolerance weightless"
)
# the same for every diagnostic: limits of a run, and doubts about a record, a number of the user (length,
# gravity, mass, tendon), and an external trajectory
CODES = _with_units(
    f"{' '.join(FAILURES)} slip lift_off tension friction_needed wall_contact energy rolling_loss undecided "
    "solver mode unresolved_slide turning_slide impact_loss early_uplift unresolved_pass settled unsettled "
    "extrapolated not_extrapolated one_column side tendon_yield "
    "large_peak unlike_components same_components large_hazard "
    "unlikely_length unlikely_gravity unlikely_mass unlikely_tendon "
    "offset gravity_in_record unlikely_step ends_in_strong_motion other_direction "
    "note missed_pass"
)
# code: reason, as its detail states it
REASONS: Mapping[str, tuple[str, ...]] = MappingProxyType(
    {
        "large_peak": ("", "m/s2", "cm/s2", "m/s2 for g", "cm/s2 for g", "cm/s2 for m/s2"),
        "unlike_components": ("x", "y", "z"),
        "same_components": ("x and y", "x and z", "y and z"),
        "unlikely_length": ("mm", "cm", "in", "ft", "km"),
        "unlikely_gravity": ("ft/s2", "in/s2", "cm/s2", "mm/s2"),
        "large_hazard": ("g", "m/s"),
        "unlikely_tendon": ("prestress", "stiffness"),
        "offset": ("x", "y", "z"),
        "gravity_in_record": ("x", "y", "z"),
        "other_direction": tuple(f"{place} is {axis}" for place in "xyz" for axis in "xyz" if axis != place),
        "unsettled": ("fails", "still_changes", "no_later", "no_closer", "unresolved_pass", "energy"),
        "not_extrapolated": ("fails", "diverged", "no_closer", "unresolved_pass", "energy"),
    }
)
_SEPARATOR = ", "


def cell_of(codes: Iterable[str]) -> str:
    """Codes, each once, as a table cell.

    Examples
    --------
    >>> cell_of(["slip", "energy", "slip"])
    'slip, energy'
    """
    return _SEPARATOR.join(dict.fromkeys(codes))


def codes_in(cell: str) -> list[str]:
    """Return the codes in a cell of a table.

    Examples
    --------
    >>> codes_in("slip, energy"), codes_in("")
    (['slip', 'energy'], [])
    """
    return cell.split(_SEPARATOR) if cell else []


@with_argument_kinds
@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class Diagnostic(CompactRepr):
    """A fact about a motion; programs decide by code, time and size, never by words.

    Attributes
    ----------
    code : str
        One of `CODES`.
    time : float
        When it first holds [s]; NaN where it has no time.
    duration : float
        For how long altogether [s], NaN where that is not known; of "settled", "unsettled" and
        "extrapolated" until when.
    size, bound : float
        How large it is, and the limit it is compared with; units in `CODES`. NaN where there is none. The
        bound of "settled" and "extrapolated" is the order of convergence, that of "unresolved_pass" the tilt
        that is resolved [rad].
    detail : str
        What an engine or a file says, word for word, not for decisions; of the codes in `REASONS` one of
        those.

    Raises
    ------
    ValueError
        If the code is unknown, or the detail none of its reasons.

    Examples
    --------
    >>> Diagnostic(code="slip", time=2.5, duration=0.1).meaning
    'contact slipped from 2.5 s on'
    """

    code: str
    time: float = math.nan
    duration: float = math.nan
    size: float = math.nan
    bound: float = math.nan
    detail: str = ""

    def __post_init__(self) -> None:
        if self.code not in CODES:
            raise ValueError(f"code must be one of models.diagnostic.CODES, got {self.code!r}")
        reasons = REASONS.get(self.code)
        if reasons and self.detail not in reasons:
            raise ValueError(f"detail must be one of {', '.join(reasons)}, got {self.detail!r}")
        for name in ("time", "duration", "size", "bound"):
            value = float(getattr(self, name))
            # one NaN object, so that equal facts compare equal
            object.__setattr__(self, name, math.nan if math.isnan(value) else value)

    def finding(self) -> Finding:
        """Diagnostic as a finding."""
        values = {name: getattr(self, name) for name in ("time", "duration", "size", "bound", "detail")}
        return Finding(key=f"diagnostic.{self.code}", values=values)

    @property
    def meaning(self) -> str:
        """The diagnostic in words."""
        return repr(Findings([self.finding()]))


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class Assumptions(CompactRepr):
    """The demands of a solution on ground and recess, as extrema of the continuous motion.

    They are taken from a tilt of `CLOSED_TILT` (a thousandth) of alpha on, below which the base is closed.
    In a frame those of base and top of a column, whichever asks for more, each over the weight it carries.

    Attributes
    ----------
    breaches : tuple of Diagnostic
        "tension", with the least normal force as its size [weights], and "friction_needed".
    least_normal_force, largest_normal_force : float
        In weights, while the base is open; 1 if it never is.
    largest_friction_needed : float
        While the base is open; inf where contact is lost, 0 if it never is.
    largest_restraining_moment : float
        Kappa of the moment kappa (z_world + z_body) of the recess, over the weight [m].
    friction : float
        Coefficient of the ground that the demand is compared with.

    Examples
    --------
    >>> import rockwobble as rw
    >>> pier = rw.Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    >>> held = rw.simulate(rw.Case(pier, rw.el_centro_1940(), duration=15.0)).assumptions
    >>> held.all_hold, round(held.largest_friction_needed, 3), round(held.least_normal_force, 2)
    (True, 0.221, 0.94)
    """

    breaches: tuple[Diagnostic, ...] = ()
    least_normal_force: float = 1.0
    largest_normal_force: float = field(default=1.0, repr=False)
    largest_friction_needed: float = 0.0
    largest_restraining_moment: float = 0.0
    friction: float

    @property
    def all_hold(self) -> bool:
        """Whether contact and friction held throughout."""
        return not self.breaches
