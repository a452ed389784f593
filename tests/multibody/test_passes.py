"""Turning points and passes of given curves."""

from __future__ import annotations

import numpy as np
import pytest

from rockwobble.multibody.passes import TurningPoint, passes_between, turning_points


def test_a_straight_way_past_upright_is_exact_at_any_step() -> None:
    # the axis goes past at distance d: four steps, none of them near the closest point
    distance, speed = 1e-5, 0.1
    time = np.arange(4) * 1e-3
    along = speed * (time - 1.37e-3)
    tilt = np.hypot(distance, along)
    (point,) = turning_points(time, tilt, np.unwrap(np.arctan2(along, distance)))
    assert not point.is_maximum
    assert point.tilt == pytest.approx(distance, rel=1e-9)
    assert point.time == pytest.approx(1.37e-3, rel=1e-9)


def test_maximum_of_a_cosine() -> None:
    time = np.linspace(-1.0, 1.0, 2001) + 3.3e-4
    (point,) = turning_points(time, np.cos(time), 2.0 * time)
    assert point.is_maximum
    # third order in the step of 1e-3
    assert point.time == pytest.approx(0.0, abs=1e-6)
    assert point.tilt == pytest.approx(1.0, abs=1e-12)
    assert point.rolling_angle == pytest.approx(0.0, abs=1e-6)


def point(time: float, tilt: float, angle: float, maximum: bool) -> TurningPoint:
    return TurningPoint(time, tilt, angle, maximum)


def test_a_pass_lies_between_two_maxima() -> None:
    points = [
        point(0.5, 0.01, 0.2, False),
        point(1.0, 0.10, 0.5, True),
        point(2.0, 0.02, 2.0, False),
        point(3.0, 0.11, 3.7, True),
        point(4.0, 0.03, 5.0, False),
    ]
    (found,) = passes_between(points, 1e-9).itertuples()
    assert (found.time, found.minimum_tilt) == (2.0, 0.02)
    assert found.angle_of_turn == pytest.approx(3.2)


def test_swings_of_rounding_are_no_passes() -> None:
    points = [
        point(1.0, 0.10, 0.5, True),
        point(1.1, 0.10 - 1e-12, 0.6, False),
        point(1.2, 0.10 + 1e-12, 0.7, True),
        point(2.0, 0.02, 2.0, False),
        point(2.1, 0.02 + 1e-12, 2.1, True),
        point(2.2, 0.02 - 1e-12, 2.2, False),
        point(3.0, 0.11, 3.7, True),
    ]
    (found,) = passes_between(points, 1e-9).itertuples()
    assert found.time == 2.2
    assert found.angle_of_turn == pytest.approx(3.0)
