"""Single run: the trace of one method, and the time at which copies of its model diverge."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Self

from rockwobble.compare.comparison.peak_error import NO_ERROR, PeakError, peak_error
from rockwobble.compare.metrics.mode import mode_findings, slide_finding
from rockwobble.compare.metrics.pair import balance_of
from rockwobble.compare.runs.choice import own_model_of
from rockwobble.compare.runs.execution import Job, job_fingerprint, simulate_all, simulate_run
from rockwobble.compare.runs.progress import ProgressCallback, stages
from rockwobble.compare.storage.manifest import Number, Stored
from rockwobble.compare.storage.results import Results
from rockwobble.models import Case, Run, Trace
from rockwobble.models.bounds import OVERTURNED_TILT
from rockwobble.models.case import FLAT_MODEL, RECESS_MODEL
from rockwobble.models.finding import Finding, Findings, Value
from rockwobble.models.mode import REST, SLIDES
from rockwobble.models.plain_json import plain
from rockwobble.models.support import RECESS, SUPPORTS
from rockwobble.models.trace_file import COLUMNS, PASS_COLUMNS, case_facts, to_parquet

from .advice.demands import overturning_time
from .advice.trust import BAND_STEP, copies_divergence_time, scatter_of, with_time_to_fall
from .plans import AdvicePlan

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_FILE = "run.parquet"
_WIDE = 0.1  # scatter of the copies above which a number is called approximate
_PLAN = AdvicePlan(copies=20)  # enough copies to say from when on they diverge


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class SingleRun(Results, kind="run"):
    """Results of one run.

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
        """Findings: mode, outcome, divergence time of copies, and other numbers."""
        trace = self.trace
        said: list[Finding] = []
        if trace.run.support in SUPPORTS:
            said += mode_findings(trace.case, trace.run.support)
            if "slides" in trace.mode:
                moved = trace.peak_displacement, trace.residual_displacement
                said.append(slide_finding(*moved, self.facts["single_trace"].get("slid", ())))
        if trace.mode != SLIDES:
            said.append(_outcome(trace, self.facts.get("single_trace", {}).get("scatter", math.nan)))
        return Findings([*said, *self._doubt(), *_quantities(trace, self.error)])

    def _doubt(self) -> Iterator[Finding]:
        trace, single = self.trace, self.facts.get("single_trace", {})
        # unknown for results of earlier versions
        part, falls = single.get("copies_part", math.inf), overturning_time(trace)
        if not math.isfinite(part):
            return
        late = falls if math.isfinite(falls) else trace.peak_time
        before = "before_it_falls" if math.isfinite(falls) else "before_largest_tilt"
        values: dict[str, Value] = {
            "time": part,
            "reason": before if late > part else None,
            "reason_model": None if trace.run.is_model else "in_the_model",
            "share": single["perturbation"],
        }
        yield Finding(key="run.not_reproducible", level="caution", values=values)

    @property
    def error(self) -> PeakError:
        """Error of the peak tilt; NaN, without a source, where none was estimated."""
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
        """Trace in the format of `Trace.load`, with its samples and passes as CSV."""
        trace = self.trace
        return {
            _FILE: to_parquet(self.tables["run"], trace.to_plain(), trace.case),
            "run.csv": self.tables["run"].to_csv(index=False).encode(),
            "passes.csv": trace.passes.to_csv(index=False).encode(),
        }

    @classmethod
    def of_stored(cls, stored: Stored) -> Self:
        """Results read from verified files."""
        trace = Trace.load(stored.folder / _FILE)
        return cls(tables=stored.tables(), facts=stored.manifest.about, manifest=stored.manifest, trace=trace)

    def plot(self, part: str | None = None) -> Figure:
        """Matplotlib figure of the trace."""
        return self.trace.plot(part)


def _outcome(trace: Trace, scatter: float) -> Finding:
    """Finding of the outcome; `scatter`: see `scatter_of`."""
    falls, peak, alpha = overturning_time(trace), trace.peak_tilt, trace.case.cylinder.alpha
    if math.isfinite(falls):
        balance = balance_of(trace.case)
        values: dict[str, Value] = {
            "time_uplift": math.nan if trace.case.initial else trace.uplift_time,
            "tilt": balance,
            "peak": balance / alpha,
            "time": falls,
            "time_end": float(trace.time[-1]),
        }
        if balance >= OVERTURNED_TILT:
            return Finding(key="run.falls_from_any_tilt", values=values)
        return Finding(key="run.falls" if falls else "run.starts_beyond_balance", values=values)
    if math.isfinite(peak):
        about = "about" if scatter > _WIDE else None
        values = {"peak": peak / alpha, "tilt": peak, "share_scatter": scatter, "reason": about}
        return Finding(key="run.stands" if peak else "run.at_rest", values=values)
    return Finding(key="run.undecided" if trace.outcome == "undecided" else "run.failed")


def _quantities(trace: Trace, error: PeakError) -> Iterator[Finding]:
    """Numbers of a run, as far as its method and mode define them."""
    case, settings, slides = trace.case, trace.run.settings, trace.mode == SLIDES

    def quantity(name: str, /, **values: Value) -> Finding:
        return Finding(key=f"quantity.{name}", values=values)

    if math.isfinite(plane := settings.get("plane", math.nan)):
        yield quantity("plane", angle=plane)
    if restitution := settings.get("restitution"):
        yield quantity("restitution", detail=str(restitution))
    if error.source:
        yield quantity("error", peak=error.size, detail=error.source)
    end, length = float(trace.time[-1]), case.length
    yield quantity(
        "end",
        time=end,
        time_still=length if end > length else None,
        reason="moving" if trace.outcome == "stands" and not trace.rests else None,
        time_followed=trace.followed_until if trace.followed_until > end else None,
    )
    if not case.initial and not slides:
        uplifts = trace.uplift_time if math.isfinite(trace.uplift_time) else math.nan
        yield quantity("uplift", time=uplifts, angle=math.remainder(trace.uplift_direction, math.tau))
    if not slides:
        yield quantity("passes", count=len(trace.passes))
    closest = float(trace.passes["minimum_tilt"].min()) / case.cylinder.alpha
    if math.isfinite(closest):
        yield quantity("closest", peak=closest)
    yield from _demands(trace, quantity)
    if math.isfinite(trace.peak_tendon_force):
        yield quantity("tendon", force=trace.peak_tendon_force)
    if not (trace.run.is_model and trace.run.support.guided):  # it may leave its place
        for name, moved in (("peak", trace.peak_displacement), ("residual", trace.residual_displacement)):
            yield quantity(
                f"displacement_{name}", displacement=moved, ratio=moved / case.cylinder.base_radius
            )
        yield quantity("twist", angle=trace.residual_twist)
    if math.isfinite(first := trace.first("wall_contact")):
        yield quantity("wall_contact", duration=float(trace.wall_contact[-1]), time=first)
    if not trace.run.is_model:
        yield quantity("time_step", duration=trace.time_step)
    yield quantity("computing_time", duration=trace.wall_time)


def _demands(trace: Trace, quantity: Callable[..., Finding]) -> Iterator[Finding]:
    """Findings on the demands of a run on friction and recess, up to its overturning time."""
    falls = overturning_time(trace)
    held = trace.assumptions_until(falls)
    if held is None:
        return
    # the swing that is followed past the end has no samples
    covered = "until_the_end" if trace.followed_until > float(trace.time[-1]) else None
    covered = "until_it_falls" if math.isfinite(falls) else covered
    # friction of a base that stays closed, known to reduced models; 0 where it moves
    at_rest = trace.case.friction_at_rest if trace.run.is_model and not trace.peak_tilt else 0.0
    lost = min((fact.time for fact in held.breaches if fact.code == "tension"), default=math.nan)
    friction = max(at_rest, held.largest_friction_needed)
    yield quantity("friction", demand=friction, time=lost, reason=covered)
    moment = held.largest_restraining_moment / trace.case.cylinder.base_radius
    if moment > 0.0:
        yield quantity("moment", demand=moment, reason=covered)


def single_run(
    case: Case, run: Run, *, answer: str = "", progress: ProgressCallback | None = None
) -> SingleRun:
    """Run a case, with the divergence time of copies of its reduced model, by the rule of an advice.

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
    stage = stages(progress, [1.0, 1.0])
    with stage(Job(case=case, run=run).label):
        # an engine in a process of its own, so that Ctrl-C also stops it in the middle of a long call
        (trace,) = simulate_all([Job(case=case, run=run)], workers=1 if model == run else 2)
    single: dict[str, object] = {"answer": answer}
    if len(trace.time):
        with stage(f"{_PLAN.copies} copies of the {model}"):
            own = trace if model == run else simulate_run(case, model)
            if len(own.time) and own.mode not in ("", REST):
                single |= _copies(case, trace, own, model)
    return single_run_of(trace, single)


def _copies(case: Case, trace: Trace, own: Trace, model: Run) -> dict[str, object]:
    """Scatter and divergence of copies, as arguments of `single_run_of`; `own`: trace of the model."""
    case = with_time_to_fall(case, own)
    copies = [simulate_run(each, model, sample_step=BAND_STEP) for each in _PLAN.perturbed(case)]
    if own.mode == SLIDES:
        moved = [[each.peak_displacement, each.residual_displacement] for each in copies]
        return {"slid": moved} if trace is own else {}
    # the response on the other support, whose difference is the model form; its own in a plane
    other = own
    if not own.run.is_planar and case.tendon is None:
        other = simulate_run(case, FLAT_MODEL if own.run.support == RECESS else RECESS_MODEL)
    return {
        "copies_part": copies_divergence_time(case, own, copies),
        "scatter": scatter_of(own.peak_tilt, (copy.peak_tilt for copy in copies)),
        "error": peak_error(case, trace, own, other, copies=copies, simulate=simulate_run),
    }


def single_run_of(trace: Trace, single: Mapping[str, object] | None = None) -> SingleRun:
    """Results of a trace and of its copies.

    Parameters
    ----------
    trace : Trace
    single : mapping, optional
        copies_part, from when on they diverge [s]; perturbation of their input; scatter of their peaks over
        that of the trace; error of its peak, a `PeakError`; slid, their slides (n, 2) [m]; answer, the
        command that says what they do.
    """
    job = Job(case=trace.case, run=trace.run)
    left_out = ("rest_intervals", "extrema", "passes")
    none = {"copies_part": math.inf, "perturbation": _PLAN.perturbation, "scatter": math.nan}
    facts = {
        "inputs": job_fingerprint(job),
        "run": job.label,
        "case": case_facts(trace.case),
        "result": {name: value for name, value in trace.to_plain().items() if name not in left_out},
        "single_trace": {**none, "answer": "", "error": NO_ERROR, **(single or {})},
        "columns": {"run.csv": COLUMNS, "passes.csv": PASS_COLUMNS},
    }
    return SingleRun(tables={"run": trace.to_frame()}, facts=plain(facts), trace=trace)
