"""Agreement of a subject with the independent model, and with the order of its method.

An engine in a recess is compared with the recess model, one on flat ground with the flat-ground model. A
recess with clearance has no model of its own: until the first touch of a wall it is flat ground. The error
falls with the time step as the method promises.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterator

import numpy as np
from numpy.typing import ArrayLike

from rockwobble.models import Case, Cylinder, GroundMotion, InitialState, Trace, el_centro_1940
from rockwobble.models.cylinder import PIER
from rockwobble.models.members import perturbed_in_strength
from rockwobble.models.support import FLAT, support_named
from rockwobble.multibody.engines.registry import engine_facts
from rockwobble.multibody.scene import REFERENCE_TIME_STEP

from ..external.motion import exceeds
from ..metrics.pair import agreement_of, energy_loss, rms
from .lagrange import TENDON
from .measurement import (
    FRAME_RELEASE,
    GRAVITY,
    RELEASE,
    SQUAT,
    THRESHOLD,
    Bound,
    Result,
    at_most,
    largest,
    lean_difference,
    release_case,
    steady,
    why,
)
from .subject import ENGINE_TOLERANCE, Subject, engine

# a squat body with given inertias, on ground that accelerates evenly in three components
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
_SAMPLE = 0.00437  # [s] no multiple of a step (7e-5 s): half a step of delay shows
# unit of each field, and factor on the tolerance; rates and forces are differences of recorded values
_FIELDS = {
    "tilt": ("rad", 1.0, 1.0),
    "tilt_rate": ("rad/s", 1.0, 3.0),
    "rolling_angle": ("rad", 1.0, 1.0),
    "twist": ("rad", 1.0, 2.0),
    "contact_point": ("b", BODY.base_radius, 1.0),
    "centre_of_mass": ("R", BODY.semidiagonal, 1.0),
    "energy": ("g R", GRAVITY * BODY.semidiagonal, 1.0),
}
# the guide of a recess, without twist at the start, makes rate and force oscillate about their mean
_GUIDED_SWINGS, _SWINGS = (200.0, 5e3), (5.0, 5.0)
RAMP = Case(PIER, GroundMotion(np.outer([0.0, 1.5], [0.6, 0.8]) * THRESHOLD, 1.5), name="ramp")
RECORD = Case(Cylinder(semidiagonal=10.0, tan_alpha=0.1), el_centro_1940(), duration=8.0, name="El Centro")
_CONTACT = "contact at its step"
_LEVEL = 1e-3  # tilt over alpha that counts as uplift
_COPY = 1e-3  # relative change of record or release in the copy whose divergence ends a comparison


def fields(subject: Subject, support: str) -> Iterator[Result]:
    """Every field of a trace that the model of the support also has, and the balance of energy."""
    trace, model = _both(subject, SHAKEN, support, _SAMPLE)
    whole = len(trace.time) == len(model.time)

    def difference(name: str, cut: slice = slice(None)) -> float:
        return largest(getattr(trace, name)[cut] - getattr(model, name)[cut]) if whole else math.nan

    for name, (unit, size, times) in _FIELDS.items():
        yield at_most(name, difference(name) / size, subject.tolerance_bound(times, _CONTACT, unit))
    swings = _GUIDED_SWINGS if support_named(support).guided else _SWINGS
    rate, force = (subject.tolerance_bound(times, "means over 60 steps") for times in swings)
    yield at_most("rolling_rate", difference("rolling_rate"), rate)
    # without the half window at either end
    yield at_most("contact force", difference("contact_force", slice(2, -2)), force)
    if "energy_error" in subject.knows:
        work = -(trace.centre_of_mass - trace.centre_of_mass[0]) @ GROUND
        left = largest(trace.energy - trace.energy[0] - work - trace.energy_error)
        bound = subject.tolerance_bound(1.0, "work step by step, and samples between steps", "g R")
        yield at_most("energy error against energy and work", left / _FIELDS["energy"][1], bound)
        outside = np.hypot(*model.contact_point.T) - BODY.base_radius
        off = largest(trace.contact_offset - outside) if whole else math.nan
        yield at_most(
            "contact offset", off / BODY.base_radius, subject.tolerance_bound(1.0, "as the model", "b")
        )


def release(subject: Subject, support: str) -> Iterator[Result]:
    """Tilt, peak and passes of a release with a near-upright pass."""
    trace, model = _both(subject, RELEASE, support)
    yield _leans(subject, trace, model, "tilt and azimuth of a release", 1.0, _CONTACT)
    bound = subject.tolerance_bound(10.0, "as the model", "s, rad")
    if "passes" in subject.knows:
        columns = ["time", "minimum_tilt", "angle_of_turn"]
        yield at_most(
            "passes of a release",
            _distance(*(each.passes[columns] for each in (trace, model))),
            bound,
        )
    if "extrema" in subject.knows:
        off = _distance(trace.extrema[:, :2], model.extrema[:, :2])
        yield at_most("turning points of a release", off, bound)


def _distance(values: ArrayLike, other: ArrayLike) -> float:
    """Return the largest difference of two tables; NaN where they have not as many rows."""
    tables = np.asarray(values, dtype=float), np.asarray(other, dtype=float)
    return largest(tables[0] - tables[1]) if tables[0].shape == tables[1].shape else math.nan


def frame(subject: Subject, support: str) -> Iterator[Result]:
    """Tilt of a release of a frame: one column under a slab that can only translate."""
    both = _both(subject, FRAME_RELEASE, support)
    yield _leans(subject, *both, "tilt and azimuth of a frame", 1.0, _CONTACT)


def tendon(subject: Subject, support: str) -> Iterator[Result]:
    """Tilt of a release with a tendon: a spring between points, whose elongation follows from the tilt."""
    both = _both(subject, dataclasses.replace(RELEASE, tendon=TENDON), support)
    yield _leans(subject, *both, "tilt and azimuth with a tendon", 1.0, _CONTACT)


def ramp(subject: Subject, support: str) -> Iterator[Result]:
    """Tilt after an uplift under a rising load, up to 1.5 times the uplift load of the pier."""
    both = _both(subject, RAMP, support, 0.05)
    yield _leans(subject, *both, "tilt and azimuth after an uplift", 5.0, "the base tips at the threshold")


def record(subject: Subject, support: str) -> Iterator[Result]:
    """Tilt and azimuth under El Centro, of a case sensitive to an error of 0.1 % in the size."""
    both = _both(subject, RECORD, support)
    times = 1.0 if subject.run is None else 10.0  # an engine errs at uplift, and passes magnify that
    reason = "its accuracy, and what passes make of it"
    yield _leans(subject, *both, "tilt and azimuth under El Centro", times, reason)


def ring(subject: Subject, support: str) -> Iterator[Result]:
    """Recess with clearance: flat ground until contact with a wall; the walls bound the displacement."""
    case = release_case(0.5, 0.5, 4.0, SQUAT)
    trace, flat = (subject.simulate(case, each) for each in (support, FLAT))
    before = trace.time < trace.first("wall_contact")
    same = len(trace.time) == len(flat.time)
    apart = largest(trace.tilt[before] - flat.tilt[before]) if same else math.nan
    yield at_most("tilt before a wall is touched", apart, subject.tolerance_bound(0.0, "the same run", "rad"))
    yield from walls("release, tan alpha = 1", case, trace)


def trajectory(subject: Subject, support: str) -> Iterator[Result]:
    """Differences of start or uplift, motion and peak of a case from the model, as long as it is predictable.

    That is until a copy whose record or release is off by 0.1 % is 1 % of alpha away.
    """
    for case in subject.cases or ():
        trace, model = _both(subject, case, support)
        alpha = case.cylinder.alpha
        if case.initial is None:
            seen = [exceeds(each.time, each.tilt, _LEVEL * alpha, 3.0) for each in (trace, model)]
            off = 0.0 if seen[0] == seen[1] else abs(seen[0] - seen[1])
            yield at_most("time of uplift", off, subject.tolerance_bound(1.0, "as the model", "s"))
        else:
            off = abs(float(trace.tilt[0]) - case.initial.tilt) / alpha
            yield at_most("tilt at release", off, subject.tolerance_bound(1.0, "as stated", "alpha"))
        end = _agreement(subject, case, support, model)
        name, reason = f"tilt and azimuth up to {end:.4g} s", "as asked for"
        yield _leans(subject, trace, model, name, 1.0, reason, end)
        peaks = [float(each.tilt[each.time <= end].max()) / alpha for each in (trace, model)]
        yield at_most("peak tilt", abs(peaks[0] - peaks[1]), subject.tolerance_bound(1.0, reason, "alpha"))


def walls(name: str, case: Case, trace: Trace) -> Iterator[Result]:
    """Energy lost at walls, and the displacement that they allow."""
    touched = trace.first("wall_contact")
    note = f"first touch at {touched:.3g} s" if math.isfinite(touched) else "no wall was touched"
    loss = Bound(0.3, "walls that only keep the cylinder in place; 0.09 was measured")
    part = "inclination, friction or clearance of the walls"
    yield at_most(f"{name}: share of the energy lost", abs(energy_loss(trace, case.motion)), loss, part, note)
    moved = trace.residual_displacement / case.cylinder.base_radius
    # the wall has a clearance of a thousandth, and an inclination
    clearance = Bound(0.05, "clearance of the walls, and 1 - cos of the tilt at the end", "b")
    yield at_most(f"{name}: base centre away from its place", moved, clearance, "the walls let it out", note)


def _both(subject: Subject, case: Case, support: str, sample_step: float = 0.01) -> tuple[Trace, Trace]:
    """Motion of the subject and of the independent model; a failed motion raises its reason."""
    assert subject.reference is not None
    trace = subject.simulate(case, support, sample_step=sample_step)
    if trace.outcome == "failed":
        raise RuntimeError(f"the run failed: {why(trace)}")
    model = subject.reference(case, support=support, rtol=1e-11, sample_step=sample_step)
    return trace, model


def _leans(
    subject: Subject, trace: Trace, model: Trace, name: str, times: float, reason: str, end: float = math.inf
) -> Result:
    """Compare the leans to the end of the case, or until a time: root mean square over sin(alpha)."""
    apart = lean_difference(trace, model, min(end, model.case.length))
    bound = subject.tolerance_bound(times, reason, "alpha")
    return at_most(name, rms(apart) if len(apart) > 1 else math.inf, bound)


def _agreement(subject: Subject, case: Case, support: str, model: Trace) -> float:
    """Time up to which a copy perturbed by 0.1 % stays within 1 % of alpha [s]."""
    assert subject.reference is not None
    other = dataclasses.replace(perturbed_in_strength(case, _COPY), duration=case.length)
    return agreement_of(model, subject.reference(other, support=support, rtol=1e-11)).end


# steps of the check of the order, over the default: in single precision rounding exceeds the error at the
# finest steps, and the order shows at coarse ones
_STEPS, _COARSE_STEPS = (4.0, 2.0, 1.0), (10.0, 7.0, 4.0)
LOW_RELEASE = release_case(0.5, 0.5, 2.0, SQUAT, "release, tan alpha = 1")


def order(subject: Subject, support: str) -> Iterator[Result]:
    """The error against the independent model falls with the order of the engine in its time step."""
    assert subject.reference is not None
    assert subject.run is not None
    exact = subject.reference(LOW_RELEASE, support=support, rtol=1e-11)
    times = _STEPS if subject.tolerance == ENGINE_TOLERANCE else _COARSE_STEPS
    steps, errors = REFERENCE_TIME_STEP * np.array(times), []
    for step in steps.tolist():
        trace = engine(subject.label, step, **subject.run.settings).simulate(LOW_RELEASE, support)
        errors.append(math.nan if trace.outcome == "failed" else rms(trace.tilt - exact.tilt))
    known = all(math.isfinite(error) and error > 0.0 for error in errors)
    slope = float(np.polyfit(np.log(steps), np.log(errors), 1)[0]) if known else math.nan
    bound, order = (
        Bound(0.2, f"scatter of a slope over {len(errors)} points"),
        engine_facts(subject.label).order,
    )
    yield at_most("error by the time step", max(order - slope, 0.0), bound, note=f"slope {slope:.2f}")
