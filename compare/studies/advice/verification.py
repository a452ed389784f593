"""When a reduced model and an engine have to part, and one run of an engine that shows when they do."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from rockwobble.models import Case, Diagnostic, Run, Trace

from ...comparison.driver import compare
from ...comparison.prediction import Prediction, estimated_error, predict, time_scale
from ...metrics.agreement import agreement_time
from ...runs.execution import simulate_run
from ...traces.pair import make_pair

# [s] the default step of the engines at 6 m and 9.81 m/s^2, for a prediction without an engine
_STEP = 1e-4


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Verification:
    """One run of an engine, held against the reduced model of its support.

    Attributes
    ----------
    label : str
        Engine and support.
    version : str
    time_step : float
        [s]
    trajectory : Trace or None
        None where the engine's process died.
    outcome : str
    why : tuple of Diagnostic
        What ended or limits it.
    peak_tilt : float
        [alpha]; NaN where failed.
    agreement : float
        From uplift or release to the first tilt difference above 1 % of alpha [s]; the length of the run
        where there is none.
    agreed_until : float
        The same in the time of the run [s].
    diverged : bool
    divergence : str
        Whether that was "in time", "later" or "earlier" than predicted, or "never, as predicted".
    """

    label: str
    version: str
    time_step: float
    trajectory: Trace | None
    outcome: str
    why: tuple[Diagnostic, ...]
    peak_tilt: float
    agreement: float
    agreed_until: float
    diverged: bool
    divergence: str


def predicted(case: Case, response: Trace, run: Run | None) -> Prediction:
    """When an engine at its default step would have to part, from the reduced models alone."""
    if response.outcome == "failed" or not math.isfinite(response.uplift_time):
        return Prediction(length=case.length, reason="")
    step = _STEP * time_scale(case)
    if run is not None and isinstance(run.time_step, float):
        step = run.time_step
    return predict(
        case,
        reference=response,
        own=response,
        # the tilt that the fastest fall crosses in one step; the penetration counts for less than it
        contact_resolution=float(np.abs(response.tilt_rate).max()) * step,
        error=estimated_error(case, "mujoco" if run is None else run.engine, step),
        simulate=simulate_run,
    )


def verified(case: Case, run: Run, model: Run) -> tuple[Verification, Prediction]:
    """Run the engine; what it resolved makes the prediction sharper."""
    found = compare(case, runs=[run], reference=model)
    row = found.summary[found.summary["reference"] == str(model)].iloc[0]
    trajectory = found.traces.get((case.name, str(run)))
    agreed_until = 0.0
    if trajectory is not None:
        pair = make_pair(case.cylinder, found.traces[case.name, str(model)], trajectory)
        agreed_until = agreement_time(pair, broken=row.outcome == "failed").end
    verification = Verification(
        label=f"{run.engine} {run.support}",
        version=row.engine_version,
        time_step=float(row.time_step),
        trajectory=trajectory,
        outcome=row.outcome,
        why=trajectory.facts if trajectory is not None else (Diagnostic(code="died"),),
        peak_tilt=float(row.peak_tilt),
        agreement=float(row.agreement_time),
        agreed_until=agreed_until,
        diverged=bool(row.diverged),
        divergence=row.divergence,
    )
    predicted = float(row.predicted_agreement_time)
    if not math.isfinite(predicted):  # a crash left none
        return verification, Prediction(length=case.length, reason="")
    return verification, Prediction(length=predicted, reason=row.predicted_by)
