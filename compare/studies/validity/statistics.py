"""Distributions of peak tilt over many records: reduced models and engine, member by member."""

from __future__ import annotations

from collections.abc import Sequence

from rockwobble.models import Run

from ...runs.choice import SUPPORTS, own_model
from ...runs.execution import simulate_run
from .extent import Extent
from .motions import ensemble_names, shaken_case
from .part import Inputs, Part, Row
from .verification import ENGINE

TAN_ALPHA, SIZE = 0.2, 6.0


def _tasks(extent: Extent) -> Sequence[Inputs]:
    return [
        {
            "motion": name,
            "level": level,
            "tan_alpha": TAN_ALPHA,
            "semidiagonal": SIZE,
            "time_step": extent.member_step,
        }
        for level in extent.levels
        for name in ensemble_names(extent.members)
    ]


def measure(inputs: Inputs) -> list[Row]:
    """Return a row for each method: motion, level, method, peak over alpha, outcome."""
    case = shaken_case(inputs["motion"], inputs["tan_alpha"], inputs["semidiagonal"], inputs["level"])
    trials = {f"engine, {support}": Run(ENGINE, support, inputs["time_step"]) for support in SUPPORTS}
    own = {model.support: model for model in map(own_model, trials.values())}
    found = {method: simulate_run(case, run) for method, run in (own | trials).items()}
    point = {name: inputs[name] for name in ("motion", "level", "tan_alpha", "semidiagonal")}
    rows: list[Row] = []
    for method, run in found.items():
        peak = run.peak_tilt / case.cylinder.alpha
        rows.append({**point, "method": method, "peak": peak, "outcome": run.outcome})
    return rows


PART = Part(
    name="statistics",
    title="distributions of peak tilt in the engine",
    tasks=_tasks,
    measure=measure,
    cost=lambda inputs: 6.0,
    module=__name__,
    engine=ENGINE,
)
