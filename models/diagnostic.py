"""Facts about one motion by their code: what ended it, what limits it, what it asks of ground and recess."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from types import MappingProxyType

from .argument_kinds import with_argument_kinds
from .shown import Brief

# code: (unit of size and bound, meaning); why a run failed
FAILURES: Mapping[str, tuple[str, str]] = MappingProxyType(
    {
        "not_finite": ("", "the state is not finite"),
        "energy_gain": ("", "the engine gained energy that nothing supplied"),
        "penetration": ("", "the cylinder sank into the ground"),
        "wall_penetration": ("", "the cylinder sank into a wall"),
        "guide": ("", "the guide did not hold the twist"),
        "warning": ("", "the engine warned"),
        "died": ("", "the run ended its process"),
        "step_budget": ("steps", "the steps allowed were used up: the motion chatters near upright"),
        "tolerance": ("", "no step met the tolerance"),
        "weightless": ("weights", "g + az reached 0: the ground does not carry it, and nothing here applies"),
    }
)
# and of every diagnostic
CODES: Mapping[str, tuple[str, str]] = MappingProxyType(
    {
        **FAILURES,
        # what limits a run
        "slip": ("", "contact slipped"),
        "lift_off": ("", "the cylinder left the ground"),
        "tension": ("weights", "the ground would have to pull: contact is lost"),
        "friction_needed": ("", "the rim would slip: more friction is needed than there is"),
        "wall_contact": ("", "the cylinder touched a wall"),
        "energy": ("", "contact made (above 0) or took (below 0) of the energy of the motion"),
        "rolling_loss": ("", "rolling resistance took of the energy of the motion, besides"),
        "undecided": ("", "it stays by its balance: rounding decides whether it falls or turns back"),
        "solver": ("steps", "the solver had not converged in some of the steps looked at"),
        "mode": ("", "another mode of motion than the mechanics lets the case have"),
        "unresolved_slide": ("", "the displacement is off that of Coulomb's law, over its peak"),
        "turning_slide": ("rad", "it turns while it slides, which friction of a closed base does not do"),
        "early_uplift": ("", "the base opened before the load was at its rim"),
        "unresolved_pass": ("passes", "passes are closer to upright than contact resolves"),
        "settled": ("alpha", "error that the time step leaves, by extrapolation"),
        "unsettled": ("alpha", "change from twice the time step: it has not settled, or nobody knows"),
        "extrapolated": ("alpha", "error left after extrapolation in the time step, by estimate"),
        "not_extrapolated": ("", "runs at successive time steps do not agree well enough to extrapolate"),
        "one_column": ("columns", "the engine runs one column, under a slab that only translates"),
        "side": ("", "it passed through upright itself: the side to which it goes on is undetermined"),
        "tendon_yield": ("weights", "the tendon would yield: what comes after is not modelled"),
        # what makes a record of the ground improbable
        "large_peak": ("g", "no record has such a peak: is its unit another?"),
        "unlike_components": ("", "peaks of components differ as only units do"),
        "same_components": ("", "two components are the same: is one file given twice?"),
        "large_hazard": (
            "g or m/s",
            "half of a hazard curve is above strong shaking: is its unit another?",
        ),
        # and a length, a gravity, a mass or a tendon
        "unlikely_length": ("m", "no structure has such a length: is its unit another?"),
        "unlikely_gravity": ("m/s2", "no planet has such a gravity: is its unit another?"),
        "unlikely_mass": ("t/m3", "no structure has such a density: is the unit of its mass another?"),
        "unlikely_tendon": ("weights", "no tendon has such a force: is its unit another?"),
        "offset": ("", "the mean is a large part of the peak: the offset was not removed"),
        "gravity_in_record": ("g", "the mean is 1 g: the sensor has recorded gravity"),
        "unlikely_step": ("s", "no recorder has such a time step: is the unit of time another?"),
        "ends_in_strong_motion": ("", "the record ends in strong motion: is it cut?"),
        "other_direction": ("", "a component stands in the place of another direction"),
        # what an external trajectory leaves open
        "note": ("", "how the file was read"),
        "missed_pass": ("passes", "passes fell between two samples"),
    }
)
# code: why, as its detail says it
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
    """Return codes, each once, as a cell of a table.

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
class Diagnostic(Brief):
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
    'contact slipped'
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
            # one NaN, which is itself: facts that say the same are equal
            object.__setattr__(self, name, math.nan if math.isnan(value) else value)

    @property
    def meaning(self) -> str:
        """The code in words."""
        return CODES[self.code][1]


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class Assumptions(Brief):
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
