"""Layer traces: every field of an engine's trace, where the reduced model of its support knows it, too.

Two short runs of each engine have all that a trace tells in them: a squat body with inertias of its own
on ground that accelerates evenly in three components, and a standing pier on a ramp. Samples fall between
the steps. Engines that not every installation has run the beginning of the first, and the second: their
steps cost up to twenty times as much. The reduced models are held against the equations in the layers
before.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterator, Mapping

import numpy as np

from rockwobble.models import Case, Cylinder, GroundMotion, InitialState, Run, Trace
from rockwobble.multibody.engines.registry import find_engine
from rockwobble.multibody.scene.froude import default_step

from ...runs.choice import own_model
from ...runs.execution import Job, simulate_run
from ..bench import Array, Bench, engines_here, largest, not_here, why
from ..finding import Bound, Finding, at_most
from ..problems import GRAVITY, PIER, THRESHOLD, released, steady


def _contact(most: float, unit: str) -> Bound:
    return Bound(most, "error of contact at this step; less than half of it was measured", unit)


SQUAT = Cylinder(semidiagonal=3.0, tan_alpha=1.0, height=5.0, transverse_inertia=3.0, axial_inertia=1.6)
GROUND = np.array([0.10, -0.06, 0.30]) * GRAVITY
SHAKEN = Case(
    SQUAT,
    steady(GROUND, 0.9),
    initial=InitialState(0.5 * SQUAT.alpha, tilt_rate=-0.1, rolling_angle=0.7, rolling_rate=1.1),
    duration=0.9,
    friction=2.0,
    name="even acceleration in three components",
)
BEGINNING = dataclasses.replace(SHAKEN, duration=0.2)
SAMPLE = 0.00437  # [s] no multiple of a step
# a sample off by half a step, of 3.5e-5 s in MuJoCo, would be off by 2e-5 rad
FIELDS: Mapping[str, Bound] = {
    "tilt": _contact(5e-6, "rad"),
    "tilt_rate": _contact(1.5e-5, "rad/s"),
    "rolling_angle": _contact(5e-6, "rad"),
    "twist": _contact(1e-5, "rad"),
    "contact_point": _contact(1e-5, "m"),
    "centre_of_mass": _contact(1e-5, "m"),
    "energy": _contact(7e-5, "m^2/s^2"),
}
# rate, and force as a mean over 125 steps or more, without the half window at either end; in the recess the
# guide, which starts without twist, lets both swing about their mean
SWINGS: Mapping[str, tuple[Bound, Bound]] = {
    "recess": (_contact(1.5e-3, "rad/s"), _contact(0.03, "weights")),
    "flat": (_contact(2e-5, "rad/s"), _contact(2e-5, "weights")),
}
PLACE, RESIDUAL = _contact(1e-5, "m"), _contact(1e-5, "m, rad")
BALANCE = _contact(8e-5, "m^2/s^2")  # of 20; 4e-5 was measured: work step by step, and samples between steps
# |a| rises and the weight falls: 2 t/0.8 = 1 - 0.5 t/0.8 at the uplift, in units of the threshold
RAMP = Case(
    PIER,
    GroundMotion(np.array([[0.0, 0.0, 0.0], [-1.6, 1.2, -2.5]]) * THRESHOLD, 0.8),
    duration=0.6,
    friction=2.0,
    name="ramp",
)
RISE = _contact(5e-5, "rad")  # 1e-5 was measured with PyBullet
UPLIFT, AZIMUTH = _contact(1e-6, "s"), _contact(1e-9, "rad")  # 1e-8 and 3e-15 were measured
UPLIFT_FURTHER = _contact(2e-6, "s")  # 9e-7 was measured with Drake
AT_REST = _contact(1e-6, "weights")
RELEASE = released(0.3, 0.4, 1.9, name="release")  # one pass, at 0.1 alpha
# smaller than the size at which the engines run every scene, as in `_slides`
LANDING = Case(
    Cylinder(semidiagonal=1.5, tan_alpha=0.2), initial=InitialState(0.06), duration=0.9, name="lands"
)
FALL = Case(PIER, initial=InitialState(1.5 * PIER.alpha), duration=4.0, friction=5.0, name="falls")
ON_ITS_SIDE = Bound(5e-3, "near its side the rim lifts off and slips; less than half of it was measured", "s")
FLAT_ON_THE_GROUND = _contact(1e-6, "s")
PEAK, PASS = _contact(1e-7, "rad"), _contact(1e-6, "s, rad")
ENDS = _contact(0.0, "")
SLIDE = Bound(0.05, "closed form; contact chatters as it slides: 0.01 and 0.03 were measured")


def check(bench: Bench) -> Iterator[Finding]:
    """Yield the findings of this layer."""
    yield from not_here("fields of a trace", bench.engines)
    for engine in engines_here(bench.engines):
        for support in ("recess", "flat"):
            yield from _shaken(bench, SHAKEN, bench.adjust(_run(engine, support, SHAKEN)))
        yield from _uplift(bench, engine, UPLIFT)
        yield from _passes(bench, engine)
        yield _lands(bench, engine)
        yield _falls(bench, engine)
        yield _slides(bench, engine)
    for engine in bench.further_engines():
        backend = find_engine(engine)
        for support in ("recess", "flat"):
            if support in backend.supports:
                yield from _shaken(bench, BEGINNING, bench.adjust(_run(engine, support, BEGINNING)))
        if backend.uplifts:
            yield from _uplift(bench, engine, UPLIFT_FURTHER)


def _run(engine: str, support: str, case: Case) -> Run:
    return Run(engine, support, 0.5 * default_step(case.cylinder.semidiagonal, case.gravity))


def _shaken(bench: Bench, case: Case, run: Run) -> Iterator[Finding]:
    trace = simulate_run(case, run, sample_step=SAMPLE)
    if trace.outcome == "failed":
        yield _failed(str(run), trace)
        return
    model = bench.solve(case, own_model(run).support, rtol=1e-11, sample_step=SAMPLE)
    whole = len(trace.time) == len(model.time)

    def same(name: str, own: Array, other: Array, bound: Bound, more: str = "") -> Finding:
        part = f"{name} of a trace of {run.engine}{more}"
        return at_most(f"{name}, {run}", largest(own - other) if whole else math.nan, bound, part)

    for name, bound in FIELDS.items():
        yield same(name, getattr(trace, name), getattr(model, name), bound)
    rate, force = SWINGS[run.support]
    yield same("rolling_rate", trace.rolling_rate, model.rolling_rate, rate)
    forces = trace.contact_force[2:-2], model.contact_force[2:-2]
    yield same("contact force", *forces, force, ", or its vertical component")
    outside = np.hypot(*model.contact_point.T) - SQUAT.base_radius
    yield same("contact offset", trace.contact_offset, outside, PLACE)
    part = f"slip of a trace of {run.engine}, or its friction"
    yield at_most(f"slip, {run}", abs(trace.slip[-1]), PLACE, part)
    # the base centre is b sin(theta) above the ground on the rim, and the mass centre h along the axis
    s, c = math.sin(model.tilt[-1]), math.cos(model.tilt[-1])
    ahead = np.array([math.cos(model.rolling_angle[-1]), math.sin(model.rolling_angle[-1])])
    moved = math.hypot(*(model.centre_of_mass[-1, :2] - SQUAT.mass_centre_height * s * ahead))
    yield at_most(
        f"residual displacement and twist, {run}",
        max(abs(trace.residual_displacement - moved), abs(trace.residual_twist - model.twist[-1])),
        RESIDUAL,
        f"residual displacement or twist of a trace of {run.engine}",
        f"base centre {moved:.3g} m off, contact at cos {c:.2g}",
    )
    # what the ground's constant acceleration did on the way, from the positions of the trace itself
    work = -(trace.centre_of_mass - trace.centre_of_mass[0]) @ GROUND
    yield at_most(
        f"energy error against energy and work, {run}",
        largest(trace.energy - trace.energy[0] - work - trace.energy_error),
        BALANCE,
        f"energy error of a trace of {run.engine}, or how the acceleration reaches it",
    )


def _uplift(bench: Bench, engine: str, latest: Bound) -> Iterator[Finding]:
    run = bench.adjust(Run(engine, "recess"))
    trace = simulate_run(RAMP, run, sample_step=0.05)
    if trace.outcome == "failed":
        yield _failed(f"{engine}, ramp", trace)
        return
    vertical = ", or its vertical component"
    late = abs(trace.uplift_time - 0.8 / 2.5)
    yield at_most(f"instant of uplift, {engine}", late, latest, f"uplift of a trace of {engine}{vertical}")
    off = abs(math.remainder(trace.uplift_direction - math.atan2(-1.2, 1.6), 2.0 * math.pi))
    yield at_most(f"azimuth of uplift, {engine}", off, AZIMUTH, f"azimuth of uplift of a trace of {engine}")
    model = bench.solve(RAMP, rtol=1e-11, sample_step=0.05)
    apart = largest(trace.tilt - model.tilt) if len(trace.tilt) == len(model.tilt) else math.nan
    name = f"tilt after an uplift under a falling weight, {engine}"
    yield at_most(name, apart, RISE, f"uplift of {engine}{vertical}")
    part = f"peak tilt of a trace of {engine}"
    apart = abs(trace.peak_tilt - model.peak_tilt)
    yield at_most(f"peak of a run that ends while it rises, {engine}", apart, RISE, part)
    at = np.flatnonzero((trace.time > 0.04) & (trace.time < 0.31))
    ground = np.outer(trace.time[at] / 0.8, [-1.6, 1.2, -2.5]) * PIER.tan_alpha
    apart = largest(trace.contact_force[at] - ground - [0.0, 0.0, 1.0])
    part = f"contact force of a trace of {engine}{vertical}"
    yield at_most(f"contact force at rest, {engine}", apart, AT_REST, part)


def _passes(bench: Bench, engine: str) -> Iterator[Finding]:
    """A release that passes the upright position once, and rises again to its peak."""
    (trace,) = bench.traces([Job(case=RELEASE, run=bench.adjust(_run(engine, "recess", RELEASE)))])
    if trace.outcome == "failed":
        yield _failed(f"{engine}, release", trace)
        return
    model = bench.solve(RELEASE, rtol=1e-11)
    apart = abs(trace.peak_tilt - model.peak_tilt)
    yield at_most(f"peak, {engine}", apart, PEAK, f"peak tilt of a trace of {engine}")
    columns = ["time", "minimum_tilt", "angle_of_turn"]
    own, other = (found.passes[columns].to_numpy(dtype=float) for found in (trace, model))
    yield at_most(
        f"passes, {engine}",
        largest(own - other) if own.shape == other.shape else math.nan,
        PASS,
        f"turning points of a trace of {engine}",
        f"{len(own)} passes, {len(other)} of the model",
    )


def _lands(bench: Bench, engine: str) -> Finding:
    """A release without spin: its base meets the ground, which is a pass nearer than contact resolves."""
    (trace,) = bench.traces([Job(case=LANDING, run=bench.adjust(Run(engine, "recess")))])
    landing = bench.solve(LANDING, "planar").extrema[1, 0]
    late = abs(trace.first("unresolved_pass") - landing)
    part = f"turning points or diagnostics of a trace of {engine}: the first pass that is not resolved"
    return at_most(f"first pass that is not resolved, {engine}", late, FLAT_ON_THE_GROUND, part)


def _falls(bench: Bench, engine: str) -> Finding:
    """A release beyond alpha: it falls to its side, where the trace ends between two samples."""
    (trace,) = bench.traces([Job(case=FALL, run=bench.adjust(Run(engine, "flat")))])
    model = bench.solve(FALL, "planar")
    whole = trace.outcome == "overturned" and trace.tilt[-1] == 0.5 * math.pi == trace.peak_tilt
    late = abs(trace.time[-1] - model.time[-1]) if whole and (np.diff(trace.time) > 0.0).all() else math.nan
    part = f"samples or outcome of a trace of {engine} that ends early"
    return at_most(f"end of a fall, {engine}", late, ON_ITS_SIDE, part, f"{trace.outcome}, {why(trace)}")


def _slides(bench: Bench, engine: str) -> Finding:
    """A standing cylinder on ground that moves away under it: half of what friction does not hold, t^2."""
    friction, time = 0.1, 0.5
    # not of the size at which the engines run every scene, so that lengths and times differ from it
    small = Cylinder(semidiagonal=1.5, tan_alpha=0.2)
    case = Case(small, steady([0.12 * GRAVITY, -0.09 * GRAVITY], time), friction=friction, name="slide")
    trace = simulate_run(case, bench.adjust(Run(engine, "flat")))
    if trace.outcome == "failed":
        return _failed(f"{engine}, slide", trace)
    distance = 0.5 * (0.15 - friction) * GRAVITY * time**2
    off = (abs(trace.slip[-1] / distance - 1.0), abs(trace.residual_displacement / distance - 1.0))
    part = f"slip or residual displacement of a trace of {engine}, or its friction"
    return at_most(f"slip and displacement of a cylinder that slides, {engine}", max(off), SLIDE, part)


def _failed(name: str, trace: Trace) -> Finding:
    part = f"contact of {trace.run.engine}: the run failed"
    return at_most(f"{name} reaches its end", math.nan, ENDS, part, why(trace))
