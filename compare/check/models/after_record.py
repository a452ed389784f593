"""Layer rest, third part: what comes after the end of a record, and falls.

The ground is still after a record, at once where it ends in full swing. A cylinder that is then beyond its
balance, or has more energy than that of its balance, falls, however late its side reaches the ground.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rockwobble.models import Case, Cylinder, GroundMotion, InitialState, pulse

from ..bench import Bench
from ..finding import Finding, at_most
from ..polyline import polyline, steady
from . import lagrange, quadrature
from .lagrange import shape_of

LAYER = "rest"
GRAVITY = 9.81
CYLINDER = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
THRESHOLD = GRAVITY * CYLINDER.tan_alpha
SOLUTION: dict[str, Any] = {"rtol": 1e-9, "rest_tilt": 1e-4}
# steps of rtol 1e-11; 1e-11 was measured
ENERGY = 1e-9
# of a sine that lasts 1.2 s, over the threshold: from no uplift to a fall during the pulse, and none of
# them within 3 % of the energy of the balance
SCALES = (0.9, 1.5, 2.5, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0)
PEAK = 1e-12  # [alpha] the same run: rounding of the scale


def check(bench: Bench) -> Iterator[Finding]:
    """Yield the findings of this part."""
    yield _work_until_the_end(bench)
    for model in ("recess", "flat", "planar"):
        yield _energy_after(bench, model)
    yield from _falls_after(bench)
    yield from _brought_back(bench)


def _work_until_the_end(bench: Bench) -> Finding:
    """Even acceleration: the energy changes by its work, until the record ends and no longer."""
    ground, end = np.array([0.06, -0.04, 0.2]) * GRAVITY, 0.9
    shape = shape_of(CYLINDER, GRAVITY)
    found = bench.reduced.simulate(
        Case(
            CYLINDER,
            steady(ground, end),
            initial=InitialState(tilt=0.5 * CYLINDER.alpha, rolling_rate=0.4),
            duration=2.0,
            gravity=GRAVITY,
        ),
        sample_step=0.05,
        rtol=1e-11,
        rest_tilt=0.0,
    )
    place = lagrange.mass_centre(shape, found.tilt, found.rolling_angle)
    state = found.tilt, found.rolling_angle, found.tilt_rate, found.rolling_rate
    last = np.minimum(np.arange(len(found.time)), round(end / 0.05))
    work = -(place[last] - place[0]) @ ground
    energy = lagrange.energy(shape, *state)
    return at_most(
        LAYER,
        "energy against the work of an even acceleration, and after its end",
        np.abs(energy - energy[0] - work).max() / energy.max(),
        ENERGY,
        reason="work of a constant force, from positions; none on still ground",
        part="end of the record: the last of its pieces, or what the ground does after it",
    )


def _energy_after(bench: Bench, model: str) -> Finding:
    """A record that ends in full swing."""
    end = 1.6
    values = np.array(
        [[0.0, 0.0, 0.0], [1.6, 0.9, 0.3], [-0.5, 1.2, -0.3], [0.9, -0.4, 0.5], [0.8, -0.6, 0.6]]
    )
    found = bench.reduced.simulate(
        Case(
            CYLINDER,
            polyline([0.0, 0.5, 1.0, 1.5, end], values * THRESHOLD, 0.1),
            duration=2.6,
            gravity=GRAVITY,
        ),
        sample_step=0.05,
        rtol=1e-11,
        rest_tilt=0.0,
        **bench.reduced.MODELS[model],
    )
    after = found.energy[np.searchsorted(found.time, end - 1e-9) :]
    return at_most(
        LAYER,
        f"energy after the end of a record that ends in full swing, {model}",
        np.ptp(after) / after[0] if after[0] > 0.0 else math.nan,
        ENERGY,
        reason="the ground is still",
        part="end of the record: what the ground does after it",
    )


def _falls_after(bench: Bench) -> Iterator[Finding]:
    """A pulse that ends in the middle of a fall."""
    motion = pulse("one-sine", amplitude=THRESHOLD, period=1.2, azimuth=0.3)
    shape = shape_of(CYLINDER, GRAVITY)
    balance = quadrature.height_energy(shape, np.array([CYLINDER.alpha]))[0]
    peaks = _peaks(bench, motion, SCALES)
    wrong = []
    for scale, peak in zip(SCALES, peaks, strict=True):
        found = bench.reduced.simulate(Case(CYLINDER, motion.scaled(scale)), sample_step=0.1, **SOLUTION)
        at = int(np.argmin(np.abs(found.time - motion.duration)))
        tilt, rate = found.tilt[at : at + 1], found.tilt_rate[at]
        energy = 0.5 * quadrature.tilt_inertia(shape) * rate**2 + quadrature.height_energy(shape, tilt)[0]
        falls = bool(tilt[0] > CYLINDER.alpha or energy > balance)
        if falls != (found.outcome == "overturned"):
            wrong.append(f"simulate at {scale:g}: {found.outcome}")
        if falls != (peak == 0.5 * math.pi):
            wrong.append(f"peak_tilts at {scale:g}: {peak / CYLINDER.alpha:.3g} alpha")
    yield at_most(
        LAYER,
        f"wrong endings of {2 * len(SCALES)} runs whose record ends as they move, one direction",
        len(wrong),
        0.0,
        reason="beyond the balance, or with more than its energy, a cylinder falls on still ground",
        part="fall after the end of the record",
        note="; ".join(wrong),
    )
    # with spin the energy does not decide alone: held against still ground that is part of the record
    both = polyline(
        [0.0, 0.4, 0.8, 1.2],
        np.array([[0.0, 0.0], [0.9, 0.5], [-0.6, 1.0], [0.0, 0.0]]) * THRESHOLD,
        0.1,
    )
    still = GroundMotion(np.vstack([both.acceleration, np.zeros((200, 2))]), 0.1)
    scales = (1.5, 3.0, 4.5, 6.0, 9.0)
    ends, goes_on = (_peaks(bench, motion, scales) == 0.5 * math.pi for motion in (both, still))
    yield at_most(
        LAYER,
        f"overturning that still ground at the end of the record changes, of {len(scales)} runs",
        float(np.count_nonzero(ends != goes_on)) if 0 < goes_on.sum() < len(scales) else math.nan,
        0.0,
        reason="the ground is still after a record, too",
        part="fall after the end of the record",
    )


def _brought_back(bench: Bench) -> Iterator[Finding]:
    """Falls that later shaking stops, of which half of it or the whole weight would make certain ones.

    The loss at the landing lets the cylinder that came back stand.
    """
    for name, push, length, weight in (
        ("later shaking", 3.4, 2.0, 1.0),
        ("later shaking with a tenth of the weight", 3.3, 2.0, 0.1),
        ("later shaking while the ground falls faster than g", 3.8, 2.5, -0.1),
    ):
        apart, back = [], 0
        times = [0.0, 0.5, 1.0, 2.0, 2.25, 2.25 + length, 2.5 + length, 10.0]
        for strength in np.arange(0.1, 3.0, 0.1):
            along = THRESHOLD * np.array([0.0, -push, 0.0, 0.0, strength, strength, 0.0, 0.0])
            up = (weight - 1.0) * GRAVITY * np.array([0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0])
            record = polyline(times, np.column_stack([along, 0.0 * along, up]), 0.25)
            options = {**SOLUTION, "plane": 0.0, "restitution": 0.6}
            whole = bench.reduced.simulate(Case(CYLINDER, record), sample_step=1.0, **options)
            # a scale of two on half of the record: the same numbers, and the scale is there
            (early,) = _peaks(bench, record.scaled(0.5), (2.0,), plane=0.0, restitution=0.6)
            apart.append(abs(whole.peak_tilt - early) / CYLINDER.alpha)
            back += whole.outcome != "overturned" and whole.peak_tilt > CYLINDER.alpha
        yield at_most(
            LAYER,
            f"peaks with and without an early end of a certain fall, {name}",
            max(apart) if back else math.nan,
            PEAK,
            unit="alpha",
            reason="nothing later can stop a fall that is called certain",
            part="when a fall is called certain: strongest and lightest of what is to come",
            note=f"{back} of {len(apart)} falls are brought back",
        )


def _peaks(bench: Bench, motion: GroundMotion, scales: Any, **options: Any) -> NDArray[np.float64]:
    found = bench.reduced.peak_tilts(
        [CYLINDER.semidiagonal], CYLINDER.tan_alpha, motion, scales, workers=1, **SOLUTION, **options
    )
    return np.asarray(found[0])
