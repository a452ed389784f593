"""Verdict on an external trajectory against a model, in numbers and codes."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import pandas as pd

from rockwobble.models import Case, Trace

from ...traces.motion import motion_of
from ...metrics.pair import start_of
from ...traces.trajectory import external_motion, measurement
from .difference import Difference, Part, difference
from .explanation import Explanation, explain
from .frame import Mistake
from .uplift_difference import uplift_differences

# columns of the summary that only external trajectories have: unit, meaning
Cell = float | str | bool | tuple[str, ...] | tuple[float, ...]
Row = dict[str, Cell]  # of a summary
VERDICT_COLUMNS: Mapping[str, tuple[str, str]] = {
    "differs_in": ("", "of an external trajectory: tilt, azimuth, path, uplift_time, uplift_direction"),
    "not_compared": (
        "",
        "azimuth or path, where not given or where the tilts agree over too little motion",
    ),
    "not_given": ("", "those of them that the file does not give"),
    "azimuth_rms": ("deg", "difference of the azimuths while the tilts agree, weighted by the tilt"),
    "azimuth_differs_from": ("s", "time of the first difference of the azimuths above its bound"),
    "path_rms": ("b", "distance of the mass centres while the tilts agree"),
    "path_differs_from": ("s", "time of the first distance above its bound"),
    "tilt_bound": ("alpha", "tilt difference that ends the agreement: 1 % of alpha, and more with noise"),
    "noise": ("alpha", "standard deviation of the scatter of the samples"),
    "uplift_time_uncertainty": ("s", "how well the samples tell the difference of the uplift times"),
    "uplift_direction_uncertainty": ("rad", "how well they tell that of the directions"),
    "likely_mistake": ("", "codes of what explains the differences: see `Mistake`"),
    "likely_mistake_in": ("", "what each of them concerns"),
    "likely_mistake_value": ("", "their values, in the units of the codes"),
    "alternative_mistake": ("", "what explains the azimuth just as well"),
    "alternative_mistake_value": ("", "its value"),
    "differs_without_mistake": ("", "what still differs, of tilt, azimuth and path"),
    "agreement_without_mistake": ("s", "from uplift or release, as it would be without them"),
}
# those of them that hold a tuple
LISTS = (
    *("differs_in", "not_compared", "not_given", "differs_without_mistake"),
    *("likely_mistake", "likely_mistake_in", "likely_mistake_value"),
    *("alternative_mistake", "alternative_mistake_value"),
)


@dataclass(frozen=True, slots=True, kw_only=True)
class Verdict:
    """An external trajectory held against a model.

    Attributes
    ----------
    explanation : Explanation or None
        None where nothing differs.
    not_compared, not_given : tuple of str
        Azimuth or path, because there is too little motion while the tilts agree or because it is not given.
    uplift_time, uplift_direction : Part or None
        Difference and its uncertainty as size and bound [s], [rad]; None at a release, or where one of the
        two does not uplift.
    noise : float
        Standard deviation of the scatter of the samples [alpha].
    """

    difference: Difference
    explanation: Explanation | None
    not_compared: tuple[str, ...]
    not_given: tuple[str, ...]
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
            "differs_in": self.differs_in,
            "not_compared": self.not_compared,
            "not_given": self.not_given,
            "tilt_bound": self.difference.tilt.bound,
            "noise": self.noise,
            "likely_mistake": tuple(mistake.code for mistake in self.mistakes),
            "likely_mistake_in": tuple(mistake.concerns for mistake in self.mistakes),
            "likely_mistake_value": tuple(mistake.value for mistake in self.mistakes),
        }
        if self.explanation is not None and self.mistakes:
            others, left = self.explanation.alternatives, self.explanation.left
            own["alternative_mistake"] = tuple(mistake.code for mistake in others)
            own["alternative_mistake_value"] = tuple(mistake.value for mistake in others)
            # as of the agreement time: the length of the run where they never diverge
            own["differs_without_mistake"] = left.differs_in
            own["agreement_without_mistake"] = left.length if left.tilt.differs else left.end
        if azimuth is not None:
            own |= {"azimuth_rms": math.degrees(azimuth.size), "azimuth_differs_from": azimuth.first_time}
        if path is not None:
            own |= {"path_rms": path.size, "path_differs_from": path.first_time}
        for name, part in (("uplift_time", self.uplift_time), ("uplift_direction", self.uplift_direction)):
            if part is not None:
                own[f"{name}_uncertainty"] = part.bound
        return own


def judge(trajectory: Trace, reference: Trace, case: Case) -> Verdict:
    """Hold an external trajectory of a case against the trace of a model."""
    model, motion = motion_of(reference), external_motion(trajectory)
    start = start_of(reference)
    found = difference(model, motion, cylinder=case.cylinder, start=start)
    time, direction = uplift_differences(trajectory, reference)
    parts = (("azimuth", found.azimuth, motion.lean), ("path", found.path, motion.path))
    verdict = Verdict(
        difference=found,
        explanation=None,
        not_compared=tuple(name for name, part, _ in parts if part is None),
        not_given=tuple(name for name, _, given in parts if given is None),
        uplift_time=time,
        uplift_direction=direction,
        noise=measurement(trajectory).poses.noise / case.cylinder.alpha,
    )
    if not found.differs_in:
        return verdict
    return replace(verdict, explanation=explain(trajectory, model, case, start=start))


def numbers_of(row: Row) -> dict[str, float]:
    """Return the numbers of a row."""
    return {name: float(cell) for name, cell in row.items() if not isinstance(cell, str | tuple)}


def no_verdict() -> Row:
    """Return the columns of a run that is no external trajectory."""
    return {name: () if name in LISTS else math.nan for name in VERDICT_COLUMNS}


def lists_in_words(summary: pd.DataFrame) -> pd.DataFrame:
    """Return a summary whose lists are texts, for a CSV file or a page: "azimuth; path"."""
    return summary.assign(**{name: summary[name].map(_joined) for name in LISTS})


def _joined(cell: Sequence[str | float]) -> str:
    return "; ".join(
        each if isinstance(each, str) else f"{each:.6g}" if math.isfinite(each) else "" for each in cell
    )


def lists_of_file(summary: pd.DataFrame) -> pd.DataFrame:
    """Return a summary that was stored, with its lists as tuples again.

    Raises
    ------
    ValueError
        If it does not have them.
    """
    if not set(LISTS) <= set(summary):
        raise ValueError("it is of another version of rockwobble")
    return summary.assign(**{name: summary[name].map(tuple) for name in LISTS})
