"""Time until which a trace can be trusted: another method, or inputs perturbed by 1 %, diverge then."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np

from rockwobble.compare.metrics.pair import tolerance_of
from rockwobble.compare.runs.choice import labels_beside_references
from rockwobble.compare.runs.execution import SAMPLE_STEP, Job, simulate_all, simulate_run
from rockwobble.models import Case, Run, Trace
from rockwobble.models.frames import pd
from rockwobble.models.trace import NO_PEAK
from rockwobble.multibody import DEFAULT_ENGINE
from rockwobble.multibody.passes import STEPS_OF_A_PASS
from rockwobble.multibody.scene import REFERENCE_TIME_STEP

if TYPE_CHECKING:
    from rockwobble.compare.comparison.prediction import Prediction

# A trace is lost where the copies are spread over half of the peak tilt. A percent of alpha, the limit of
# agreement between methods, would be exceeded by the percent that the copies differ by itself.
LOST = 0.5
BAND_STEP = 0.05  # [s] enough to draw a swing of a second


@dataclass(frozen=True, slots=True, kw_only=True)
class Trust:
    """Time until which a trace can be trusted, and the reason.

    Attributes
    ----------
    kind : {"trace", "peak", "statistics"}
        The whole trace; the trace until `until`, the largest tilt included; or only statistics, because the
        largest tilt comes after `until`.
    until : float
        [s] in the time of the run.
    because : {"", "methods", "data"}
        What ends it: reduced model and engine diverge there, or the copies do.
    """

    kind: Literal["trace", "peak", "statistics"]
    until: float
    because: Literal["", "methods", "data"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Verification:
    """One run of an engine, compared with the reduced model of its support.

    Attributes
    ----------
    label, version : str
    time_step : float
        [s]
    outcome, diagnostics : str
        Codes of what ended or limits it.
    peak_tilt : float
        [alpha]; NaN where failed.
    moves : bool
        Whether it uplifts, or is released.
    agreed_until : float
        Time of the record of the first tilt difference above the tolerance, or of the end [s].
    diverged : bool
        Whether there is such a difference.
    divergence : str
        Whether that was when predicted, as in the summary of a comparison.
    stopped : float
        Time at which it was ended [s], see `trusted_part`; inf where it ran as long as the case.
    """

    label: str
    version: str
    time_step: float
    outcome: str
    diagnostics: str
    peak_tilt: float
    moves: bool
    agreed_until: float
    diverged: bool
    divergence: str
    stopped: float = math.inf


def trust_of(methods_until: float, data_until: float, peak_time: float, end: float) -> Trust:
    """Trust in a trace, with the method or perturbation that limits it.

    Parameters
    ----------
    methods_until, data_until : float
        Until when reduced model and engine agree, or have to, and until when the copies stay together [s].
    peak_time, end : float
        Time of the largest tilt, and the end of the motion: of the run, or the fall [s].
    """
    until = min(methods_until, data_until)
    if until >= end:
        return Trust(kind="trace", until=end, because="")
    because: Literal["methods", "data"] = "methods" if methods_until <= data_until else "data"
    return Trust(kind="peak" if peak_time <= until else "statistics", until=until, because=because)


def band_of(case: Case, traces: Sequence[Trace]) -> pd.DataFrame:
    """Tilts [alpha] not exceeded by 5 % and by 95 % of the copies at each time [s]: low, high."""
    time = np.arange(0.0, case.length, BAND_STEP)
    known = [trace for trace in traces if trace.outcome != "failed"]
    # overturned copies keep their last tilt
    tilts = [np.interp(time, trace.time, trace.tilt / case.cylinder.alpha) for trace in known]
    low, high = np.quantile(tilts, [0.05, 0.95], axis=0) if known else np.full((2, len(time)), math.nan)
    return pd.DataFrame({"time": time, "low": low, "high": high})


def spread_from(band: pd.DataFrame, peak: float) -> float:
    """Time at which the spread of the copies exceeds half of the peak tilt [s]; inf if never."""
    wide = np.flatnonzero(band["high"] - band["low"] > LOST * min(peak, 1.0))
    return float(band["time"].iloc[wide[0]]) if len(wide) else math.inf


def copies_divergence_time(case: Case, trace: Trace, copies: Sequence[Trace]) -> float:
    """Divergence time of the copies of a run: spread over half of its peak tilt [s]; inf if never."""
    if trace.outcome in NO_PEAK:
        return math.inf
    return spread_from(band_of(case, copies), trace.peak_tilt / case.cylinder.alpha)


def scatter_of(peak: float, copies: Iterable[float]) -> float:
    """Half the 90 % range of the copies' peak tilts over the peak of the case; NaN without copies."""
    known = [tilt for tilt in copies if math.isfinite(tilt)]
    if not known or not peak > 0.0:
        return math.nan
    low, high = np.quantile(known, [0.05, 0.95])
    return float(0.5 * (high - low) / peak)


def with_time_to_fall(case: Case, trace: Trace) -> Case:
    """Case extended over still ground to the end of the overturning of its run.

    All that is run for it then sees the fall: the engine, the copies, and when two methods diverge. A case
    whose run ends in time is the same.
    """
    end = float(trace.time[-1])
    if end <= case.length:
        return case
    motion = case.motion
    if motion is not None and case.length < motion.duration:
        kept = math.floor(case.length / motion.time_step * (1.0 + 1e-12)) + 1
        motion = motion.with_samples(motion.acceleration[: max(kept, 2)], f"cut to {case.length:g} s")
    duration = math.ceil(end / SAMPLE_STEP) * SAMPLE_STEP
    return dataclasses.replace(case, motion=motion, duration=duration)


def model_prediction(case: Case, trace: Trace, run: Run | None) -> Prediction:
    """Predicted divergence of an engine at its default step, from the reduced models alone."""
    from rockwobble.compare.comparison.prediction import Prediction, estimated_error, predict, time_scale

    if trace.outcome == "failed" or not math.isfinite(trace.uplift_time):
        return Prediction(length=case.length, reason="")
    step = REFERENCE_TIME_STEP * time_scale(case)
    if run is not None and isinstance(run.time_step, float):
        step = run.time_step
    return predict(
        case,
        reference=trace,
        own=trace,
        # resolution at the tilt rate of the fastest fall; penetration counts for less
        contact_resolution=STEPS_OF_A_PASS * float(np.abs(trace.tilt_rate).max()) * step,
        error=estimated_error(case, run or Run(DEFAULT_ENGINE, trace.run.support), step),
        simulate=simulate_run,
        tolerance=tolerance_of(trace),
    )


def trusted_part(case: Case, trace: Trace, until: float) -> tuple[Case, Trace]:
    """Case cut at the divergence time of its copies [s], with its run; later motion tests no engine.

    A run that overturns is whole.
    """
    if trace.outcome == "overturned" or not until < case.length:
        return case, trace
    shorter = dataclasses.replace(case, duration=math.ceil(until / SAMPLE_STEP) * SAMPLE_STEP)
    return shorter, simulate_run(shorter, trace.run)


def verify_run(case: Case, run: Run, reference: Trace) -> tuple[Verification, Prediction, Trace]:
    """Run an engine and compare it with a reduced model; its resolved passes sharpen the prediction.

    Parameters
    ----------
    case : Case
    run : Run
    reference : Trace
        Response of the reduced model.
    """
    from rockwobble.compare.comparison.driver import comparison_row
    from rockwobble.compare.comparison.prediction import Prediction

    (label,), name = labels_beside_references([run], reference.run)
    own = run.own_model
    # a separate process: an engine that crashes leaves the rest of the advice
    (trace,) = simulate_all([Job(case=case, run=run, label=label)], workers=2)
    row = comparison_row(
        case,
        name,
        reference,
        label,
        trace,
        own=reference if own == reference.run else simulate_run(case, own),
        simulate=simulate_run,
    )
    verification = Verification(
        label=label,
        version=row["engine_version"],
        moves=math.isfinite(trace.uplift_time),
        agreed_until=float(row["within_tolerance_until"]),
        diverged=bool(row["left_tolerance"]),
        **{name: row[name] for name in ("time_step", "outcome", "diagnostics", "peak_tilt", "divergence")},
    )
    until, reason = float(row["predicted_until"]), row["predicted_by"]
    if not math.isfinite(until):  # failed runs have no agreement time
        return verification, Prediction(length=case.length, reason=""), trace
    start = row["reference_uplift_time"] if reason else 0.0
    return verification, Prediction(length=until - start, reason=reason), trace
