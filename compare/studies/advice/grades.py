"""From numbers to a verdict: what is sound, what wants care, and what rules the reduced model out.

A grade is "good", "care" or "bad".
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

from .demands import Demands

GRADES = ("good", "care", "bad")
# share of the moving time for which contact or friction may be missing before the motion is another one:
# below it stand the spikes of single passes, milliseconds each
BROKEN = 0.01
# a lowest overturning scale below this is near: records of one site differ by as much
NEAR = 1.5
# share of perturbed members that overturn from which on a run that stands proves little
CHANCE = 0.05


@dataclass(frozen=True, slots=True, kw_only=True)
class Trust:
    """How far a trace can be trusted.

    Attributes
    ----------
    kind : {"trace", "peak", "statistics"}
        The whole trace; the trace until `until`, the largest tilt included; or only statistics, because
        the largest tilt comes after `until`.
    until : float
        [s] in the time of the run.
    because : {"", "methods", "data"}
        What ends it: two sound methods part there, or the same method on data known to a percent.
    """

    kind: str
    until: float
    because: str


def trust_of(methods_until: float, data_until: float, peak_time: float, end: float) -> Trust:
    """Return how far a trace can be trusted.

    Parameters
    ----------
    methods_until : float
        Until when the reduced model and an engine agree, or have to [s].
    data_until : float
        Until when perturbed starts stay together [s].
    peak_time : float
        Time of the largest tilt [s].
    end : float
        End of the motion [s]: of the run, or the fall.
    """
    until = min(methods_until, data_until)
    if until >= end:
        return Trust(kind="trace", until=end, because="")
    because = "methods" if methods_until <= data_until else "data"
    return Trust(kind="peak" if peak_time <= until else "statistics", until=until, because=because)


def grade_friction(demands: Demands) -> str:
    """Return the grade of the friction that is available."""
    if demands.slides:
        return "bad"
    return _grade_time(demands.slip_time, demands.moving_time)


def grade_contact(demands: Demands) -> str:
    """Return the grade of the contact."""
    return _grade_time(demands.lost_time, demands.moving_time)


def grade_trust(trust: Trust) -> str:
    """Return the grade of a trace: statistics want care."""
    return "care" if trust.kind == "statistics" else "good"


def grade_overturning(overturned: bool, lowest: float, chance: float) -> str:
    """Return the grade of the stability of the cylinder itself.

    Parameters
    ----------
    overturned : bool
        In the run as it is given.
    lowest : float
        Lowest overturning factor on the ground motion; NaN if none does.
    chance : float
        Share of the perturbed members that overturn; NaN if none was run.
    """
    if overturned:
        return "bad"
    return "care" if lowest < NEAR or chance >= CHANCE else "good"


def grade_engine(divergence: str, outcomes_differ: bool) -> str:
    """Return the grade of a run of an engine: `divergence` is that of the summary of a comparison."""
    if divergence == "earlier":
        return "bad"
    return "care" if outcomes_differ else "good"


def overall(grades: Iterable[str]) -> str:
    """Return the worst of some grades; "good" of none."""
    return max(grades, key=GRADES.index, default="good")


def _grade_time(missing: float, moving: float) -> str:
    if missing <= 0.0:
        return "good"
    return "bad" if not moving > 0.0 or missing / moving > BROKEN else "care"


def relative(value: float, nominal: float) -> float:
    """Return value/nominal - 1; NaN where the nominal value is zero or unknown."""
    return value / nominal - 1.0 if nominal > 0.0 and math.isfinite(nominal) else math.nan
