"""Single run: the trace of one reduced model or engine, and from when on perturbed copies diverge."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Self

from rockwobble.compare.comparison.peak_error import NO_ERROR, PeakError, peak_error
from rockwobble.compare.metrics.mode import mode_findings, slide_finding
from rockwobble.compare.runs.choice import own_model_of
from rockwobble.compare.runs.execution import Job, job_fingerprint, simulate_all, simulate_run
from rockwobble.compare.runs.progress import ProgressCallback, stages
from rockwobble.compare.storage.manifest import Number, Stored
from rockwobble.compare.storage.results import Results
from rockwobble.models import Case, Run, Trace
from rockwobble.models.case import FLAT_MODEL, RECESS_MODEL
from rockwobble.models.finding import Findings
from rockwobble.models.mode import REST, SLIDES
from rockwobble.models.plain_json import plain
from rockwobble.models.support import RECESS, SUPPORTS
from rockwobble.models.trace_file import COLUMNS, PASS_COLUMNS, case_facts, to_parquet

from .advice.trust import BAND_STEP, copies_part_at, scatter_of, with_time_to_fall
from .plans import AdvicePlan

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_FILE = "run.parquet"
_COPIES = 20  # enough to say from when on they diverge


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class SingleRun(Results, kind="run"):
    """One run.

    Attributes
    ----------
    tables : mapping of str to DataFrame
        run: the samples of the trace.
    facts : mapping
        run: its label; case and result: what the samples do not hold; single_trace: from when on copies of
        it part [s], by how much their input is off, the scatter of their largest tilts over its own, and the
        command that says what they do; columns of the files.
    trace : Trace
    """

    trace: Trace

    def findings(self) -> Findings:
        """The mode of motion, and how far it slides."""
        trace = self.trace
        if trace.run.support not in SUPPORTS:
            return Findings()
        first = mode_findings(trace.case, trace.run.support)
        if "slides" not in trace.mode:
            return Findings(first)
        moved = trace.peak_displacement, trace.residual_displacement
        return Findings([*first, slide_finding(*moved, self.facts["single_trace"].get("slid", ()))])

    @property
    def error(self) -> PeakError:
        """Error of the peak tilt; of earlier versions nothing is known."""
        return PeakError(*self.facts["single_trace"].get("error", NO_ERROR))

    def headline(self) -> Mapping[str, Number]:
        """Return outcome, mode, peak tilt or displacement, uplift and number of passes."""
        trace, error = self.trace, self.error
        slid = {
            "peak displacement [m]": trace.peak_displacement,
            "residual displacement [m]": trace.residual_displacement,
        }
        return {
            "outcome": trace.outcome,
            "mode": trace.mode,
            **(slid if "slides" in trace.mode else {}),
            "peak tilt [alpha]": trace.peak_tilt / trace.case.cylinder.alpha,
            "uplift [s]": trace.uplift_time,
            "passes": len(trace.passes),
            **({} if error.source == "" else {"error [alpha]": error.size, "error source": error.source}),
        }

    def sheets(self) -> Mapping[str, bytes]:
        """Return the trace as `Trace.load` reads it, its samples and its passes as CSV."""
        trace = self.trace
        return {
            _FILE: to_parquet(self.tables["run"], trace.to_plain(), trace.case),
            "run.csv": self.tables["run"].to_csv(index=False).encode(),
            "passes.csv": trace.passes.to_csv(index=False).encode(),
        }

    @classmethod
    def of_stored(cls, stored: Stored) -> Self:
        """Return the results whose files are whole."""
        trace = Trace.load(stored.folder / _FILE)
        return cls(tables=stored.tables(), facts=stored.manifest.about, manifest=stored.manifest, trace=trace)

    def plot(self, part: str | None = None) -> Figure:
        """Return a matplotlib figure of the trace."""
        return self.trace.plot(part)


def single_run(
    case: Case, run: Run, *, answer: str = "", progress: ProgressCallback | None = None
) -> SingleRun:
    """Return a run, and from when on copies of its reduced model diverge, by the rule of an advice.

    Parameters
    ----------
    case : Case
    run : Run
    answer : str, optional
        Command that says what the copies do.
    progress : callable, optional
        Called with a `Progress` at the start and at the end of each stage.
    """
    model = run if run.is_model else own_model_of(case, run)
    plan = AdvicePlan(copies=_COPIES)
    stage = stages(progress, [1.0, 1.0])
    with stage(Job(case=case, run=run).label):
        # an engine in a process of its own, so that Ctrl-C also stops it in the middle of a long call
        (trace,) = simulate_all([Job(case=case, run=run)], workers=1 if model == run else 2)
    part, scatter = math.inf, math.nan
    if not len(trace.time):
        return single_run_of(trace, part, answer, plan.perturbation)
    error = NO_ERROR
    with stage(f"{plan.copies} copies of the {model}"):
        own = trace if model == run else simulate_run(case, model)
        slid: list[list[float]] = []
        if len(own.time) and own.mode not in ("", REST):
            case = with_time_to_fall(case, own)
            copies = [simulate_run(each, model, sample_step=BAND_STEP) for each in plan.perturbed(case)]
            if trace.mode == SLIDES == own.mode and model == run:
                slid = [[each.peak_displacement, each.residual_displacement] for each in copies]
            elif own.mode != SLIDES:
                part = copies_part_at(case, own, copies)
                scatter = scatter_of(own.peak_tilt, (copy.peak_tilt for copy in copies))
                other = _other_model(case, own)
                error = peak_error(case, trace, own, other, copies=copies, simulate=simulate_run)
    return single_run_of(trace, part, answer, plan.perturbation, slid, scatter, error)


def _other_model(case: Case, own: Trace) -> Trace:
    """The response on the other support, whose difference is the model form; its own in a plane."""
    other = FLAT_MODEL if own.run.support == RECESS else RECESS_MODEL
    return own if own.run.is_planar or case.tendon is not None else simulate_run(case, other)


def single_run_of(
    trace: Trace,
    part: float = math.inf,
    answer: str = "",
    perturbation: float = AdvicePlan().perturbation,
    slid: Sequence[Sequence[float]] = (),
    scatter: float = math.nan,
    error: PeakError = NO_ERROR,
) -> SingleRun:
    """Results of a trace; its copies: when they diverge [s], slides (n, 2) [m], scatter; its error."""
    job = Job(case=trace.case, run=trace.run)
    left_out = ("rest_intervals", "extrema", "passes")
    facts = {
        "inputs": job_fingerprint(job),
        "run": job.label,
        "case": case_facts(trace.case),
        "result": {name: value for name, value in trace.to_plain().items() if name not in left_out},
        "single_trace": {
            "copies_part": part,
            "perturbation": perturbation,
            "scatter": scatter,
            "answer": answer,
            "error": error,
        }
        | ({"slid": slid} if slid else {}),
        "columns": {"run.csv": COLUMNS, "passes.csv": PASS_COLUMNS},
    }
    return SingleRun(tables={"run": trace.to_frame()}, facts=plain(facts), trace=trace)
