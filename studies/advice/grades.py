"""Grades of an advice, each by a written criterion.

A grade rests on what was run: "not tested" is the grade of what nothing was run for.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping

from rockwobble.compare.comparison.prediction import BEATEN, UNTESTED
from rockwobble.compare.metrics.statistics import FEWEST
from rockwobble.models.finding import GRADES, Finding, Grade, Value
from rockwobble.models.trace import NO_PEAK

from .demands import COVERED

POOR: tuple[Grade, ...] = ("caution", "not satisfied")
# share of the moving time for which contact or friction may be missing before the motion is another one:
# below it stand the spikes of single passes, milliseconds each
BROKEN = 0.01
# a lowest overturning scale below this is near: records of one site differ by as much
NEAR = 1.5
# share of a group that overturns from which on a cylinder is not safe
UNSAFE = 0.1
# ratio by which the largest tilt may change under shaking as strong
SENSITIVE = 1.5
# margin of the ratio: the tilt may change by so much more between the scales that were run
BETWEEN_SCALES = 1.05

# columns of a frame: what lies on more than three ends rests on those that happen to be higher
EVENLY_LOADED = 3


# numbers that the words of a criterion name, by topic and grade
_NEAR = {"factor": NEAR, "share": UNSAFE}
_SHARES = {"share": BROKEN, "share_covered": COVERED, "runs": FEWEST}
_CRITERIA: Mapping[str, Mapping[str, Value]] = {
    "overturning": _NEAR,
    "friction": _SHARES,
    "contact": _SHARES,
    "tendon": _SHARES,
    "intensity": {"factor": SENSITIVE, "share_margin": BETWEEN_SCALES - 1.0},
    "engine": {"factor": BEATEN},
}


def criterion(topic: str, grade: Grade) -> Finding:
    """Criterion for a grade of a topic."""
    key = f"criterion.{topic}_{grade.replace(' ', '_')}"
    return Finding(key=key, level=grade, values=_CRITERIA.get(topic, {}))


def grade_share(missing: float, *, asked: bool = True, slides: bool = False, tested: bool = True) -> Grade:
    """Return the grade of friction or contact.

    Parameters
    ----------
    missing : float
        Share of the moving time in which it is missing, that 95 % of the runs do not exceed.
    asked : bool, optional
        Whether what there is was given.
    slides : bool, optional
        Whether the cylinder slides where it would have uplifted.
    tested : bool, optional
        Whether that is of runs that differ, and not of the case as given alone.
    """
    if slides or missing > BROKEN:
        return "not satisfied"
    if missing > 0.0 or not asked:
        return "caution"
    return "satisfied" if tested else "not tested"


def grade_tendon(tension: float, yield_force: float | None, *, tested: bool) -> Grade:
    """Return the grade of a tendon by its largest tension and its yield force [weights of one column]."""
    if yield_force is None:
        return "caution"
    if tension > yield_force:
        return "not satisfied"
    return "satisfied" if tested else "not tested"


def grade_overturning(overturned: bool, lowest: float, chances: Iterable[float], *, tested: bool) -> Grade:
    """Return the grade of the stability of the cylinder.

    Parameters
    ----------
    overturned : bool
        In the run as it is given.
    lowest : float
        Lowest overturning factor on the ground motion; NaN if none does.
    chances : iterable of float
        Share of each group of members that overturns; NaN of a group that says nothing.
    tested : bool
        Whether other scales of the ground motion were run, or copies of a release over still ground, and the
        tendon, if there is one, yields in none.
    """
    worst = overall(map(grade_chance, chances))
    if overturned or worst == "not satisfied":
        return "not satisfied"
    if worst == "caution" or lowest < NEAR:
        return "caution"
    return "satisfied" if tested else "not tested"


def grade_chance(chance: float) -> Grade:
    """Return the grade of a share of runs that overturn; "not tested" of NaN."""
    if math.isnan(chance):
        return "not tested"
    return "not satisfied" if chance > UNSAFE else "caution" if chance > 0.0 else "satisfied"


def grade_trace(kind: str, *, tested: bool) -> Grade:
    """Return the grade of a trace by the kind of its `Trust`; tested: whether copies that differ were run."""
    if kind == "statistics":
        return "caution"
    return "satisfied" if tested else "not tested"


def grade_intensity(low: float, peak: float, high: float) -> Grade:
    """Return the grade of a largest tilt that is `low` to `high` under shaking as strong; NaN: not run."""
    if math.isnan(low):
        return "not tested"
    limit = SENSITIVE / BETWEEN_SCALES
    return "caution" if high > limit * peak or low * limit < peak else "satisfied"


def grade_engine(outcome: str, divergence: str, *, differs: bool) -> Grade:
    """Return the grade of a run of an engine.

    Parameters
    ----------
    outcome, divergence : str
        As in the summary of a comparison.
    differs : bool
        Whether one of engine and model overturns, or moves, and the other does not.
    """
    if outcome in NO_PEAK:
        return "not tested"
    if divergence == "earlier":
        return "not satisfied"
    if differs:
        return "caution"
    return "not tested" if divergence in UNTESTED else "satisfied"


def overall(grades: Iterable[Grade]) -> Grade:
    """Return the worst of some grades; "not tested" of none."""
    return max(grades, key=GRADES.index, default="not tested")
