"""Until when MuJoCo follows its reduced model under El Centro from rest, and what ends it.

`python tests/benchmarks agreement_times` prints the table: the record at 1, 1.5 and 2 times, on
cylinders of three sizes and slendernesses, in the recess against the recess model, on flat ground against
the flat-ground model, and for contrast against the recess model.

What must end an agreement is read off the reduced model: its first pass closer to upright than the
engine's contact resolves, or the growth of the engine's small error through the passes before that (a
perturbed copy of the model, off by as much as the engine errs, leaves it).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from rockwobble.compare.comparison.prediction import estimated_error, predict, verdict
from rockwobble.compare.metrics.pair import Pair, agreement_time, make_pair
from rockwobble.compare.runs.execution import Job, simulate_all, simulate_run
from rockwobble.compare.runs.progress import ProgressCallback
from rockwobble.models import Case, Cylinder, Run, Trace, el_centro_1940
from rockwobble.models.support import MODELLED

from .console import options_of, show, tell

if TYPE_CHECKING:
    import pandas as pd

CYLINDERS = ((6.0, 0.2), (10.0, 0.1), (2.0, 0.3))  # semidiagonal [m], tan alpha
SCALES = (1.0, 1.5, 2.0)
PAIRS = (("recess", "recess"), ("flat", "flat"), ("flat", "recess"))
CARRIED = 0.3  # weights
_BETWEEN = 0.1  # of alpha; closer to upright the force changes by weights from one sample to the next
_AFTER = 0.1  # [s]
_SAME = 1e-3  # of alpha: forces are those of the same motion, which traces about to part no longer are


def cases() -> tuple[Case, ...]:
    """Return the cases of the table."""
    record = el_centro_1940()
    return tuple(
        Case(
            Cylinder(semidiagonal=size, tan_alpha=tan_alpha),
            record.scaled(scale),
            name=f"R {size:g} m, tan alpha {tan_alpha:g}, times {scale:g}",
        )
        for size, tan_alpha in CYLINDERS
        for scale in SCALES
    )


def agreement_times(
    chosen: Sequence[Case] | None = None,
    *,
    engine: str = "mujoco",
    workers: int | None = None,
    progress: ProgressCallback | None = None,
) -> pd.DataFrame:
    """Measure how long an engine follows its model, and what the model says must end that.

    Parameters
    ----------
    chosen : sequence of Case, optional
        Default: those of the table.
    engine : str
    workers : int, optional
        Processes.
    progress : callable, optional

    Returns
    -------
    DataFrame
        case, support, reference, outcome (of the engine), uplift [s], length [s, of the motion from
        uplift], agreement_time [s from uplift], diverged, rms (of the tilt difference up to then) [alpha],
        resolution (smallest tilt of a pass that the engine resolves) [rad], close_pass [s from uplift] and
        close_tilt [rad] (the first pass of the engine's own model below it; NaN without one), passes
        (those within the agreement), closest (smallest tilt of them) [rad], predicted [s] and reason (what
        has to end the agreement, and when), agreed ("in time", "later", "earlier" or "never, as
        predicted"), and force: see `force_error`.
    """
    import pandas as pd

    chosen = cases() if chosen is None else chosen
    runs = [Run(each, support) for each in (None, engine) for support in MODELLED]
    results = simulate_all(
        [Job(case=case, run=run) for case in chosen for run in runs], workers=workers, progress=progress
    )
    rows = []
    for index, case in enumerate(chosen):
        block = results[len(runs) * index : len(runs) * (index + 1)]
        traces: dict[tuple[str | None, str], Trace] = {
            (trace.run.engine, trace.run.support): trace for trace in block
        }
        rows += [
            _row(case, model, traces[engine, support], traces[None, support], traces[None, model])
            for support, model in PAIRS
        ]
    return pd.DataFrame(rows)


def _row(case: Case, model: str, trial: Trace, own: Trace, reference: Trace) -> dict[str, Any]:
    row = {"case": case.name, "support": trial.run.support, "reference": model, "reason": ""}
    if not len(trial.time):
        return row | {"outcome": "failed", "agreed": "the process died"}
    start = reference.uplift_time
    if not math.isfinite(start):
        same = trial.outcome == reference.outcome
        return row | {"outcome": trial.outcome, "agreed": "both rest" if same else "only one uplifts"}
    pair = make_pair(case.cylinder, reference, trial)
    agreement = agreement_time(pair, broken=trial.outcome == "failed")
    prediction = predict(
        case,
        reference=reference,
        own=own,
        contact_resolution=trial.contact_resolution,
        error=estimated_error(case, trial.run, trial.time_step),
        simulate=simulate_run,
    )
    times = own.passes["time"].to_numpy(float)
    minima = own.passes["minimum_tilt"].to_numpy(float)
    close = np.flatnonzero(minima < trial.contact_resolution)
    before = minima[times <= agreement.end]
    within = (pair.time >= start) & (pair.time <= agreement.end)
    return row | {
        "outcome": trial.outcome,
        "uplift": start,
        "length": pair.end - start,
        "agreement_time": agreement.end - start,
        "diverged": agreement.diverged,
        "rms": float(np.sqrt(np.mean(pair.tilt_difference[within] ** 2))),
        "resolution": trial.contact_resolution,
        "close_pass": float(times[close[0]]) - start if len(close) else math.nan,
        "close_tilt": float(minima[close[0]]) if len(close) else math.nan,
        "passes": len(before),
        "closest": float(before.min()) if len(before) else math.nan,
        "predicted": prediction.length,
        "reason": prediction.reason,
        "agreed": verdict(agreement.end - start, agreement.diverged, prediction.length, prediction.reason),
        "force": force_error(case, reference, trial, _same_until(pair)),
    }


def _same_until(pair: Pair) -> float:
    beyond = np.flatnonzero(np.abs(pair.tilt_difference) > _SAME)
    return float(pair.time[beyond[0]]) if len(beyond) else math.inf


def force_error(case: Case, model: Trace, trial: Trace, end: float) -> float:
    """Return the largest difference of the contact force until `end` [s], over the force of the model.

    Of the normal force over the normal force, and of the horizontal one over the whole. Counted are samples
    between passes (tilt above a tenth of alpha, a tenth of a second after the uplift) as long as the
    ground of the model carries `CARRIED` of the weight: where a cylinder falls it goes to zero, and soon
    needs more friction than there is. NaN if no sample counts.
    """
    count = min(len(model.time), len(trial.time)) - 1  # the last sample of a fall stands at its own time
    time, expected = model.time[:count], model.contact_force[:count]
    normal = expected[:, 2]
    loose = time[(normal < CARRIED) & (time > model.uplift_time)]
    fall = loose[0] if len(loose) and model.outcome == "overturned" else math.inf
    between = (model.tilt[:count] > _BETWEEN * case.cylinder.alpha) & (normal > CARRIED)
    between &= (time > model.uplift_time + _AFTER) & (time <= min(end, fall))
    difference = (trial.contact_force[:count] - expected)[between]
    size = np.linalg.norm(expected[between], axis=1)
    parts = (np.abs(difference[:, 2]) / normal[between], np.hypot(*difference[:, :2].T) / size)
    return float(np.max(parts)) if between.any() else math.nan


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the table."""
    options = options_of("agreement_times", "Until when MuJoCo follows its reduced model, and what ends it.")
    options.parse_args(arguments)
    formats = {
        "case": "", "support": "", "reference": "", "length": ".2f", "agreement_time": ".2f", "rms": ".1e",
        "passes": ".0f", "closest": ".1e", "resolution": ".1e", "close_pass": ".2f", "close_tilt": ".1e",
        "predicted": ".2f", "reason": "", "agreed": "", "force": ".1e",
    }  # fmt: skip
    show(
        agreement_times(progress=tell),
        "MuJoCo and its reduced models, El Centro 1940 from rest",
        formats,
        "times in s from uplift, tilts of passes in rad, rms within the agreement in alpha; close pass: the "
        "first of the engine's own model below the contact resolution; force: largest difference of the "
        "contact force between passes over the force, until the tilts differ by 0.1 % of alpha",
    )
    return 0
