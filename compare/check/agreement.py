"""Agreement with the independent model: of an engine or a model, of a trajectory, and of the runs of a suite.

An engine in a recess is compared with the recess model, one on flat ground with the flat-ground model. A
recess with clearance has no model of its own: until the first touch of a wall it is flat ground.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterator, Sequence

import numpy as np

from rockwobble.models import Bounds, Case, Cylinder, GroundMotion, InitialState, Run, Trace, el_centro_1940

from ..comparison.prediction import Prediction, estimated_error, predict
from ..comparison.summary import SUMMARY_COLUMNS, summary_row
from ..external.verdict import numbers_of
from ..metrics.energy import energy_loss
from ..metrics.tilt import rms
from ..runs.choice import own_model
from ..runs.execution import Job
from . import own_bounds
from .motion import Array, largest, lean
from .own_bounds import SuiteRuns, why
from .result import Bound, Result, at_most
from .scenes import FRAME_RELEASE, GRAVITY, PIER, RELEASE, SQUAT, THRESHOLD, released, steady
from .subject import Subject

# a squat body with inertias of its own, on ground that accelerates evenly in three components
BODY = Cylinder(semidiagonal=3.0, tan_alpha=1.0, height=5.0, transverse_inertia=3.0, axial_inertia=1.6)
GROUND = np.array([0.10, -0.06, 0.30]) * GRAVITY
SHAKEN = Case(
    BODY,
    steady(GROUND, 0.5),
    initial=InitialState(0.5 * BODY.alpha, tilt_rate=-0.1, rolling_angle=0.7, rolling_rate=1.1),
    duration=0.5,
    friction=2.0,
    name="even acceleration in three components",
)
_SAMPLE = 0.00437  # [s] no multiple of a step, which is 7e-5 s: a sample off by half of one shows
# unit of each field, and times the tolerance; rates and forces are differences of what is recorded
_FIELDS = {
    "tilt": ("rad", 1.0, 1.0),
    "tilt_rate": ("rad/s", 1.0, 3.0),
    "rolling_angle": ("rad", 1.0, 1.0),
    "twist": ("rad", 1.0, 2.0),
    "contact_point": ("b", BODY.base_radius, 1.0),
    "centre_of_mass": ("R", BODY.semidiagonal, 1.0),
    "energy": ("g R", GRAVITY * BODY.semidiagonal, 1.0),
}
# the guide of a recess, which starts without twist, lets rate and force swing about their mean
_SWINGS = {"recess": (200.0, 5e3), "flat": (5.0, 5.0)}
_RAMP = Case(PIER, GroundMotion(np.outer([0.0, 1.5], [0.6, 0.8]) * THRESHOLD, 1.5), name="ramp")
RECORD = Case(Cylinder(semidiagonal=10.0, tan_alpha=0.1), el_centro_1940(), duration=8.0, name="El Centro")
_LEVEL = 1e-3  # of alpha: tilt at which an uplift is seen


def fields(subject: Subject, support: str) -> Iterator[Result]:
    """Every field of a trace, where the model of the support knows it, too, and the balance of energy."""
    found, model = _both(subject, SHAKEN, support, _SAMPLE)
    whole = len(found.time) == len(model.time)

    def apart(name: str, cut: slice = slice(None)) -> float:
        return largest(getattr(found, name)[cut] - getattr(model, name)[cut]) if whole else math.nan

    for name, (unit, size, times) in _FIELDS.items():
        yield at_most(name, apart(name) / size, subject.within(times, "contact at its step", unit), name)
    rate, force = (subject.within(times, "means over 60 steps") for times in _SWINGS[support])
    yield at_most("rolling_rate", apart("rolling_rate"), rate, "rolling_rate")
    # without the half window at either end
    yield at_most("contact force", apart("contact_force", slice(2, -2)), force, "contact_force")
    if "energy_error" in subject.knows:
        work = -(found.centre_of_mass - found.centre_of_mass[0]) @ GROUND
        left = largest(found.energy - found.energy[0] - work - found.energy_error)
        bound = subject.within(1.0, "work step by step, and samples between steps", "g R")
        yield at_most("energy error against energy and work", left / _FIELDS["energy"][1], bound)
        outside = np.hypot(*model.contact_point.T) - BODY.base_radius
        off = largest(found.contact_offset - outside) if whole else math.nan
        yield at_most("contact offset", off / BODY.base_radius, subject.within(1.0, "as the model", "b"))


def release(subject: Subject, support: str) -> Iterator[Result]:
    """Tilt, peak and passes of a release that passes the upright position."""
    found, model = _both(subject, RELEASE, support)
    apart = _difference(found, model, RELEASE.length)
    yield at_most("tilt and azimuth of a release", apart, subject.within(1.0, "contact at its step", "alpha"))
    if "passes" in subject.knows:
        columns = ["time", "minimum_tilt", "angle_of_turn"]
        own, other = (each.passes[columns].to_numpy(dtype=float) for each in (found, model))
        off = largest(own - other) if own.shape == other.shape else math.nan
        yield at_most("passes of a release", off, subject.within(10.0, "as the model", "s, rad"))


def frame(subject: Subject, support: str) -> Iterator[Result]:
    """Tilt of a release of a frame: one column under a slab that can only translate."""
    found, model = _both(subject, FRAME_RELEASE, support)
    apart = _difference(found, model, FRAME_RELEASE.length)
    yield at_most("tilt and azimuth of a frame", apart, subject.within(1.0, "contact at its step", "alpha"))


def ramp(subject: Subject, support: str) -> Iterator[Result]:
    """Tilt after an uplift on a load that rises, as far as 1.5 times the load that lifts the pier."""
    found, model = _both(subject, _RAMP, support, 0.05)
    bound = subject.within(5.0, "the base tips at the threshold", "alpha")
    yield at_most("tilt and azimuth after an uplift", _difference(found, model, _RAMP.length), bound)


def record(subject: Subject, support: str) -> Iterator[Result]:
    """Tilt and azimuth under El Centro, of a case that shows a size that is 0.1 % wrong."""
    found, model = _both(subject, RECORD, support)
    times = 1.0 if subject.run is None else 10.0  # an engine errs at uplift, and passes magnify that
    bound = subject.within(times, "its accuracy, and what passes make of it", "alpha")
    yield at_most("tilt and azimuth under El Centro", _difference(found, model, RECORD.length), bound)


def ring(subject: Subject, support: str) -> Iterator[Result]:
    """A recess with clearance: flat ground until a wall is touched; the walls keep it in its place."""
    case = released(0.5, 0.5, 4.0, SQUAT)
    found, flat = (subject.simulate(case, each) for each in (support, "flat"))
    before = found.time < found.first("wall_contact")
    same = len(found.time) == len(flat.time)
    apart = largest(found.tilt[before] - flat.tilt[before]) if same else math.nan
    yield at_most("tilt before a wall is touched", apart, subject.within(0.0, "the same run", "rad"))
    yield from _walls("release, tan alpha = 1", case, found)


def trajectory(subject: Subject, support: str) -> Iterator[Result]:
    """The trajectory of a case: its start or uplift, its motion and its peak, as long as they must agree.

    That is until a copy whose record or release is off by 0.1 % is 1 % of alpha away.
    """
    for case in subject.cases or ():
        found, model = _both(subject, case, support)
        alpha = case.cylinder.alpha
        if case.initial is None:
            seen = [_rises(each.time, each.tilt, _LEVEL * alpha) for each in (found, model)]
            off = 0.0 if all(map(math.isnan, seen)) else abs(seen[0] - seen[1])
            yield at_most("time of uplift", off, subject.within(1.0, "as the model", "s"))
        else:
            off = abs(float(found.tilt[0]) - case.initial.tilt) / alpha
            yield at_most("tilt at release", off, subject.within(1.0, "as stated", "alpha"))
        end = _agreement(subject, case, support, model)
        apart, bound = _difference(found, model, end), subject.within(1.0, "as asked for", "alpha")
        yield at_most(f"tilt and azimuth up to {end:.4g} s", apart, bound)
        peaks = [float(each.tilt[each.time <= end].max()) / alpha for each in (found, model)]
        yield at_most("peak tilt", abs(peaks[0] - peaks[1]), bound)


def check_suite(runs: SuiteRuns, jobs: Sequence[Job], bounds: Bounds | None) -> Iterator[Result]:
    """Yield the results of the runs of a suite, by the bounds that it states, or by its own runs."""
    traces = runs.traces(jobs)
    if bounds is None:
        own_bounds.prepare(runs, jobs, traces)
    for job, trace in zip(jobs, traces, strict=True):
        for result in check_run(runs, job, trace, bounds):
            yield dataclasses.replace(result, subject=job.label)


def reference_of(run: Run, bounds: Bounds | None) -> Run:
    """Return the reduced model that a run is compared with."""
    return own_model(run) if bounds is None or bounds.reference == "own" else Run(None, bounds.reference)


def check_run(runs: SuiteRuns, job: Job, trace: Trace, bounds: Bounds | None) -> Iterator[Result]:
    """Yield the results on one run of an engine."""
    reference = reference_of(job.run, bounds)
    name = f"{job.case.name}, {job.label} compared with {reference.support}"
    if trace.outcome == "failed":
        yield at_most(name, math.nan, own_bounds.ENDS, f"contact of {job.run.engine}", why(trace))
        return
    if job.run.support == "ring":
        yield from _walls(f"{job.case.name}, {job.label}", job.case, trace)
    model = runs.solve(job.case, reference.support)
    if bounds is None:
        yield from own_bounds.compared(runs, job, name, model, trace)
        return
    prediction = predict(
        job.case,
        reference=model,
        own=model,
        contact_resolution=trace.contact_resolution,
        error=estimated_error(job.case, job.run.engine, trace.time_step),
        simulate=lambda case, run: runs.solve(case, run.support),
    )
    yield from _stated(bounds, job, name, model, trace, prediction)


def _stated(
    bounds: Bounds, job: Job, name: str, model: Trace, trace: Trace, prediction: Prediction
) -> Iterator[Result]:
    """One result for each bound that the suite states."""
    row = summary_row(job.case, str(model.run), model, job.label, trace, prediction=prediction)
    for column, most in bounds.given().items():
        unit, meaning = SUMMARY_COLUMNS[column]
        value = abs(numbers_of(row)[column])
        if column == "agreement_time":
            # the shorter the worse: what is missing may be nothing
            missing = max(0.0, most - value) if row["diverged"] else 0.0
            bound = Bound(0.0, f"the suite asks for {most:g} s", unit)
            yield at_most(f"{name}: agreement_time missing", missing, bound, note=f"it is {value:.3g} s")
        else:
            bound = Bound(most, f"stated by the suite: {meaning}", unit)
            yield at_most(f"{name}: {column}", value, bound, note=str(row["diagnostics"]))


def _walls(name: str, case: Case, trace: Trace) -> Iterator[Result]:
    touched = trace.first("wall_contact")
    note = f"first touch at {touched:.3g} s" if math.isfinite(touched) else "no wall was touched"
    loss = Bound(0.3, "walls that only keep the cylinder in place; 0.09 was measured")
    part = "inclination, friction or clearance of the walls"
    yield at_most(f"{name}: share of the energy lost", abs(energy_loss(trace, case.motion)), loss, part, note)
    moved = trace.residual_displacement / case.cylinder.base_radius
    # the wall stands back by a thousandth, and leans
    clearance = Bound(0.05, "clearance of the walls, and 1 - cos of the tilt at the end", "b")
    yield at_most(f"{name}: base centre away from its place", moved, clearance, "the walls let it out", note)


def _both(subject: Subject, case: Case, support: str, sample_step: float = 0.01) -> tuple[Trace, Trace]:
    """Return the motion and that of the independent model; raise where it failed, which says why."""
    assert subject.reference is not None
    found = subject.simulate(case, support, sample_step=sample_step)
    if found.outcome == "failed":
        raise RuntimeError(f"the run failed: {why(found)}")
    model = subject.reference(case, support=support, rtol=1e-11, sample_step=sample_step)
    return found, model


def _difference(found: Trace, model: Trace, end: float) -> float:
    """Root mean square difference of the leans until a time, over sin(alpha); of the tilt without azimuth."""
    from scipy.interpolate import CubicSpline

    at = found.time[found.time <= min(end, float(model.time[-1]))]
    if len(at) < 2:
        return math.inf
    own, other = lean(found), lean(model)
    if not np.isfinite(found.rolling_angle).any():
        own, other = np.abs(own), np.abs(other)
    return rms(np.abs(own[: len(at)] - CubicSpline(model.time, other)(at)))


def _agreement(subject: Subject, case: Case, support: str, model: Trace) -> float:
    """Return until when a copy that is off by 0.1 % stays within 1 % of alpha [s]."""
    assert subject.reference is not None
    motion, start = case.motion, case.initial
    if motion is not None:
        motion = motion.scaled(1.001)
    elif start is not None:
        start = dataclasses.replace(start, tilt=1.001 * start.tilt)
    other = dataclasses.replace(case, motion=motion, initial=start, duration=case.length)
    copy = subject.reference(other, support=support, rtol=1e-11)
    count = min(len(copy.tilt), len(model.tilt))
    beyond = np.flatnonzero(np.abs(copy.tilt[:count] - model.tilt[:count]) > 0.01 * case.cylinder.alpha)
    return float(model.time[beyond[0]] if len(beyond) else model.time[-1])


def _rises(time: Array, tilt: Array, level: float) -> float:
    """Return when the tilt first exceeds a level [s]; its cube root is linear in between. NaN if never."""
    beyond = np.flatnonzero(tilt > level)
    if not len(beyond) or not beyond[0]:
        return math.nan
    i = int(beyond[0])
    low, high = np.cbrt(np.maximum(tilt[i - 1 : i + 1], 0.0))
    return float(time[i - 1] + (time[i] - time[i - 1]) * (np.cbrt(level) - low) / (high - low))
