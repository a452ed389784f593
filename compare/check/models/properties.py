"""Layer: one motion stated in several ways, which must give one response.

The motions have few and wide passes, so that rounding stays rounding; where a record of an earthquake
is needed, a perturbed copy shows how far it is magnified.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from rockwobble.models import Case, Cylinder, GroundMotion, InitialState, el_centro_1940

from ..bench import Bench
from ..finding import Finding, at_most
from ..polyline import polyline, refined

LAYER = "properties"
GRAVITY = 9.81
CYLINDER = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
THRESHOLD = GRAVITY * CYLINDER.tan_alpha
MODELS = ("recess", "flat", "planar")
RTOL = 1e-11
# rounding of some hundred steps and the one pass of these motions; 5e-11 was measured
SAME = 1e-9
# El Centro on a large cylinder for 3 s at rtol 1e-8: 4e-11 was measured, as for a record 1e-9 stronger
SAMPLED, SECONDS = 1e-8, 3.0
# rest threshold over alpha: the foreshock sits down, and what it is loses no more than that
REST = 1e-2
BACKWARDS = 1e-8  # there and back at rtol 1e-11, magnified by the passes on the way
SHOCK_TIMES = (0.0, 0.5, 1.0, 1.5, 2.0)
SHOCK = (
    np.array(
        [[0.0, 0.0, 0.0], [1.6, 1.2, 0.0], [-0.5, 1.5, 0.5], [-0.6, -0.9, -0.5], [0.0, 0.0, 0.0]],
    )
    * THRESHOLD
)
_STEP = 0.05  # of the samples that are compared [s]


def check(bench: Bench) -> Iterator[Finding]:
    """Yield the findings of this layer."""
    for model in MODELS:
        yield from _one_motion(bench, model)
    yield _sampled_record(bench)
    yield _backwards(bench)
    for model in MODELS:
        yield _equivalence(bench, model)
    yield _planar_at_first(bench)


def _one_motion(bench: Bench, model: str) -> Iterator[Finding]:
    alone = _run(bench, polyline(SHOCK_TIMES, SHOCK, 0.5), 4.0, model)
    moved = np.ptp(alone.tilt) > 0.1 * CYLINDER.alpha
    finer = [_run(bench, polyline(SHOCK_TIMES, SHOCK, step), 4.0, model) for step in (0.25, 0.125, 0.02)]
    yield _same(
        f"samples four to 25 times as dense, {model}",
        max(_apart(alone, trace) for trace in finer) if moved else math.nan,
        "samples of the record: steps that end at them",
    )
    later = GroundMotion(np.vstack([SHOCK, np.zeros((6, 3))]), 0.5)
    yield _same(
        f"still ground as part of the record, {model}",
        _apart(alone, _run(bench, later, 4.0, model)) if moved else math.nan,
        "end of the record",
    )
    # two weak shocks, across the direction of the main one; their size lets the base settle
    across = [1.0, 0.0, 0.0] if model == "planar" else [0.6, -0.8, 0.0]
    weak = 1.1 * THRESHOLD * np.array([[0.0, 0.0, 0.0], across, [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]])
    values = np.vstack([weak[:-1], weak, SHOCK[1:]])
    times = [0.0, 0.5, 1.0, 2.0, 2.5, 3.0, 4.0, 4.5, 5.0, 5.5, 6.0]
    both = _run(bench, polyline(times, values, 0.25), 8.0, model)
    rested = np.isnan(both.rolling_angle)
    begin = round(4.0 / _STEP)
    stands = bool(rested[round(2.0 / _STEP)] and rested[begin])
    rose = bool(0.0 < both.tilt[:begin].max() < REST * CYLINDER.alpha)
    yield _same(
        f"main shock after two weak ones and rest, against the main shock alone, {model}",
        float(np.abs(both.tilt[begin:] - alone.tilt).max()) / CYLINDER.alpha if stands and rose else math.nan,
        "uplift after rest: what is kept of the motion before",
        "" if stands and rose else "the weak shocks do not end in rest",
    )


def _sampled_record(bench: Bench) -> Finding:
    """El Centro by its own straight lines: an uplift next to a sample takes another path in each."""
    cylinder = Cylinder(semidiagonal=52.63085533795045, tan_alpha=0.2)
    motion = el_centro_1940()
    motion = motion.scaled(2.0962025316455697 * GRAVITY * cylinder.tan_alpha / motion.peak)
    kept = math.ceil(SECONDS / motion.time_step) + 2
    motion = GroundMotion(motion.acceleration[:kept], motion.time_step)
    plain, copy, *finer = (
        bench.reduced.simulate(
            Case(cylinder, record, duration=SECONDS), sample_step=_STEP, rtol=1e-8
        )
        for record in (motion, motion.scaled(1.0 + 1e-9), refined(motion, 2), refined(motion, 5))
    )
    moved = bool(plain.tilt.max() > 0.0)
    return at_most(
        LAYER,
        "El Centro, 0.01 s, sampled every 0.005 and 0.002 s, R = 52.6 m",
        max(_apart(plain, trace, cylinder) for trace in finer) if moved else math.nan,
        SAMPLED,
        unit="alpha",
        reason="rtol 1e-8 over 3 s",
        part="uplift next to a sample of the record, or after rest",
        note=f"a perturbed copy is off by {_apart(plain, copy, cylinder):.1e}",
    )


def _backwards(bench: Bench) -> Finding:
    """Free motion from where another ended, with its rates turned round, ends where that began."""
    apart = []
    for tan_alpha in (0.2, 1.0):
        cylinder = Cylinder(semidiagonal=6.0, tan_alpha=tan_alpha)
        begin = InitialState(0.5 * cylinder.alpha, tilt_rate=0.1, rolling_angle=0.4, rolling_rate=0.3)
        options = {"sample_step": 4.0, "rtol": RTOL, "rest_tilt": 0.0}
        there = bench.reduced.simulate(Case(cylinder, initial=begin, duration=4.0), **options)
        turned = InitialState(
            float(there.tilt[-1]),
            tilt_rate=-float(there.tilt_rate[-1]),
            rolling_angle=float(there.rolling_angle[-1]),
            rolling_rate=-float(there.rolling_rate[-1]),
        )
        back = bench.reduced.simulate(Case(cylinder, initial=turned, duration=4.0), **options)
        apart += [
            abs(back.tilt[-1] - begin.tilt),
            abs(back.tilt_rate[-1] + begin.tilt_rate),
            abs(back.rolling_angle[-1] - begin.rolling_angle),
            abs(back.rolling_rate[-1] + begin.rolling_rate),
        ]
    return at_most(
        LAYER,
        "free motion run backwards, 4 s there and back",
        max(apart),
        BACKWARDS,
        unit="rad, rad/s",
        reason="no loss: tilt, angle and both rates come back",
        part="equations of motion, or rates of the response",
    )


def _equivalence(bench: Bench, model: str) -> Finding:
    """Ground that falls with 0.3 g all the time is a gravity of 0.7 g, in motion, at uplift and at rest."""
    fall = 0.3 * GRAVITY
    level = SHOCK * [0.8, 0.8, 0.0]
    values = np.vstack([np.zeros((1, 3)), 0.4 * level[:-1], level, np.zeros((1, 3))])
    times = np.arange(len(values)) * 0.5
    length = float(times[-1])
    lighter = _run(bench, polyline(times, values, 0.25), length, model, gravity=GRAVITY - fall)
    falling = _run(bench, polyline(times, values - [0.0, 0.0, fall], 0.25), length, model)
    apart = max(
        _apart(lighter, falling), abs(lighter.uplift_time - falling.uplift_time), _peak(lighter, falling)
    )
    return _same(
        f"ground that falls with 0.3 g against a gravity of 0.7 g, {model}",
        apart if np.ptp(lighter.tilt) > 0.02 * CYLINDER.alpha else math.nan,
        "vertical acceleration: uplift, motion, landing or rest",
    )


def _planar_at_first(bench: Bench) -> Finding:
    """One component, then the other, in any direction: rounding must not choose the side of a first pass."""
    values = np.array([[0.0, 0.0], [1.5, 0.0], [-1.2, 0.0], [0.5, 0.0], [0.0, 0.9], [0.0, -0.7], [0.0, 0.0]])
    motion = polyline(0.5 * np.arange(len(values)), values * THRESHOLD, 0.25)
    plain = _run(bench, motion, 4.0)
    turned = [_run(bench, motion.rotated(angle), 4.0) for angle in (0.3, 1.0, 2.0, 2.7, 4.0, 5.5)]
    return _same(
        "one component at first, rotated by six angles",
        max(_apart(plain, trace) for trace in turned) if np.ptp(plain.tilt) > 0.0 else math.nan,
        "side of a first pass that is planar",
    )


def _run(
    bench: Bench,
    motion: GroundMotion,
    duration: float,
    model: str = "recess",
    *,
    gravity: float = GRAVITY,
) -> Any:
    return bench.reduced.simulate(
        Case(CYLINDER, motion, duration=duration, gravity=gravity),
        sample_step=_STEP,
        rtol=RTOL,
        rest_tilt=REST,
        **bench.reduced.MODELS[model],
    )


def _apart(one: Any, other: Any, cylinder: Cylinder = CYLINDER) -> float:
    """Return the largest difference of tilts [alpha], and infinity where one ended earlier."""
    if len(one.tilt) != len(other.tilt):
        return math.inf
    return float(np.abs(one.tilt - other.tilt).max()) / cylinder.alpha


def _peak(one: Any, other: Any) -> float:
    return float(abs(one.peak_tilt - other.peak_tilt)) / CYLINDER.alpha


def _same(name: str, value: float, part: str, note: str = "") -> Finding:
    return at_most(
        LAYER,
        name,
        value,
        SAME,
        unit="alpha",
        reason="the same motion; rounding of its steps",
        part=part,
        note=note,
    )
