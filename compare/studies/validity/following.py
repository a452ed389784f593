"""Traces under El Centro: how long the engine follows the reduced model, and its peak tilt."""

from __future__ import annotations

from collections.abc import Sequence

from rockwobble.models import Run

from ...comparison.driver import compare
from ...runs.choice import SUPPORTS
from .extent import Extent
from .motions import EL_CENTRO, shaken_case
from .part import Inputs, Part, Row
from .verification import ENGINE

_COLUMNS = (
    "support",
    "reference_support",
    "outcome",
    "reference_outcome",
    "peak_tilt",
    "reference_peak_tilt",
    "tilt_rms",
    "tilt_rms_relative",
    "agreement_time",
    "predicted_agreement_time",
    "diverged",
    "agreed_passes",
    "residual_displacement",
    "residual_twist",
)


_RENAMED = {"reference_support": "reference"}


def _tasks(extent: Extent) -> Sequence[Inputs]:
    return [
        {
            "tan_alpha": tan_alpha,
            "semidiagonal": size,
            "intensity": intensity,
            "support": support,
            "duration": extent.trace_length,
        }
        for tan_alpha, size, intensity in extent.trace_points
        for support in SUPPORTS
    ]


def measure(inputs: Inputs) -> list[Row]:
    """Return the summary of a run of the engine against recess and, on open ground, rolling.

    The columns are tan_alpha, semidiagonal, intensity, duration and those of `SUMMARY_COLUMNS`.
    """
    case = shaken_case(
        EL_CENTRO,
        inputs["tan_alpha"],
        inputs["semidiagonal"],
        inputs["intensity"],
        duration=inputs["duration"],
    )
    summary = compare(case, runs=[Run(ENGINE, inputs["support"])], workers=1).summary
    point = {name: inputs[name] for name in ("tan_alpha", "semidiagonal", "intensity", "duration")}
    return [
        point | {_RENAMED.get(str(name), str(name)): value for name, value in row.items()}
        for row in summary[list(_COLUMNS)].to_dict("records")
    ]


PART = Part(
    name="following",
    title="traces under El Centro in the engine",
    tasks=_tasks,
    measure=measure,
    cost=lambda inputs: 0.2 * inputs["duration"],
    module=__name__,
    engine=ENGINE,
)
