"""Layer invariance: changes of frame and scale that must not change the response."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from rockwobble.models import Case, Cylinder, GroundMotion, Trace, el_centro_1940

from ..bench import Array, Bench
from ..finding import Bound, Finding, at_most, worst_of
from ..problems import GRAVITY, PIER, refined

DURATION, RTOL = 6.0, 1e-10
EXACT = Bound(0.0, "exact in binary arithmetic", "alpha")
# of every step, and one of the record; 1e-12 was measured
ROUNDING = Bound(1e-9, "rounding, magnified by the passes of 6 s", "alpha")
IN_PLANE = Bound(0.0, "exact in binary arithmetic", "alpha, weights, m")
ANGLE = Bound(100.0 * ROUNDING.most, ROUNDING.reason, "alpha")


def check(bench: Bench) -> Iterator[Finding]:
    """Yield the findings of this layer."""
    motion = el_centro_1940().scaled(2.0)
    a, step = motion.acceleration, motion.time_step

    def run(
        motion: GroundMotion,
        cylinder: Cylinder = PIER,
        *,
        duration: float = DURATION,
        sample_step: float = 0.01,
        gravity: float = GRAVITY,
    ) -> Trace:
        case = Case(cylinder, motion, duration=duration, gravity=gravity)
        return bench.solve(case, sample_step=sample_step, rtol=RTOL)

    plain = run(motion)

    def same(name: str, tilt: Array, bound: Bound, part: str) -> Finding:
        count = min(len(plain.tilt), len(tilt)) - 1  # the last sample is the end, wherever it is
        return at_most(name, np.abs(plain.tilt[:count] - tilt[:count]).max() / PIER.alpha, bound, part)

    mirrored = run(GroundMotion(a * [1.0, -1.0], step))
    yield same("mirror image", mirrored.tilt, EXACT, "equations: a term that prefers one side")
    four = Cylinder(semidiagonal=24.0, tan_alpha=0.2)
    large = run(GroundMotion(a, 2.0 * step), four, duration=2.0 * DURATION, sample_step=0.02)
    absolute = "a length or time that is absolute"
    yield same("four times the size in twice the time", large.tilt, EXACT, absolute)
    turned = run(motion.rotated(2.0))
    components = "components of the record, or their signs"
    yield same("record rotated by 2 rad", turned.tilt, ROUNDING, components)
    off = turned.rolling_angle - plain.rolling_angle - 2.0
    angle = np.nanmax(np.abs(off - 2.0 * math.pi * np.round(off / (2.0 * math.pi))))
    yield at_most("rolling angle with the record rotated", angle, ANGLE, components)
    late = 32.0 * step
    delayed = run(GroundMotion(np.vstack([np.zeros((32, 2)), a]), step), duration=DURATION + late)
    part = "time of the record's samples"
    yield same("record that begins later", delayed.tilt[round(late / 0.01) :], ROUNDING, part)
    slow = 1.0 / math.sqrt(0.7)
    weaker = run(
        GroundMotion(a * 0.7, step / math.sqrt(0.7)),
        duration=DURATION * slow,
        sample_step=0.01 * slow,
        gravity=GRAVITY * 0.7,
    )
    part = "gravity, or a time that is absolute"
    yield same("weaker gravity in slower time", weaker.tilt, ROUNDING, part)
    between = run(refined(motion, 2))
    yield same("record with samples halfway between", between.tilt, ROUNDING, "samples of the record")
    fine = run(motion, sample_step=0.005)
    yield same("output twice as often", fine.tilt[::2], EXACT, "output that influences the steps")
    yield _planar(bench, motion)


def _planar(bench: Bench, motion: GroundMotion) -> Finding:
    """Planar motion and its forces under a record, with and without what shakes across the plane."""
    inside = GroundMotion(motion.acceleration * [1.0, 0.0], motion.time_step)
    one, other = (bench.solve(Case(PIER, each, duration=DURATION), "planar") for each in (motion, inside))
    differences = {
        name: np.nanmax(np.abs(getattr(one, name) - getattr(other, name)))
        for name in ("tilt", "contact_force", "friction_needed", "restraining_moment")
    }
    part = "planar motion: the component of the record in its plane"
    return worst_of("planar motion under a record that leaves its plane", differences, IN_PLANE, part)
