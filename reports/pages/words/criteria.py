"""The criteria of the grades of an advice, in words made from the numbers that decide."""

from __future__ import annotations

from collections.abc import Mapping

from rockwobble.compare.comparison.prediction import BEATEN
from rockwobble.compare.metrics.order_statistics import FEWEST
from rockwobble.compare.studies.advice.grades import BROKEN, GRADES, NEAR, SENSITIVE, UNSAFE, Grade

_FEW = f"fewer than {FEWEST} runs that differ"
# topic: the criterion of each of `GRADES`
CRITERIA: Mapping[str, Mapping[Grade, str]] = {
    topic: dict(zip(GRADES, criteria, strict=True))
    for topic, criteria in {
        "overturning": (
            f"no run overturns, nor was any scale up to {NEAR:g} times this shaking found to; of a release "
            "over still ground, no copy does",
            "no run overturns, but no other scales of this shaking were run",
            f"some run overturns, at most {100 * UNSAFE:g} % of any group; or a scale below {NEAR:g} does",
            f"the case as given overturns, or more than {100 * UNSAFE:g} % of a group",
        ),
        "friction": (
            "the friction given suffices in 95 % of all runs",
            _FEW,
            f"it is not given; or it is short for at most {100 * BROKEN:g} % of the time in motion",
            "it is short for longer, or below b/h: the cylinder slides before it uplifts",
        ),
        "contact": (
            "contact is never lost in 95 % of all runs",
            _FEW,
            f"it is lost for at most {100 * BROKEN:g} % of the time in motion",
            "it is lost for longer: the models do not know flight",
        ),
        "trace": (
            "the largest tilt comes before two methods, or copies 1 % off, diverge",
            "the copies are all one run",
            "it comes after: only statistics can be trusted",
            "the run failed",
        ),
        "intensity": (
            f"12 % more or less shaking changes the largest tilt by less than {SENSITIVE:g} times",
            "no other scales of this shaking were run",
            "it changes it by more, or overturns the cylinder",
            "never: the percentiles say it",
        ),
        "engine": (
            "it diverges from the model when predicted, or later, and comes to the same end",
            f"no engine was run, or it failed; it agrees more than {BEATEN:g} times as long as predicted; or "
            "they diverge before the model's tilt changes by more than the tolerance",
            "it comes to another end, or stays at rest where the model moves",
            "it diverges earlier than half of what is predicted: neither may be trusted",
        ),
    }.items()
}
