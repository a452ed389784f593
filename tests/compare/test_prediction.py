"""Causes that end an agreement, and verdicts on the prediction."""

from __future__ import annotations

import math

import numpy as np
import pytest

from rockwobble import reduced
from rockwobble.compare.comparison.prediction import (
    close_pass,
    early_rms,
    estimated_error,
    predict,
    verdict,
)
from rockwobble.compare.metrics.pair import landings
from rockwobble.models import Case, GroundMotion, InitialState, Run

TIME = np.arange(1001) * 0.01


@pytest.fixture
def case(cylinder):
    return Case(cylinder, initial=InitialState(0.3 * cylinder.alpha), duration=10.0, name="synthetic")


def traces_of(case: Case, make_trace, uplift: float):
    """Traces with a difference in alpha from uplift on, and copies that diverge e-fold in each second."""
    after = np.maximum(TIME - uplift, 0.0)
    level = np.where(uplift > TIME, 0.0, 0.3 * case.cylinder.alpha)

    def trace(difference, **fields):
        return make_trace(TIME, level + difference * case.cylinder.alpha, uplift_time=uplift, **fields)

    def simulate(disturbed: Case, _: Run):
        relative = disturbed.gravity / case.gravity - 1.0
        return trace(relative * np.where(uplift > TIME, 0.0, np.exp(after)))

    return trace, simulate


@pytest.mark.parametrize("uplift", [0.0, 2.0])
def test_the_first_of_three_causes_ends_the_agreement(case, cylinder, make_trace, uplift):
    if uplift:  # the first second after uplift, as after a release
        case = Case(cylinder, GroundMotion(np.ones((1001, 2)), 0.01), name="synthetic")
    trace, simulate = traces_of(case, make_trace, uplift)

    def found(passes=(), form=math.inf, error=1e-5, tolerance=0.01):
        own = trace(0.0, passes=[(uplift + time, tilt) for time, tilt in passes])
        reference = own if math.isinf(form) else trace(np.where(uplift + form <= TIME, 0.02, 0.0))
        prediction = predict(
            case,
            reference=reference,
            own=own,
            contact_resolution=1e-5,
            error=error,
            simulate=simulate,
            tolerance=tolerance,
        )
        return prediction.reason, prediction.length

    # RMS of exp(t) in the first second: sqrt((e^2 - 1)/2) = 1.787; 1e-5/1.787 exp(t) = 0.01
    assert found() == ("growth", pytest.approx(np.log(1e3 * 1.787), abs=0.02))  # two samples
    assert found(tolerance=1e-3) == ("growth", pytest.approx(np.log(1e2 * 1.787), abs=0.02))
    assert found([(4.0, 1e-6), (2.0, 1e-4)]) == ("pass", 4.0)
    assert found([(4.0, 1e-6)], form=3.0) == ("model form", pytest.approx(3.0))
    assert found(error=1e-9) == ("", 10.0)  # a small error without a close pass ends no agreement


def test_an_exactly_upright_pass_before_a_fall_ends_the_agreement(cylinder):
    # upright once, then overturned: without a later maximum it is no pass
    time = np.arange(102) * 0.01
    pulse = 4.0 * 9.81 * cylinder.tan_alpha * np.sin(2.0 * np.pi * np.minimum(time, 1.0))
    motion = GroundMotion(np.column_stack([pulse, np.zeros_like(pulse)]), 0.01)
    response = reduced.simulate(Case(cylinder, motion, duration=6.0))
    assert response.outcome == "overturned"
    assert response.passes.empty
    (landed,) = landings(response)
    assert landed == pytest.approx(response.extrema[1, 0], abs=0.01)  # a sample
    prediction = close_pass(response, 1e-5, 6.0)
    assert (prediction.reason, prediction.length) == ("pass", landed - response.uplift_time)


@pytest.mark.parametrize(
    ("measured", "diverged", "predicted", "reason", "expected"),
    [
        (10.0, False, 10.0, "", "never, as predicted"),
        (5.0, True, 4.0, "growth", "in time"),
        (1.9, True, 4.0, "growth", "earlier"),
        (8.1, True, 4.0, "pass", "later"),
        (10.0, False, 4.0, "pass", "later"),
        (10.0, False, 6.0, "pass", "in time"),
        (10.0, False, 1.01, "pass", "later"),
        (10.0, False, 0.99, "pass", "much later"),
        (0.02, True, 0.0, "pass", "much later"),
        (4.9, True, 10.0, "", "earlier"),
    ],
)
def test_the_verdict_follows_from_both_times(measured, diverged, predicted, reason, expected):
    assert verdict(measured, diverged, predicted, reason) == expected


def test_the_estimated_error_is_of_first_order_in_the_step(case):
    run = Run("mujoco", "recess")
    assert estimated_error(case, run, 4e-4) == pytest.approx(4.0 * estimated_error(case, run, 1e-4))


def test_early_error_covers_one_second_at_six_metres(case):
    size = math.sqrt(case.cylinder.semidiagonal / 6.0)
    time = size * np.array([1.9, 2.0, 3.0, 3.005])
    assert early_rms(case, time, np.array([9.0, 3.0, 4.0, 9.0]), 2.0 * size) == pytest.approx(math.sqrt(12.5))
