"""Grades of an advice, each by a written criterion.

A grade rests on what was run: "not tested" is the grade of what nothing was run for.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Literal

from rockwobble.models.trace import NO_PEAK

from ...comparison.prediction import UNTESTED

Grade = Literal["satisfied", "not tested", "caution", "not satisfied"]
GRADES: tuple[Grade, ...] = ("satisfied", "not tested", "caution", "not satisfied")  # the best first
# share of the moving time for which contact or friction may be missing before the motion is another one:
# below it stand the spikes of single passes, milliseconds each
BROKEN = 0.01
# a lowest overturning scale below this is near: records of one site differ by as much
NEAR = 1.5
# share of a group that overturns from which on a cylinder is not safe
UNSAFE = 0.1
# ratio by which the largest tilt may change with the shaking a little stronger or weaker
SENSITIVE = 1.5


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
        Whether other scales of the ground motion were run, or copies of a release over still ground.
    """
    worst = max((chance for chance in chances if not math.isnan(chance)), default=0.0)
    if overturned or worst > UNSAFE:
        return "not satisfied"
    if worst > 0.0 or lowest < NEAR:
        return "caution"
    return "satisfied" if tested else "not tested"


def grade_trace(kind: str, *, tested: bool) -> Grade:
    """Return the grade of a trace by the kind of its `Trust`; tested: whether copies that differ were run."""
    if kind == "statistics":
        return "caution"
    return "satisfied" if tested else "not tested"


def grade_intensity(low: float, peak: float, high: float) -> Grade:
    """Return the grade of a largest tilt that is `low` to `high` for shaking a little off; NaN: not run."""
    if math.isnan(low):
        return "not tested"
    return "caution" if high > SENSITIVE * peak or low * SENSITIVE < peak else "satisfied"


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
