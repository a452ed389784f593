"""Runs of a suite compared with the models: by its stated bounds, or by a second run at another step.

Where none is stated every case is compared with its model twice. As it is: engines err at uplift, and near
passes magnify what they err, so the bound is a wide one. It grows with the difference of the two steps and
with copies of the model: off by as much as the engine is at first, and with a base that closes below the tilt
that contact resolves. The window ends where those reach 1 % of alpha. In motion: the first seconds of a
release, or, of a case that begins at rest, the strongest seconds of its motion, at half of what uplifts, as
they meet a cylinder that rocks and wobbles. There the error is what the step leaves and no more, and what
0.5 % of R does is a hundred times the bound.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterator, Sequence

import numpy as np

from rockwobble import reduced
from rockwobble.models import AGREEMENT, Bounds, Case, GroundMotion, InitialState, Run, Trace
from rockwobble.multibody.engines.registry import engine_fault, find_engine, standard_engines
from rockwobble.multibody.scene import default_step
from rockwobble.reduced.problem import LARGEST_REST_TILT, REST_TILT

from ..comparison.prediction import (
    Prediction,
    copies_off_by,
    early_rms,
    estimated_error,
    time_scale,
)
from ..comparison.summary import SUMMARY_COLUMNS, summary_row
from ..metrics.pair import landings, rms
from ..runs.choice import at_step, require_runnable
from ..runs.execution import Job, simulate_all
from ..runs.progress import ProgressCallback
from ..storage.provenance import fingerprint
from .agreement import walls
from .measurement import Array, Bound, Result, at_most, not_run, why
from .subject import Simulate

# factor on the difference of two steps, whose error is once or twice as large
CLEAN, WIDE = 5.0, 10.0
LEAST = 1e-5  # [alpha] error of contact at any step
# strongest part of a motion: tilt over alpha and rolling rate of the cylinder at its start, its length, both
# in units of the time scale, and its strength over the uplift threshold
_LEAN, _SPIN, _LENGTH, _STRENGTH = 0.4, 0.5, 2.0, 0.5
# diagnostics after which the assumptions of its model do not hold
_LIMITS = ("slip", "lift_off", "tension", "friction_needed", "wall_contact", "unresolved_pass", "side")
ENDS = Bound(AGREEMENT, "the run must reach its end", "alpha")
# two runs agree if they differ by less than this share of the difference of engine and model
_SAME_SIDE = 0.3
# cause and its reason, by the run with which a second engine agrees
_SIDES = {
    "model": ("{what}", "{other} follows the model to {from_model:.1e} alpha"),
    "engine": ("the {model}", "{engine} and {other} agree to {from_engine:.1e} alpha"),
    "neither": ("", "{other} agrees with neither: {from_model:.1e} alpha from the model"),
}


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class SuiteRuns:
    """Runs of a suite, each computed once and stored.

    Parameters
    ----------
    reference : callable, optional
        The reduced models, called as `reduced.simulate`.
    workers : int, optional
        Number of processes for engines. Default: one for each core.
    progress : callable, optional
        Called at the start and the end of each engine run.
    kept : dict, optional
        Engine runs that were made before.
    """

    reference: Simulate = reduced.simulate
    workers: int | None = None
    progress: ProgressCallback | None = None
    kept: dict[str, Trace] = dataclasses.field(default_factory=dict)

    def traces(self, jobs: Sequence[Job]) -> list[Trace]:
        """Return the trace of each job."""
        keys = [fingerprint([job.case, job.run]) for job in jobs]
        missing = {key: job for key, job in zip(keys, jobs, strict=True) if key not in self.kept}
        traces = simulate_all(list(missing.values()), workers=self.workers, progress=self.progress)
        self.kept.update(zip(missing, traces, strict=True))
        return [self.kept[key] for key in keys]

    def simulate(self, case: Case, run: Run, **options: float) -> Trace:
        """Return the motion of the reduced model that a run names."""
        return self.reference(case, support=run.support, **options)


def check_suite(runs: SuiteRuns, jobs: Sequence[Job], bounds: Bounds | None) -> Iterator[Result]:
    """Results of the runs of a suite, by its stated bounds, or by its own runs."""
    traces = runs.traces(jobs)
    if bounds is None:
        prepare(runs, jobs, traces)
    for job, trace in zip(jobs, traces, strict=True):
        for result in check_run(runs, job, trace, bounds):
            yield dataclasses.replace(result, subject=job.label)


def reference_of(run: Run, bounds: Bounds | None) -> Run:
    """Reduced model with which a run is compared."""
    return run.own_model if bounds is None or bounds.reference == "own" else Run(None, bounds.reference)


def check_run(runs: SuiteRuns, job: Job, trace: Trace, bounds: Bounds | None) -> Iterator[Result]:
    """Results of one run of an engine."""
    reference = reference_of(job.run, bounds)
    name = f"{job.case.name}, {job.label} compared with {reference.support}"
    if trace.outcome == "failed":
        yield at_most(name, math.nan, ENDS, f"contact of {job.run.engine}", why(trace))
        return
    if job.run.support.walls:
        yield from walls(f"{job.case.name}, {job.label}", job.case, trace)
    model = runs.simulate(job.case, reference)
    if bounds is None:
        yield from results_without_bounds(runs, job, name, model, trace)
        return
    # without a bound on the prediction
    none = Prediction(length=job.case.length, reason="")
    row = summary_row(job.case, str(model.run), model, job.label, trace, prediction=none)
    for column, most in bounds.as_dict().items():
        unit, meaning = SUMMARY_COLUMNS[column]
        value = abs(row[column])
        if column == "agreement_time":
            # a shorter time is worse: a missing part may be zero
            missing = max(0.0, most - value) if row["diverged"] else 0.0
            bound = Bound(0.0, f"the suite asks for {most:g} s", unit)
            yield at_most(f"{name}: agreement_time missing", missing, bound, note=f"it is {value:.3g} s")
        else:
            bound = Bound(most, f"stated by the suite: {meaning}", unit)
            yield at_most(f"{name}: {column}", value, bound, note=str(row["diagnostics"]))


def results_without_bounds(
    runs: SuiteRuns, job: Job, name: str, model: Trace, trace: Trace
) -> Iterator[Result]:
    """Results of a run of a suite without bounds."""
    yield _result_by_step(runs, job, name, model, trace, clean=False)
    if (other := _in_motion(job)) is not None:
        (trace,) = runs.traces([other])
        words = "first seconds" if job.case.is_release else "met rocking"
        name = f"{name}, {words}"
        model = runs.simulate(other.case, model.run)
        if trace.outcome == "failed":
            yield at_most(name, math.nan, ENDS, f"contact of {job.run.engine}", why(trace))
        else:
            yield _result_by_step(runs, other, name, model, trace, clean=True)


def prepare(runs: SuiteRuns, jobs: Sequence[Job], traces: Sequence[Trace]) -> None:
    """Compute the motions for many runs, side by side."""
    others = [other for job in jobs if (other := _in_motion(job)) is not None]
    known = [*zip(jobs, traces, strict=True), *zip(others, runs.traces(others), strict=True)]
    runs.traces([other_step(job, trace)[0] for job, trace in known if trace.outcome != "failed"])


def in_motion(case: Case) -> Case | None:
    """First seconds of a release, or the strongest of a motion, which a rocking cylinder meets.

    None where nothing moves.
    """
    motion, unit = case.motion, time_scale(case)
    if case.is_release:
        return dataclasses.replace(case, duration=min(case.length, _LENGTH * unit))
    if motion is None or motion.peak == 0.0:
        return None
    size = np.hypot(*motion.acceleration[:, :2].T)
    strongest, reach = int(np.argmax(size)), math.ceil(0.5 * _LENGTH * unit / motion.time_step)
    cut = motion.acceleration[max(0, strongest - reach) : strongest + reach + 1]
    scale = _STRENGTH * case.gravity * case.cylinder.tan_alpha / size[strongest]
    return dataclasses.replace(
        case,
        motion=GroundMotion(np.vstack([cut, cut[-1:]]) * scale, motion.time_step, motion.name),
        initial=InitialState(_LEAN * case.cylinder.alpha, rolling_rate=_SPIN / unit),
        duration=_LENGTH * unit,
    )


def other_step(job: Job, trace: Trace) -> tuple[Job, float]:
    """Run at twice or half its step, and the factor from the difference of both to the error."""
    case, step = job.case, trace.time_step
    if not math.isfinite(step):  # several steps: the default of the engine is used
        step = default_step(case.cylinder.semidiagonal, case.gravity)
    for times, factor in ((2.0, 1.0), (0.5, 2.0)):
        run = at_step(job.run, times * step)
        try:
            require_runnable(case, run)
        except ValueError:  # twice the step is too large for contact
            continue
        return Job(case=case, run=run, label=f"{job.label}, {times:g} times the step"), factor
    raise ValueError(f"the run must have a step beside {step:g} s, got none for {job.label}")


def _in_motion(job: Job) -> Job | None:
    # no model exists once walls are touched
    case = in_motion(job.case) if job.run.support.has_model else None
    return None if case is None else Job(case=case, run=job.run, label=job.label)


def _result_by_step(
    runs: SuiteRuns, job: Job, name: str, model: Trace, trace: Trace, *, clean: bool
) -> Result:
    if not any(math.isfinite(each.uplift_time) for each in (model, trace)):
        return not_run(name, "neither uplifts")
    by_step = _by_step(runs, job, trace)
    if by_step is None:
        return not_run(name, "the run of another step failed: there is nothing to judge it by")
    parts = [by_step, *([] if clean else _copies(runs, job, model, trace, by_step))]
    apart = _tilt_difference(model, trace)
    count = min(len(each) for each in (apart, *parts))
    allowed = np.maximum.reduce([np.abs(each[:count]) for each in parts])
    if not clean:
        allowed = np.maximum.accumulate(allowed)  # monotonic in time
    time = trace.time[:count]
    limit = min([model.first(*_LIMITS), trace.first(*_LIMITS), *landings(model)[:1], job.case.length])
    within = (time >= np.nan_to_num(model.uplift_time)) & (time < limit) & (clean | (allowed < AGREEMENT))
    if np.count_nonzero(within) < 2:
        return not_run(name, "the agreement is predicted to end at once: there is nothing to compare")
    until, step = float(time[within][-1]), rms(allowed[within])
    most = (CLEAN if clean else WIDE) * step + LEAST
    grown = "" if clean else " and what as large an error grows to"
    reason = f"{CLEAN if clean else WIDE:g} times what the step changes{grown}, and contact"
    bound = Bound(min(most, AGREEMENT) if clean else most, reason, "alpha")
    result = at_most(name, rms(apart[:count][within]), bound, note=f"to {until:.3g} s")
    if not result.failed:
        return result
    if clean and most > AGREEMENT:
        part = f"time step of {job.run.engine}"
        fits = trace.time_step * AGREEMENT / most
        advice = f"the trace changes by {step:.1e} alpha with its step: try a time step of {fits:.1g} s"
    else:
        part, advice = likely_cause(runs, job, model, trace, until=until)
    return dataclasses.replace(result, cause=part, note=f"{result.note}; {advice}")


def _by_step(runs: SuiteRuns, job: Job, trace: Trace) -> Array | None:
    """Change of a run with its step (n,) [alpha]; None where the other run fails."""
    other, factor = other_step(job, trace)
    (second,) = runs.traces([other])
    return None if second.outcome == "failed" else factor * np.abs(_tilt_difference(trace, second))


def _tilt_difference(one: Trace, other: Trace) -> Array:
    """Difference of the tilts at the samples that both runs have [alpha]; falls end at different times."""
    count = max(min(len(one.time), len(other.time)) - 1, 0)
    return np.asarray(other.tilt[:count] - one.tilt[:count]) / one.case.cylinder.alpha


def _copies(runs: SuiteRuns, job: Job, model: Trace, trace: Trace, by_step: Array) -> list[Array]:
    """Distance of copies of the model [alpha]: perturbed to the early error of the engine, with its impacts.

    A base that opens by less than the contact sinks in stays closed in every engine, at every step: after
    weak shaking a model chatters there, and the strong motion that follows finds it elsewhere.
    """
    case, start = job.case, float(np.nan_to_num(model.uplift_time))
    threshold = trace.contact_resolution / case.cylinder.alpha
    closing = []
    if threshold > REST_TILT:
        closed = runs.simulate(case, model.run, rest_tilt=min(threshold, LARGEST_REST_TILT))
        closing.append(_tilt_difference(model, closed))

    by_table = estimated_error(case, job.run, trace.time_step)
    error = max(early_rms(case, trace.time[: len(by_step)], by_step, start), by_table)
    copies = copies_off_by(case, model, error, runs.simulate)
    return [*closing, *(_tilt_difference(model, runs.simulate(copy, model.run)) for copy in copies)]


def likely_cause(runs: SuiteRuns, job: Job, model: Trace, trace: Trace, *, until: float) -> tuple[str, str]:
    """Likely cause of a difference of engine and model, by the run with which a second engine agrees."""
    engine, support = job.run.engine, job.run.support
    here = [name for name in standard_engines() if name != engine and not engine_fault(name)]
    other = next((name for name in here if support in find_engine(name).supports), None)
    if other is None:
        return "", "a second engine would tell which is wrong: add one to the runs of the suite"
    (second,) = runs.traces([Job(case=job.case, run=Run(other, support))])
    if second.outcome == "failed":
        return "", f"{other} fails on this case, and tells nothing"

    def differ(one: Trace, other: Trace) -> float:
        apart = _tilt_difference(one, other)
        value = rms(apart[one.time[: len(apart)] <= until])
        return value if math.isfinite(value) else math.inf

    most = _SAME_SIDE * differ(model, trace)
    from_model, from_engine = differ(model, second), differ(trace, second)
    side = "model" if from_model < most else "engine" if from_engine < most else "neither"
    cause, reason = _SIDES[side]
    what = "settings" if job.run.settings else "contact"
    words = {"what": f"{what} of {engine} ({support})", "model": model.run, "engine": engine, "other": other}
    words |= {"from_model": from_model, "from_engine": from_engine}
    return cause.format(**words), reason.format(**words)
