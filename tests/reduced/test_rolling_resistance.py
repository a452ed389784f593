"""Rolling resistance against quadrature, closed forms and balances: swings, passes, standstills, uplift."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable

import numpy as np
import pytest
from scipy.integrate import quad

from rockwobble import reduced
from rockwobble.models import (
    Case,
    Cylinder,
    GroundMotion,
    InitialState,
    Trace,
    WobblingFrame,
    el_centro_1940,
    synthetic_motions,
)
from rockwobble.reduced.body import Body, body_of
from rockwobble.reduced.equations import flat_rhs
from rockwobble.reduced.integration import stiff
from rockwobble.reduced.integration.resisted import RESISTED_FLAT
from rockwobble.reduced.integration.result import State
from rockwobble.reduced.rolling import impact_ratio, momenta_of, needed_to_stand, twist_share

G = 9.81
BODIES = {
    "h = 2b": Cylinder(semidiagonal=math.sqrt(5.0), tan_alpha=0.5),
    "slender": Cylinder(semidiagonal=6.0, tan_alpha=0.1),
    "squat": Cylinder(semidiagonal=0.5, tan_alpha=1.5),
    "inertias": Cylinder(semidiagonal=2.0, tan_alpha=0.4, transverse_inertia=1.2, axial_inertia=0.3),
    "frame": WobblingFrame(Cylinder(semidiagonal=3.0, tan_alpha=0.3), 2.0),
}
SMALL = 1e-6  # delta over b, at which a loss is of first order to 1e-5


def released(cylinder: Cylinder, length: float, spin: float = 0.0, duration: float = 8.0) -> Case:
    release = InitialState(0.5 * cylinder.alpha, rolling_rate=spin)
    return Case(cylinder, initial=release, duration=duration, rolling_resistance=length)


def lost_by_load(body: Body, tilt: float) -> float:
    """Return the integral of N over the tilt from rest at `tilt` to upright, of the motion without loss.

    N is that on both ends of a column, whose mass centre has mu times the inertia of the load.
    """
    b, h, mu = body.b, body.h, body.mu

    def rate_squared(theta: float) -> float:
        fall = math.sin(0.5 * (tilt - theta)) * 2.0
        middle = 0.5 * (tilt + theta)
        return 2.0 * body.g * fall * (b * math.cos(middle) - h * math.sin(middle)) / body.A

    def normal(theta: float) -> float:
        s, c = math.sin(theta), math.cos(theta)
        acceleration = -body.g * (b * c - h * s) / body.A
        return body.g + mu * ((b * c - h * s) * acceleration - (b * s + h * c) * rate_squared(theta))

    return float(quad(normal, 0.0, tilt, epsrel=1e-12)[0])


def swing_loss(trace: Trace) -> float:
    """Return the share of its energy that a motion loses from its release to the next maximum."""
    maxima = trace.extrema[trace.extrema[:, 3] > 0.0]
    energy = np.interp(maxima[:2, 0], trace.time, trace.energy_lost)
    return float((energy[1] - energy[0]) / trace.energy[0])


@pytest.mark.parametrize("cylinder", BODIES.values(), ids=BODIES)
def test_the_loss_of_a_swing_from_rest(cylinder: Cylinder) -> None:
    body = body_of(cylinder, G)
    b, tilt = body.b, 0.5 * cylinder.alpha
    potential = G * (b * math.sin(tilt) - 2.0 * body.h * math.sin(0.5 * tilt) ** 2)
    load, at_pass = 2.0 * b * lost_by_load(body, tilt) / potential, 4.0 * body.mu * b * b / body.A
    if cylinder is BODIES["h = 2b"]:
        assert (round(load, 3), round(at_pass, 3)) == (2.262, 0.608)
    case = released(cylinder, SMALL * b, duration=10.0 / body.p)
    trace = reduced.simulate(case, rtol=1e-12, sample_step=1e-3 / body.p)
    # of first order in SMALL, and the energy lost is read off between samples at rest
    assert swing_loss(trace) / SMALL == pytest.approx(load + at_pass, rel=3e-5)


def test_a_pass_of_vanishing_spin_takes_more_than_an_impact() -> None:
    """In the recess the speed rises by sqrt(A/J) on the way round the upright position."""
    cylinder = BODIES["h = 2b"]
    body = body_of(cylinder, G)
    tilt = 0.5 * cylinder.alpha
    potential = G * (body.b * math.sin(tilt) - 2.0 * body.h * math.sin(0.5 * tilt) ** 2)
    load = 2.0 * body.b * lost_by_load(body, tilt) / potential
    longer = quad(lambda x: math.sqrt(x * x + body.A / body.J * (1.0 - x * x)), 0.0, 1.0)[0]
    assert longer == pytest.approx(1.0577, abs=1e-4)
    case = released(cylinder, SMALL * body.b, spin=1e-5, duration=2.0)
    trace = reduced.simulate(case, rtol=1e-11, sample_step=1e-4)
    expected = load + longer * 4.0 * body.b**2 / body.A
    assert swing_loss(trace) / SMALL == pytest.approx(expected, rel=2e-4)  # the spin and the samples


def test_an_impact_loses_what_delta_of_b_does_to_first_order() -> None:
    slenderness = np.array([0.1, 0.05, 0.025])
    differences = []
    for tan_alpha in slenderness:
        cylinder = Cylinder(semidiagonal=1.0, tan_alpha=tan_alpha)
        body = body_of(cylinder, G)
        rolling = impact_ratio(body._replace(delta=body.b), 1.0)
        differences.append(rolling - reduced.restitution_from_momentum(cylinder))
    slope = np.polyfit(np.log(slenderness), np.log(differences), 1)[0]
    assert slope == pytest.approx(4.0, abs=0.2)  # both lose 2 b^2/A, and differ by its square


@pytest.mark.parametrize("kind", ["h = 2b", "frame"])
@pytest.mark.parametrize("restitution", [1.0, 0.9])
def test_what_the_couple_takes_of_an_impact(restitution: float, kind: str) -> None:
    body = body_of(BODIES[kind], G, 0.02)
    before = 0.7
    after = impact_ratio(body, restitution) * before
    impulse = body.mu * body.b * (before + after)
    assert body.A * (restitution * before - after) == pytest.approx(
        body.delta * impulse, rel=1e-14
    )  # rounding


def work_of_ground(trace: Trace, motion: GroundMotion, plane: float | None) -> np.ndarray:
    """Return the work of the inertia force of the ground up to each sample, per unit mass."""
    at = np.arange(len(motion.acceleration)) * motion.time_step
    force = -np.column_stack([np.interp(trace.time, at, column) for column in motion.acceleration.T])
    if plane is not None:
        along = np.array([math.cos(plane), math.sin(plane)])
        force[:, :2] = (force[:, :2] @ along)[:, None] * along
    moved = np.diff(trace.centre_of_mass[:, : force.shape[1]], axis=0)
    return np.concatenate([[0.0], np.cumsum((0.5 * (force[1:] + force[:-1]) * moved).sum(axis=1))])


@pytest.mark.parametrize("model", reduced.MODELS)
@pytest.mark.parametrize("restitution", [1.0, "momentum"])
def test_the_energy_of_a_run_is_accounted_for(model: str, restitution: float | str) -> None:
    options = dict(reduced.MODELS[model])
    if model == "planar":
        options |= {"restitution": restitution}
    motion = el_centro_1940().scaled(2.0)
    cylinder = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    small = 0.01 * cylinder.base_radius
    for body, length in ((cylinder, 0.0), (cylinder, small), (WobblingFrame(cylinder, 2.0), small)):
        case = Case(body, motion, duration=12.0, rolling_resistance=length)
        trace = reduced.simulate(case, sample_step=1e-3, rtol=1e-9, **options)
        work = work_of_ground(trace, motion, options.get("plane"))
        assert trace.energy_lost[-1] > (0.02 if length else -1.0) * trace.energy.max()
        assert (np.diff(trace.energy_lost) >= 0.0).all()
        error = trace.energy + trace.energy_lost - work
        # the work is summed by trapezia of 1 ms, in a motion with near passes
        assert np.abs(error).max() < 2e-4 * trace.energy.max()


@pytest.mark.parametrize("support", ["recess", "flat"])
def test_the_precession_of_a_spinning_disc_grows_as_one_over_the_time_left(support: str) -> None:
    """The root of theta is linear, by W^2 = 4 g/(b theta), energy 3 g b theta/2 and power delta g theta W."""
    disc = Cylinder(semidiagonal=1.0, tan_alpha=1e4)
    b, length, tilt = disc.base_radius, 2e-3, 0.02
    release = InitialState(tilt, rolling_rate=reduced.steady_wobble_rate(disc, tilt))
    time_left = math.sqrt(tilt) / (2.0 / 3.0 * length / b * math.sqrt(G / b))
    case = Case(disc, initial=release, duration=0.9 * time_left, rolling_resistance=length)
    trace = reduced.simulate(case, support=support, rtol=1e-9)
    root = np.sqrt(trace.tilt) / math.sqrt(tilt)
    # of the next order in the tilt, and of the nutation that the release leaves
    assert np.abs(root - (1.0 - trace.time / time_left)).max() < 0.02
    late = trace.time > 0.5 * time_left
    slope = np.polyfit(np.log(time_left - trace.time[late]), np.log(np.abs(trace.rolling_rate[late])), 1)[0]
    assert slope == pytest.approx(-1.0, abs=0.05)


@pytest.mark.parametrize("model", reduced.MODELS)
def test_the_error_follows_the_tolerance(model: str) -> None:
    cylinder = BODIES["h = 2b"]
    release = InitialState(0.5 * cylinder.alpha, rolling_rate=0.0 if model == "planar" else 0.05)
    case = Case(cylinder, initial=release, duration=6.0, rolling_resistance=0.02)
    tolerances = 10.0 ** -np.arange(7.0, 12.0)
    exact = reduced.simulate(case, rtol=1e-13, **reduced.MODELS[model]).tilt
    errors = [
        np.abs(reduced.simulate(case, rtol=rtol, **reduced.MODELS[model]).tilt - exact).max()
        for rtol in tolerances
    ]
    assert max(np.array(errors) / tolerances) < 30.0 * cylinder.alpha  # of five passes
    assert errors[2] < 3e-8 * cylinder.alpha
    slope = np.polyfit(np.log(tolerances), np.log(errors), 1)[0]
    assert slope == pytest.approx(1.0, abs=0.2)


def ramp(of_threshold: Callable[[float], float], cylinder: Cylinder, duration: float) -> GroundMotion:
    """Return a motion along x whose samples are shares of g tan(alpha)."""
    time = np.arange(0.0, duration + 0.005, 0.01)
    along = np.array([of_threshold(t) for t in time]) * G * cylinder.tan_alpha
    return GroundMotion(np.column_stack([along, np.zeros_like(along)]), 0.01)


@pytest.mark.parametrize("kind", ["h = 2b", "frame"])
@pytest.mark.parametrize("plane", [None, 0.0])
def test_the_couple_delays_uplift(plane: float | None, kind: str) -> None:
    cylinder, share = BODIES[kind], 0.03
    motion = ramp(lambda t: 2.0 * t, cylinder, 1.0)
    case = Case(cylinder, motion, rolling_resistance=share * cylinder.base_radius)
    trace = reduced.simulate(case, plane=plane)
    assert trace.uplift_time == pytest.approx(0.5 * (1.0 + share), rel=1e-12)  # rounding
    begin = trace.time > trace.uplift_time
    time = trace.time[begin][:5] - trace.uplift_time
    body = body_of(cylinder, G, case.rolling_resistance)
    jerk = body.h * 2.0 * G * cylinder.tan_alpha / (body.A + body.delta * body.mu * body.b)
    # of the next term, (p t)^2/20
    assert trace.tilt[begin][:5] == pytest.approx(jerk * time**3 / 6.0, rel=2e-3)


@pytest.mark.parametrize("support", ["recess", "flat"])
@pytest.mark.parametrize("share", [0.99, -0.99, 1.01, -1.01])
def test_a_cylinder_stands_on_its_rim_where_the_couple_holds_it(support: str, share: float) -> None:
    cylinder = BODIES["h = 2b"]
    length = 0.01 * cylinder.base_radius
    # the weight acts at the distance R sin(alpha - theta) from the rim
    tilt = cylinder.alpha - share * math.asin(length / cylinder.semidiagonal)
    case = Case(cylinder, initial=InitialState(tilt), duration=3.0, rolling_resistance=length)
    trace = reduced.simulate(case, support=support)
    assert bool((trace.tilt == tilt).all()) == (abs(share) < 1.0)
    if abs(share) < 1.0:
        assert (trace.outcome, trace.rests) == ("stands", False)
        assert math.isnan(trace.followed_until)  # it does not move
        assert np.array_equal(trace.contact_force, np.tile([0.0, 0.0, 1.0], (len(trace.time), 1)))
        assert not trace.energy_lost.any()


@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize("across", [0.0, 0.5])
def test_a_standstill_ends_when_the_ground_overcomes_the_couple(sign: float, across: float) -> None:
    cylinder = BODIES["h = 2b"]
    length, rate = 0.01 * cylinder.base_radius, 0.02 * G
    time = np.arange(0.0, 2.0, 0.01)
    motion = GroundMotion(np.column_stack([sign * rate * time, across * rate * time]), 0.01)
    release = InitialState(cylinder.alpha)
    case = Case(cylinder, motion, initial=release, rolling_resistance=length)
    trace = reduced.simulate(case, sample_step=1e-4)
    # at alpha the weight has no moment: the inertia force along the lean has R, that across it D/s
    s, c = math.sin(cylinder.alpha), math.cos(cylinder.alpha)
    across_arm = cylinder.mass_centre_height + cylinder.base_radius * s / (1.0 + c)
    freed = length * G / (rate * math.hypot(cylinder.semidiagonal, across * across_arm))
    moving = trace.time[trace.tilt != cylinder.alpha]
    assert moving[0] == pytest.approx(freed, abs=2e-3)  # it begins with the cube of the time
    assert (trace.tilt[-1] - cylinder.alpha) * sign < 0.0


def test_motion_in_space_comes_to_a_standstill_too() -> None:
    """A shove that is too weak for the couple ends on the rim, with its energy accounted for."""
    cylinder = BODIES["h = 2b"]
    release = InitialState(cylinder.alpha, tilt_rate=1e-3, rolling_rate=2e-3)
    case = Case(cylinder, initial=release, duration=4.0, rolling_resistance=0.02 * cylinder.base_radius)
    trace = reduced.simulate(case, rtol=1e-9)
    assert (trace.outcome, trace.rests) == ("stands", False)
    assert trace.tilt_rate[-1] == 0.0 == trace.rolling_rate[-1]
    assert trace.step_count < 500
    assert trace.energy + trace.energy_lost == pytest.approx(trace.energy[0], rel=1e-9)  # rtol


@pytest.mark.parametrize("seed", range(5))
def test_the_couple_that_holds_leaves_what_pivots(seed: int) -> None:
    """It keeps theta' = psi' = 0 by the equations of flat ground, and the moment of the ground is D'' a_t."""
    random = np.random.default_rng(seed)
    cylinder = [*BODIES.values(), WobblingFrame(BODIES["h = 2b"], 0.7)][seed]
    body = body_of(cylinder, G, 0.02 * cylinder.base_radius)
    tilt, phi, rate = random.uniform(0.05, 1.3), random.uniform(0.0, 6.0), random.normal()
    a = tuple(random.normal(size=3))
    s, c = math.sin(tilt), math.cos(tilt)
    Lambda, S = momenta_of(body, s, c, rate, 0.0)
    _, free, phi_rate, Lambda_rate, twist_rate, S_rate = flat_rhs(body, tilt, 0.0, phi, Lambda, 0.0, S, *a)
    assert (phi_rate, twist_rate) == pytest.approx((rate, rate), rel=1e-12)  # rounding, as below
    tilting, turning = needed_to_stand(body, tilt, phi, rate, G + a[2], a, True)
    assert free + tilting / body.A == pytest.approx(0.0, abs=1e-12 * (abs(free) + G / body.h))
    Lambda_rate -= s * turning
    S_rate += twist_share(body, s, c) * turning
    assert Lambda_rate * S == pytest.approx(S_rate * Lambda, rel=1e-9, abs=1e-12 * abs(S * Lambda))
    inertia = body.I1 * s * s + body.I2 * c * c + body.mu * (body.b * c - body.h * s) ** 2
    across = a[1] * math.cos(phi) - a[0] * math.sin(phi)
    assert S_rate / S * rate * inertia == pytest.approx((body.b * c - body.h * s) * across, rel=1e-9)


def test_a_cylinder_pivots_on_a_rim_that_the_couple_holds() -> None:
    """Steadily over still ground; shaken across by D'' a_t/I_v, until the couple gives way."""
    cylinder = BODIES["h = 2b"]
    length, duration = 0.05 * cylinder.base_radius, 3.0
    tilt = cylinder.alpha - 0.5 * math.asin(length / cylinder.semidiagonal)
    time = np.arange(0.0, duration, 0.01)
    push = 0.004 * G * np.sin(2.0 * math.pi * time) * (time < 1.0) * np.array([[0.0], [1.0]])
    motion = GroundMotion(push.T, 0.01)
    case = Case(cylinder, motion, initial=InitialState(tilt), duration=duration, rolling_resistance=length)
    trace = reduced.simulate(case, support="flat", rtol=1e-9)
    assert (trace.outcome, trace.rests) == ("stands", False)
    assert (trace.tilt == tilt).all()
    assert np.allclose(trace.twist, trace.rolling_angle, atol=1e-12)  # rounding
    body = body_of(cylinder, G)
    s, c = math.sin(tilt), math.cos(tilt)
    beside = body.b * c - body.h * s
    inertia = body.I1 * s * s + body.I2 * c * c + beside * beside
    turned = trace.rolling_angle
    across = np.interp(trace.time, time, push[1]) * np.cos(turned)
    rate = np.concatenate([[0.0], np.cumsum(0.5 * (across[1:] + across[:-1]) * np.diff(trace.time))])
    # the trapezia of the samples are exact but for the turn of the contact in one
    assert trace.rolling_rate == pytest.approx(beside / inertia * rate, abs=1e-9)
    assert abs(turned[-1]) > 1e-4
    assert not trace.energy_lost.any()
    stronger = Case(
        cylinder,
        motion.scaled(20.0),
        initial=InitialState(tilt),
        duration=duration,
        rolling_resistance=length,
    )
    exact = reduced.simulate(stronger, support="flat", rtol=1e-12).tilt
    assert np.ptp(exact) > 0.1 * cylinder.alpha
    # samples between those of the ground motion change neither it nor when the couple gives way
    between = np.linspace(0.0, time[-1], 5 * (len(time) - 1) + 1)
    samples = np.column_stack([np.interp(between, time, 20.0 * component) for component in push])
    finer = dataclasses.replace(stronger, motion=GroundMotion(samples, 0.002))
    again = reduced.simulate(finer, support="flat", rtol=1e-12).tilt
    assert again == pytest.approx(exact[: len(again)], abs=1e-11)
    for rtol in (1e-7, 1e-8, 1e-9):
        error = np.abs(reduced.simulate(stronger, support="flat", rtol=rtol).tilt - exact).max()
        assert error / cylinder.alpha < 10.0 * rtol  # 3.4 at most, from 1e-5 to 1e-12


@pytest.mark.parametrize(("number", "level"), [(54, 2.75), (105, 9.0)])
def test_shaking_about_the_bound_of_uplift_ends(number: int, level: float) -> None:
    """The couple wears motion down where the ground overcomes the weight alone, or holds it at a crawl."""
    pier = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    motion = synthetic_motions(number + 1, peak=level * G * pier.tan_alpha, seed=16)[number]
    trace = reduced.simulate(Case(pier, motion, rolling_resistance=0.03 * pier.base_radius))
    assert trace.outcome in ("stands", "overturned")
    assert trace.step_count < 20_000  # of a budget of 2.8 million


@pytest.mark.parametrize(
    ("size", "slenderness", "share", "release"),
    [
        (6.19, 0.104, 0.0573, (0.818, 0.0198, 0.0281)),  # pivots in the end
        (1.4, 2.29, 0.0788, (0.232, 0.302, -1.09)),  # twists as its tilt vanishes
    ],
)
def test_releases_on_flat_ground_come_to_an_end(
    size: float, slenderness: float, share: float, release: tuple[float, float, float]
) -> None:
    cylinder = Cylinder(semidiagonal=size, tan_alpha=slenderness)
    rate = math.sqrt(G / size)
    tilt, tilt_rate, spin = release
    start = InitialState(tilt * cylinder.alpha, tilt_rate=tilt_rate * rate, rolling_rate=spin * rate)
    length = share * cylinder.base_radius
    case = Case(cylinder, initial=start, duration=20.0 / rate, rolling_resistance=length)
    trace = reduced.simulate(case, support="flat")
    assert trace.outcome == "stands"
    assert not trace.tilt_rate[-1]
    assert trace.energy + trace.energy_lost == pytest.approx(trace.energy[0], rel=1e-6)  # 1e2 rtol


@pytest.mark.parametrize("seed", [35, 61, 68, 71, 78])
def test_a_couple_as_large_as_the_restoring_one_asks_for_no_million_steps(seed: int) -> None:
    """Its direction turns with a velocity that it holds near nothing: explicit steps took millions."""
    random = np.random.default_rng(seed)
    cylinder = Cylinder(
        semidiagonal=10.0 ** random.uniform(-1.0, 1.5), tan_alpha=10.0 ** random.uniform(-1.3, 0.1)
    )
    peak = G * cylinder.tan_alpha * random.uniform(1.1, 4.0)
    (motion,) = synthetic_motions(1, peak=peak, seed=seed, duration=8.0)
    case = Case(cylinder, motion, rolling_resistance=random.uniform(0.1, 0.98) * cylinder.base_radius)
    trace = reduced.simulate(case, support="flat", rtol=1e-8)
    assert trace.outcome in ("stands", "overturned")
    assert trace.step_count < 100_000  # 75,869 at most


def rolling(seed: int, speed: float) -> tuple[Body, State]:
    """Return a body and a state that rolls and tilts about as fast [rad/s]."""
    random = np.random.default_rng(seed)
    cylinder = list(BODIES.values())[seed % 4]
    body = body_of(cylinder, G, random.uniform(0.05, 0.4) * cylinder.base_radius)
    tilt = random.uniform(0.05, 0.9) * cylinder.alpha
    s, c = math.sin(tilt), math.cos(tilt)
    across = speed * random.uniform(0.5, 1.0)
    Lambda, S = momenta_of(body, s, c, random.normal() * math.sqrt(G / cylinder.semidiagonal), across)
    return body, (tilt, -speed, random.uniform(0.0, 6.0), Lambda, 0.0, S, 0.0, 0.0, 0.0, 1.0)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(8))
def test_the_rates_of_a_long_step_are_those_of_the_momenta(seed: int) -> None:
    """By the law of moments in the angular velocity, and by (18), (19) and the twist."""
    body, y = rolling(seed, 1e-3)
    a = tuple(np.random.default_rng(seed).normal(size=3))
    work = np.zeros((stiff._ROWS, stiff._ALL))
    stiff.write_rates(body, y, work)
    assert stiff.state_of(body, work, stiff.START, 1.0) == pytest.approx(y, rel=1e-9, abs=1e-12)
    stiff.rates_on_flat_ground(body, work, stiff.START, a, stiff.END)
    wanted = RESISTED_FLAT.derivative(body, y, a)
    step = 1e-6
    found = []
    start = work[stiff.START].copy()
    for sign in (1.0, -1.0):
        work[stiff.START] = start + sign * step * work[stiff.END]
        found.append(np.array(stiff.state_of(body, work, stiff.START, 1.0)))
    slope = (found[0] - found[1]) / (2.0 * step)
    size = np.abs(np.array(wanted)).max()
    assert slope[:9] == pytest.approx(np.array(wanted)[:9], rel=1e-5, abs=1e-8 * size)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(4))
def test_a_long_step_is_of_fourth_order(seed: int) -> None:
    body, y = rolling(seed, 0.3)
    a, slope = (0.3, -0.2, 0.1), (0.5, 0.4, -0.3)

    def after(count: int, length: float = 0.1) -> np.ndarray:
        work = np.zeros((stiff._ROWS, stiff._ALL))
        stiff.write_rates(body, y, work)
        h = length / count
        for k in range(count):
            now = tuple(each + rate * k * h for each, rate in zip(a, slope, strict=True))
            stiff.implicit_step(body, work, h, now, slope)
            work[stiff.START] = work[stiff.END]
        return work[stiff.START].copy()

    exact = after(512)
    errors = [np.abs(after(count) - exact)[:5].max() for count in (8, 16, 32)]
    assert math.log2(errors[0] / errors[2]) / 2.0 > 3.5, errors


def test_a_mirror_image_and_another_size_move_alike() -> None:
    cylinder, motion = Cylinder(semidiagonal=6.0, tan_alpha=0.2), el_centro_1940().scaled(2.0)
    case = Case(cylinder, motion, duration=8.0, rolling_resistance=0.012)
    trace = reduced.simulate(case, sample_step=0.02)
    mirrored = GroundMotion(np.array(motion.acceleration) * [1.0, -1.0], motion.time_step)
    image = reduced.simulate(
        Case(cylinder, mirrored, duration=8.0, rolling_resistance=0.012), sample_step=0.02
    )
    assert np.array_equal(image.tilt, trace.tilt)
    assert np.array_equal(image.energy_lost, trace.energy_lost)
    # Froude: lengths times 4, times of the motion times 2
    large = Case(
        Cylinder(semidiagonal=24.0, tan_alpha=0.2),
        GroundMotion(motion.acceleration, 2.0 * motion.time_step),
        duration=16.0,
        rolling_resistance=0.048,
    )
    scaled = reduced.simulate(large, sample_step=0.04)
    assert scaled.tilt == pytest.approx(trace.tilt, abs=1e-8)  # the tolerance of the solution
    assert scaled.energy_lost == pytest.approx(4.0 * trace.energy_lost, abs=1e-7)


@pytest.mark.parametrize("model", reduced.MODELS)
def test_grids_hold_the_peaks_of_runs(model: str) -> None:
    motion, options = el_centro_1940(), reduced.MODELS[model]
    peaks = reduced.peak_tilts([3.0, 8.0], 0.2, motion, [1.0, 3.0], rolling_resistance=0.02, **options)
    for i, size in enumerate((3.0, 8.0)):
        for j, scale in enumerate((1.0, 3.0)):
            cylinder = Cylinder(semidiagonal=size, tan_alpha=0.2)
            case = Case(cylinder, motion.scaled(scale), rolling_resistance=0.02)
            assert reduced.simulate(case, rtol=1e-7, **options).peak_tilt == peaks[i, j]


@pytest.mark.parametrize("length", [-1e-9, 1.0, math.nan, "0.1"])
def test_a_length_is_of_a_contact_within_the_base(length: float) -> None:
    with pytest.raises(ValueError, match="rolling_resistance must be"):
        Case(BODIES["h = 2b"], duration=1.0, rolling_resistance=length)
