"""The derivation that the checks rest on, against solutions that are independent of it."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest
from newton_euler import State, kinetic_energy, newton_euler, vector

from rockwobble import reduced
from rockwobble.compare.check import Bench, differences
from rockwobble.compare.check.models import equations, lagrange, quadrature, short_motions
from rockwobble.models import Case, Cylinder, InitialState, read_suite
from rockwobble.reduced.body import body_of

CYLINDER = Cylinder(semidiagonal=6.0, tan_alpha=0.4, transverse_inertia=9.0, axial_inertia=2.0)
SHAPE = lagrange.shape_of(CYLINDER)
ROUNDING = 1e-12


def one(*values: float) -> list[np.ndarray]:
    return [np.array([value]) for value in values]


def test_kinetic_energy_is_that_of_vectors() -> None:
    theta, phi, theta_rate, phi_rate = 0.3, 1.1, 0.7, -0.9
    expected = kinetic_energy(
        body_of(CYLINDER, 9.81), State(*map(vector_of, (theta, theta_rate, phi, phi_rate, -phi_rate)))
    )
    found = lagrange.kinetic(SHAPE, *one(theta, phi, theta_rate, phi_rate))[0]
    assert found == pytest.approx(float(expected), rel=ROUNDING)


def vector_of(value: float):
    return vector(value)[0]


def test_accelerations_of_newton_and_euler_leave_no_residual() -> None:
    theta, phi, theta_rate, phi_rate = 0.5, -0.4, 0.3, 0.8
    ground = (1.1, -0.7, 0.4)
    state = State(*map(vector_of, (theta, theta_rate, phi, phi_rate, -phi_rate)))
    motion = newton_euler(body_of(CYLINDER, 9.81), state, vector(*ground), True)
    arguments = (one(theta, phi), one(theta_rate, phi_rate))
    found = lagrange.residuals(
        SHAPE, *arguments, one(float(motion.theta), float(motion.phi)), np.array([ground])
    )
    # rounding of differences 0.01 s apart, of energies of 60 m^2/s^2
    assert max(abs(value[0]) for value in found) < 1e-10
    wrong = lagrange.residuals(
        SHAPE, *arguments, one(1.01 * float(motion.theta), float(motion.phi)), np.array([ground])
    )
    assert abs(wrong[0][0]) > 1e-2
    force = np.array([motion.force], dtype=float)
    curves = one(float(motion.theta), float(motion.phi))
    kappa = lagrange.restraining(SHAPE, *arguments, curves, force)[0]
    assert kappa == pytest.approx(float(motion.moment), rel=ROUNDING)


def test_a_restraining_moment_that_is_off_by_a_millionth_is_found() -> None:
    motion = short_motions.sample(Bench(reduced=reduced, suite=read_suite("quick")), CYLINDER)
    assert equations._euler(motion) < equations.MOMENT.most
    wrong = dataclasses.replace(motion, stated_moment=(1.0 + 1e-6) * motion.stated_moment)
    assert equations._euler(wrong) > equations.MOMENT.most


@pytest.mark.parametrize("support", ["recess", "flat"])
def test_the_moment_about_the_vertical_is_1_plus_cos_theta_times_kappa(support: str) -> None:
    release = InitialState(tilt=0.5 * CYLINDER.alpha, rolling_rate=1.2)
    step = 1e-3
    found = reduced.simulate(
        Case(CYLINDER, initial=release, duration=1.0), support=support, sample_step=step, rtol=1e-12
    )
    # angular momentum about the vertical through the mass centre, from the stored angles alone
    s, c = np.sin(found.tilt), np.cos(found.tilt)
    twist_rate = np.gradient(found.twist, step, edge_order=2)
    about_axis = twist_rate - (1.0 - c) * found.rolling_rate
    momentum = SHAPE.I1 * s**2 * found.rolling_rate + SHAPE.I2 * c * about_axis
    arm = found.contact_point - found.centre_of_mass[:, :2]
    force = SHAPE.g * found.contact_force
    moment = np.gradient(momentum, step) - (arm[:, 0] * force[:, 1] - arm[:, 1] * force[:, 0])
    stated = (1.0 + c) * SHAPE.g * found.restraining_moment
    assert np.abs(stated).max() > 1e-3 if support == "recess" else (stated == 0.0).all()
    np.testing.assert_allclose(moment[2:-2], stated[2:-2], rtol=0.0, atol=2e-9)


@pytest.mark.parametrize("place", [1, 2, 3])
def test_a_coefficient_of_the_equations_as_written_is_found(
    monkeypatch: pytest.MonkeyPatch, place: int
) -> None:
    right = reduced.equations.recess_rhs

    def wrong(*state: float) -> list[float]:
        return [rate * (1.0 + 1e-9 * (at == place)) for at, rate in enumerate(right(*state))]

    assert max(equations._written(reduced, CYLINDER)) < ROUNDING
    monkeypatch.setattr(reduced.equations, "recess_rhs", wrong)
    off = equations._written(reduced, CYLINDER)
    assert [error > ROUNDING for error in off] == [place == at for at in (1, 2, 3)]


def test_differences_are_exact_for_polynomials_and_good_for_sines() -> None:
    time = 0.05 * np.arange(17)
    assert differences.first(time**5, 0.05) == pytest.approx(5.0 * time[6:-6] ** 4, rel=1e-10)
    assert differences.second(np.sin(time), 0.05) == pytest.approx(-np.sin(time[6:-6]), abs=1e-12)


@pytest.mark.parametrize("tan_alpha", [0.1, 1.0])
def test_quadrature_gives_the_angle_of_turn_of_the_exact_solution(tan_alpha: float) -> None:
    cylinder = Cylinder(semidiagonal=6.0, tan_alpha=tan_alpha)
    tilt = 0.5 * cylinder.alpha
    _, turn = quadrature.period_and_turn(lagrange.shape_of(cylinder), tilt, 0.3)
    # rounding of the energies near both ends
    assert turn == pytest.approx(
        reduced.angle_of_turn(cylinder, InitialState(tilt=tilt, rolling_rate=0.3)), abs=1e-9
    )


def test_quarter_period_and_steady_rate_are_those_of_closed_forms() -> None:
    tilt = 0.4 * CYLINDER.alpha
    assert quadrature.planar_quarter(SHAPE, tilt) == pytest.approx(
        reduced.planar_quarter_period(CYLINDER, tilt), rel=1e-10
    )
    assert quadrature.steady_rate(SHAPE, tilt) == pytest.approx(
        reduced.steady_wobble_rate(CYLINDER, tilt), rel=ROUNDING
    )
    assert quadrature.tilt_inertia(SHAPE) == pytest.approx(9.0 + 36.0, rel=ROUNDING)
    assert not math.isnan(quadrature.turn_inertia(SHAPE, np.array([1e-3]))[0])
