"""Layer traces, third part: rings of walls, and falls that go on past the end of their record."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from rockwobble.models import Case, Cylinder, Run
from rockwobble.multibody.engines.registry import find_engine
from rockwobble.multibody.scene.ring_geometry import clearance_needed

from ...runs.execution import simulate_run
from ..bench import Bench, engines_here, largest
from ..finding import Bound, Finding, at_most, worst_of
from ..problems import PIER, THRESHOLD, steady
from .traces import SHAKEN, SQUAT

# cylinder, tilt and inclination of the walls; the last lean as much as the cylinder
LEANS = ((PIER, 0.1, 0.02), (PIER, 0.15, 0.0), (SQUAT, 0.6, 0.3), (SQUAT, 0.5, 0.1), (PIER, 0.1, 0.1))
REACH = Bound(1e-6, "the points of both rims, 0.1 deg apart", "b")
CLEARANCE = 0.01  # [b]
ROLLED_OUT = Case(SQUAT, initial=SHAKEN.initial, duration=1.0, name="rolls out")
SAME = Bound(0.0, "nothing touches a wall: the same run", "rad")
TOUCH = Bound(
    0.01, "when the model's contact point is as far out; 0.005 was measured, 128 walls for a circle", "s"
)
# the push ends while the cylinder falls, between two samples; from 1.3 rad on contact is open
CUT_OFF = Case(PIER, steady(np.array([2.4, 1.8]) * THRESHOLD, 0.8), duration=0.8, name="cut off")
HELD = 1.0  # [rad]
FALL = Bound(3e-4, "error of contact at the default step; 7e-5 was measured", "rad")
FORCE = Bound(2e-3, "error of contact, as means over 125 steps; 5e-4 was measured", "weights")
WHOLE = Bound(0.0, "a fall takes what it takes, and every sample of it is there")


def check(bench: Bench) -> Iterator[Finding]:
    """Yield the findings of this part; the first says which engines are not installed."""
    errors = {
        f"tilt {tilt:g}, walls {inclination:g} rad": clearance_needed(cylinder, tilt, inclination)
        - _reach(cylinder, tilt, inclination)
        for cylinder, tilt, inclination in LEANS
    }
    yield worst_of("clearance that a ring needs", errors, REACH, "geometry of a ring")
    for engine in engines_here(bench.engines):
        yield from _falls(bench, engine)
        if "ring" in find_engine(engine).supports:
            yield from _rolls_out(bench, engine)


def _reach(cylinder: Cylinder, tilt: float, inclination: float) -> float:
    """Return how far the points of both rims come over the walls of a ring at its foot, in base radii."""
    turn, azimuth = np.radians(0.1 * np.arange(3600)), np.radians(np.arange(0.0, 181.0, 0.5))[:, None]
    b, height = cylinder.base_radius, 2.0 * cylinder.half_height
    s, c = math.sin(tilt), math.cos(tilt)
    furthest = 0.0
    for level in (0.0, height):
        # tilted about the contact point, which stays on the original circle at x = b
        x, y = c * (b * np.cos(turn) - b) + s * level + b, b * np.sin(turn)
        z = -s * (b * np.cos(turn) - b) + c * level
        outward = (x * np.cos(azimuth) + y * np.sin(azimuth)) * math.cos(inclination)
        furthest = max(furthest, float((outward - z * math.sin(inclination)).max()))
    return max(furthest / (b * math.cos(inclination)) - 1.0, 0.0)


def _rolls_out(bench: Bench, engine: str) -> Iterator[Finding]:
    """On flat ground until it has rolled out as far as the walls stand back."""
    part = f"walls of a ring in {engine} (multibody/scene)"
    walls = {"ring_clearance": CLEARANCE, "ring_inclination": 1.0}
    ring, flat = (
        simulate_run(ROLLED_OUT, bench.adjust(run))
        for run in (Run(engine, "ring", **walls), Run(engine, "flat"))
    )
    touched = ring.first("wall_contact")
    before = ring.time < touched
    apart = largest(ring.tilt[before] - flat.tilt[before]) if len(ring.time) == len(flat.time) else math.nan
    yield at_most(f"tilt in a ring before it is touched, {engine}", apart, SAME, part)
    model = bench.solve(ROLLED_OUT, "flat", rtol=1e-11, sample_step=1e-3)
    outside = np.hypot(*model.contact_point.T) / SQUAT.base_radius - 1.0
    expected = float(np.interp(CLEARANCE, outside, model.time))
    yield at_most(f"first contact with a wall, {engine}", abs(touched - expected), TOUCH, part)


def _falls(bench: Bench, engine: str) -> Iterator[Finding]:
    part = f"a run of {engine} past the end of its record (multibody/recording)"
    trace = simulate_run(CUT_OFF, bench.adjust(Run(engine, "flat")), sample_step=0.06)
    model = bench.solve(CUT_OFF, "flat", rtol=1e-11, sample_step=0.06)
    held = model.tilt < HELD
    whole = trace.outcome == model.outcome == "overturned" and len(trace.time) >= held.sum()
    count = int(held.sum()) if whole else 0
    name = f"fall that the record cuts off, {engine}"
    yield at_most(f"tilt of a {name}", largest(trace.tilt[:count] - model.tilt[:count]), FALL, part)
    # without the first samples and the last, which have half a window
    forces = trace.contact_force[2:count], model.contact_force[2:count]
    yield at_most(f"contact force of a {name}", largest(forces[0] - forces[1]), FORCE, part)
    times = np.abs(trace.time[:count] - model.time[:count]) < 1e-12
    ends = trace.peak_tilt == 0.5 * math.pi and len(trace.contact_force) == len(trace.time) > count
    yield at_most(f"samples of a {name}", float(not (times.all() and ends)), WHOLE, part)
