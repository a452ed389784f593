"""What must not change the response, on many random problems: sampling, rests, frames, what follows the end.

Each is told from sensitivity by perturbed copies: a problem counts only where these agree. How many count is
tested with it.
"""

import dataclasses
import math

import numpy as np
import pytest
from shaken_problems import G, Problem, is_firm, joined, problem, resampled

from rockwobble import reduced
from rockwobble.models import Case, Cylinder, GroundMotion, InitialState, Trace

FIRM = 1e-4  # of the peak that perturbed copies may differ by: beyond it a problem says nothing
SAME = 2e-3  # of the peak: the tolerance of 1e-9, amplified as that of a perturbed copy of 1e-7 may be


def changed(x: Trace, y: Trace) -> bool:
    return x.outcome != y.outcome or not abs(x.peak_tilt - y.peak_tilt) <= SAME * x.peak_tilt


@pytest.mark.slow
def test_the_same_function_of_time_sampled_finer():
    firm, off = 0, []
    for seed in range(140):
        given = problem(seed, models=("recess", "flat"), time_steps=(0.005, 0.01, 0.02))
        if given.chatters:
            continue
        plain = given.simulate()
        if is_firm(given, plain, FIRM):
            firm += 1
            finer = {parts: given.simulate(motion=resampled(given.motion, parts)) for parts in (2, 5)}
            off += [(seed, parts) for parts, response in finer.items() if changed(plain, response)]
    assert firm > 100
    assert not off


@pytest.mark.slow
def test_coarse_samples_of_large_cylinders_are_the_same_function_of_time():
    """Within one sample the direction of the ground may turn right round; the first motion tells."""
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
    """Half a sine that only just lifts, its azimuth turning, and still ground after it."""
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
def test_a_weak_foreshock_that_comes_to_rest_before_the_main_shock():
    firm, off = 0, []
    for seed in range(90):
        given = problem(seed)
        first = foreshock(given, 10.0 ** -(1 + seed % 4), seed % 3)
        weak = given.simulate(motion=first, rest_tilt=1e-2)  # so that it comes to rest in time
        alone = given.simulate(rest_tilt=1e-2)
        if not weak.rests or not len(weak.rest_intervals) or weak.peak_tilt >= alone.peak_tilt:
            continue
        if is_firm(given, alone, FIRM, rest_tilt=1e-2):
            firm += 1
            both = given.simulate(motion=joined(first, given.motion), rest_tilt=1e-2)
            off += [seed] * changed(alone, both)
    assert firm > 20
    assert not off


@pytest.mark.slow
def test_uplift_after_a_rest_equals_a_first_uplift():
    """Where the series of the uplift ends at a sample, the next step must not know of what was before."""
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
            # the times of the samples round otherwise
            assert both.tilt[later : later + 10] == pytest.approx(alone.tilt[begin : begin + 10], rel=1e-8), (
                seed
            )
    assert count > 60


@pytest.mark.slow
def test_two_runs_joined_at_a_rest():
    firm, off = 0, []
    for seed in range(80):
        given = problem(seed, time_steps=(0.01,), slenderness=(0.1, 1.0))
        first = given.motion.scaled(1.02 * given.threshold / given.motion.peak)
        first = joined(first, GroundMotion(np.zeros((40, 2)), first.time_step))
        if not len(given.simulate(motion=first, rest_tilt=3e-2).rest_intervals):
            continue
        second = given.motion.scaled(1.5 * given.threshold / given.motion.peak)
        other = given._replace(motion=second)
        alone = other.simulate(rest_tilt=3e-2)
        if not given.simulate(motion=first, rest_tilt=3e-2).rests:
            continue
        if is_firm(other, alone, FIRM, rest_tilt=3e-2):
            firm += 1
            both = other.simulate(motion=joined(first, second), rest_tilt=3e-2)
            if both.peak_tilt > given.simulate(motion=first, rest_tilt=3e-2).peak_tilt:
                off += [seed] * changed(alone, both)
    assert firm > 10
    assert not off


def planar_at_first(given: Problem, seed: int) -> GroundMotion:
    """The second component begins later."""
    acceleration = np.array(given.motion.acceleration)
    begin = (0.15 + 0.1 * (seed % 5)) * len(acceleration)
    acceleration[: int(begin), 1] = 0.0
    if seed % 2:
        acceleration[:, [0, 1]] = acceleration[:, [1, 0]]
    motion = GroundMotion(acceleration, given.motion.time_step)
    return motion.scaled(given.motion.peak / motion.peak)


@pytest.mark.slow
@pytest.mark.parametrize("late", [False, True])
def test_rotated_by_any_angle(late):
    firm, off = 0, []
    for seed in range(100):
        given = problem(seed, models=("recess", "flat"), slenderness=(0.05, 1.0))
        if given.chatters:
            continue
        if late:
            given = given._replace(motion=planar_at_first(given, seed))
        plain = given.simulate()
        # where the rounding of the first part chose a side, a copy with another first part would tell nothing
        later = slice((seed + 1) % 2, (seed + 1) % 2 + 1) if late else slice(None)
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
        longer = cut + 30.0 / plain.source.problem.body.p  # twice as long as a run takes to decide
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


@pytest.mark.parametrize("model", ["recess", "flat", "planar"])
def test_a_cell_that_falls_after_the_record_is_its_single_run(model):
    motion = problem(9, models=(model,)).motion
    cut = GroundMotion(motion.acceleration[: len(motion.acceleration) // 2], motion.time_step)
    sizes, scales = [0.6, 2.0, 7.0], np.geomspace(0.5, 8.0, 8) * G * 0.2 / cut.peak
    peaks = reduced.peak_tilts(sizes, 0.2, cut, scales, **reduced.MODELS[model])
    single = [
        [
            reduced.simulate(
                Case(Cylinder(semidiagonal=size, tan_alpha=0.2), cut.scaled(scale)),
                **reduced.MODELS[model],
                rtol=1e-7,
            )
            for scale in scales
        ]
        for size in sizes
    ]
    assert np.array_equal(peaks, [[response.peak_tilt for response in row] for row in single])
    assert any(response.time[-1] > cut.duration for row in single for response in row)


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


def test_samples_however_short_lift():
    """The same half sine from samples far shorter than 1e-6 of 1/p to coarse ones."""
    cylinder = Cylinder(semidiagonal=1000.0, tan_alpha=0.2)
    peaks = []
    for time_step in (1e-3, 1e-4, 1e-5, 2e-6):
        time = np.arange(round(0.02 / time_step) + 1) * time_step
        swell = 3.0 * np.sin(50.0 * math.pi * time)
        motion = GroundMotion(np.column_stack([swell, 0.3 * swell**2 / 3.0]), time_step)
        peaks.append(reduced.simulate(Case(cylinder, motion, duration=0.05)).peak_tilt)
    # a polygon of twenty corners is not the sine
    assert peaks == pytest.approx([peaks[-1]] * 4, rel=2e-2)


@pytest.mark.slow
def test_the_error_falls_with_the_tolerance():
    firm, errors = 0, []
    tolerances = (1e-5, 1e-7, 1e-9)
    for seed in range(60):
        given = problem(seed)
        if given.chatters:
            continue
        exact = given.simulate(rtol=1e-12)
        if exact.outcome != "overturned" and is_firm(given, exact, 1e-5):
            firm += 1
            peaks = [given.simulate(rtol=rtol).peak_tilt for rtol in tolerances]
            errors.append(np.abs(np.array(peaks) / exact.peak_tilt - 1.0))
    assert firm > 10
    typical = np.median(errors, axis=0)
    assert typical[0] > 10.0 * typical[1] > 100.0 * typical[2]
    # one step is held to the tolerance; a run has thousands of them
    assert (np.max(errors, axis=0) <= 1e2 * np.array(tolerances)).all()


def test_free_response_run_backwards():
    for seed in range(12):
        given = problem(seed, released=True, slenderness=(0.1, 1.0), models=("recess", "flat"))
        given = given._replace(model="recess")
        assert given.initial is not None
        duration = 3.0 * math.sqrt(given.cylinder.semidiagonal / G)
        there = given.simulate(motion=None, duration=duration, rtol=1e-12)
        if there.outcome == "overturned":
            continue
        end = dataclasses.replace(
            given.initial,
            tilt=float(there.tilt[-1]),
            tilt_rate=-float(there.tilt_rate[-1]),
            rolling_angle=float(there.rolling_angle[-1]),
            rolling_rate=-float(there.rolling_rate[-1]),
        )
        back = given.simulate(motion=None, duration=duration, rtol=1e-12, initial=end)
        assert back.tilt[-1] == pytest.approx(given.initial.tilt, rel=1e-7)
        assert back.rolling_angle[-1] == pytest.approx(given.initial.rolling_angle, abs=1e-6)


@pytest.mark.parametrize(
    ("scale", "ground", "spin"),
    [(1.0, (0.0, 0.0, 0.0), 0.01), (1.0, (0.0, 0.0, -0.5 * G), 0.01), (0.5, (0.1 * G, 0.0, 0.0), 0.0)],
    ids=["still ground", "half the weight", "a push of half the threshold"],
)
@pytest.mark.parametrize("planar", [False, True])
def test_a_release_rests_only_below_the_energy_of_the_threshold(scale, ground, spin, planar):
    """A push of half the threshold takes half off restoring moment and bound; weight changes both."""
    pier, rest = Cylinder(semidiagonal=6.0, tan_alpha=0.2), 1e-2
    motion = GroundMotion([ground, ground], 10.0)
    for share, rests in ((0.9, True), (1.1, False)):
        rate = 0.0 if planar else spin
        initial = InitialState(share * scale * rest * pier.alpha, rolling_rate=rate)
        case = Case(pier, motion, initial=initial, duration=2.0)
        found = reduced.simulate(case, rest_tilt=rest, **({"plane": 0.0} if planar else {}))
        assert (found.tilt[-1] == found.tilt_rate[-1] == 0.0 and np.isnan(found.rolling_angle[-1])) == rests
