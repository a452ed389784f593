"""Differences of two synthetic traces: tilt, angle of turn, contact points and energy."""

from __future__ import annotations

import math

import numpy as np
import pytest

from rockwobble import reduced
from rockwobble.compare.metrics.pair import (
    Agreement,
    contact_rms,
    direction_difference,
    energy_loss,
    first_unresolved_pass,
    largest_differences,
    make_pair,
    tilt_rms,
    tilt_rms_relative,
    turn_difference,
)
from rockwobble.models import Case, Cylinder, GroundMotion, InitialState, el_centro_1940
from rockwobble.models.mode import ROCKS_IN_PLANE

ROUNDING = 1e-12  # sums of some thousand terms of order one
GRID = 1e-3  # a mean over samples against the integral: one sample more than a whole period
# work from a path with samples 0.01 s apart: error of fourth differences
SAMPLING = 2e-5
TIME = np.arange(1001) * 0.01


@pytest.mark.parametrize("shift", [1e-4, 1.0, math.pi])
def test_rms_of_a_shifted_sine_is_its_closed_form(cylinder, make_trace, shift):
    time = np.arange(2001) * 0.005
    reference, trial = (
        make_trace(time, cylinder.alpha * (0.5 + 0.25 * np.sin(2.0 * np.pi * time + by)))
        for by in (0.0, shift)
    )
    pair = make_pair(cylinder, reference, trial)
    # sin(x + d) - sin x = 2 sin(d/2) cos(x + d/2), whose RMS is sqrt(2) sin(d/2)
    expected = 0.25 * math.sqrt(2.0) * math.sin(0.5 * shift)
    assert tilt_rms(pair) == pytest.approx(expected, rel=GRID)
    mean_square = 0.5**2 + 0.5 * 0.25**2
    assert tilt_rms_relative(pair) == pytest.approx(expected / math.sqrt(mean_square), rel=GRID)


def test_relative_rms_counts_only_up_to_the_end_of_its_window(cylinder, make_trace):
    tilt = np.where(TIME < 2.0, 0.0, 0.3 * cylinder.alpha)
    reference = make_trace(TIME, tilt, uplift_time=2.0)
    trial = make_trace(TIME, tilt + np.where(TIME > 5.0, 0.1, 0.0) * cylinder.alpha, uplift_time=2.0)

    def relative_rms(until=None):
        return tilt_rms_relative(make_pair(cylinder, reference, trial, until=until))

    assert relative_rms(until=5.0) == 0.0
    # from 2 s to 10 s there are 801 samples, and 500 of them differ by a third: the rest before uplift, where
    # both stand, counts on neither side
    assert relative_rms() == pytest.approx(math.sqrt(500 / 801) / 3.0, rel=ROUNDING)
    assert relative_rms(until=7.5) == pytest.approx(math.sqrt(250 / 551) / 3.0, rel=ROUNDING)
    still = make_trace(TIME, np.zeros_like(TIME), uplift_time=math.nan)
    assert math.isnan(tilt_rms_relative(make_pair(cylinder, still, still)))
    with pytest.raises(ValueError, match="at least one sample"):
        relative_rms(until=-1.0)


def test_a_pair_ends_where_a_trace_ends_or_is_not_finite(cylinder, make_trace):
    time = np.arange(101) * 0.01
    long = make_trace(time, np.full_like(time, 0.1))
    # the exact end of a run need not be a multiple of the sample step
    short = make_trace(np.append(time[:50], 0.4955), np.linspace(0.1, 0.2, 51))
    assert make_pair(cylinder, long, short).end == pytest.approx(0.49)
    pair = make_pair(cylinder, short, long)
    assert pair.end == pytest.approx(0.4955)
    assert pair.tilt == pytest.approx(np.full(51, 0.1), abs=ROUNDING)
    broken = make_trace(time, np.where(time > 0.305, np.nan, 0.1), peak_tilt=math.nan)
    pair = make_pair(cylinder, long, broken)
    assert pair.end == pytest.approx(0.30)
    assert np.isfinite(pair.tilt_difference).all()


def test_other_sample_steps_are_interpolated(cylinder, make_trace):
    coarse, fine = np.arange(101) * 0.01, np.arange(401) * 0.0025
    pair = make_pair(cylinder, make_trace(coarse, 0.1 * coarse), make_trace(fine, 0.1 * fine))
    assert len(pair.time) == 101
    assert tilt_rms(pair) == pytest.approx(0.0, abs=ROUNDING)


def rolling(cylinder, make_trace, rate, offset=0.0, **fields):
    tilt = np.full_like(TIME, 0.3 * cylinder.alpha)
    return make_trace(TIME, tilt, rolling_angle=offset + rate * TIME, uplift_direction=offset, **fields)


def test_turns_are_counted_up_to_the_end_of_agreement(cylinder, make_trace):
    slow, fast = (rolling(cylinder, make_trace, rate) for rate in (2.0, 3.0))
    pair = make_pair(cylinder, slow, fast)
    assert turn_difference(pair, until=10.0) == pytest.approx(10.0, rel=ROUNDING)  # more than a whole turn
    assert turn_difference(pair, until=2.5) == pytest.approx(2.5, rel=ROUNDING)
    resting = np.where(TIME > 4.0, np.nan, 2.0 * TIME)
    lands = make_trace(TIME, np.where(TIME > 4.0, 0.0, 0.05), rolling_angle=resting)
    # last sample with both tilted
    assert turn_difference(make_pair(cylinder, lands, fast), until=10.0) == pytest.approx(4.0)
    never = make_trace(TIME, np.zeros_like(TIME), rolling_angle=np.full_like(TIME, np.nan))
    assert math.isnan(turn_difference(make_pair(cylinder, never, fast), until=10.0))


@pytest.mark.parametrize("turns", [-3, 1])
def test_azimuths_whole_turns_apart_are_equal(cylinder, make_trace, turns):
    one = rolling(cylinder, make_trace, 2.0, offset=3.1)
    other = rolling(cylinder, make_trace, 2.0, offset=3.1 + 0.2 + 2.0 * math.pi * turns)
    direction = direction_difference(one, other)
    assert direction == pytest.approx(0.2, abs=ROUNDING)
    pair = make_pair(cylinder, one, other)
    # the direction of uplift may be less certain than the azimuth of the first tilted sample
    for known in (direction, 0.5):
        assert turn_difference(pair, until=10.0, direction_difference=known) == pytest.approx(0.2, abs=1e-11)


def test_the_side_of_a_pass_in_one_plane_is_no_turn(cylinder, make_trace):
    tilt = np.full_like(TIME, 0.3 * cylinder.alpha)
    one, other = (
        make_trace(TIME, tilt, rolling_angle=np.where(TIME > 5.0, turn, 0.0), uplift_direction=0.0)
        for turn in (math.pi, -math.pi)
    )
    assert one.mode == ROCKS_IN_PLANE
    assert turn_difference(make_pair(cylinder, one, other), until=10.0) == pytest.approx(0.0, abs=ROUNDING)


def test_direction_difference_is_trial_minus_reference_across_pi(cylinder, make_trace):
    one, other, half, none = (
        rolling(cylinder, make_trace, 1.0, offset=offset)
        for offset in (math.pi - 0.1, 0.1 - math.pi, math.pi, 0.0)
    )
    assert direction_difference(one, other) == pytest.approx(0.2, abs=ROUNDING)
    assert direction_difference(other, one) == pytest.approx(-0.2, abs=ROUNDING)
    assert abs(direction_difference(half, none)) == pytest.approx(math.pi)


def test_first_unresolved_pass_is_after_the_start(make_trace):
    passes, tilt = [(1.0, 1e-3), (3.0, 1e-7), (5.0, 1e-9)], np.full_like(TIME, 0.1)
    for unresolved, start, expected in (([3.0, 5.0], 0.0, 3.0), ([], 0.0, math.inf), ([1.0, 5.0], 2.0, 5.0)):
        trace = make_trace(TIME, tilt, passes=passes, unresolved=unresolved)
        assert first_unresolved_pass(trace, start=start) == expected


def test_unknown_contact_points_are_masked(cylinder, make_trace):
    one, other = (rolling(cylinder, make_trace, 2.0, offset=offset) for offset in (0.0, 0.3))
    # a chord of the unit circle
    assert contact_rms(make_pair(cylinder, one, other)) == pytest.approx(2.0 * math.sin(0.15), rel=ROUNDING)
    late = make_trace(TIME, one.tilt, rolling_angle=np.where(TIME < 1.0, np.nan, 2.0 * TIME + 0.3))
    assert contact_rms(make_pair(cylinder, one, late)) == pytest.approx(2.0 * math.sin(0.15), rel=ROUNDING)
    rest = make_trace(TIME, np.zeros_like(TIME), rolling_angle=np.full_like(TIME, np.nan))
    assert math.isnan(contact_rms(make_pair(cylinder, rest, rest)))


def test_contact_points_count_only_where_both_are_tilted(cylinder, make_trace):
    high, phi = 0.3 * cylinder.alpha, 2.0 * TIME
    reference = make_trace(TIME, np.where(TIME < 5.0, high, 0.04 * high), rolling_angle=phi)
    # 0.3 rad apart before 2 s; opposite where one of the two is below 5 % of the reference's peak
    off = np.where(TIME < 2.0, 0.3, np.where(TIME < 5.0, 0.0, np.pi))
    off = np.where((TIME > 3.0) & (TIME < 5.0), np.pi, off)
    low = np.where((TIME > 3.0) & (TIME < 5.0), 0.04 * high, high)
    trial = make_trace(TIME, low, rolling_angle=phi + off)
    expected = 2.0 * math.sin(0.15) * math.sqrt(200 / 301)  # 200 of the 301 samples that count
    assert contact_rms(make_pair(cylinder, reference, trial)) == pytest.approx(expected, rel=ROUNDING)
    # just above 5 % of that peak: below 5 % of alpha, and of the trial's own peak; at last just below
    share = np.where(TIME < 4.0, 1.0, np.where(TIME < 8.0, 0.0502, 0.0498))
    reference = make_trace(TIME, high * share, rolling_angle=phi)
    trial = make_trace(TIME, high * np.where(TIME < 4.0, 3.0, share), rolling_angle=phi + 0.3 * (TIME >= 4.0))
    expected = 2.0 * math.sin(0.15) * math.sqrt(0.5)  # in half of the samples that count
    assert contact_rms(make_pair(cylinder, reference, trial)) == pytest.approx(expected, rel=ROUNDING)


@pytest.mark.parametrize("diverged", [True, False])
def test_largest_differences_are_those_before_the_end_of_agreement(cylinder, make_trace, diverged):
    tilt = np.where(TIME < 0.5, 0.01, 0.3) * cylinder.alpha  # first below 5 % of the peak
    higher = np.select([TIME < 2.0, TIME < 5.0], [0.001, 0.002], 0.5) * cylinder.alpha
    turned = np.select([TIME < 0.5, TIME < 3.0], [3.0, 0.1], 0.2 - 2.0 * math.pi)
    pair = make_pair(
        cylinder,
        make_trace(TIME, tilt, rolling_angle=2.0 * TIME + 2.0 * math.pi),
        make_trace(TIME, tilt + higher, rolling_angle=2.0 * TIME + turned),
    )
    agreement = Agreement(length=5.0, end=5.0, diverged=diverged, tested=True)
    largest = largest_differences(pair, agreement, unresolved=2.9, direction_difference=3.0)
    # the sample at the divergence is the first outside of the agreement
    assert largest == pytest.approx((0.002 if diverged else 0.5, 2.0 * math.sin(0.1), 0.2))
    # a whole turn counts where each pass is resolved
    assert largest_differences(pair, agreement, unresolved=math.inf)[2] == pytest.approx(2.0 * math.pi - 0.2)


def test_energy_loss_in_free_motion_is_start_minus_end(make_trace):
    tilt = np.full_like(TIME, 0.1)
    for energy, loss in ((2.0 - 0.05 * TIME, 0.25), (0.0 * TIME, 0.0), (np.nan * TIME, math.nan)):
        assert energy_loss(make_trace(TIME, tilt, energy=energy), None) == pytest.approx(loss, nan_ok=True)


@pytest.mark.parametrize("record_step", [0.005, 0.02, 0.013])
def test_work_of_the_ground_counts_as_no_loss(make_trace, record_step):
    """A free mass on moving ground moves by -u relative to it; its energy is the work of -a."""
    times = np.arange(0.0, 8.0 + 0.5 * record_step, record_step)
    # fades out, because the fine sums below have no jump
    a = np.column_stack([np.sin(2.0 * times), 0.5 * np.cos(3.0 * times)]) * (1.0 - times / times[-1])[:, None]
    motion = GroundMotion(a, record_step)
    h = 1.25e-4
    at = np.column_stack([np.interp(np.arange(80001) * h, times, column, right=0.0) for column in a.T])
    v = -np.vstack([np.zeros(2), np.cumsum(0.5 * (at[1:] + at[:-1]) * h, axis=0)])
    x = np.vstack([np.zeros(2), np.cumsum(0.5 * (v[1:] + v[:-1]) * h, axis=0)])
    place = np.column_stack([x, np.zeros(len(x))])[::80]
    energy = 0.5 * (v[::80] ** 2).sum(axis=1)
    for lost in (0.0, 0.01):
        trace = make_trace(TIME, np.full_like(TIME, 0.1), centre_of_mass=place, energy=energy - lost * TIME)
        assert energy_loss(trace, motion) * trace.energy.max() == pytest.approx(10.0 * lost, abs=1e-5)


def test_the_reduced_model_loses_nothing(cylinder):
    release = InitialState(tilt=0.5 * cylinder.alpha, rolling_rate=0.5)
    free = reduced.simulate(Case(cylinder, initial=release, duration=8.0))
    assert energy_loss(free, None) == pytest.approx(0.0, abs=1e-6)  # rtol 1e-8 over some hundred steps
    motion = el_centro_1940()
    shaken = reduced.simulate(Case(cylinder, motion))
    assert energy_loss(shaken, motion) == pytest.approx(0.0, abs=SAMPLING)


def test_the_work_of_the_ground_between_two_samples_counts(cylinder: Cylinder) -> None:
    push = GroundMotion([[3.0, 0.0], [3.0, 0.0]], 0.3)
    trace = reduced.simulate(Case(cylinder, push, duration=0.003))
    assert len(trace.time) == 2
    assert energy_loss(trace, push) == pytest.approx(0.0, abs=0.01)  # of the largest energy, 1
