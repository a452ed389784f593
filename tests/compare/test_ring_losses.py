"""What a ring costs: its cases, its rows, and where the numbers come from."""

from __future__ import annotations

import math

import pytest

from rockwobble.compare.studies.validity.ring_losses import measure, ring_cases
from rockwobble.models import Case, Cylinder, InitialState, Run

SQUAT = Cylinder(semidiagonal=6.0, tan_alpha=1.0)
# error of an engine at its default step, in the tilt against its own model, over 1.2 s
ENGINE = 1e-4


def test_the_cases_turn():
    straight, turned = ring_cases(), ring_cases(0.1)
    assert [case.name for case in straight] == [case.name for case in turned]
    assert turned[0].initial.rolling_angle == pytest.approx(0.1)
    assert turned[1].motion.peak == pytest.approx(straight[1].motion.peak)
    # as many times the acceleration that uplifts as the table says
    assert straight[1].motion.peak / (9.81 * 0.2) == pytest.approx(2.0)


def test_rows_hold_each_support_against_its_model():
    case = Case(SQUAT, initial=InitialState(SQUAT.alpha / 2, rolling_rate=0.5), duration=1.2, name="short")
    steep = Run("mujoco", "ring", ring_inclination=0.1)
    rows = measure(
        [case], [Run("mujoco", "recess"), Run("mujoco", "flat"), Run("mujoco", "ring"), steep], workers=1
    )
    guided, free, ring = rows  # the release would start inside of the steep walls
    assert guided.against_recess < ENGINE < guided.against_flat
    assert free.against_flat < ENGINE < free.against_recess
    # in a recess the cylinder would always come down in its place, on open ground it rolls away from it
    assert guided.rolled_out < 1e-5 < 1e-3 < free.rolled_out
    assert math.isnan(free.first_contact)
    assert abs(free.loss) < ENGINE
    assert 0.5 < ring.first_contact < 1.2
    assert ring.contact_time > 0.0
    assert ring.loss > 100 * abs(free.loss)
