"""The criteria of the grades of an advice, in words made from the numbers that decide."""

from __future__ import annotations

from collections.abc import Mapping

from rockwobble.compare.studies.advice.grades import BROKEN, NEAR, SENSITIVE, UNSAFE

# topic: what is sound, what asks for care, what fails
CRITERIA: Mapping[str, tuple[str, str, str]] = {
    "overturning": (
        f"no run overturns, and no scale up to {NEAR:g} times this shaking was found to",
        f"some run overturns, at most {100 * UNSAFE:g} % of any group; or a scale below {NEAR:g} does",
        f"the case as given overturns, or more than {100 * UNSAFE:g} % of a group",
    ),
    "friction": (
        "the friction given suffices in 95 % of all runs",
        f"it is not given; or it is short for at most {100 * BROKEN:g} % of the time in motion",
        "it is short for longer, or below b/h: the cylinder slides before it uplifts",
    ),
    "contact": (
        "contact is never lost in 95 % of all runs",
        f"it is lost for at most {100 * BROKEN:g} % of the time in motion",
        "it is lost for longer: the models do not know flight",
    ),
    "trace": (
        "the largest tilt comes before two methods, or copies 1 % off, diverge",
        "it comes after: only statistics can be trusted",
        "never: statistics remain",
    ),
    "intensity": (
        f"12 % more or less shaking changes the largest tilt by less than {SENSITIVE:g} times",
        "it changes it by more, or overturns the cylinder",
        "never: the percentiles say it",
    ),
    "engine": (
        "it diverges from the model when predicted, or later, and comes to the same end",
        "it comes to another end, or failed",
        "it diverges earlier than half of what is predicted: neither may be trusted",
    ),
}
