from __future__ import annotations

import math

import numpy as np
import pytest

from rockwobble.compare.metrics.pair import (
    Agreement,
    contact_rms,
    direction_difference,
    first_unresolved_pass,
    largest_differences,
    make_pair,
    turn_difference,
)

ROUNDING = 1e-12


@pytest.fixture
def time():
    return np.arange(1001) * 0.01


def rolling(cylinder, make_trace, time, rate, offset=0.0, **fields):
    tilt = np.full_like(time, 0.3 * cylinder.alpha)
    return make_trace(time, tilt, rolling_angle=offset + rate * time, uplift_direction=offset, **fields)


def test_turns_are_counted_up_to_the_end_of_agreement(cylinder, make_trace, time):
    slow, fast = (rolling(cylinder, make_trace, time, rate) for rate in (2.0, 3.0))
    pair = make_pair(cylinder, slow, fast)
    assert turn_difference(pair, until=10.0) == pytest.approx(10.0, rel=ROUNDING)  # more than a whole turn
    assert turn_difference(pair, until=2.5) == pytest.approx(2.5, rel=ROUNDING)


@pytest.mark.parametrize("turns", [-3, -1, 1, 2])
def test_an_azimuth_named_whole_turns_apart_is_the_same(cylinder, make_trace, time, turns):
    one = rolling(cylinder, make_trace, time, 2.0, offset=3.1)
    other = rolling(cylinder, make_trace, time, 2.0, offset=3.1 + 0.2 + 2.0 * math.pi * turns)
    direction = direction_difference(one, other)
    assert direction == pytest.approx(0.2, abs=ROUNDING)
    pair = make_pair(cylinder, one, other)
    found = turn_difference(pair, until=10.0, direction_difference=direction)
    assert found == pytest.approx(0.2, abs=1e-11)


def test_the_whole_turn_taken_off_is_the_nearest(cylinder, make_trace, time):
    one = rolling(cylinder, make_trace, time, 2.0)
    other = rolling(cylinder, make_trace, time, 2.0, offset=0.2 + 2.0 * math.pi)
    pair = make_pair(cylinder, one, other)
    # the direction of uplift is known less well than the azimuth of the first tilted sample
    found = turn_difference(pair, until=10.0, direction_difference=0.5)
    assert found == pytest.approx(0.2, abs=1e-11)


def test_direction_difference_is_trial_minus_reference_across_the_cut(cylinder, make_trace, time):
    one = rolling(cylinder, make_trace, time, 1.0, offset=math.pi - 0.1)
    other = rolling(cylinder, make_trace, time, 1.0, offset=-math.pi + 0.1)
    assert direction_difference(one, other) == pytest.approx(0.2, abs=ROUNDING)
    assert direction_difference(other, one) == pytest.approx(-0.2, abs=ROUNDING)
    half = rolling(cylinder, make_trace, time, 1.0, offset=math.pi)
    none = rolling(cylinder, make_trace, time, 1.0, offset=0.0)
    assert abs(direction_difference(half, none)) == pytest.approx(math.pi)


def test_the_last_sample_with_both_tilted_counts(cylinder, make_trace, time):
    resting = np.where(time > 4.0, np.nan, 2.0 * time)
    one = make_trace(time, np.where(time > 4.0, 0.0, 0.05), rolling_angle=resting)
    other = rolling(cylinder, make_trace, time, 3.0)
    assert turn_difference(make_pair(cylinder, one, other), until=10.0) == pytest.approx(4.0)
    never = make_trace(time, np.zeros_like(time), rolling_angle=np.full_like(time, np.nan))
    assert math.isnan(turn_difference(make_pair(cylinder, never, other), until=10.0))


def test_first_unresolved_pass(make_trace, time):
    passes = [(1.0, 1e-3), (3.0, 1e-7), (5.0, 1e-9)]
    tilt = np.full_like(time, 0.1)
    assert first_unresolved_pass(make_trace(time, tilt, passes=passes, unresolved=[3.0, 5.0])) == 3.0
    assert first_unresolved_pass(make_trace(time, tilt, passes=passes, unresolved=[])) == math.inf
    early = make_trace(time, tilt, passes=passes, unresolved=[1.0, 5.0])
    assert first_unresolved_pass(early, start=2.0) == 5.0


def test_contact_points_apart_by_a_fixed_angle(cylinder, make_trace, time):
    one = rolling(cylinder, make_trace, time, 2.0)
    other = rolling(cylinder, make_trace, time, 2.0, offset=0.3)
    # a chord of the unit circle
    assert contact_rms(make_pair(cylinder, one, other)) == pytest.approx(2.0 * math.sin(0.15), rel=ROUNDING)


def test_contact_points_count_only_where_both_are_tilted(cylinder, make_trace, time):
    high = 0.3 * cylinder.alpha
    phi = 2.0 * time
    reference = make_trace(time, np.where(time < 5.0, high, 0.04 * high), rolling_angle=phi)
    # 0.3 rad off before 2 s; opposite where one of the two is below 5 % of the reference's peak
    off = np.where(time < 2.0, 0.3, np.where(time < 5.0, 0.0, np.pi))
    off = np.where((time > 3.0) & (time < 5.0), np.pi, off)
    low = np.where((time > 3.0) & (time < 5.0), 0.04 * high, high)
    trial = make_trace(time, low, rolling_angle=phi + off)
    expected = 2.0 * math.sin(0.15) * math.sqrt(200 / 301)  # 200 of the 301 samples that count
    assert contact_rms(make_pair(cylinder, reference, trial)) == pytest.approx(expected, rel=ROUNDING)


def test_contact_points_count_above_5_percent_of_the_reference_peak(cylinder, make_trace, time):
    high, angle = 0.3 * cylinder.alpha, 2.0 * time
    # then just above 5 % of that peak: below 5 % of alpha, and of the trial's own peak; at last just below
    share = np.where(time < 4.0, 1.0, np.where(time < 8.0, 0.0502, 0.0498))
    reference = make_trace(time, high * share, rolling_angle=angle)
    trial = make_trace(
        time, high * np.where(time < 4.0, 3.0, share), rolling_angle=angle + 0.3 * (time >= 4.0)
    )
    expected = 2.0 * math.sin(0.15) * math.sqrt(0.5)  # in half of the samples that count
    assert contact_rms(make_pair(cylinder, reference, trial)) == pytest.approx(expected, rel=ROUNDING)


def test_contact_points_that_are_not_known_are_masked(cylinder, make_trace, time):
    tilt = np.full_like(time, 0.3 * cylinder.alpha)
    known = np.where(time < 1.0, np.nan, 2.0 * time)
    pair = make_pair(
        cylinder,
        make_trace(time, tilt, rolling_angle=2.0 * time),
        make_trace(time, tilt, rolling_angle=known + 0.3),
    )
    assert contact_rms(pair) == pytest.approx(2.0 * math.sin(0.15), rel=ROUNDING)


def test_contact_points_at_rest_are_masked(cylinder, make_trace, time):
    rest = make_trace(time, np.zeros_like(time), rolling_angle=np.full_like(time, np.nan))
    assert math.isnan(contact_rms(make_pair(cylinder, rest, rest)))


@pytest.mark.parametrize("diverged", [True, False])
def test_largest_differences_are_those_before_the_end_of_agreement(cylinder, make_trace, time, diverged):
    tilt = np.where(time < 0.5, 0.01, 0.3) * cylinder.alpha  # first below 5 % of the peak
    higher = np.select([time < 2.0, time < 5.0], [0.001, 0.002], 0.5) * cylinder.alpha
    turned = np.select([time < 0.5, time < 3.0], [3.0, 0.1], 0.2 - 2.0 * math.pi)
    pair = make_pair(
        cylinder,
        make_trace(time, tilt, rolling_angle=2.0 * time + 2.0 * math.pi),
        make_trace(time, tilt + higher, rolling_angle=2.0 * time + turned),
    )
    agreement = Agreement(length=5.0, end=5.0, diverged=diverged, tested=True)
    largest = largest_differences(pair, agreement, unresolved=2.9, direction_difference=3.0)
    # the sample at the divergence is the first that does not agree
    assert largest == pytest.approx((0.002 if diverged else 0.5, 2.0 * math.sin(0.1), 0.2))
    # a whole turn counts where each pass is resolved
    assert largest_differences(pair, agreement, unresolved=math.inf)[2] == pytest.approx(2.0 * math.pi - 0.2)
