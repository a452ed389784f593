"""Peak tilts over records: of the reduced models over slenderness, size and intensity, and of the engine."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence

from rockwobble import reduced
from rockwobble.models import Case, Run, Trace
from rockwobble.multibody import DEFAULT_ENGINE

from ...runs.execution import simulate_run
from .plan import EL_CENTRO, LARGEST_PEAK, Extent, Inputs, Part, Row, motion_named, record_names, shaken_case

# the record of the perturbed copy is stronger by this: no record is known better, and no model can be asked
# for more than what it changes
COPY = 0.01
_RTOL = 1e-7


def _peaks_tasks(extent: Extent) -> Iterable[Inputs]:
    # El Centro besides, which has a vertical component
    for motion in [*record_names(extent.members), EL_CENTRO]:
        for tan_alpha in extent.shaken_tan_alphas:
            for size in extent.sizes:
                yield {
                    "motion": motion,
                    "tan_alpha": tan_alpha,
                    "semidiagonal": size,
                    "intensities": tuple(i for i in extent.intensities if i * tan_alpha <= LARGEST_PEAK),
                }


def measure_peaks(
    motion: str, tan_alpha: float, semidiagonal: float, intensities: Sequence[float]
) -> list[Row]:
    """Return one row for each intensity.

    The columns: motion, tan_alpha, semidiagonal [m], intensity; peak tilt over alpha, pi/2 over alpha if
    overturned, of the recess model, of its perturbed copy under a record stronger by 1 %, of the flat-ground
    model, and of the recess model with the vertical component (NaN where the record has none). Needs of the
    recess model: friction, least_normal [weights], moment, the restraining moment over weight and base
    radius; NaN where it does not move or overturns.
    """
    return [_row(motion, tan_alpha, semidiagonal, intensity) for intensity in intensities]


def _row(motion: str, tan_alpha: float, size: float, intensity: float) -> Row:
    case = shaken_case(motion, tan_alpha, size, intensity)
    recess = _run(case)
    stronger = shaken_case(motion, tan_alpha, size, intensity * (1.0 + COPY))
    found = {"recess": recess, "copy": _run(stronger), "flat": _run(case, "flat")}
    if motion_named(motion).acceleration.shape[1] == 3:
        found["vertical"] = _run(shaken_case(motion, tan_alpha, size, intensity, vertical=True))
    row: Row = {
        "intensity": intensity,
        "vertical": math.nan,
        **{name: trace.peak_tilt / case.cylinder.alpha for name, trace in found.items()},
        "friction": math.nan,
        "least_normal": math.nan,
        "moment": math.nan,
    }
    if recess.peak_tilt > 0.0 and recess.outcome == "stands":
        needs = recess.assumptions
        assert needs is not None
        row["friction"] = needs.largest_friction_needed
        row["least_normal"] = needs.least_normal_force
        row["moment"] = needs.largest_restraining_moment / case.cylinder.base_radius
    return row


def _run(case: Case, support: str = "recess") -> Trace:
    return reduced.simulate(case, support=support, rtol=_RTOL)


PEAKS = Part(
    name="peaks",
    title="peak tilt over records",
    tasks=_peaks_tasks,
    measure=measure_peaks,
    keys=("motion", "tan_alpha", "semidiagonal"),
    cost=lambda intensities, **_: 0.03 * len(intensities),
)


RECESS, FLAT, PERTURBED = "recess model", "flat-ground model", "perturbed copy"
HALVED = "ring, half the step"


def _records_tasks(extent: Extent) -> Iterable[Inputs]:
    for tan_alpha, size, intensity in extent.record_points:
        for motion in record_names(extent.members):
            yield {
                "motion": motion,
                "tan_alpha": tan_alpha,
                "semidiagonal": size,
                "intensity": intensity,
                "time_step": extent.record_step,
            }


def measure_records(
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


RECORDS = Part(
    name="records",
    title="peak tilt over records in the engine",
    tasks=_records_tasks,
    measure=measure_records,
    keys=("motion", "tan_alpha", "semidiagonal", "intensity"),
    cost=lambda time_step, **_: 16.0 * 2e-4 / time_step,
    engine=DEFAULT_ENGINE,
)
