"""Layer agreement, second part: whether the engines still follow the reduced models on a suite.

An engine in a recess is held against the recess model, one on flat ground against the flat-ground model. A
ring of walls has no model of its own: until the first touch of a wall it is flat ground, and after it only
what every motion in a recess must show is asked for.

What a run may be off comes from its suite where that states bounds; from what was measured once for the
suite "quick"; and for any other suite from the run itself, see `own_bounds`.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

from rockwobble.models import Bounds, Case, Run, Trace

from ...comparison.prediction import Prediction, estimated_error, predict, time_scale, verdict
from ...comparison.summary import SUMMARY_COLUMNS, summary_row
from ...external.verdict import numbers_of
from ...metrics.agreement import agreement_time
from ...metrics.energy import energy_loss
from ...metrics.pair import is_release, make_pair
from ...metrics.tilt import tilt_rms
from ...runs.choice import own_model
from ...runs.execution import Job
from ..bench import Bench, why
from ..finding import Bound, Finding, at_most, not_run
from . import own_bounds

# RMS of the tilt difference [alpha] at a step of 1e-4 s (R = 6 m), from release: 2e-6 tan^2(alpha) was
# measured with MuJoCo and PyBullet on the slender, and from rest 6e-5 to 1.4e-4, which near passes magnify
RELEASED, RELEASED_LEAST = 1e-5, 1e-7
FROM_REST = 5e-4
ENDS = Bound(0.0, "the run must reach its end", "alpha")
LOSS = Bound(0.3, "walls that only hold the cylinder in place; 0.09 was measured")
# the wall stands back by a thousandth, and leans
PLACE = Bound(0.05, "clearance of the walls, and 1 - cos of the tilt at the end", "b")


def check(bench: Bench) -> Iterator[Finding]:
    """Yield the findings of this part."""
    jobs = bench.jobs()
    traces = bench.traces(jobs)
    if not bench.shipped and bench.suite.bounds is None:
        own_bounds.prepare(bench, jobs, traces)
    for job, trace in zip(jobs, traces, strict=True):
        yield from check_run(bench, job, trace)


def reference_of(bench: Bench, run: Run) -> Run:
    """Return the reduced model that a run is held against."""
    bounds = bench.suite.bounds
    return own_model(run) if bounds is None or bounds.reference == "own" else Run(None, bounds.reference)


def check_run(bench: Bench, job: Job, trace: Trace) -> Iterator[Finding]:
    """Yield the findings on one run of an engine."""
    reference = reference_of(bench, job.run)
    name = f"{job.case.name}, {job.label} against {reference.support}"
    if trace.outcome == "failed":
        part = f"contact of {job.run.engine} ({job.run.support}): the run failed"
        yield at_most(name, math.nan, ENDS, part, why(trace))
        return
    model = bench.solve(job.case, reference.support)
    if job.run.support == "ring":
        yield from _ring(job, trace)
    if bench.suite.bounds is None and not bench.shipped:
        yield from own_bounds.held(bench, job, name, model, trace)
        return
    prediction = predict(
        job.case,
        reference=model,
        own=model,
        contact_resolution=trace.contact_resolution,
        error=estimated_error(job.case, job.run.engine, trace.time_step),
        simulate=lambda case, run: bench.solve(case, run.support),
    )
    if bench.suite.bounds is None:
        yield _as_measured_once(job, name, model, trace, prediction)
    else:
        yield from _stated(bench.suite.bounds, job, name, model, trace, prediction)


def _as_measured_once(job: Job, name: str, model: Trace, trace: Trace, prediction: Prediction) -> Finding:
    case, run = job.case, job.run
    until = min(case.length, trace.first("wall_contact"))
    pair = make_pair(case.cylinder, model, trace, until=until)
    # what near passes have magnified says nothing: to half of the predicted agreement time
    end = min(pair.end, pair.start + 0.5 * prediction.length) if prediction.reason else pair.end
    part = f"{run.engine} ({run.support}), its contact and step, or the reduced model"
    if not any(math.isfinite(each.uplift_time) for each in (model, trace)):
        return not_run(name, part, "neither uplifts: there is nothing to compare")
    if end <= pair.start:
        return not_run(name, part, "the agreement is predicted to end at once: there is nothing to compare")
    apart = tilt_rms(make_pair(case.cylinder, model, trace, until=end))
    agreement = agreement_time(pair)
    words = verdict(agreement.length, agreement.diverged, prediction.length, prediction.reason)
    note = f"to {end:.3g} s" + (f"; they diverge {words}" if agreement.diverged else "")
    bound = Bound(
        tilt_bound(case, trace.time_step), "error of contact at this step, first order in it", "alpha"
    )
    return at_most(name, apart, bound, part, note)


def tilt_bound(case: Case, time_step: float | None) -> float:
    """Return the largest RMS difference of tilts that the step and its contact explain [alpha]."""
    step = 1.0 if time_step is None else max(1.0, time_step / (1e-4 * time_scale(case)))
    if is_release(case) and case.motion is None:
        return step * max(RELEASED * case.cylinder.tan_alpha**2, RELEASED_LEAST)
    return step * FROM_REST


def _ring(job: Job, trace: Trace) -> Iterator[Finding]:
    touched = trace.first("wall_contact")
    note = f"first touch at {touched:.3g} s" if math.isfinite(touched) else "no wall was touched"
    name = f"{job.case.name}, {job.label}"
    loss = abs(energy_loss(trace, job.case.motion))
    part = "ring: inclination, friction or clearance of its walls"
    yield at_most(f"{name}: share of the energy lost", loss, LOSS, part, note)
    moved = trace.residual_displacement / job.case.cylinder.base_radius
    part = "ring: its walls let the cylinder out"
    yield at_most(f"{name}: base centre away from its place", moved, PLACE, part, note)


def _stated(
    bounds: Bounds, job: Job, name: str, model: Trace, trace: Trace, prediction: Prediction
) -> Iterator[Finding]:
    """One finding for each bound that the suite states."""
    row = summary_row(job.case, str(model.run), model, job.label, trace, prediction=prediction)
    part = f"{job.run.engine} ({job.run.support}) or the {model.run}"
    for column, most in bounds.given().items():
        unit, meaning = SUMMARY_COLUMNS[column]
        value = abs(numbers_of(row)[column])
        if column == "agreement_time":
            # the shorter the worse: what is missing may be nothing
            missing = max(0.0, most - value) if row["diverged"] else 0.0
            bound = Bound(0.0, f"the suite asks for {most:g} s", unit)
            note = f"they agree for {value:.3g} s"
            yield at_most(f"{name}: agreement_time missing", missing, bound, part, note)
        else:
            bound = Bound(most, f"stated by the suite: {meaning}", unit)
            yield at_most(f"{name}: {column}", value, bound, part, str(row["diagnostics"]))
