"""Summary of a comparison, a row for each run and reference, and the agreement matrix of all motions.

What only some runs have stands in tables of its own, by the same `KEYS`: error budgets, and verdicts on
external trajectories.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from itertools import permutations
from typing import Any, Protocol, cast

import numpy as np

from rockwobble.models import AGREEMENT, Case, Run, Trace
from rockwobble.models.diagnostic import cell_of
from rockwobble.models.frames import column_meanings, pd

from ..external.verdict import ExternalSummaryRow, Row, judge
from ..metrics.pair import (
    Agreement,
    Pair,
    agreed_passes,
    agreement_time,
    closest_pass,
    contact_rms,
    direction_difference,
    displacement_difference,
    energy_loss,
    first_unresolved_pass,
    largest_differences,
    make_pair,
    start_of,
    tilt_rms,
    tilt_rms_relative,
    tolerance_of,
    turn_difference,
)
from .peak_error import NO_ERROR, PeakError
from .prediction import Prediction, close_pass, verdict

KEYS = ["case", "run", "reference"]  # columns that identify a row in each table
# name: (unit, meaning); the order is that of the table
SUMMARY_COLUMNS = column_meanings("rockwobble.compare", "summary")
_UNKNOWN: Row = {**dict.fromkeys(SUMMARY_COLUMNS, math.nan), "error_source": ""}


def summary_row(
    case: Case,
    name: str,
    reference: Trace,
    label: str,
    trial: Trace,
    *,
    prediction: Prediction,
    within: Prediction | None = None,
    estimated_error: float = math.nan,
    until: float | None = None,
    allowance: float = 0.0,
    reference_time: float | None = None,
    error: PeakError = NO_ERROR,
) -> Row:
    """All columns of the summary for one run and one reference.

    Parameters
    ----------
    case : Case
    name : str
        Label of the reference.
    reference : Trace
    label : str
        Label of the run.
    trial : Trace
    prediction : Prediction
        Predicted agreement time of the two.
    within : Prediction, optional
        The same for the tolerance of `tolerance_of`. Default: `prediction`.
    estimated_error : float, optional
        Error of the run that the prediction rests on [alpha].
    until : float, optional
        End of the window of tilt_rms, tilt_rms_relative and contact_rms, in the time of the run
        [s]. Default: the whole run.
    allowance : float, optional
        For the noise of a measurement: added to the tilt difference that ends the agreement [alpha].
    reference_time : float, optional
        Computing time of the reference [s]. Default: that of its run.
    error : PeakError, optional
        Of the peak tilt.
    """
    cylinder, spent = case.cylinder, reference.wall_time if reference_time is None else reference_time
    alpha, radius = cylinder.alpha, cylinder.base_radius
    whole, agreement, difference = _difference(case, trial, reference, until, allowance)
    broken = "failed" in (trial.outcome, reference.outcome)
    tolerance, within = tolerance_of(reference, trial), within or prediction
    close = agreement_time(whole, tolerance=tolerance, broken=broken, allowance=allowance)
    direction = direction_difference(reference, trial)
    unresolved = first_unresolved_pass(trial, start=whole.start)
    tilt, contact, turn = largest_differences(
        whole, close, unresolved=unresolved, direction_difference=direction
    )
    return {
        **_UNKNOWN,
        **_methods(case, name, reference, label, trial),
        "time_step": trial.time_step,
        "peak_tilt": trial.peak_tilt / alpha,
        "reference_peak_tilt": reference.peak_tilt / alpha,
        **difference,
        "turn_difference": math.degrees(
            turn_difference(whole, until=min(agreement.end, unresolved), direction_difference=direction)
        ),
        "largest_tilt_difference": tilt,
        "largest_contact_difference": contact,
        "largest_turn_difference": math.degrees(turn),
        "uplift_time_difference": trial.uplift_time - reference.uplift_time,
        "uplift_direction_difference": direction,
        "agreed_passes": agreed_passes(reference, agreement),
        "predicted_agreement_time": prediction.length,
        "displacement_difference": displacement_difference(whole),
        "residual_displacement": trial.residual_displacement / radius,
        "residual_twist": math.degrees(trial.residual_twist),
        "energy_loss": energy_loss(trial, case.motion),
        "wall_time": trial.wall_time,
        "time_ratio": trial.wall_time / spent if spent > 0.0 else math.nan,
        "reference_wall_time": spent,
        "contact_resolution": trial.contact_resolution,
        "closest_pass": closest_pass(reference, agreement) / alpha,
        "engine_version": trial.version,
        "predicted_by": within.reason,
        "reference_uplift_time": whole.start,
        "tolerance": tolerance,
        "within_tolerance_until": close.end,
        "left_tolerance": close.diverged,
        "predicted_until": within.length + (whole.start if within.reason else 0.0),
        "divergence": _divergence(trial, close, within),
        "estimated_error": estimated_error,
        "error": error.size,
        "error_source": error.source,
    }


def _methods(case: Case, name: str, reference: Trace, label: str, trial: Trace) -> Row:
    """Run and reference, and the outcomes of both."""
    return {
        "case": case.name,
        "engine": trial.run.engine_name,
        "support": trial.run.support,
        "reference_engine": reference.run.engine_name,
        "reference_support": "planar" if reference.run.is_planar else reference.run.support,
        "outcome": trial.outcome,
        "reference_outcome": reference.outcome,
        "mode": trial.mode,
        "reference_mode": reference.mode,
        "diagnostics": cell_of(fact.code for fact in trial.facts),
        "run": label,
        "reference": name,
    }


def _divergence(trial: Trace, agreement: Agreement, prediction: Prediction) -> str:
    outcome = verdict(agreement.length, agreement.diverged, prediction.length, prediction.reason)
    if outcome != "earlier":
        return outcome if agreement.tested else "too little motion"
    # no reduced model has walls, so none predicts their effect
    return "after it touched a wall" if trial.first("wall_contact") <= agreement.end else outcome


def external_row(
    case: Case,
    name: str,
    reference: Trace,
    label: str,
    trial: Trace,
    *,
    until: float | None = None,
) -> Row:
    """Row and verdict of an external trajectory, with steps and errors unknown.

    Its uplift is compared as its samples show it: see `external.verdict.uplift_differences`. Its peak is
    compared with that of the reference while the file lasts.
    """
    verdict = judge(trial, reference, case)
    row = summary_row(
        case,
        name,
        reference,
        label,
        trial,
        prediction=close_pass(reference, trial.contact_resolution, case.length),
        until=until,
        allowance=verdict["tilt_bound"] - AGREEMENT,
    )
    tilts = np.vstack([np.column_stack([reference.time, reference.tilt]), reference.extrema[:, :2]])
    covered = (tilts[:, 0] >= trial.time[0]) & (tilts[:, 0] <= trial.time[-1])
    largest = float(np.max(tilts[covered, 1], initial=0.0))
    row["peak_tilt_difference"] = (trial.peak_tilt - largest) / case.cylinder.alpha
    return row | verdict


def lost_row(case: Case, name: str, reference: Trace, label: str, trial: Trace) -> Row:
    """Row of a run that left no samples, with NaN for unknown numbers."""
    return {
        **_UNKNOWN,
        **_methods(case, name, reference, label, trial),
        "reference_peak_tilt": reference.peak_tilt / case.cylinder.alpha,
        "agreement_time": 0.0,
        "diverged": True,
        "agreed_passes": 0,
        "reference_wall_time": reference.wall_time,
        "reference_uplift_time": start_of(reference),
        "within_tolerance_until": start_of(reference),
        "left_tolerance": True,
        "engine_version": "",
        "predicted_by": "",
        "divergence": "",
    }


class SummaryRow(ExternalSummaryRow, Protocol):
    """A row of the summary, a table beside it, or the agreement matrix, by the names of its columns."""

    def __getattr__(self, column: str, /) -> Any: ...


def rows_of(table: pd.DataFrame) -> Iterator[SummaryRow]:
    """The rows of a table, with a field for each column."""
    yield from cast("Iterator[SummaryRow]", table.itertuples())


def own_rows(summary: pd.DataFrame) -> pd.DataFrame:
    """Row of each run against the model of its support, or else its first row."""
    own = summary["reference"] == summary["support"].map(lambda support: str(Run(None, support).own_model))
    keys = summary["case"] + "\n" + summary["run"]
    alone = ~keys.isin(keys[own]) & ~keys.duplicated()
    return summary[own | alone]


# columns of the agreement matrix: (unit, meaning)
MATRIX_COLUMNS = column_meanings("rockwobble.compare", "matrix")


def agreement_matrix(
    cases: Mapping[str, Case], traces: Mapping[tuple[str, str], Trace], *, until: float | None = None
) -> pd.DataFrame:
    """Differences of each motion of a case from every other on the same support.

    Only where two engines or more have run: what one engine differs from its model by is in the summary.

    Parameters
    ----------
    cases : mapping
        Case of each name.
    traces : mapping
        Trace for each name of a case and label; what left no samples is left out.
    until : float, optional
        End of the window of the RMS columns, in the time of the run [s]. Default: the whole run.
    """
    rows = [row for name, case in cases.items() for row in _rows(name, case, traces, until)]
    return pd.DataFrame(rows, columns=list(MATRIX_COLUMNS)).astype({"diverged": bool})


def _rows(
    name: str, case: Case, traces: Mapping[tuple[str, str], Trace], until: float | None
) -> Iterator[Row]:
    own = {label: trace for (of, label), trace in traces.items() if of == name and len(trace.time)}
    for support in dict.fromkeys(trace.run.support for trace in own.values()):
        members = {label: trace for label, trace in own.items() if trace.run.support == support}
        if len({trace.run.engine for trace in members.values() if not trace.run.is_model}) < 2:
            continue
        for run, other in permutations(members, 2):
            whole, _, difference = _difference(case, members[run], members[other], until)
            named = {"case": name, "support": support, "run": run, "other": other}
            yield {**named, **difference, "other_uplift_time": whole.start}


def _difference(
    case: Case, trial: Trace, reference: Trace, until: float | None, allowance: float = 0.0
) -> tuple[Pair, Agreement, Row]:
    """Two motions on one time axis, their agreement, and the columns common to any two motions."""
    cylinder = case.cylinder
    whole = make_pair(cylinder, reference, trial, until=case.length)  # a fall after it multiplies differences
    window = whole if until is None else make_pair(cylinder, reference, trial, until=until)
    broken = "failed" in (trial.outcome, reference.outcome)
    agreement = agreement_time(whole, broken=broken, allowance=allowance)
    columns: Row = {
        "tilt_rms": tilt_rms(window),
        "tilt_rms_relative": tilt_rms_relative(window),
        "contact_rms": contact_rms(window),
        "peak_tilt_difference": (trial.peak_tilt - reference.peak_tilt) / cylinder.alpha,
        "agreement_time": agreement.length,
        "diverged": agreement.diverged,
    }
    return whole, agreement, columns
