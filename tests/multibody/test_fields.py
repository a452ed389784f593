"""Every sampled field of a run against finite differences and closed forms of the others."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any

import numpy as np
import pytest

from rockwobble import multibody
from rockwobble.models import Case, Cylinder, GroundMotion, InitialState, Trace

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
    columns = np.column_stack([np.interp(time, samples, part) for part in SHAKING.acceleration.T])
    return columns * (time <= samples[-1])[:, None]


def slope(values: Any) -> Any:
    """Central difference of samples, second order: 1e-6 of the third derivative."""
    return (values[2:] - values[:-2]) / (2.0 * SAMPLE)


def away_from_kinks(time: Any, distance: float) -> Any:
    since = np.abs(time[:, None] - SHAKING.time_step * np.arange(len(SHAKING.acceleration)))
    return (since.min(axis=1) > distance) & (time > distance) & (time < 1.0 - distance)


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
    # energy less the work of the ground is constant
    push = (ground(run.time)[inner] * velocity).sum(axis=1)
    work = np.append(0.0, -SAMPLE * np.cumsum(0.5 * (push[1:] + push[:-1])))
    kept = run.energy[inner] - work
    np.testing.assert_allclose(kept, kept[0] * np.ones(len(kept)), atol=2e-3 * energy.max())
    assert np.ptp(run.energy) > 0.05 * energy.max()
    # half of the work of one step is 1e-4 of the energy; contact takes 4e-6
    assert np.abs(run.energy_error).max() < 1e-5 * energy.max()


def test_force_is_mass_times_acceleration_plus_weight(run: Any) -> None:
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
    # after the record ends with a jump, free motion alone
    still = run.time[inner][clear] > 0.805
    assert np.median(error[still]) < 1e-4


@pytest.mark.slow
def test_the_vertical_component_moves_the_uplift(engine: str, solve_forced: Callable[..., Any]) -> None:
    # the load of the rim is g + az: a ramp of the push reaches its share of it at another time
    uplifts = []
    for vertical in (-3.0, 0.0, 3.0):
        ramp = GroundMotion([[0.0, 0.0, vertical], [3.0, 0.1, vertical], [6.0, 0.2, vertical]], 0.4)
        trace = multibody.simulate(Case(PIER, ramp), engine=engine)
        due = 0.8 * (9.81 + vertical) * PIER.tan_alpha / np.hypot(6.0, 0.2)
        assert trace.uplift_time == pytest.approx(due, abs=2e-4 if engine == "mujoco" else 1e-4)
        assert trace.uplift_direction == pytest.approx(np.arctan2(-0.2, -6.0), abs=1e-2)
        exact = solve_forced(PIER, ramp, 0.8)
        assert trace.tilt[-1] == pytest.approx(exact.tilt[-1], abs=UPLIFT[engine] * PIER.alpha)
        uplifts.append(trace.uplift_time)
    assert uplifts == sorted(uplifts)
