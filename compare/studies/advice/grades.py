"""Grades of an advice, each by a written criterion: "good", "care" or "bad"."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Literal

Grade = Literal["good", "care", "bad"]
GRADES: tuple[Grade, ...] = ("good", "care", "bad")
# share of the moving time for which contact or friction may be missing before the motion is another one:
# below it stand the spikes of single passes, milliseconds each
BROKEN = 0.01
# a lowest overturning scale below this is near: records of one site differ by as much
NEAR = 1.5
# share of a group that overturns from which on a cylinder is not safe
UNSAFE = 0.1
# ratio by which the largest tilt may change with the shaking a little stronger or weaker
SENSITIVE = 1.5


def grade_share(missing: float, *, asked: bool = True, slides: bool = False) -> Grade:
    """Return the grade of friction or contact.

    Parameters
    ----------
    missing : float
        Share of the moving time in which it is missing, that 95 % of the runs do not exceed.
    asked : bool, optional
        Whether what there is was given.
    slides : bool, optional
        Whether the cylinder slides where it would have uplifted.
    """
    if slides or missing > BROKEN:
        return "bad"
    return "care" if missing > 0.0 or not asked else "good"


def grade_overturning(overturned: bool, lowest: float, chances: Iterable[float]) -> Grade:
    """Return the grade of the stability of the cylinder.

    Parameters
    ----------
    overturned : bool
        In the run as it is given.
    lowest : float
        Lowest overturning factor on the ground motion; NaN if none does.
    chances : iterable of float
        Share of each group of members that overturns.
    """
    worst = max((chance for chance in chances if not math.isnan(chance)), default=0.0)
    if overturned or worst > UNSAFE:
        return "bad"
    return "care" if worst > 0.0 or lowest < NEAR else "good"


def grade_intensity(low: float, peak: float, high: float) -> Grade:
    """Return the grade of a largest tilt that is `low` to `high` for shaking a little off."""
    return "care" if high > SENSITIVE * peak or low * SENSITIVE < peak else "good"


def grade_engine(outcome: str, divergence: str, *, differs: bool) -> Grade:
    """Return the grade of a run of an engine: `divergence` is that of the summary of a comparison."""
    if divergence == "earlier" and outcome != "failed":
        return "bad"
    return "care" if differs or outcome == "failed" else "good"


def overall(grades: Iterable[Grade]) -> Grade:
    """Return the worst of some grades; "good" of none."""
    return max(grades, key=GRADES.index, default="good")
