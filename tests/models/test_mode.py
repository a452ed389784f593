"""The expected mode: friction, slenderness and shaking decide, on flat ground alone."""

from __future__ import annotations

import numpy as np
import pytest

from rockwobble.models import Case, Cylinder, GroundMotion, InitialState, Tendon, WobblingFrame
from rockwobble.models.mode import expected_mode

CASK = Cylinder(semidiagonal=3.0, tan_alpha=0.5)
AROUND = GroundMotion(np.array([[0, 0], [3, 4], [-4, 3], [0, 0]]), 0.5)  # up to 5 m/s^2
ALONG = GroundMotion(np.array([[0, 0], [3, 4], [-3, -4], [0, 0]]), 0.5)


@pytest.mark.parametrize(
    ("friction", "scale", "motion", "flat", "recess"),
    [
        (0.3, 0.3 * 9.81 / 5 * 0.999, AROUND, "rest", "rest"),
        (0.3, 0.3 * 9.81 / 5 * 1.001, AROUND, "slides", "rest"),
        (0.499, 3.0, AROUND, "slides", "rocks"),
        (0.501, 3.0, AROUND, "rocks and slides", "rocks"),
        (0.549, 3.0, ALONG, "rocks and slides", "rocks in one plane"),
        (0.551, 3.0, ALONG, "rocks in one plane", "rocks in one plane"),
        (0.551, 0.97, AROUND, "rest", "rest"),
        (1.0, 1.0, AROUND, "rocks", "rocks"),
        (0.0, 1e-3, AROUND, "slides", "rest"),
    ],
)
def test_the_smaller_of_friction_and_slenderness_decides_the_mode(
    friction: float, scale: float, motion: GroundMotion, flat: str, recess: str
) -> None:
    case = Case(CASK, motion.scaled(scale), friction=friction)
    assert (expected_mode(case, "flat"), expected_mode(case, "recess")) == (flat, recess)


def test_a_release_rocks_and_upward_acceleration_prevents_uplift() -> None:
    tilted = InitialState(0.1, rolling_angle=np.arctan2(4, 3))
    assert expected_mode(Case(CASK, ALONG, initial=tilted, friction=0.1), "flat") == "rocks in one plane"
    assert expected_mode(Case(CASK, AROUND, initial=tilted, friction=0.1), "flat") == "rocks"
    pressed = GroundMotion(np.array([[0, 0, 0], [4.9, 0, 0.5], [0, 0, 0]]), 0.1)
    lifted = GroundMotion(np.array([[0, 0, 0], [4.9, 0, -0.5], [0, 0, 0]]), 0.1)
    assert [expected_mode(Case(CASK, each), "flat") for each in (pressed, lifted)] == [
        "rest",
        "rocks in one plane",
    ]


def test_tendon_under_slab_slides_before_it_uplifts() -> None:
    held = Case(WobblingFrame(CASK, 1.0), AROUND, tendon=Tendon(prestress=1.0))
    assert held.friction_of_uplift == pytest.approx(0.5 * (1 + 2 / 3) / 1.5)
    assert Case(CASK, AROUND, tendon=Tendon(prestress=1.0)).friction_of_uplift == 0.5
