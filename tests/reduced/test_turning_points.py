"""Turning points of the tilt, two or more of which may fall within one step where samples are far apart."""

import math

import numpy as np
import pytest

from rockwobble import reduced
from rockwobble.models import Case, Cylinder, GroundMotion, InitialState, el_centro_1940

SAMPLE = 0.001  # [s]
STILL = 1e-8  # share of the largest tilt rate that counts as zero
PROBLEMS = 60
OPTIONS = {"recess": {"support": "recess"}, "flat": {"support": "flat"}, "planar": {"plane": 0.0}}


def rough(seed: int, time_step: float) -> Case:
    """Cylinder under ten seconds of noise with a coarse sample step."""
    random = np.random.default_rng(seed)
    cylinder = Cylinder(
        semidiagonal=random.choice([3.0, 6.0, 15.0, 30.0]), tan_alpha=random.uniform(0.08, 0.5)
    )
    strength = random.uniform(0.6, 1.5) * cylinder.tan_alpha * 9.81
    acceleration = strength * random.normal(size=(round(10.0 / time_step), 2))
    return Case(cylinder, GroundMotion(acceleration, time_step), duration=10.0)


@pytest.mark.slow
@pytest.mark.parametrize("time_step", [0.05, 0.1])
@pytest.mark.parametrize("model", OPTIONS)
def test_listed_turning_points_are_those_of_dense_samples(model: str, time_step: float) -> None:
    turned = 0
    for seed in range(PROBLEMS):
        trace = reduced.simulate(rough(seed, time_step), sample_step=SAMPLE, **OPTIONS[model])
        if trace.outcome == "overturned":
            continue
        assert trace.peak_tilt >= trace.tilt.max(), seed
        moving = np.isfinite(trace.rolling_angle)
        rising = np.diff(trace.tilt) > 0.0
        turns = 1 + np.flatnonzero(rising[1:] != rising[:-1])
        turns = turns[moving[turns - 1] & moving[turns] & moving[turns + 1]]
        times, tilts, _, _ = trace.extrema.T
        for turn in turns:
            assert np.abs(times - trace.time[turn]).min() < 2.0 * SAMPLE, (seed, trace.time[turn])
        turned += len(turns)
        result, _ = trace.source.problem.solve(times)
        turning = tilts > 0.0  # at a planar landing the base has a speed
        rates = np.abs(result.samples[turning, 1])
        assert rates.max() < STILL * np.abs(trace.tilt_rate).max(), (seed, times[turning][rates.argmax()])
    assert turned > 5 * PROBLEMS


def test_landing_and_rise_within_one_step_are_detected() -> None:
    """Rising tilt at both ends of the step that contains the landing; unseen, the landing became a fall."""
    scale = 0.5 + 1.5 * 6.0 / 39.0
    (cell,) = reduced.peak_tilts([2.0], 0.1, el_centro_1940(), [scale], plane=0.3).ravel()
    # the spatial model, by other equations and another method, under shaking along the plane
    motion = el_centro_1940().scaled(scale)
    push = motion.acceleration @ [math.cos(0.3), math.sin(0.3)]
    along = GroundMotion(np.column_stack([push, 0.0 * push]), motion.time_step)
    trace = reduced.simulate(Case(Cylinder(semidiagonal=2.0, tan_alpha=0.1), along))
    assert trace.outcome == "stands"
    assert cell == pytest.approx(trace.peak_tilt, rel=1e-6)


@pytest.mark.parametrize("rolling_rate", [1e-40, 1e-20, 1e-14])
def test_a_hop_in_one_step_does_not_end_below_upright(rolling_rate: float) -> None:
    """Between two turning points the tilt passes close to zero, which spin keeps it from reaching."""
    x = np.array([-17.1128, 0.2280, -10.5809])
    release = InitialState(tilt=1.516939e-3, tilt_rate=-5.659764e-2, rolling_rate=rolling_rate)
    cylinder = Cylinder(semidiagonal=7.566023, tan_alpha=0.2598229)
    motion = GroundMotion(np.column_stack([x, 0.0 * x]), 0.1)
    trace = reduced.simulate(Case(cylinder, motion, initial=release, duration=0.2))
    assert trace.outcome == "stands"
    assert trace.tilt.min() > 0.0
    assert trace.passes["angle_of_turn"].tolist() == pytest.approx([3.2647283], abs=1e-6)
