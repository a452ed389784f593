"""Layer properties: one motion stated in several ways, which must give one response.

The motions have few and wide passes, so that rounding stays rounding; where a record of an earthquake
is needed, a perturbed copy shows how far it is magnified.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from rockwobble.models import Case, Cylinder, GroundMotion, InitialState, Trace, el_centro_1940

from ..bench import Bench, largest, tilts_apart
from ..finding import Bound, Finding, at_most
from ..problems import GRAVITY, MODELS, PIER, THRESHOLD, polyline, refined

RTOL = 1e-11
# some hundred steps and the one pass of these motions; 5e-11 was measured
SAME = Bound(1e-9, "the same motion; rounding of its steps", "alpha")
# on a large cylinder; 4e-11 was measured, as for a record 1e-9 stronger
SAMPLED = Bound(1e-8, "rtol 1e-8 over 3 s", "alpha")
# at rtol 1e-11, magnified by the passes on the way
BACKWARDS = Bound(1e-8, "no loss: tilt, angle and both rates come back", "rad, rad/s")
# rest threshold over alpha: the foreshock sits down, and what it is loses no more than that
REST = 1e-2
SHOCK_TIMES = (0.0, 0.5, 1.0, 1.5, 2.0)
SHOCK = THRESHOLD * np.array(
    [[0.0, 0.0, 0.0], [1.6, 1.2, 0.0], [-0.5, 1.5, 0.5], [-0.6, -0.9, -0.5], [0.0, 0.0, 0.0]]
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
    moved = np.ptp(alone.tilt) > 0.1 * PIER.alpha
    finer = [_run(bench, polyline(SHOCK_TIMES, SHOCK, step), 4.0, model) for step in (0.25, 0.125, 0.02)]
    apart = max(tilts_apart(alone, trace) for trace in finer) if moved else math.nan
    part = "samples of the record: steps that end at them"
    yield at_most(f"samples four to 25 times as dense, {model}", apart, SAME, part)
    later = GroundMotion(np.vstack([SHOCK, np.zeros((6, 3))]), 0.5)
    apart = tilts_apart(alone, _run(bench, later, 4.0, model)) if moved else math.nan
    yield at_most(f"still ground as part of the record, {model}", apart, SAME, "end of the record")
    # two weak shocks, across the direction of the main one; their size lets the base settle
    across = [1.0, 0.0, 0.0] if model == "planar" else [0.6, -0.8, 0.0]
    weak = 1.1 * THRESHOLD * np.array([[0.0, 0.0, 0.0], across, [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]])
    values = np.vstack([weak[:-1], weak, SHOCK[1:]])
    times = [0.0, 0.5, 1.0, 2.0, 2.5, 3.0, 4.0, 4.5, 5.0, 5.5, 6.0]
    both = _run(bench, polyline(times, values, 0.25), 8.0, model)
    rested = np.isnan(both.rolling_angle)
    begin = round(4.0 / _STEP)
    stands = bool(rested[round(2.0 / _STEP)] and rested[begin])
    rose = bool(0.0 < both.tilt[:begin].max() < REST * PIER.alpha)
    settled = stands and rose
    yield at_most(
        f"main shock after two weak ones and rest, against the main shock alone, {model}",
        largest(both.tilt[begin:] - alone.tilt) / PIER.alpha if settled else math.nan,
        SAME,
        "uplift after rest: what is kept of the motion before",
        "" if settled else "the weak shocks do not end in rest",
    )


def _sampled_record(bench: Bench) -> Finding:
    """El Centro by its own straight lines: an uplift next to a sample takes another path in each."""
    cylinder = Cylinder(semidiagonal=52.63085533795045, tan_alpha=0.2)
    motion = el_centro_1940()
    motion = motion.scaled(2.0962025316455697 * GRAVITY * cylinder.tan_alpha / motion.peak)
    motion = GroundMotion(motion.acceleration[: math.ceil(3.0 / motion.time_step) + 2], motion.time_step)
    plain, copy, *finer = (
        bench.solve(Case(cylinder, record, duration=3.0), sample_step=_STEP, rtol=1e-8)
        for record in (motion, motion.scaled(1.0 + 1e-9), refined(motion, 2), refined(motion, 5))
    )
    moved = bool(plain.tilt.max() > 0.0)
    return at_most(
        "El Centro, 0.01 s, sampled every 0.005 and 0.002 s, R = 52.6 m",
        max(tilts_apart(plain, trace) for trace in finer) if moved else math.nan,
        SAMPLED,
        "uplift next to a sample of the record, or after rest",
        f"a perturbed copy is off by {tilts_apart(plain, copy):.1e}",
    )


def _backwards(bench: Bench) -> Finding:
    """Free motion from where another ended, with its rates turned round, ends where that began."""
    apart = []
    for tan_alpha in (0.2, 1.0):
        cylinder = Cylinder(semidiagonal=6.0, tan_alpha=tan_alpha)
        begin = InitialState(0.5 * cylinder.alpha, tilt_rate=0.1, rolling_angle=0.4, rolling_rate=0.3)
        tilt, tilt_rate, angle, rate = _end(bench, cylinder, begin)
        back = _end(bench, cylinder, InitialState(tilt, -tilt_rate, angle, -rate))
        meant = (begin.tilt, -begin.tilt_rate, begin.rolling_angle, -begin.rolling_rate)
        apart += [abs(one - other) for one, other in zip(back, meant, strict=True)]
    part = "equations of motion, or rates of the response"
    return at_most("free motion run backwards, 4 s there and back", max(apart), BACKWARDS, part)


def _end(bench: Bench, cylinder: Cylinder, begin: InitialState) -> tuple[float, float, float, float]:
    case = Case(cylinder, initial=begin, duration=4.0)
    found = bench.solve(case, sample_step=4.0, rtol=RTOL, rest_tilt=0.0)
    last = found.tilt[-1], found.tilt_rate[-1], found.rolling_angle[-1], found.rolling_rate[-1]
    return float(last[0]), float(last[1]), float(last[2]), float(last[3])


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
        tilts_apart(lighter, falling),
        abs(lighter.uplift_time - falling.uplift_time),
    )
    return at_most(
        f"ground that falls with 0.3 g against a gravity of 0.7 g, {model}",
        apart if np.ptp(lighter.tilt) > 0.02 * PIER.alpha else math.nan,
        SAME,
        "vertical acceleration: uplift, motion, landing or rest",
    )


def _planar_at_first(bench: Bench) -> Finding:
    """One component, then the other, in any direction: rounding must not choose the side of a first pass."""
    values = np.array([[0.0, 0.0], [1.5, 0.0], [-1.2, 0.0], [0.5, 0.0], [0.0, 0.9], [0.0, -0.7], [0.0, 0.0]])
    motion = polyline(0.5 * np.arange(len(values)), values * THRESHOLD, 0.25)
    plain = _run(bench, motion, 4.0)
    turned = [_run(bench, motion.rotated(angle), 4.0) for angle in (0.3, 1.0, 2.0, 2.7, 4.0, 5.5)]
    apart = max(tilts_apart(plain, trace) for trace in turned) if np.ptp(plain.tilt) > 0.0 else math.nan
    part = "side of a first pass that is planar"
    return at_most("one component at first, rotated by six angles", apart, SAME, part)


def _run(
    bench: Bench, motion: GroundMotion, duration: float, model: str = "recess", *, gravity: float = GRAVITY
) -> Trace:
    case = Case(PIER, motion, duration=duration, gravity=gravity)
    return bench.solve(case, model, sample_step=_STEP, rtol=RTOL, rest_tilt=REST)
