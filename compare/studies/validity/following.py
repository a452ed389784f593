"""Traces under El Centro: agreement times of engine and reduced models, and their peak tilts."""

from __future__ import annotations

from collections.abc import Iterable

from rockwobble.models import Run
from rockwobble.multibody import DEFAULT_ENGINE

from ...comparison.driver import compare
from ...runs.choice import SUPPORTS
from .extent import Extent
from .motions import EL_CENTRO, shaken_case
from .part import Inputs, Part, Row

_COLUMNS = (
    *("support", "reference_support", "outcome", "reference_outcome", "peak_tilt", "reference_peak_tilt"),
    *("tilt_rms", "tilt_rms_relative", "agreement_time", "predicted_agreement_time", "diverged"),
    *("agreed_passes", "residual_displacement", "residual_twist"),
)


def _tasks(extent: Extent) -> Iterable[Inputs]:
    for tan_alpha, size, intensity in extent.trace_points:
        for support in SUPPORTS:
            yield {
                "tan_alpha": tan_alpha,
                "semidiagonal": size,
                "intensity": intensity,
                "support": support,
                "duration": extent.trace_length,
            }


def measure(
    tan_alpha: float, semidiagonal: float, intensity: float, support: str, duration: float
) -> list[Row]:
    """Return the summary of a run of the engine against the recess and, on flat ground, the flat model.

    The columns are tan_alpha, semidiagonal, intensity, duration and those of `SUMMARY_COLUMNS`.
    """
    case = shaken_case(EL_CENTRO, tan_alpha, semidiagonal, intensity, duration=duration)
    summary = compare(case, runs=[Run(DEFAULT_ENGINE, support)], workers=1).summary[list(_COLUMNS)]
    return [{str(name): value for name, value in row.items()} for row in summary.to_dict("records")]


PART = Part(
    name="following",
    title="traces under El Centro in the engine",
    tasks=_tasks,
    measure=measure,
    keys=("tan_alpha", "semidiagonal", "intensity", "duration"),
    cost=lambda duration, **_: 0.04 * duration,
    engine=DEFAULT_ENGINE,
)
