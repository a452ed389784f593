"""Runs in a recess with clearance: refusals, diagnostics, and contact with walls."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from rockwobble import multibody
from rockwobble.models import Case, Cylinder, GroundMotion, InitialState, Trace
from rockwobble.multibody.guard import PENETRATION, first_breach
from rockwobble.multibody.kinematics import kinematics
from rockwobble.multibody.protocol import Steps, Wall
from rockwobble.multibody.scene import scaled_body, starting_state

PIER = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
SQUAT = Cylinder(semidiagonal=6.0, tan_alpha=1.0)
# rounding of 1e-15 after the first touches of a wall, each of which multiplies it
TURNED = 1e-9
# largest loss of energy without contact: an undisturbed run of this length gains or loses 1e-5 of its energy
LOSSLESS = 1e-4


def ring(
    cylinder: Cylinder = SQUAT,
    *,
    tilt: float = 0.5,
    rolling_rate: float = 0.5,
    duration: float = 2.0,
    friction: float = 1.0,
    **settings: Any,
) -> Trace:
    """Release at a tilt in alpha."""
    initial = InitialState(tilt * cylinder.alpha, rolling_rate=rolling_rate)
    case = Case(cylinder, initial=initial, duration=duration, friction=friction)
    return multibody.simulate(case, support="ring", **settings)


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        ({"ring_clearance": -0.1}, "ring_clearance must be from 0 to 100, got -0.1"),
        ({"ring_inclination": 1.6}, "ring_inclination must be from 0 to 1.5"),
        ({"ring_facets": 2}, "ring_facets must be a whole number from 3 to 1000, got 2"),
        ({"ring_friction": -1.0}, "ring_friction must be from 0 to 100, got -1.0"),
        (
            {"ring_inclination": 0.1},
            "a release at a tilt of 0.3927 rad needs walls that lean by as much or stand back by 0.5",
        ),
        (
            {"support": "flat", "ring_clearance": 0.1, "ring_facets": 8},
            "ring_clearance, ring_facets is for support 'ring' only, got support 'flat'",
        ),
        ({"engine": "pybullet"}, "support must be one of recess, flat in pybullet, got 'ring'"),
    ],
)
def test_a_ring_refuses_bad_settings_and_starts(settings: dict[str, Any], message: str) -> None:
    if settings.get("engine") == "pybullet" and "pybullet" not in multibody.available_engines():
        pytest.skip("no wheel of pybullet here")
    arguments = {"support": "ring", **settings}
    with pytest.raises(ValueError, match=r"must|only|needs|not a setting") as caught:
        multibody.simulate(Case(SQUAT, initial=InitialState(SQUAT.alpha / 2), duration=1.0), **arguments)
    assert str(caught.value).startswith(message)
    assert "\n" not in str(caught.value)


def test_a_wide_ring_equals_flat_ground() -> None:
    initial = InitialState(SQUAT.alpha / 2, rolling_rate=0.5)
    wide = ring(ring_clearance=0.2)
    free = multibody.simulate(Case(SQUAT, initial=initial, duration=2.0), support="flat")
    # the same steps in the same order
    np.testing.assert_allclose(wide.tilt, free.tilt, atol=1e-12)
    assert {"ring_clearance", "ring_inclination", "ring_facets", "ring_friction"} <= set(wide.settings)
    assert wide.settings["ring_inclination"] == pytest.approx(SQUAT.alpha)
    assert not any(name.startswith("ring") for name in free.settings)
    assert math.isinf(wide.first("wall_contact"))
    assert not wide.wall_contact.any()
    assert not wide.wall_impulse.any()
    assert wide.facts == ()


def test_a_cylinder_that_rolls_out_meets_the_wall_and_loses_energy() -> None:
    run = ring(ring_clearance=1e-3)
    assert run.outcome == "stands"
    assert 0.5 < run.first("wall_contact") < 1.5
    assert "wall_contact" in {fact.code for fact in run.facts}
    before = run.time < run.first("wall_contact")
    energy = run.energy[0]
    assert not run.wall_contact[before].any()
    assert (np.abs(run.energy_error[before]) < LOSSLESS * energy).all()
    assert run.energy_error[-1] < -100 * LOSSLESS * energy
    # time in contact and impulse only grow, together, and no faster than the clock
    assert (np.diff(run.wall_contact) >= 0.0).all()
    assert (np.diff(run.wall_impulse) >= 0.0).all()
    assert 0.0 < run.wall_contact[-1] <= run.time[-1] - run.first("wall_contact") + run.time_step
    assert run.wall_impulse[-1] > 0.0
    grows = np.diff(run.wall_impulse) > 0.0
    assert (np.diff(run.wall_contact)[grows] > 0.0).all()
    assert {"wall_contact", "wall_impulse"} <= set(run.to_frame())


def test_impulse_is_the_integral_of_the_wall_force() -> None:
    # at rest against a wall without friction: its normal force balances the push, with one part in a thousand
    # of the impact remaining
    push, steep = 0.05 * 9.81, 0.4
    motion = GroundMotion(np.tile([-push, 0.0], (51, 1)), 0.01)
    run = multibody.simulate(
        Case(PIER, motion, friction=0.0, duration=0.5),
        support="ring",
        ring_clearance=0.0001,
        ring_friction=0.0,
        ring_inclination=steep,
    )
    late = run.time > 0.3
    slope = np.polyfit(run.time[late], run.wall_impulse[late], 1)[0]
    assert slope == pytest.approx(push / math.cos(steep), rel=1e-3)
    assert np.polyfit(run.time[late], run.wall_contact[late], 1)[0] == pytest.approx(1.0, rel=1e-3)


def test_sinking_into_a_wall_is_a_breach() -> None:
    body = scaled_body(SQUAT, 1.0)
    start = starting_state(body, None, 1.0)
    still = np.zeros((5, 3))
    poses = Steps(np.tile(start.position, (5, 1)), np.tile(start.quaternion, (5, 1)), still, still)
    state = kinematics(poses, poses, body, 9.81)
    depth = np.array([0.0, 0.0, 0.5, 1.5, 2.0]) * PENETRATION * body.base_radius
    wall = Wall(depth > 0.0, np.zeros(5), depth)
    breach = first_breach(state, np.zeros(5), body, 9.81, in_recess=False, wall=wall)
    assert breach is not None
    assert (breach.index, breach.code) == (3, "wall_penetration")
    assert first_breach(state, np.zeros(5), body, 9.81, in_recess=False) is None


def test_a_wall_that_pushes_the_cylinder_down_is_not_reported() -> None:
    run = ring(PIER, rolling_rate=3.0, duration=1.0, friction=3.0, sample_step=1e-3)
    # ground and walls together push it down by its weight for some milliseconds
    assert run.contact_force[:, 2].min() < -0.5
    codes = {fact.code for fact in run.facts}
    assert "wall_contact" in codes
    assert not codes & {"tension", "friction_needed"}


@pytest.mark.slow
@pytest.mark.parametrize(
    ("extreme", "outcome", "said"),
    [
        # contact so stiff, or so elastic, that it gains energy
        ({"contact_time_constant": 1e-4}, "failed", "energy_gain"),
        ({"contact_damping_ratio": 0.01}, "failed", "energy_gain"),
        # without friction of the ground the walls alone hold it
        ({"friction": 0.0}, "stands", "wall_contact"),
        ({"rolling_rate": 30.0}, "stands", "lift_off"),
        ({"ring_friction": 10.0, "rolling_rate": 3.0}, "stands", "wall_contact"),
        # the coarsest step allowed
        ({"time_step": 1e-3}, "stands", "energy"),
    ],
)
def test_a_ring_at_an_extreme_reports_a_diagnostic(extreme: dict[str, Any], outcome: str, said: str) -> None:
    run = ring(SQUAT, duration=1.2, **{"friction": 3.0, **extreme})
    assert run.outcome == outcome
    assert said in {fact.code for fact in run.facts}
