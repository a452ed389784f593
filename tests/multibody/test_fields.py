"""Every sampled field of a run against finite differences and closed forms of the others."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from functools import cache
from typing import Any

import numpy as np
import pytest

from rockwobble import multibody
from rockwobble.models import Case, Cylinder, GroundMotion, InitialState, Trace, el_centro_1940

PIER = Cylinder(semidiagonal=6.0, tan_alpha=0.35)
RELEASE = InitialState(0.4 * PIER.alpha, rolling_angle=0.6, rolling_rate=0.9)
SAMPLE = 1e-3  # [s]
# Of alpha, error of the tilt some 0.3 s after an uplift at a step of 1e-4 s, of first order in it. A load of
# the wrong sign in the vertical component shifts the uplift by 0.1 s, and the tilt by a hundredth.
# of MuJoCo in one plane, where nothing is steered and soft points calm the base
UPLIFT = {"mujoco": 6e-6, "pybullet": 2e-6, "dart": 2e-6, "drake": 2e-6}
SHAKING = GroundMotion(
    [[0.5, -0.3, 0.4], [1.5, 0.4, -2.0], [-1.0, 0.8, 1.5], [0.3, -1.2, -0.8], [1.0, 0.7, 0.9]], 0.2
)


@pytest.fixture
def run(engine: str) -> Trace:
    """A release under all three components, free to twist, and still ground from 0.8 s on."""
    return _run(engine)


@cache
def _run(engine: str) -> Trace:
    return multibody.simulate(
        Case(PIER, SHAKING, initial=RELEASE, duration=1.0), engine=engine, support="flat", sample_step=SAMPLE
    )


def ground(time: Any) -> Any:
    """Acceleration at some times, zero outside the record, shape (n, 3)."""
    samples = SHAKING.time_step * np.arange(len(SHAKING.acceleration))
    found = np.column_stack([np.interp(time, samples, part) for part in SHAKING.acceleration.T])
    return found * (time <= samples[-1])[:, None]


def slope(values: Any) -> Any:
    """Central difference of samples, second order: 1e-6 of the third derivative."""
    return (values[2:] - values[:-2]) / (2.0 * SAMPLE)


def away_from_kinks(time: Any, distance: float) -> Any:
    since = np.abs(time[:, None] - SHAKING.time_step * np.arange(len(SHAKING.acceleration)))
    return (since.min(axis=1) > distance) & (time > distance) & (time < 1.0 - distance)


def test_rates_are_the_slopes_of_the_angles(run: Any) -> None:
    np.testing.assert_allclose(run.tilt_rate[1:-1], slope(run.tilt), atol=1e-4)
    np.testing.assert_allclose(run.rolling_rate[1:-1], slope(run.rolling_angle), atol=2e-3)
    assert np.ptp(run.tilt_rate) > 0.08
    assert np.ptp(run.rolling_rate) > 0.3


def test_positions_are_those_of_a_rim_on_the_ground(run: Any) -> None:
    # r_S = T + b (base centre less contact point) + h axis, and the lowest point on the ground
    b, h = PIER.base_radius, PIER.mass_centre_height
    lean = np.column_stack([np.cos(run.rolling_angle), np.sin(run.rolling_angle)])
    sine, cosine = np.sin(run.tilt), np.cos(run.tilt)
    over = run.contact_point + (h * sine - b * cosine)[:, None] * lean
    np.testing.assert_allclose(run.centre_of_mass[:, :2], over, atol=1e-7)
    np.testing.assert_allclose(run.centre_of_mass[:, 2], h * cosine + b * sine, atol=1e-6)
    np.testing.assert_allclose(run.contact_offset, np.hypot(*run.contact_point.T) - b, atol=1e-12)
    assert np.ptp(run.contact_offset) > 1e-3 * b
    base = run.centre_of_mass[-1, :2] - h * sine[-1] * lean[-1]
    assert run.residual_displacement == pytest.approx(np.hypot(*base), rel=1e-6)
    assert run.residual_twist == run.twist[-1]


def test_the_rim_rolls_without_slip_as_the_twist_says(run: Any) -> None:
    # the contact point advances by b psi' along the rim, with psi = twist - phi
    turning = slope(run.twist - run.rolling_angle)
    phi = run.rolling_angle[1:-1]
    along = PIER.base_radius * turning[:, None] * np.column_stack([np.sin(phi), -np.cos(phi)])
    np.testing.assert_allclose(slope(run.contact_point), along, atol=5e-3)
    assert np.abs(along).max() > 1.0
    assert np.abs(run.twist).max() > 1e-2


def test_energy_is_kinetic_and_potential(run: Any) -> None:
    velocity = slope(run.centre_of_mass)
    theta, inner = run.tilt[1:-1], slice(1, -1)
    b, height = PIER.base_radius, 2.0 * PIER.half_height
    phi_rate = slope(run.rolling_angle)
    spin = slope(run.twist) - phi_rate + phi_rate * np.cos(theta)  # about the axis
    transverse, axial = (3.0 * b * b + height * height) / 12.0, 0.5 * b * b
    energy = 0.5 * (velocity**2).sum(axis=1) + 9.81 * (run.centre_of_mass[inner, 2] - PIER.mass_centre_height)
    energy += (
        0.5 * transverse * (slope(run.tilt) ** 2 + (phi_rate * np.sin(theta)) ** 2) + 0.5 * axial * spin**2
    )
    np.testing.assert_allclose(run.energy[inner], energy, atol=2e-4 * energy.max())
    # less the work of the ground it stays as it was
    push = (ground(run.time)[inner] * velocity).sum(axis=1)
    work = np.append(0.0, -SAMPLE * np.cumsum(0.5 * (push[1:] + push[:-1])))
    kept = run.energy[inner] - work
    np.testing.assert_allclose(kept, kept[0] * np.ones(len(kept)), atol=2e-3 * energy.max())
    assert np.ptp(run.energy) > 0.05 * energy.max()
    # half of the work of one step is 1e-4 of the energy; contact takes 4e-6
    assert np.abs(run.energy_error).max() < 1e-5 * energy.max()


def test_force_is_what_the_mass_centre_needs(run: Any) -> None:
    inner = slice(1, -1)
    curve = np.diff(run.centre_of_mass, 2, axis=0) / SAMPLE**2
    needed = (curve + ground(run.time)[inner]) / 9.81 + [0.0, 0.0, 1.0]
    # a sample of the force is a mean over 3.3 ms on each side, and a kink of the record lies in one of them
    clear = away_from_kinks(run.time[inner], 0.005)
    assert clear.sum() > 900
    error = np.abs(run.contact_force[inner] - needed)[clear]
    assert np.median(error) < 1e-4
    assert np.quantile(error, 0.9) < 5e-3
    assert np.ptp(needed[:, 2]) > 0.3
    # after the record ends, with a jump, nothing but its own motion
    still = run.time[inner][clear] > 0.805
    assert np.median(error[still]) < 1e-4


@pytest.mark.slow
@pytest.mark.parametrize("vertical", [3.0, -2.0])
def test_a_constant_vertical_acceleration_is_gravity(engine: str, vertical: float) -> None:
    motion = GroundMotion(np.tile([0.0, 0.0, vertical], (2, 1)), 1.0)
    moved, heavy = (
        multibody.simulate(
            Case(PIER, given, initial=RELEASE, duration=0.9, gravity=gravity), engine=engine, time_step=1e-4
        )
        for given, gravity in ((motion, 9.81), (None, 9.81 + vertical))
    )
    # the scene of the other gravity has another step, and the first half step feels no ground yet
    np.testing.assert_allclose(moved.tilt, heavy.tilt, atol=2e-4 * PIER.alpha)
    still = multibody.simulate(Case(PIER, initial=RELEASE, duration=0.9), engine=engine)
    assert np.abs(still.tilt - heavy.tilt).max() > 0.02 * PIER.alpha
    part = slice(5, -5)
    np.testing.assert_allclose(
        moved.contact_force[part], heavy.contact_force[part] * (9.81 + vertical) / 9.81, atol=2e-3
    )


@pytest.mark.slow
def test_the_vertical_component_moves_the_uplift(engine: str, solve_forced: Callable[..., Any]) -> None:
    # the load of the rim is g + az: a ramp of the push reaches its share of it at a time of its own
    uplifts = []
    for vertical in (-3.0, 0.0, 3.0):
        ramp = GroundMotion([[0.0, 0.0, vertical], [3.0, 0.1, vertical], [6.0, 0.2, vertical]], 0.4)
        found = multibody.simulate(Case(PIER, ramp), engine=engine)
        due = 0.8 * (9.81 + vertical) * PIER.tan_alpha / np.hypot(6.0, 0.2)
        assert found.uplift_time == pytest.approx(due, abs=2e-4 if engine == "mujoco" else 1e-4)
        assert found.uplift_direction == pytest.approx(np.arctan2(-0.2, -6.0), abs=1e-2)
        exact = solve_forced(PIER, ramp, 0.8)
        assert found.tilt[-1] == pytest.approx(exact.tilt[-1], abs=UPLIFT[engine] * PIER.alpha)
        uplifts.append(found.uplift_time)
    assert uplifts == sorted(uplifts)


@pytest.mark.slow
def test_the_ground_keeps_still_after_the_last_sample(engine: str) -> None:
    # the record ends at its largest: the run is that of a record with zeros after it
    push = np.array([[0.0, 0.0, 0.0], [1.5, 0.5, 2.0], [2.0, -1.0, -3.0]])
    ended = GroundMotion(push, 0.1)
    followed = dataclasses.replace(ended, acceleration=np.vstack([push, np.zeros((2, 3))]))
    first, still = (
        multibody.simulate(Case(PIER, motion, initial=RELEASE, duration=0.5), engine=engine)
        for motion in (ended, followed)
    )
    # a record goes down to its first zero in a straight line, which one that ends does not
    until = first.time <= 0.2
    np.testing.assert_allclose(first.tilt[until], still.tilt[until], atol=1e-8)
    after = first.time > 0.205
    np.testing.assert_allclose(first.energy[after], first.energy[after][0], atol=1e-4 * first.energy.max())
    assert np.ptp(still.energy[(still.time > 0.205) & (still.time < 0.3)]) > 1e-2 * still.energy.max()


@pytest.mark.slow
def test_the_twist_of_a_whole_earthquake_does_not_jump(engine: str) -> None:
    # on flat ground it goes beyond a turn; a quaternion tells it up to two, and Bullet changes its sign
    case = Case(Cylinder(semidiagonal=6.0, tan_alpha=0.2), el_centro_1940())
    for step in (1e-3, 8e-4, 6e-4, 4e-4):  # in a run that long it is chance how far it goes
        run = multibody.simulate(case, engine=engine, support="flat", time_step=step)
        # 0.3 rad/s over 10 ms
        assert np.abs(np.diff(run.twist)).max() < 0.01
        if np.abs(run.twist).max() > np.pi:
            break
    assert np.abs(run.twist).max() > np.pi
    assert run.residual_twist == run.twist[-1]
