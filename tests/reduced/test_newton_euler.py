"""The equations of motion and the contact force against Newton and Euler, in vectors.

The reference works in 40 digits: what is compared is the rounding of the code alone, also next to the
upright where the equations are badly conditioned. Every other problem is a frame: there the column and
its share of the slab are bodies of their own.
"""

from collections.abc import Sequence
from typing import Any, NamedTuple

import mpmath as mp
import numpy as np
import pytest
from newton_euler import Motion, Slab, State, Vector, kinetic_energy, newton_euler, vector

from rockwobble import reduced
from rockwobble.models import Case, Cylinder, InitialState, WobblingFrame
from rockwobble.reduced.body import Body, body_of
from rockwobble.reduced.equations import energy, flat_rhs, planar_rhs, recess_rhs
from rockwobble.reduced.forces import contact_force, derived_quantities, top_force
from rockwobble.reduced.integration.resisted import RESISTED_FLAT, RESISTED_RECESS
from rockwobble.reduced.rolling import creep_rate, rolling_momentum

AGREEMENT = 1e-12  # relative to the terms of each sum; measured 4e-14, and 4e-16 without twist
DIGITS = 40


def quadratic_form(body: Body, share: float, theta: Any) -> tuple[Any, Any, Any]:
    """B, G and C of a column and its share of the slab, per unit of the mass in the restoring moment.

    The kinetic energy is A theta'^2/2 + B phi'^2/2 - G phi' tau' + C tau'^2/2, tau = phi + psi, in vectors.
    """

    def kinetic(phi_rate: int, tau_rate: int) -> Any:
        state = State(theta, mp.mpf(0), mp.mpf(0), mp.mpf(phi_rate), mp.mpf(tau_rate - phi_rate))
        return kinetic_energy(body, state, share) / (1 + 2 * mp.mpf(share))

    B, C = 2 * kinetic(1, 0), 2 * kinetic(0, 1)
    return B, (B + C) / 2 - kinetic(1, 1), C


def momenta(body: Body, share: float, theta: Any, phi_rate: Any, tau_rate: Any) -> tuple[Any, Any]:
    """Return Lambda = B phi' - G tau' and S = (C - G^2/B) tau'."""
    B, G, C = quadratic_form(body, share, theta)
    return B * phi_rate - G * tau_rate, (C - G * G / B) * tau_rate


class Sample(NamedTuple):
    """A random state, in the variables of the code under test."""

    body: Body
    column: Body  # alone
    slab: Slab
    theta: float
    omega: float
    phi: float
    Lambda: float
    S: float
    ground: tuple[float, float, float]


def sample(seed: int, *, twisting: bool) -> Sample:
    random = np.random.default_rng(seed)
    size, gravity = 10.0 ** random.uniform(-2.0, 2.0), random.uniform(1.0, 30.0)
    inertias = {}
    if seed % 3 == 0:  # a body of revolution that is not a solid cylinder
        transverse = size**2 * 10.0 ** random.uniform(-2.0, 0.0)
        inertias = {
            "transverse_inertia": transverse,
            "axial_inertia": transverse * random.uniform(0.05, 1.95),
        }
    cylinder = Cylinder(semidiagonal=size, tan_alpha=10.0 ** random.uniform(-1.3, 0.7), **inertias)
    column = body_of(cylinder, gravity)
    rate = np.sqrt(gravity / size)
    theta = random.uniform(0.01, 1.4) if seed % 4 < 2 else 10.0 ** random.uniform(-6.0, -1.0)
    # in a near pass phi' is proportional to 1/theta
    phi_rate = random.uniform(-2.0, 2.0) * rate * min(1.0, 0.1 / theta) / min(1.0, 10.0 * theta)
    tau_rate = random.uniform(-1.0, 1.0) * rate if twisting else 0.0
    with mp.workdps(DIGITS):
        share = 10.0 ** random.uniform(-2.0, 2.0) if seed % 2 else 0.0
        Lambda, S = momenta(column, share, mp.mpf(theta), mp.mpf(phi_rate), mp.mpf(tau_rate))
    ax, ay, az = random.uniform(-1.0, 1.0, 3) * gravity
    return Sample(
        body_of(WobblingFrame(cylinder, share), gravity),
        column,
        Slab(mp.mpf(share), []),
        theta,
        random.uniform(-1.0, 1.0) * rate,
        random.uniform(-7.0, 7.0),
        float(Lambda),
        float(S),
        (float(ax), float(ay), float(az)),
    )


def state_of(given: Sample) -> State:
    """State that the rounded momenta stand for."""
    theta = mp.mpf(given.theta)
    B, G, C = quadratic_form(given.column, given.slab.share, theta)
    tau_rate = mp.mpf(given.S) / (C - G * G / B)
    phi_rate = (mp.mpf(given.Lambda) + G * tau_rate) / B
    return State(theta, mp.mpf(given.omega), mp.mpf(given.phi), phi_rate, tau_rate - phi_rate)


def momenta_rates(given: Sample, state: State, motion: Motion) -> tuple[Any, Any]:
    """Return Lambda' and S' from the accelerations of the angles."""

    def after(time: Any, index: int) -> Any:
        theta = state.theta + time * state.theta_rate
        phi_rate = state.phi_rate + time * motion.phi
        tau_rate = state.phi_rate + state.psi_rate + time * (motion.phi + motion.psi)
        return momenta(given.column, given.slab.share, theta, phi_rate, tau_rate)[index]

    # central difference: 1e-12 of the tilt leaves 1e-24, in arithmetic of 80 digits
    with mp.workdps(2 * DIGITS):
        step = state.theta * mp.mpf(10) ** -12 / (1 + abs(state.theta_rate) + abs(state.phi_rate))
        rates = [(after(step, i) - after(-step, i)) / (2 * step) for i in range(2)]
    return rates[0], rates[1]


def carried(given: Sample) -> Any:
    """Mass above the base over that of the column."""
    return 1 + given.slab.share


def resisted(given: Sample, share: float) -> Sample:
    """Body with a length of rolling resistance over the base radius, at both ends in a frame."""
    delta = share * given.body.b
    return given._replace(body=given.body._replace(delta=delta), column=given.column._replace(delta=delta))


def pressed(motion: Motion) -> Any:
    """Normal force on both ends of a column, over its mass."""
    return motion.force[2] + motion.top[2]


def polar(force: Vector, phi: float) -> Vector:
    """Return the components along the contact azimuth, across it and upwards."""
    c, s = mp.cos(mp.mpf(phi)), mp.sin(mp.mpf(phi))
    return vector(force[0] * c + force[1] * s, force[1] * c - force[0] * s, force[2])


def assert_close(values: Sequence[float], expected: Sequence[Any], scale: Sequence[Any]) -> None:
    errors = [float(abs(f - e) / s) for f, e, s in zip(values, expected, scale, strict=True)]
    assert max(errors) < AGREEMENT, errors


class Scales(NamedTuple):
    """Sizes of the terms in each sum; near upright phi' grows as 1/theta."""

    theta: Any  # theta''
    force: Any
    moment: Any  # and S'
    Lambda: Any  # Lambda'


def scales_of(given: Sample, state: State) -> Scales:
    size, theta = given.body.b + given.body.h, min(state.theta, 1)
    push = given.body.g + sum(abs(component) for component in given.ground)
    swing, roll, twist = abs(state.theta_rate), abs(state.phi_rate), abs(state.phi_rate + state.psi_rate)
    force = push + size * ((swing + twist) ** 2 + theta * roll * (roll + swing) + roll * twist)
    return Scales(
        theta=force * size / given.body.A,
        force=force,
        moment=size * (push + size * theta * swing * roll),
        Lambda=size * (push * theta + size * swing * twist),
    )


# a length of rolling resistance large enough to matter, with contact in most of the samples
KINDS = [
    *(pytest.param(seed, True, 0.0, id=f"recess-{seed}", marks=pytest.mark.slow) for seed in range(16)),
    *(pytest.param(seed, False, 0.0, id=f"flat-{seed}") for seed in range(100, 116)),
    *(
        pytest.param(seed, recess, share, id=f"resisted-{seed}-{recess}", marks=pytest.mark.slow)
        for seed, share in zip(range(140, 148), 2 * (0.01, 0.01, 0.51, 0.51), strict=True)
        for recess in (True, False)
    ),
]


@pytest.mark.parametrize(("seed", "recess", "share"), KINDS)
def test_accelerations_and_forces_obey_newton_and_euler(seed: int, recess: bool, share: float) -> None:
    free = sample(seed, twisting=not recess)
    given = resisted(free, share)
    body, ground, started = given.body, given.ground, (given.theta, given.omega, given.phi, given.Lambda)
    with mp.workdps(DIGITS):
        state = state_of(given)
        eps = mp.mpf(float(creep_rate(body, np.sin(given.theta)))) if share else mp.mpf(0)
        motion = newton_euler(given.column, state, vector(*ground), recess, given.slab, eps)
        if share and pressed(motion) <= 0:  # without contact there is no couple
            motion = newton_euler(free.column, state, vector(*ground), recess, given.slab)
            assert pressed(motion) <= 0
        Lambda_rate, S_rate = momenta_rates(given, state, motion)
        tau_rate, scale = state.phi_rate + state.psi_rate, scales_of(given, state)
        if share:
            system = RESISTED_RECESS if recess else RESISTED_FLAT
            rest = () if recess else (0.3, given.S, 0.0, 0.0)
            rates = system.derivative(body, (*started, *rest, 0.0), ground)
        elif recess:
            rates = recess_rhs(body, *started, *ground)
        else:
            rates = flat_rhs(body, *started, 0.3, given.S, *ground)
        expected = [state.theta_rate, motion.theta, state.phi_rate, Lambda_rate]
        sizes = [abs(state.theta_rate), scale.theta, abs(state.phi_rate), scale.Lambda]
        if not recess:
            assert motion.moment == 0
            expected += [tau_rate, S_rate]
            sizes += [abs(tau_rate), scale.moment]
            B, G, _ = quadratic_form(given.column, given.slab.share, state.theta)
            momenta = rolling_momentum(body, given.theta, given.Lambda, given.S)
            assert_close([momenta], [B * state.phi_rate], [abs(given.Lambda) + abs(G * tau_rate)])
        assert_close(rates[: len(expected)], expected, sizes)
        if share:
            rolling = mp.sqrt(state.theta_rate**2 + (mp.sin(state.theta) * state.psi_rate) ** 2)
            power = body.delta * max(pressed(motion), 0) * rolling**2 / mp.sqrt(rolling**2 + eps**2)
            power /= 1 + 2 * given.slab.share
            assert_close(rates[-1:], [power], [body.delta * scale.force * rolling])
        force = contact_force(body, *started, given.S, *ground, not recess)
        expected = [part / carried(given) for part in (*polar(motion.force, given.phi), motion.moment)]
        assert_close(force, expected, [scale.force, scale.force, scale.force, scale.moment])


@pytest.mark.parametrize("seed", range(200, 210))
def test_planar_acceleration_and_forces_obey_newton_and_euler(seed: int) -> None:
    given = sample(seed, twisting=False)._replace(Lambda=0.0)
    along, vertical = given.ground[0], given.ground[2]
    for direction in (1.0, -1.0):
        with mp.workdps(DIGITS):
            state = State(
                mp.mpf(given.theta),
                mp.mpf(given.omega),
                mp.mpf(0 if direction > 0 else mp.pi),
                mp.mpf(0),
                mp.mpf(0),
            )
            motion = newton_euler(given.column, state, vector(along, 0, vertical), True, given.slab)
            rates = planar_rhs(given.body, given.theta, direction, along, vertical)
            assert_close((rates,), (motion.theta,), (scales_of(given, state).theta,))


@pytest.mark.parametrize("seed", range(220, 230))
def test_energy_is_the_sum_over_both_bodies(seed: int) -> None:
    given = sample(seed, twisting=bool(seed % 4))
    body = given.body
    with mp.workdps(DIGITS):
        state = state_of(given)
        share = given.slab.share
        kinetic = kinetic_energy(given.column, state, share) / (1 + 2 * share)
        potential = body.g * (body.b * mp.sin(state.theta) - body.h * (1 - mp.cos(state.theta)))
        total = energy(body, given.theta, given.omega, given.Lambda, given.S)
        assert_close((total,), (kinetic + potential,), (kinetic + body.g * (body.b + body.h) * state.theta,))


@pytest.mark.parametrize("free_twist", [False, True])
@pytest.mark.parametrize("seed", range(300, 305))
def test_contact_force_is_in_world_axes_and_weights(seed: int, free_twist: bool) -> None:
    given = sample(seed, twisting=free_twist)
    states = np.array([[given.theta, given.omega, given.phi, given.Lambda, 0.3, given.S], np.zeros(6)])
    quantities = derived_quantities(given.body, states, np.array([given.ground, given.ground]), free_twist)
    with mp.workdps(DIGITS):
        state = state_of(given)
        motion = newton_euler(given.column, state, vector(*given.ground), not free_twist, given.slab)
        weight, scale = given.body.g * carried(given), scales_of(given, state)
        assert_close(
            tuple(quantities[0, 2:]),
            tuple(component / weight for component in (*motion.force, motion.moment)),
            tuple(size / weight for size in (scale.force, scale.force, scale.force, scale.moment)),
        )
        assert_close((quantities[0, 0],), (state.phi_rate,), (abs(state.phi_rate),))
        # a standing body moves with the ground
        standing = vector(*given.ground) / mp.mpf(given.body.g) + vector(0, 0, 1)
        assert_close(tuple(quantities[1]), (0, 0, *standing, 0), (1,) * 6)


@pytest.mark.parametrize("seed", range(401, 411, 2))
def test_force_on_the_slab_obeys_newton(seed: int) -> None:
    given = sample(seed, twisting=True)
    states = np.array([[given.theta, given.omega, given.phi, given.Lambda, 0.3, given.S]])
    ground = np.array([given.ground])
    base = derived_quantities(given.body, states, ground, True)[:, 2:5]
    force = top_force(given.body, base, ground, states, float(given.slab.share))
    with mp.workdps(DIGITS):
        state = state_of(given)
        motion = newton_euler(given.column, state, vector(*given.ground), False, given.slab)
        scale = scales_of(given, state).force / given.body.g
        assert_close(tuple(force[0]), tuple(motion.top / given.slab.share / given.body.g), (scale,) * 3)


def test_the_turn_of_a_free_slab_falls_with_the_distance_of_columns() -> None:
    """On a plan of finite size the slab turns, because its columns touch it off their axes."""
    given = sample(7, twisting=False)
    share, column = mp.mpf(1), given.column
    corners = [(mp.cos(angle), mp.sin(angle)) for angle in (0.3, 2.4, 4.5)]
    with mp.workdps(DIGITS):
        state = state_of(given)
        turns, errors = [], []
        for width in (1e2, 1e3):
            reach = width * column.b
            places = [vector(reach * x, reach * y, 0) for x, y in corners]
            middle = sum(places) / 3
            free = Slab(share, [place - middle for place in places], share * 3 * mp.mpf(reach) ** 2 / 2)
            motion = newton_euler(column, state, vector(*given.ground), True, free)
            guided = newton_euler(column, state, vector(*given.ground), True, Slab(share, []))
            turns.append(float(max(abs(motion.slab_turn))))
            errors.append(float(abs(motion.theta - guided.theta)))
    assert turns[0] / turns[1] == pytest.approx(100.0, rel=0.1)  # as 1/width^2
    assert errors[0] > 5.0 * errors[1] > 0.0


@pytest.mark.parametrize("support", ["recess", "flat"])
def test_the_moment_about_the_vertical_is_1_plus_cos_theta_times_kappa(support: str) -> None:
    """From the angular momentum about the vertical through the mass centre, by the stored angles alone."""
    cylinder = Cylinder(semidiagonal=6.0, tan_alpha=0.4, transverse_inertia=9.0, axial_inertia=2.0)
    case = Case(cylinder, initial=InitialState(0.5 * cylinder.alpha, rolling_rate=1.2), duration=1.0)
    step = 1e-3
    trace = reduced.simulate(case, support=support, sample_step=step, rtol=1e-12)
    s, c = np.sin(trace.tilt), np.cos(trace.tilt)
    about_axis = np.gradient(trace.twist, step, edge_order=2) - (1.0 - c) * trace.rolling_rate
    momentum = 9.0 * s**2 * trace.rolling_rate + 2.0 * c * about_axis
    arm, force = trace.contact_point - trace.centre_of_mass[:, :2], 9.81 * trace.contact_force
    moment = np.gradient(momentum, step) - (arm[:, 0] * force[:, 1] - arm[:, 1] * force[:, 0])
    stated = (1.0 + c) * 9.81 * trace.restraining_moment
    assert np.abs(stated).max() > 1e-3 if support == "recess" else (stated == 0.0).all()
    np.testing.assert_allclose(moment[2:-2], stated[2:-2], rtol=0.0, atol=2e-9)
