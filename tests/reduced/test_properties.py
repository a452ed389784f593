"""Invariances of the response, on many random problems: sampling, rests, frames, motion after the end.

Each is told from sensitivity by perturbed copies: a problem counts only where these agree. How many count is
tested with it.
"""

import math

import numpy as np
import pytest
from shaken_problems import Problem, is_firm, joined, problem, resampled

from rockwobble.models import GroundMotion, Trace

FIRM = 1e-4  # largest difference of perturbed copies, of the peak: else too sensitive to compare
SAME = 2e-3  # of the peak: a tolerance of 1e-9, amplified as a perturbation of 1e-7 may be


def changed(x: Trace, y: Trace) -> bool:
    return x.outcome != y.outcome or not abs(x.peak_tilt - y.peak_tilt) <= SAME * x.peak_tilt


@pytest.mark.slow
def test_coarse_sampling_changes_no_response_of_large_cylinders():
    """Within one sample the ground acceleration may reverse; the first motion shows it."""
    count = 0
    for seed in range(60):
        given = problem(
            seed,
            sizes=(20.0, 500.0),
            slenderness=(0.05, 0.4),
            time_steps=(0.1, 0.2, 0.5),
            models=("recess", "flat"),
        )
        step = given.motion.time_step
        if math.isnan(given.simulate().uplift_time):
            continue
        until = given.simulate().uplift_time + 2.0 * step
        coarse, fine = (
            given.simulate(motion=motion, duration=until, sample_step=0.1 * step, rtol=1e-11)
            for motion in (given.motion, resampled(given.motion, 20))
        )
        reached = min(len(coarse.tilt), len(fine.tilt))
        if coarse.peak_tilt < 0.5 * given.cylinder.alpha and not len(coarse.passes):
            count += 1
            scale = 1e-6 * coarse.peak_tilt
            assert np.abs(coarse.tilt[:reached] - fine.tilt[:reached]).max() < scale, seed
    assert count > 30


def foreshock(given: Problem, excess: float, turning: float) -> GroundMotion:
    """Half a sine just above uplift, its azimuth turning, and still ground after it."""
    time_step = given.motion.time_step
    share = np.linspace(0.0, 1.0, max(12, round(0.6 / time_step)))
    size = given.threshold * (1.0 + excess) * np.sin(math.pi * share)
    angle = 0.4 + turning * share
    shaking = np.column_stack([size * np.cos(angle), size * np.sin(angle)])
    return GroundMotion(np.vstack([shaking, np.zeros((16, 2))]), time_step)


def lifting_just_before_a_sample(given: Problem) -> GroundMotion:
    """The horizontal motion, scaled so that a sample exceeds the threshold by 2e-4 and none before it."""
    horizontal = given.motion.acceleration[:, :2]
    size = np.hypot(*horizontal.T)
    first = int((size > 0.6 * size.max()).argmax())
    highest = size[: first + 1].max()
    return GroundMotion(horizontal * (1.0002 * given.threshold / highest), given.motion.time_step)


@pytest.mark.slow
def test_uplift_after_a_rest_equals_a_first_uplift():
    """Where the series of the uplift ends at a sample, the next step must be independent of the past."""
    count = 0
    for seed in range(200):
        given = problem(seed, slenderness=(0.05, 1.0), time_steps=(0.005,), models=("recess", "flat"))
        given = given._replace(motion=lifting_just_before_a_sample(given))
        first = foreshock(given, (0.1, 0.3, 0.6, 1.0)[seed % 4], 1 + seed % 3)
        options = {"rest_tilt": 3e-2, "sample_step": given.motion.time_step, "duration": 30.0}
        weak = given.simulate(motion=first, rest_tilt=3e-2)
        if weak.rests and len(weak.rest_intervals):
            count += 1
            alone = given.simulate(**options)
            both = given.simulate(motion=joined(first, given.motion), **options)
            begin = int(alone.uplift_time / given.motion.time_step) + 1
            later = begin + len(first.acceleration)
            # the times of the samples are rounded differently
            assert both.tilt[later : later + 10] == pytest.approx(alone.tilt[begin : begin + 10], rel=1e-8), (
                seed
            )
    assert count > 60


def planar_at_first(given: Problem, seed: int) -> GroundMotion:
    """Ground motion whose second component begins later."""
    acceleration = np.array(given.motion.acceleration)
    begin = (0.15 + 0.1 * (seed % 5)) * len(acceleration)
    acceleration[: int(begin), 1] = 0.0
    if seed % 2:
        acceleration[:, [0, 1]] = acceleration[:, [1, 0]]
    motion = GroundMotion(acceleration, given.motion.time_step)
    return motion.scaled(given.motion.peak / motion.peak)


@pytest.mark.slow
def test_a_record_rotated_by_any_angle_gives_the_rotated_response():
    firm, off = 0, []
    for seed in range(100):
        given = problem(seed, models=("recess", "flat"), slenderness=(0.05, 1.0))
        if given.chatters:
            continue
        given = given._replace(motion=planar_at_first(given, seed))
        plain = given.simulate()
        # where rounding in the first part chose a side, a copy with another first part shows nothing
        later = slice((seed + 1) % 2, (seed + 1) % 2 + 1)
        if is_firm(given, plain, FIRM, components=later):
            firm += 1
            turned = [given.simulate(motion=given.motion.rotated(angle)) for angle in (0.7, -2.3, 3.0)]
            off += [seed] * any(changed(plain, response) for response in turned)
    assert firm > 60
    assert not off


@pytest.mark.slow
def test_overturning_is_decided_over_still_ground():
    """Records cut in the middle of the strong part."""
    fell, later = 0, 0
    for seed in range(120):
        given = problem(seed, slenderness=(0.05, 0.5), released=seed % 4 == 0)
        if given.chatters:
            continue
        cut = round(0.4 * len(given.motion.acceleration)) * given.motion.time_step
        plain = given.simulate(duration=cut, rtol=1e-10)
        record = given.motion.acceleration[: round(cut / given.motion.time_step) + 1]
        motion = GroundMotion(record, given.motion.time_step)
        longer = cut + 30.0 / plain.source.problem.body.p  # twice the time that a decision takes
        padded = given.simulate(motion=motion, duration=longer, rtol=1e-10)
        assert (plain.outcome == "overturned") == (padded.outcome == "overturned"), seed
        if plain.outcome == "overturned":
            assert plain.peak_tilt == plain.tilt[-1] == 0.5 * math.pi
            assert plain.time[-1] == pytest.approx(padded.time[-1], rel=1e-6)
            fell, later = fell + 1, later + (plain.time[-1] > cut)
        else:
            assert plain.time[-1] == cut
    assert later > 10
    assert fell > later


def test_a_run_cut_anywhere_is_the_beginning_of_the_whole():
    for seed in range(20):
        given = problem(seed, released=seed % 2 == 0)
        step = given.motion.time_step
        whole = given.simulate(sample_step=step)
        index = len(given.motion.acceleration) // 2
        for beyond in (-1e-9, -1e-13, 0.0, 1e-13, 1e-9, 0.5 * step):
            part = given.simulate(sample_step=step, duration=index * step + beyond)
            count = min(index, len(whole.tilt))
            assert part.outcome != "failed"
            assert np.array_equal(part.tilt[:count], whole.tilt[:count])
