from __future__ import annotations

import math

import numpy as np
import pytest

from rockwobble.compare.metrics.pair import make_pair, tilt_rms, tilt_rms_relative

ROUNDING = 1e-12  # sums of some thousand terms of order one
GRID = 1e-3  # a mean over samples against the integral: one sample more than a whole period


def sines(cylinder, make_trace, shift):
    """Two raised sines of amplitude alpha/4 about alpha/2, period 1 s, shifted by `shift` [rad]."""
    time = np.arange(2001) * 0.005
    level, amplitude = 0.5 * cylinder.alpha, 0.25 * cylinder.alpha
    reference = make_trace(time, level + amplitude * np.sin(2.0 * np.pi * time))
    trial = make_trace(time, level + amplitude * np.sin(2.0 * np.pi * time + shift))
    return reference, trial


@pytest.mark.parametrize("shift", [1e-4, 0.1, 1.0, math.pi])
def test_rms_of_a_shifted_sine(cylinder, make_trace, shift):
    reference, trial = sines(cylinder, make_trace, shift)
    pair = make_pair(cylinder, reference, trial)
    # sin(x + d) - sin x = 2 sin(d/2) cos(x + d/2), whose RMS is sqrt(2) sin(d/2)
    expected = 0.25 * math.sqrt(2.0) * math.sin(0.5 * shift)
    assert tilt_rms(pair) == pytest.approx(expected, rel=GRID)
    mean_square = 0.5**2 + 0.5 * 0.25**2
    assert tilt_rms_relative(pair) == pytest.approx(expected / math.sqrt(mean_square), rel=GRID)


def test_relative_rms_counts_only_up_to_the_end_of_its_window(cylinder, make_trace):
    time = np.arange(1001) * 0.01
    tilt = np.where(time < 2.0, 0.0, 0.3 * cylinder.alpha)
    reference = make_trace(time, tilt, uplift_time=2.0)
    trial = make_trace(time, tilt + np.where(time > 5.0, 0.1, 0.0) * cylinder.alpha, uplift_time=2.0)

    def relative_rms(until=None):
        return tilt_rms_relative(make_pair(cylinder, reference, trial, until=until))

    assert relative_rms(until=5.0) == 0.0
    # from 2 s to 10 s there are 801 samples, and 500 of them are off by a third
    assert relative_rms() == pytest.approx(math.sqrt(500 / 801) / 3.0, rel=ROUNDING)
    # the rest before uplift, where both stand, weighs on neither side
    late = relative_rms(until=7.5)
    assert late == pytest.approx(math.sqrt(250 / 551) / 3.0, rel=ROUNDING)


def test_a_reference_that_never_tilts_has_no_relative_rms(cylinder, make_trace):
    time = np.arange(11) * 0.1
    still = make_trace(time, np.zeros_like(time), uplift_time=math.nan)
    assert math.isnan(tilt_rms_relative(make_pair(cylinder, still, still)))


def test_a_pair_ends_where_either_trace_ends(cylinder, make_trace):
    time = np.arange(101) * 0.01
    long = make_trace(time, np.full_like(time, 0.1))
    # the exact end of a run need not be a multiple of the sample step
    own = np.append(time[:50], 0.4955)
    short = make_trace(own, np.linspace(0.1, 0.2, 51))
    assert make_pair(cylinder, long, short).end == pytest.approx(0.49)
    pair = make_pair(cylinder, short, long)
    assert pair.end == pytest.approx(0.4955)
    assert pair.tilt == pytest.approx(np.full(51, 0.1), abs=ROUNDING)


def test_a_pair_ends_before_a_value_that_is_not_finite(cylinder, make_trace):
    time = np.arange(101) * 0.01
    tilt = np.full_like(time, 0.1)
    broken = np.where(time > 0.305, np.nan, tilt)
    pair = make_pair(cylinder, make_trace(time, tilt), make_trace(time, broken, peak_tilt=math.nan))
    assert pair.end == pytest.approx(0.30)
    assert np.isfinite(pair.tilt_difference).all()


def test_other_sample_steps_are_interpolated(cylinder, make_trace):
    coarse, fine = np.arange(101) * 0.01, np.arange(401) * 0.0025
    pair = make_pair(cylinder, make_trace(coarse, 0.1 * coarse), make_trace(fine, 0.1 * fine))
    assert len(pair.time) == 101
    assert tilt_rms(pair) == pytest.approx(0.0, abs=ROUNDING)


def test_a_window_before_the_first_sample_is_refused(cylinder, make_trace):
    time = np.arange(11) * 0.1
    trace = make_trace(time, np.full_like(time, 0.1))
    with pytest.raises(ValueError, match="at least one sample"):
        make_pair(cylinder, trace, trace, until=-1.0)
