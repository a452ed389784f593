"""Layer rest, third part: what comes after the end of a record, and falls.

The ground is still after a record, at once where it ends in full swing. A cylinder that is then beyond its
balance, or has more energy than that of its balance, falls, however late its side reaches the ground.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from rockwobble.models import Case, GroundMotion, pulse

from ..bench import Array, Bench, largest
from ..finding import Bound, Finding, at_most, none_wrong
from ..problems import GRAVITY, MODELS, PIER, THRESHOLD, polyline, released, steady
from . import lagrange, quadrature
from .lagrange import shape_of

SOLUTION: dict[str, Any] = {"rtol": 1e-9, "rest_tilt": 1e-4}
# steps of rtol 1e-11; 1e-11 was measured
WORK = Bound(1e-9, "work of a constant force, from positions; none on still ground")
ENERGY = Bound(1e-9, "the ground is still")
PEAK = Bound(1e-12, "nothing later can stop a fall that is called certain; rounding of the scale", "alpha")
# of a sine that lasts 1.2 s, over the threshold: from no uplift to a fall during the pulse, and none of
# them within 3 % of the energy of the balance
SCALES = (0.9, 1.5, 2.5, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0)
# push, length and weight of later shaking that brings falls back
STOPPED = {
    "later shaking": (3.4, 2.0, 1.0),
    "later shaking with a tenth of the weight": (3.3, 2.0, 0.1),
    "later shaking while the ground falls faster than g": (3.8, 2.5, -0.1),
}
AFTER = "end of the record: what the ground does after it"
FALL = "fall after the end of the record"


def check(bench: Bench) -> Iterator[Finding]:
    """Yield the findings of this part."""
    yield _work_until_the_end(bench)
    # a record that ends in full swing
    values = [[0.0, 0.0, 0.0], [1.6, 0.9, 0.3], [-0.5, 1.2, -0.3], [0.9, -0.4, 0.5], [0.8, -0.6, 0.6]]
    record = polyline([0.0, 0.5, 1.0, 1.5, 1.6], np.array(values) * THRESHOLD, 0.1)
    for model in MODELS:
        case = Case(PIER, record, duration=2.6)
        found = bench.solve(case, model, sample_step=0.05, rtol=1e-11, rest_tilt=0.0)
        after = found.energy[np.searchsorted(found.time, 1.6 - 1e-9) :]
        apart = np.ptp(after) / after[0] if after[0] > 0.0 else math.nan
        name = f"energy after the end of a record that ends in full swing, {model}"
        yield at_most(name, apart, ENERGY, AFTER)
    yield _falls_in_a_plane(bench)
    yield _falls_with_spin(bench)
    for name, each in STOPPED.items():
        yield _brought_back(bench, name, *each)


def _work_until_the_end(bench: Bench) -> Finding:
    """Even acceleration: the energy changes by its work, until the record ends and no longer."""
    ground, end = np.array([0.06, -0.04, 0.2]) * GRAVITY, 0.9
    shape = shape_of(PIER)
    case = dataclasses.replace(released(0.5, 0.4, 2.0), motion=steady(ground, end))
    found = bench.solve(case, sample_step=0.05, rtol=1e-11, rest_tilt=0.0)
    place = lagrange.mass_centre(shape, found.tilt, found.rolling_angle)
    last = np.minimum(np.arange(len(found.time)), round(end / 0.05))
    work = -(place[last] - place[0]) @ ground
    energy = lagrange.energy(shape, found.tilt, found.rolling_angle, found.tilt_rate, found.rolling_rate)
    return at_most(
        "energy against the work of an even acceleration, and after its end",
        largest(energy - energy[0] - work) / energy.max(),
        WORK,
        "end of the record: the last of its pieces, or what the ground does after it",
    )


def _falls_in_a_plane(bench: Bench) -> Finding:
    """A pulse that ends in the middle of a fall."""
    motion = pulse("one-sine", amplitude=THRESHOLD, period=1.2, azimuth=0.3)
    shape = shape_of(PIER)
    balance = quadrature.height_energy(shape, np.array([PIER.alpha]))[0]
    wrong = []
    for scale, peak in zip(SCALES, _peaks(bench, motion, SCALES), strict=True):
        found = bench.solve(Case(PIER, motion.scaled(scale)), sample_step=0.1, **SOLUTION)
        at = int(np.argmin(np.abs(found.time - motion.duration)))
        tilt, rate = found.tilt[at : at + 1], found.tilt_rate[at]
        energy = 0.5 * quadrature.tilt_inertia(shape) * rate**2 + quadrature.height_energy(shape, tilt)[0]
        falls = bool(tilt[0] > PIER.alpha or energy > balance)
        if falls != (found.outcome == "overturned"):
            wrong.append(f"simulate at {scale:g}: {found.outcome}")
        if falls != (peak == 0.5 * math.pi):
            wrong.append(f"peak_tilts at {scale:g}: {peak / PIER.alpha:.3g} alpha")
    name = f"wrong endings of {2 * len(SCALES)} runs whose record ends as they move, one direction"
    reason = "beyond the balance, or with more than its energy, a cylinder falls on still ground"
    return none_wrong(name, wrong, reason, FALL)


def _falls_with_spin(bench: Bench) -> Finding:
    """With spin the energy does not decide alone: held against still ground that is part of the record."""
    values = np.array([[0.0, 0.0], [0.9, 0.5], [-0.6, 1.0], [0.0, 0.0]]) * THRESHOLD
    both = polyline([0.0, 0.4, 0.8, 1.2], values, 0.1)
    still = GroundMotion(np.vstack([both.acceleration, np.zeros((200, 2))]), 0.1)
    scales = (1.5, 3.0, 4.5, 6.0, 9.0)
    ends, goes_on = (_peaks(bench, motion, scales) == 0.5 * math.pi for motion in (both, still))
    changed = [f"at {scale:g}" for scale in np.array(scales)[ends != goes_on]]
    name = f"overturning that still ground at the end of the record changes, of {len(scales)} runs"
    reason = "the ground is still after a record, too"
    return none_wrong(name, changed, reason, FALL, made=bool(0 < goes_on.sum() < len(scales)))


def _brought_back(bench: Bench, name: str, push: float, length: float, weight: float) -> Finding:
    """Falls that later shaking stops, of which half of it or the whole weight would make certain ones.

    The loss at the landing lets the cylinder that came back stand.
    """
    apart, back = [], 0
    times = [0.0, 0.5, 1.0, 2.0, 2.25, 2.25 + length, 2.5 + length, 10.0]
    options = {**SOLUTION, "restitution": 0.6}
    for strength in np.arange(0.1, 3.0, 0.1):
        along = THRESHOLD * np.array([0.0, -push, 0.0, 0.0, strength, strength, 0.0, 0.0])
        up = (weight - 1.0) * GRAVITY * np.array([0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0])
        record = polyline(times, np.column_stack([along, 0.0 * along, up]), 0.25)
        whole = bench.solve(Case(PIER, record), "planar", sample_step=1.0, **options)
        # a scale of two on half of the record: the same numbers, and the scale is there
        (early,) = _peaks(bench, record.scaled(0.5), (2.0,), plane=0.0, restitution=0.6)
        apart.append(abs(whole.peak_tilt - early) / PIER.alpha)
        back += whole.outcome != "overturned" and whole.peak_tilt > PIER.alpha
    return at_most(
        f"peaks with and without an early end of a certain fall, {name}",
        max(apart) if back else math.nan,
        PEAK,
        "when a fall is called certain: strongest and lightest of what is to come",
        f"{back} of {len(apart)} falls are brought back",
    )


def _peaks(bench: Bench, motion: GroundMotion, scales: Sequence[float], **options: Any) -> Array:
    sizes = [PIER.semidiagonal]
    found = bench.reduced.peak_tilts(sizes, PIER.tan_alpha, motion, scales, workers=1, **SOLUTION, **options)
    return np.asarray(found[0])
