"""Peak tilts over records: the engine in every support beside the reduced models, member by member."""

from __future__ import annotations

from collections.abc import Iterable

from rockwobble.models import Run
from rockwobble.multibody import DEFAULT_ENGINE

from ...runs.execution import simulate_run
from .extent import Extent
from .motions import record_names, shaken_case
from .part import Inputs, Part, Row
from .peaks import COPY

RECESS, FLAT, PERTURBED = "recess model", "flat-ground model", "perturbed copy"
HALVED = "ring, half the step"


def _tasks(extent: Extent) -> Iterable[Inputs]:
    for tan_alpha, size, intensity in extent.record_points:
        for motion in record_names(extent.members):
            yield {
                "motion": motion,
                "tan_alpha": tan_alpha,
                "semidiagonal": size,
                "intensity": intensity,
                "time_step": extent.record_step,
            }


def measure(
    motion: str, tan_alpha: float, semidiagonal: float, intensity: float, time_step: float
) -> list[Row]:
    """Return a row for each method.

    The columns: motion, tan_alpha, semidiagonal [m], intensity, method, peak over alpha, outcome;
    contact_time with walls [s] and loss, energy that contact took over the largest that was reached. The
    methods: the two reduced models, the perturbed copy of the recess model under a record stronger by 1 %,
    the engine in a recess, on flat ground and in a ring, and this at half its step.
    """
    case = shaken_case(motion, tan_alpha, semidiagonal, intensity)
    stronger = shaken_case(motion, tan_alpha, semidiagonal, intensity * (1.0 + COPY))
    plan = {
        RECESS: (case, Run(None, "recess")),
        FLAT: (case, Run(None, "flat")),
        PERTURBED: (stronger, Run(None, "recess")),
        **{
            support: (case, Run(DEFAULT_ENGINE, support, time_step)) for support in ("recess", "flat", "ring")
        },
        HALVED: (case, Run(DEFAULT_ENGINE, "ring", 0.5 * time_step)),
    }
    rows: list[Row] = []
    for method, (problem, run) in plan.items():
        trace = simulate_run(problem, run)
        largest = float(trace.energy.max())
        rows.append(
            {
                "method": method,
                "peak": trace.peak_tilt / case.cylinder.alpha,
                "outcome": trace.outcome,
                "contact_time": float(trace.wall_contact[-1]),
                "loss": -float(trace.energy_error[-1]) / largest if largest > 0.0 else 0.0,
            }
        )
    return rows


PART = Part(
    name="records",
    title="peak tilt over records in the engine",
    tasks=_tasks,
    measure=measure,
    keys=("motion", "tan_alpha", "semidiagonal", "intensity"),
    cost=lambda time_step, **_: 16.0 * 2e-4 / time_step,
    engine=DEFAULT_ENGINE,
)
