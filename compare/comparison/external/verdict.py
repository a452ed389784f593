"""Verdict on an external trajectory against a model, in numbers and codes."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace

from rockwobble.models import Case, Trace

from ...traces.motion import motion_of
from ...traces.pair import start_of
from ...traces.trajectory import external_motion, measurement
from .difference import Difference, Part, difference
from .explanation import Explanation, explain
from .frame import Mistake
from .uplift_difference import uplift_differences

# columns of the summary that only external trajectories have: unit, meaning
Row = dict[str, float | str | bool]  # of a summary
VERDICT_COLUMNS: Mapping[str, tuple[str, str]] = {
    "differs_in": ("", "of an external trajectory: tilt, azimuth, path, uplift_time, uplift_direction"),
    "not_compared": (
        "",
        "azimuth or path, where not given or where the tilts agree over too little motion",
    ),
    "azimuth_rms": ("deg", "difference of the azimuths while the tilts agree, weighted by the tilt"),
    "azimuth_differs_from": ("s", "time of the first difference of the azimuths above its bound"),
    "path_rms": ("b", "distance of the mass centres while the tilts agree"),
    "path_differs_from": ("s", "time of the first distance above its bound"),
    "tilt_bound": ("alpha", "tilt difference that ends the agreement: 1 % of alpha, and more with noise"),
    "noise": ("alpha", "standard deviation of the scatter of the samples"),
    "uplift_time_uncertainty": ("s", "how well the samples tell the difference of the uplift times"),
    "uplift_direction_uncertainty": ("rad", "how well they tell that of the directions"),
    "likely_mistake": ("", "codes of what explains the differences: see `Mistake`"),
    "likely_mistake_value": ("", "their values, in the units of the codes"),
    "alternative_mistake": ("", "what explains the azimuth just as well"),
    "alternative_mistake_value": ("", "its value"),
    "differs_without_mistake": ("", "what still differs, of tilt, azimuth and path"),
    "agreement_without_mistake": ("s", "from uplift or release, as it would be without them"),
}
_TEXTS = (
    *("differs_in", "not_compared", "likely_mistake", "likely_mistake_value"),
    *("alternative_mistake", "alternative_mistake_value", "differs_without_mistake"),
)


@dataclass(frozen=True, slots=True, kw_only=True)
class Verdict:
    """An external trajectory held against a model.

    Attributes
    ----------
    explanation : Explanation or None
        None where nothing differs.
    not_compared : tuple of str
        Azimuth or path with the reason: "not given", or "too little motion" while the tilts agree.
    uplift_time, uplift_direction : Part or None
        Difference and its uncertainty as size and bound [s], [rad]; None at a release, or where one of the
        two does not uplift.
    noise : float
        Standard deviation of the scatter of the samples [alpha].
    """

    difference: Difference
    explanation: Explanation | None
    not_compared: tuple[str, ...]
    uplift_time: Part | None
    uplift_direction: Part | None
    noise: float

    @property
    def differs_in(self) -> tuple[str, ...]:
        """What differs, of tilt, azimuth, path, uplift_time and uplift_direction."""
        uplift = (("uplift_time", self.uplift_time), ("uplift_direction", self.uplift_direction))
        return (
            *self.difference.differs_in,
            *(name for name, part in uplift if part is not None and part.differs),
        )

    @property
    def mistakes(self) -> tuple[Mistake, ...]:
        """The likely mistakes."""
        return () if self.explanation is None else self.explanation.mistakes

    def columns(self) -> Row:
        """Return the columns of the summary."""
        azimuth, path = self.difference.azimuth, self.difference.path
        own: Row = no_verdict() | {
            "differs_in": "; ".join(self.differs_in),
            "not_compared": "; ".join(self.not_compared),
            "tilt_bound": self.difference.tilt.bound,
            "noise": self.noise,
            **_columns_of("likely_mistake", self.mistakes),
        }
        if self.explanation is not None and self.mistakes:
            own |= _columns_of("alternative_mistake", self.explanation.alternatives)
            left = self.explanation.left
            # as of the agreement time: the length of the run where they never diverge
            own["differs_without_mistake"] = "; ".join(left.differs_in)
            own["agreement_without_mistake"] = left.length if left.tilt.differs else left.end
        if azimuth is not None:
            own |= {"azimuth_rms": math.degrees(azimuth.size), "azimuth_differs_from": azimuth.first_time}
        if path is not None:
            own |= {"path_rms": path.size, "path_differs_from": path.first_time}
        for name, part in (("uplift_time", self.uplift_time), ("uplift_direction", self.uplift_direction)):
            if part is not None:
                own[f"{name}_uncertainty"] = part.bound
        return own


def _columns_of(name: str, mistakes: tuple[Mistake, ...]) -> dict[str, str]:
    return {
        name: "; ".join(f"{mistake.concerns}: {mistake.code}" for mistake in mistakes),
        f"{name}_value": "; ".join(
            f"{mistake.value:.6g}" if math.isfinite(mistake.value) else "" for mistake in mistakes
        ),
    }


def judge(trajectory: Trace, reference: Trace, case: Case) -> Verdict:
    """Hold an external trajectory of a case against the trace of a model."""
    model, motion = motion_of(reference), external_motion(trajectory)
    start = start_of(reference)
    found = difference(model, motion, cylinder=case.cylinder, start=start)
    time, direction = uplift_differences(trajectory, reference)
    verdict = Verdict(
        difference=found,
        explanation=None,
        not_compared=tuple(
            f"{name}: {'not given' if given is None else 'too little motion'}"
            for name, part, given in (
                ("azimuth", found.azimuth, motion.lean),
                ("path", found.path, motion.path),
            )
            if part is None
        ),
        uplift_time=time,
        uplift_direction=direction,
        noise=measurement(trajectory).poses.noise / case.cylinder.alpha,
    )
    if not found.differs_in:
        return verdict
    return replace(verdict, explanation=explain(trajectory, model, case, start=start))


def no_verdict() -> Row:
    """Return the columns of a run that is no external trajectory."""
    return {name: "" if name in _TEXTS else math.nan for name in VERDICT_COLUMNS}
