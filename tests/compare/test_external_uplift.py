from __future__ import annotations

import itertools
import math

import numpy as np
import pandas as pd
import pytest

from rockwobble import comparison, reduced
from rockwobble.compare import read_trajectory
from rockwobble.compare.external.trajectory import uplift
from rockwobble.compare.external.verdict import first_passage, uplift_differences
from rockwobble.models import Case, Cylinder, el_centro_1940

BODIES = [
    (Cylinder(semidiagonal=6.0, tan_alpha=0.2), 2.0),
    (Cylinder(semidiagonal=10.0, tan_alpha=0.1), 1.0),
    (Cylinder(semidiagonal=1.0, tan_alpha=0.35), 2.5),
    (Cylinder(semidiagonal=3.0, tan_alpha=1.0), 5.0),
]


def test_uplift_of_power_law_growth_is_found_within_two_samples():
    time = 0.02 * np.arange(100)
    for power, begin in itertools.product((2, 3, 4), (0.613, 0.6205)):
        tilt = 0.5 * np.maximum(time - begin, 0.0) ** power
        start = uplift(time, tilt, 0.3 + time, stands=1e-6)
        # the cube root of another power is curved: by less than a sample; of its own power, rounding
        assert start.time == pytest.approx(begin, abs=1e-9 if power == 3 else 0.02)
        # the direction is that of the first tilted sample, at most (2e-6)^(1/4) s and a sample later
        assert 0.0 <= start.direction - (0.3 + begin) < 0.0376 + 0.02
    ones = np.ones(100)  # a release, and a body at rest
    assert uplift(time, 0.1 * ones, ones, stands=1e-3) == (0.0, 1.0, 0)
    still = uplift(time, 0.0 * ones, ones, stands=1e-3)
    assert (still.first, math.isnan(still.time)) == (None, True)


def shaken(body, scale):
    return Case(body, el_centro_1940().scaled(scale), duration=6.0, name="shaken")


def trace_of(case, sample_step):
    return reduced.simulate(Case(case.cylinder, case.motion, duration=case.duration), sample_step=sample_step)


def file_of(trace, noise=0.0, seed=0):
    generator = np.random.default_rng(seed)
    count = np.count_nonzero(trace.time <= trace.case.length)  # without the fall after it
    lean = (np.sin(trace.tilt) * np.exp(1j * np.nan_to_num(trace.rolling_angle)))[:count]
    lean = lean + noise * (generator.normal(size=len(lean)) + 1j * generator.normal(size=len(lean)))
    return pd.DataFrame(
        {"time": trace.time[:count], "tilt [rad]": np.arcsin(np.abs(lean)), "azimuth [rad]": np.angle(lean)}
    )


@pytest.mark.slow
@pytest.mark.parametrize("sample_step", [0.004, 0.01, 0.02])
@pytest.mark.parametrize(("body", "scale"), BODIES)
def test_uplifts_of_right_samples_agree_within_their_uncertainty(save, body, scale, sample_step):
    case = shaken(body, scale)
    trace, reference = trace_of(case, sample_step), trace_of(case, 0.01)
    for noise, seeds in ((0.0, 1), (0.001, 4), (0.005, 4)):
        for seed in range(seeds):
            trajectory = read_trajectory(save(file_of(trace, noise * body.alpha, seed)), case)
            time, direction = uplift_differences(trajectory, reference)
            assert abs(time.size) <= time.bound, (noise, seed)
            assert not time.differs
            assert abs(direction.size) <= direction.bound, (noise, seed)
            if not noise:
                # half a sample, and the curvature of coarse samples, which counts as noise
                assert time.bound <= 0.5 * sample_step + 0.02
                assert abs(direction.size) < 0.1


@pytest.mark.parametrize("sample_step", [0.01, 0.02])
def test_a_late_clock_shows_in_the_uplift(save, sample_step):
    case, late = shaken(*BODIES[0]), 0.06  # some samples
    table = file_of(trace_of(case, sample_step))
    waits = pd.DataFrame({"time": np.arange(0.0, late - 1e-9, sample_step)})
    table = pd.concat([waits, table.assign(time=table["time"] + late)]).fillna(0.0)
    (row,) = comparison(case, runs=[], external=[save(table)], workers=1).rows(case.name).to_dict("records")
    assert row["uplift_time_difference"] == pytest.approx(late, abs=row["uplift_time_uncertainty"])
    assert row["uplift_time_uncertainty"] <= 0.5 * sample_step + 0.01
    assert "uplift_time" in row["differs_in"]


def test_the_first_passage_of_a_ramp_is_its_cube_root():
    class Ramp:
        time = 0.01 * np.arange(200)
        tilt = 2.0 * np.maximum(time - 0.503, 0.0) ** 3
        uplift_time = 0.503

    for tilt in (1e-8, 1e-5, 1e-3):
        passage = 0.503 + (0.5 * tilt) ** (1.0 / 3.0)
        assert first_passage(Ramp(), tilt) == pytest.approx(passage, abs=1e-9)  # exact but for rounding
    assert first_passage(Ramp(), 100.0) == math.inf
