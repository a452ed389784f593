"""From pose and velocity to the quantities of the model, and back."""

from __future__ import annotations

import math
from dataclasses import fields, replace
from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from rockwobble.models import Cylinder, InitialState
from rockwobble.multibody.engines.drake import _spin
from rockwobble.multibody.kinematics import (
    Kinematics,
    Rim,
    kinematics,
    rim,
    rolling_momentum,
    unwrap,
)
from rockwobble.multibody.protocol import Steps
from rockwobble.multibody.scene import Start, scaled_body, starting_state

CYLINDER = Cylinder(semidiagonal=2.0, tan_alpha=0.4)
BODY = scaled_body(CYLINDER, 1.0)


def steps_at(start: Start) -> Steps:
    return Steps(
        start.position[None], start.quaternion[None], start.velocity[None], start.angular_velocity[None]
    )


def at(start: Start) -> Kinematics:
    return kinematics(steps_at(start), steps_at(start), BODY, 9.81)


def momentum_at(start: Start) -> float:
    return float(rolling_momentum(steps_at(start), steps_at(start), BODY)[0])


def rim_at(start: Start) -> Rim:
    return rim(steps_at(start), steps_at(start), BODY)


@pytest.mark.parametrize("seed", range(20))
def test_a_state_is_recovered_from_its_pose_and_velocity(seed: int) -> None:
    random = np.random.default_rng(seed)
    state = InitialState(
        tilt=10.0 ** random.uniform(-9.0, 0.0),
        tilt_rate=random.normal(),
        rolling_angle=random.uniform(-3.0, 3.0),
        rolling_rate=random.normal(),
    )
    start = starting_state(BODY, state, 1.0)
    pose, place = at(start), rim_at(start)
    # accurate to rounding at every tilt; an arccosine would lose everything below 1e-8
    assert pose.tilt[0] == pytest.approx(state.tilt, rel=1e-12)
    assert pose.tilt_rate[0] == pytest.approx(state.tilt_rate, rel=1e-12)
    assert pose.azimuth[0] == pytest.approx(state.rolling_angle, rel=1e-9)
    # the rate is a difference of the order of tilt^2 rolling_rate: rounding over the tilt squared
    assert place.rolling_rate[0] == pytest.approx(state.rolling_rate, rel=1e-9 + 1e-15 / state.tilt**2)
    assert pose.twist[0] == 0.0
    # the lowest point is on the original circle, on the ground, and does not slip
    b = CYLINDER.base_radius
    expected = b * np.array([math.cos(state.rolling_angle), math.sin(state.rolling_angle)])
    np.testing.assert_allclose(place.contact_point[0], expected, atol=1e-15 / state.tilt + 1e-14)
    assert pose.depth[0] == pytest.approx(0.0, abs=1e-14)
    assert pose.slip_rate[0] == pytest.approx(0.0, abs=1e-13)


def test_energy_and_momentum_are_those_of_the_equations() -> None:
    state = InitialState(tilt=0.3, tilt_rate=0.7, rolling_angle=1.1, rolling_rate=-0.9)
    start = starting_state(BODY, state, 1.0)
    pose = at(start)
    b, h, theta = CYLINDER.base_radius, CYLINDER.mass_centre_height, state.tilt
    I1, I2 = (3 * b * b + 4 * h * h) / 12, b * b / 2
    t = math.tan(theta / 2)
    B = math.sin(theta) ** 2 * (I1 + h * h + 2 * h * b * t + (I2 + b * b) * t * t)
    A = I1 + h * h + b * b
    potential = 9.81 * (b * math.sin(theta) + h * (math.cos(theta) - 1.0))
    energy = 0.5 * A * state.tilt_rate**2 + 0.5 * B * state.rolling_rate**2 + potential
    assert pose.energy[0] == pytest.approx(energy, rel=1e-12)
    assert momentum_at(start) == pytest.approx(B * state.rolling_rate, rel=1e-12)


def test_momentum_ignores_the_place_and_a_sliding_point_slips() -> None:
    start = starting_state(BODY, InitialState(tilt=0.3, rolling_rate=0.5, tilt_rate=1.0), 1.0)
    moved = replace(start, position=start.position + np.array([50.0, 20.0, 0.0]))
    assert momentum_at(moved) == pytest.approx(momentum_at(start), rel=1e-12)
    sliding = replace(start, velocity=start.velocity + np.array([0.3, 0.4, 0.0]))
    assert at(sliding).slip_rate[0] == pytest.approx(0.5, rel=1e-12)


def test_upright_has_no_rates_to_divide_by() -> None:
    standing = starting_state(BODY, None, 1.0)
    for state in (at(standing), rim_at(standing)):
        for field in fields(state):
            assert np.isfinite(getattr(state, field.name)).all(), field.name
    assert at(standing).tilt[0] == at(standing).energy[0] == 0.0


@pytest.mark.parametrize("way", [1.0, -1.0])
@pytest.mark.parametrize("turn_in_step", [0.3, 2.0, 3.2, 4.5])
def test_rolling_angle_continues_in_the_sense_of_the_momentum(way: float, turn_in_step: float) -> None:
    # a pass turns by a little over pi, and at upright all of it in one step
    steady = np.array([0.1, 0.2, 0.3])
    angle = way * np.concatenate([steady, steady[-1] + turn_in_step + steady])
    wrapped = np.angle(np.exp(1j * angle))
    unwrapped = unwrap(wrapped, lambda at: np.full(len(at), way), np.ones(len(angle), dtype=bool), 0.0, True)
    np.testing.assert_allclose(unwrapped, angle, atol=1e-12)


def test_a_small_step_back_is_not_a_whole_turn() -> None:
    # under excitation momentum and angle may disagree for a step: only large changes are ambiguous
    always = np.array([True, True])
    np.testing.assert_allclose(unwrap(np.array([0.2, 0.1]), _forward, always, 0.15, True), [0.2, 0.1])


def test_the_rolling_angle_is_constant_at_rest() -> None:
    azimuth = np.array([0.5, 2.0, -2.9, 1.0, -1.0, 0.7])
    leans = np.array([True, False, False, False, True, True])
    angle = unwrap(azimuth, _forward, leans, 0.4, True)
    np.testing.assert_allclose(angle, [0.5, 0.5, 0.5, 0.5, -1.0, 0.7])


@pytest.mark.parametrize("edge", [1, 3, 4, 5])
def test_the_rolling_angle_is_continuous_over_chunks(edge: int) -> None:
    # it stands, tilts to the other side, and turns by more than a quarter at upright
    azimuth = np.array([0.5, 2.0, -2.9, 1.0, -2.4, 2.6, 2.7])
    leans = np.array([True, False, False, False, True, True, True])
    whole = unwrap(azimuth, _forward, leans, 0.4, True)
    np.testing.assert_allclose(whole[3:], [0.5, -2.4, 2.6 - 2.0 * np.pi, 2.7 - 2.0 * np.pi])
    first = unwrap(azimuth[:edge], _forward, leans[:edge], 0.4, True)
    second = unwrap(azimuth[edge:], _forward, leans[edge:], first[-1], bool(leans[edge - 1]))
    np.testing.assert_allclose(np.append(first, second), whole)


def _forward(at: Any) -> Any:
    """Positive momentum at every index."""
    return np.full(len(at), 1.0)


def test_drake_cylinder_recovers_its_rotation_about_the_axis() -> None:
    turned = Rotation.from_rotvec([[0.3, -0.2, 0.5], [1.0, 0.4, -0.7]])
    angle = np.array([0.8, -2.5])
    expected = turned * Rotation.from_rotvec(angle[:, None] * [0.0, 0.0, 1.0])
    turn = _spin(turned.as_quat(scalar_first=True), angle)
    assert turn == pytest.approx(expected.as_quat(scalar_first=True), abs=1e-14)
