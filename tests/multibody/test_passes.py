"""Turning points and passes of given curves, and rests between two motions."""

from __future__ import annotations

import numpy as np
import pytest

from rockwobble import multibody
from rockwobble.models import Case, Cylinder, GroundMotion
from rockwobble.multibody.passes import (
    SHORTEST,
    RestWatch,
    TurningPoint,
    negligible_uplifts,
    passes_between,
    turning_points,
)

STEP = 1e-3


def test_the_minimum_of_a_straight_pass_is_exact_at_any_step() -> None:
    # the axis passes at distance d: four steps, none of them near the closest point
    distance, speed = 1e-5, 0.1
    time = np.arange(4) * 1e-3
    along = speed * (time - 1.37e-3)
    tilt = np.hypot(distance, along)
    (point,) = turning_points(time, tilt, np.unwrap(np.arctan2(along, distance)))
    assert not point.is_maximum
    assert point.tilt == pytest.approx(distance, rel=1e-9)
    assert point.time == pytest.approx(1.37e-3, rel=1e-9)


def test_the_maximum_of_a_cosine_is_third_order() -> None:
    time = np.linspace(-1.0, 1.0, 2001) + 3.3e-4
    (point,) = turning_points(time, np.cos(time), 2.0 * time)
    assert point.is_maximum
    # third order in the step of 1e-3
    assert point.time == pytest.approx(0.0, abs=1e-6)
    assert point.tilt == pytest.approx(1.0, abs=1e-12)
    assert point.rolling_angle == pytest.approx(0.0, abs=1e-6)


def points_of(*rows: tuple[float, float, float, bool]) -> list[TurningPoint]:
    return [TurningPoint(*row) for row in rows]


def test_a_pass_lies_between_two_maxima_that_are_more_than_rounding() -> None:
    points = points_of(
        (0.5, 0.01, 0.2, False),
        (1.0, 0.10, 0.5, True),
        (1.1, 0.10 - 1e-12, 0.6, False),
        (1.2, 0.10 + 1e-12, 0.7, True),
        (2.0, 0.02, 2.0, False),
        (2.1, 0.02 + 1e-12, 2.1, True),
        (2.2, 0.02 - 1e-12, 2.2, False),
        (3.0, 0.11, 3.7, True),
        (4.0, 0.03, 5.0, False),
    )
    ((time, tilt, turn),) = zip(*passes_between(points, 1e-9).values(), strict=True)
    assert (time, tilt) == (2.2, 0.02 - 1e-12)
    assert turn == pytest.approx(3.0)


@pytest.mark.parametrize("chunks", [[], [1], [150, 1, 60], [7] * 60])
def test_a_rest_is_a_tilt_that_stays_below_the_level(chunks: list[int]) -> None:
    tilt = np.full(500, 0.1)
    tilt[100:150] = 1e-9  # 50 ms
    tilt[200:203] = 1e-9  # a pass upright
    tilt[400:] = 1e-9
    watch = RestWatch(1e-6)
    for at in np.split(np.arange(500), np.cumsum(chunks)):
        watch.take(STEP * at, tilt[at])
    assert SHORTEST > 3 * STEP
    np.testing.assert_allclose(watch.rests(), [(0.1, 0.15), (0.4, 0.499)])
    # a trace counts as rests those after a motion, and leaves the last one open
    np.testing.assert_allclose(watch.after_motion(), [(0.1, 0.15), (0.4, np.nan)])
    stood = RestWatch(1e-5)
    stood.take(STEP * np.arange(500), np.where(np.arange(500) < 100, 0.0, 1e-3))
    assert stood.rests()[0][0] == 0.0
    assert stood.after_motion() == []
    assert watch.resting


def test_a_base_that_has_just_closed_is_not_at_rest() -> None:
    watch = RestWatch(1e-6)
    watch.take(STEP * np.arange(100), np.where(np.arange(100) < 95, 0.1, 0.0))
    assert not watch.resting
    assert watch.rests() == []
    watch.take(STEP * np.arange(100, 130), np.zeros(30))
    assert watch.resting


def test_a_pass_belongs_to_one_motion() -> None:
    points = points_of(
        (1.0, 0.10, 0.0, True),
        (2.0, 0.02, 2.0, False),
        (3.0, 0.09, 3.3, True),
        (4.5, 1e-7, 3.9, False),  # the noise of a base that stands
        (4.6, 1e-6, 4.0, True),
        (4.7, 1e-7, 4.1, False),
        (6.0, 0.05, 5.0, True),
        (7.0, 0.01, 7.0, False),
        (8.0, 0.04, 8.5, True),
    )
    assert 4.7 in passes_between(points, 1e-9)["time"]
    diverged = passes_between(points, 1e-9, [(4.0, 5.0)])
    assert diverged["time"].tolist() == [2.0, 7.0]
    assert diverged["angle_of_turn"].tolist() == pytest.approx([3.3, 3.5])
    # a rest before, between or after that separates nothing
    assert len(passes_between(points[:3], 1e-9, [(0.0, 0.5), (9.0, 9.5)])["time"]) == 1


def test_a_negligible_opening_precedes_a_motion() -> None:
    points = [TurningPoint(1.0, 2e-5, 0.0, True), TurningPoint(3.0, 0.01, 0.0, True)]
    rests = [(0.0, 0.9), (1.1, 2.5), (3.5, 4.0)]
    assert negligible_uplifts(points, 1e-4, rests) == [0.9]
    # contact resolves it, no motion follows, there is no rest between, or no opening
    assert negligible_uplifts(points, 1e-5, rests) == []
    assert negligible_uplifts(points[:1], 1e-4, rests) == []
    assert negligible_uplifts(points, 1e-4, [(0.0, 0.9), (3.5, 4.0)]) == []
    assert negligible_uplifts(points[1:], 1e-4, rests) == []


@pytest.mark.slow
@pytest.mark.parametrize("speaks", [False, True])
def test_an_unresolved_opening_makes_the_next_start_unpredictable(speaks: bool) -> None:
    # the first pulse passes the uplift threshold by a twentieth for some milliseconds, or stays below it
    pier = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    time = 0.005 * np.arange(360)
    push = np.zeros((len(time), 2))
    for start, length, strength in ((0.5, 0.1, 1.05 if speaks else 0.95), (1.2, 0.6, 1.5)):
        inside = (time >= start) & (time < start + length)
        push[inside, 0] += strength * 9.81 * 0.2 * np.sin(np.pi * (time[inside] - start) / length)
    run = multibody.simulate(Case(pier, GroundMotion(push, 0.005), friction=5.0), engine="mujoco")
    assert run.peak_tilt > 100.0 * run.contact_resolution
    said = [fact.time for fact in run.diagnostics if fact.code == "unresolved_pass"]
    assert len(said) == speaks
    assert all(0.5 < first < 0.6 for first in said)
