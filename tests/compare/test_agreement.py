from __future__ import annotations

import math

import numpy as np
import pytest

from rockwobble.compare.comparison.prediction import Prediction, close_pass
from rockwobble.compare.comparison.summary import summary_row
from rockwobble.compare.metrics.pair import (
    agreed_passes,
    agreement_time,
    closest_pass,
    make_pair,
    tolerance_of,
)

SAMPLE = 0.01  # an agreement time is known to one sample


@pytest.fixture
def growing(cylinder, make_trace):
    """Two traces whose difference grows from 1e-6 alpha by the factor e in each second after 2 s."""
    time = np.arange(4001) * SAMPLE
    tilt = np.where(time < 2.0, 0.0, 0.3 * cylinder.alpha)
    difference = np.where(time < 2.0, 0.0, 1e-6 * cylinder.alpha * np.exp(time - 2.0))
    passes = [(5.0, 1e-3), (10.5, 2e-5), (12.0, 3e-4), (30.0, 1e-6)]
    reference = make_trace(time, tilt, uplift_time=2.0, passes=passes)
    return reference, make_trace(time, tilt - difference, uplift_time=2.0)


def test_agreement_lasts_from_uplift_to_one_per_cent_of_alpha(cylinder, growing):
    agreement = agreement_time(make_pair(cylinder, *growing))
    assert agreement.diverged
    # 1e-6 exp(t) = 1e-2 at t = ln 1e4
    assert math.log(1e4) < agreement.length <= math.log(1e4) + SAMPLE
    assert agreement.end == pytest.approx(agreement.length + 2.0)


def test_passes_within_the_agreement_time_are_agreed(cylinder, growing):
    reference, _ = growing
    agreement = agreement_time(make_pair(cylinder, *growing))
    assert agreement.end == pytest.approx(11.22)
    assert agreed_passes(reference, agreement) == 2
    assert closest_pass(reference, agreement) == 2e-5


def test_traces_that_never_diverge_agree_for_the_length_of_the_run(cylinder, make_trace):
    time = np.arange(1001) * SAMPLE
    tilt = np.full_like(time, 0.3 * cylinder.alpha)
    pair = make_pair(
        cylinder, make_trace(time, tilt, uplift_time=2.0), make_trace(time, tilt + 0.00999 * cylinder.alpha)
    )
    agreement = agreement_time(pair)
    assert (agreement.length, agreement.end, agreement.diverged) == (10.0, 10.0, False)


def test_agreement_ends_with_a_trace_that_breaks_off(cylinder, make_trace):
    time = np.arange(1001) * SAMPLE
    tilt = np.full_like(time, 0.3 * cylinder.alpha)
    pair = make_pair(cylinder, make_trace(time, tilt, uplift_time=2.0), make_trace(time[:601], tilt[:601]))
    agreement = agreement_time(pair, broken=True)
    assert (agreement.length, agreement.end, agreement.diverged) == (4.0, 6.0, True)


def test_a_divergence_before_uplift_leaves_no_agreement(cylinder, make_trace):
    time = np.arange(1001) * SAMPLE
    reference = make_trace(time, np.zeros_like(time), uplift_time=5.0)
    trial = make_trace(time, np.where(time > 1.0, 0.1, 0.0))
    agreement = agreement_time(make_pair(cylinder, reference, trial))
    assert (agreement.length, agreement.diverged) == (0.0, True)


@pytest.mark.parametrize(("resolution", "expected"), [(1e-7, 40.0), (1e-5, 28.0), (5e-5, 8.5), (1e-2, 3.0)])
def test_an_external_trajectory_is_predicted_by_its_first_unresolved_pass(growing, resolution, expected):
    prediction = close_pass(growing[0], resolution, 40.0)
    assert prediction.length == pytest.approx(expected)
    assert prediction.reason == ("" if expected == 40.0 else "pass")


def test_a_reference_without_passes_predicts_no_divergence(make_trace):
    time = np.arange(11) * SAMPLE
    assert close_pass(make_trace(time, np.full_like(time, 0.1)), 1e-3, 0.1).length == 0.1


def test_the_tolerance_is_a_tenth_of_a_small_peak(cylinder, make_trace):
    time = np.arange(101) * SAMPLE

    def peak(share: float, uplift: float = 0.5):
        return make_trace(time, np.full_like(time, share * cylinder.alpha), uplift_time=uplift)

    small, rest = peak(0.004), peak(1e-19, math.nan)
    assert tolerance_of(peak(0.2), small) == 0.01
    assert (
        tolerance_of(small, peak(0.2))
        == tolerance_of(small)
        == tolerance_of(rest, small)
        == pytest.approx(4e-4)
    )
    assert tolerance_of(rest, rest) == 0.01  # nothing moves
    failed = make_trace(time, np.full_like(time, 0.1), peak_tilt=math.nan)
    assert tolerance_of(failed) == 0.01


def test_only_motion_beyond_the_tolerance_tests_an_agreement(cylinder, make_trace):
    time = np.arange(1001) * SAMPLE
    tilt = cylinder.alpha * 0.002 * np.maximum(time - 2.0, 0.0)  # 0.016 alpha at the end
    reference = make_trace(time, tilt, uplift_time=2.0)

    def agreed(leaves: float, tolerance: float):
        trial = make_trace(time, tilt + np.where(time >= leaves, 0.1, 0.0))
        return agreement_time(make_pair(cylinder, reference, trial), tolerance=tolerance)

    # 5 times 0.002 alpha are reached at 7 s, 5 times 0.0002 alpha at 2.5 s
    assert [agreed(leaves, 0.002).tested for leaves in (0.0, 6.9, 7.1, 20.0)] == [False, False, True, True]
    assert [agreed(leaves, 0.0002).tested for leaves in (2.4, 2.6)] == [False, True]
    lean = make_trace(time, np.full_like(time, 0.3 * cylinder.alpha))  # released, and not yet in motion
    assert not agreement_time(make_pair(cylinder, lean, lean)).tested
    sinks = make_trace(time, cylinder.alpha * (0.3 - 0.01 * time))  # a decreasing tilt is motion, too
    assert agreement_time(make_pair(cylinder, sinks, sinks)).tested


def test_a_summary_uses_both_bounds_and_the_time_of_the_run(cylinder, make_trace):
    time = np.arange(1001) * SAMPLE
    swing = np.where(time < 2.0, 0.0, 0.0075 * cylinder.alpha * np.sin(time - 2.0) ** 2)
    reference = make_trace(time, swing, uplift_time=2.0)
    rest = make_trace(time, np.full_like(time, 1e-19 * cylinder.alpha), uplift_time=math.nan)

    def row(trial, within: float):
        expected = Prediction(length=within, reason="growth")
        return summary_row(reference.case, "model", reference, "made", trial, prediction=expected)

    summary = row(rest, 3.0)
    assert (summary["diverged"], summary["agreement_time"]) == (False, 10.0)  # within 1 % of alpha
    assert (summary["tolerance"], summary["reference_uplift_time"]) == (pytest.approx(7.5e-4, rel=1e-3), 2.0)
    # a squared sine reaches a tenth of its peak at arcsin(sqrt(0.1))
    assert summary["left_tolerance"]
    assert summary["within_tolerance_until"] == pytest.approx(2.0 + math.asin(math.sqrt(0.1)), abs=SAMPLE)
    assert summary["predicted_until"] == 5.0
    assert summary["divergence"] == "earlier"
    assert row(rest, 0.3)["divergence"] == "too little motion"
    assert row(reference, 2.0)["divergence"] == "later"
    assert row(reference, 0.9)["divergence"] == "much later"
