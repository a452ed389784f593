"""Grades of an advice, each by a written criterion.

A grade rests on what was run: "not tested" is the grade of what nothing was run for.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from types import MappingProxyType

from rockwobble.compare.comparison.prediction import BEATEN, UNTESTED
from rockwobble.compare.metrics.statistics import FEWEST
from rockwobble.models.finding import GRADES, Grade
from rockwobble.models.trace import NO_PEAK

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
# of the ratio: the tilt may change by so much more between the scales that were run
BETWEEN_SCALES = 1.05

# columns of a frame: what lies on more than three ends rests on those that happen to be higher
EVENLY_LOADED = 3


@dataclass(frozen=True, slots=True, kw_only=True)
class Criterion:
    """What has to be so for each grade of a topic, in words."""

    satisfied: str
    not_tested: str
    caution: str
    not_satisfied: str

    def by_grade(self) -> dict[Grade, str]:
        """Return the words by grade."""
        words = (self.satisfied, self.not_tested, self.caution, self.not_satisfied)
        return dict(zip(GRADES, words, strict=True))


_BRIEFLY = f"for at most {100.0 * BROKEN:g} % of the time in motion"
_FEW = f"fewer than {FEWEST} runs that differ, or the tendon yields in some"
CRITERIA: Mapping[str, Criterion] = MappingProxyType(
    {
        "overturning": Criterion(
            satisfied=f"no run overturns, nor any scale up to {NEAR:g} times this shaking",
            not_tested="no run overturns, but no other scales of this shaking were run, or the tendon "
            f"yields in a run or at a scale up to {NEAR:g}",
            caution=f"at most {100.0 * UNSAFE:g} % of a group overturn, or a scale below {NEAR:g} does; "
            "copies with the vertical component are a group",
            not_satisfied=f"the case as given overturns, or more than {100.0 * UNSAFE:g} % of a group",
        ),
        "friction": Criterion(
            satisfied="the friction given suffices in 95 % of the runs of each group",
            not_tested=_FEW,
            caution=f"not given, or too little {_BRIEFLY}",
            not_satisfied="too little for longer, or below b/h: it slides before it uplifts",
        ),
        "contact": Criterion(
            satisfied="never lost in 95 % of the runs of each group",
            not_tested=_FEW,
            caution=f"lost {_BRIEFLY}",
            not_satisfied="lost for longer: the models do not know flight",
        ),
        "tendon": Criterion(
            satisfied="its tension stays below yield in 95 % of the runs of each group",
            not_tested=_FEW,
            caution="no yield force was given",
            not_satisfied="it yields: what comes after is not modelled",
        ),
        "trace": Criterion(
            satisfied="the largest tilt comes before two methods, or the copies, diverge",
            not_tested="the copies are all one run",
            caution="the largest tilt comes after methods or copies diverge: trust statistics",
            not_satisfied="the run failed, or its tendon yields",
        ),
        "intensity": Criterion(
            satisfied=f"the tilt changes by less than {SENSITIVE:g} times under shaking as strong, with a "
            f"margin of {100.0 * (BETWEEN_SCALES - 1.0):.0f} % for what lies between the scales run",
            not_tested="no other scales of this shaking were run, or the tendon yields at one of them",
            caution=f"it changes by {SENSITIVE:g} times or more, or one of these scales overturns",
            not_satisfied="never: the percentiles say it",
        ),
        "engine": Criterion(
            satisfied="agrees with the model as long as predicted, and to the same end",
            not_tested=f"not run, failed, agrees {BEATEN:g} times the prediction, or hardly moves",
            caution="comes to another end, or stays at rest where the model moves",
            not_satisfied="diverges earlier than half of what is predicted",
        ),
    }
)
# verdict on the cylinder, by the grade of overturning where it does not overturn as given
STABILITY: Mapping[Grade, str] = MappingProxyType(
    {
        "satisfied": "it stands",
        "not tested": "it stands, its margin is not tested",
        "caution": "it may overturn",
        "not satisfied": "it is not safe against overturning",
    }
)
# and on the use of a model, by the worst of the other grades
USE: Mapping[Grade, str] = MappingProxyType(
    {
        "satisfied": "the {} may be used",
        "not tested": "whether the {} may be used is not tested",
        "caution": "use the {} with caution",
        "not satisfied": "do not rely on the {}",
    }
)


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
