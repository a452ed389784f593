"""A tendon along the axis, in the recess and in a plane, against positions and springs in space."""

from __future__ import annotations

import math

import numpy as np
import pytest
from tendon import Pier, accelerations, inertia_about_the_vertical, potential

import rockwobble as rw
from rockwobble import reduced
from rockwobble.models import Case, GroundMotion, Tendon
from rockwobble.reduced.body import Body
from rockwobble.reduced.equations import recess_rhs
from rockwobble.reduced.integration.balance import free_acceleration
from rockwobble.reduced.problem import Problem
from rockwobble.reduced.restoring import TiedBody

G = 9.81
PIER = rw.Cylinder(semidiagonal=6.0, tan_alpha=0.2)
BODIES = {"column": 0.0, "under a slab": 1.3}
TENDONS = [Tendon(prestress=0.7), Tendon(stiffness=4.0), Tendon(prestress=0.4, stiffness=9.0)]


def body_of(cylinder: rw.Cylinder, gamma: float) -> rw.Cylinder:
    return rw.WobblingFrame(cylinder, gamma) if gamma else cylinder


def apart(cylinder: rw.Cylinder, tendon: Tendon, gamma: float) -> Pier:
    b = cylinder.base_radius
    return Pier(
        b=b,
        h=cylinder.mass_centre_height,
        slab=gamma,
        prestress=tendon.prestress * G,
        stiffness=tendon.stiffness * G / b,
        g=G,
    )


@pytest.mark.parametrize("seed", range(8))
def test_equations_are_those_of_springs_in_space(seed: int) -> None:
    random = np.random.default_rng(seed)
    cylinder = rw.Cylinder(semidiagonal=2.0, tan_alpha=random.uniform(0.1, 0.9))
    tendon, gamma = TENDONS[seed % 3], 1.3 * (seed % 2)
    theta, omega = random.uniform(0.05, 1.0), random.uniform(-1.0, 1.0)
    phi, spin, ground = random.uniform(-3.0, 3.0), random.uniform(-2.0, 2.0), random.uniform(-5.0, 5.0, 3)
    pier, w, d = apart(cylinder, tendon, gamma), 1.0 + 2.0 * gamma, 1e-4
    # momentum per unit of the mass in the restoring moment: that of a column and twice its share of the slab
    inertia, more, less = (inertia_about_the_vertical(pier, at) / w for at in (theta, theta + d, theta - d))
    body = Problem(Case(body_of(cylinder, gamma), duration=1.0, tendon=tendon)).body
    rates = recess_rhs(body, theta, omega, phi, inertia * spin, *ground)
    tilting, turning = accelerations(pier, theta, omega, spin, ground, phi)
    growth = inertia * turning + (more - less) / (2.0 * d) * omega * spin
    # of the differences in the reference
    assert rates == pytest.approx((omega, tilting, spin, growth), rel=1e-6, abs=1e-6)


@pytest.mark.parametrize("gamma", BODIES.values(), ids=BODIES)
def test_energy_is_that_of_springs_in_space_and_is_conserved(gamma: float) -> None:
    tendon = TENDONS[2]
    release = rw.InitialState(0.8 * PIER.alpha, rolling_rate=0.3)
    case = rw.Case(body_of(PIER, gamma), initial=release, duration=10.0, tendon=tendon)
    trace = reduced.simulate(case, rtol=1e-12)
    assert np.ptp(trace.energy) < 1e-11 * trace.energy[0]
    still = rw.Case(body_of(PIER, gamma), initial=rw.InitialState(release.tilt), duration=0.1, tendon=tendon)
    # per unit of the mass of a column and twice its share of the slab
    whole = reduced.simulate(still).energy[0] * (1.0 + 2.0 * gamma)
    assert whole == pytest.approx(potential(apart(PIER, tendon, gamma), release.tilt), rel=1e-12)


@pytest.mark.parametrize("gamma", BODIES.values(), ids=BODIES)
@pytest.mark.parametrize("vertical", [0.0, -0.3])
def test_it_uplifts_at_the_threshold_that_the_prestress_raises(gamma: float, vertical: float) -> None:
    tendon = Tendon(prestress=0.6, stiffness=2.0)
    body = body_of(PIER, gamma)
    gaps, w = (2, 1.0 + 2.0 * gamma) if gamma else (1, 1.0)
    threshold = (G * (1.0 + vertical) + gaps * tendon.prestress * G / w) * PIER.tan_alpha
    ramp = np.linspace(0.0, 1.2 * threshold, 241)
    motion = GroundMotion(np.column_stack([0.6 * ramp, 0.8 * ramp, np.full(241, vertical * G)]), 0.01, "ramp")
    trace = reduced.simulate(rw.Case(body, motion, tendon=tendon))
    assert trace.uplift_time == pytest.approx(2.4 / 1.2, abs=1e-12)
    if not vertical:
        assert tendon.uplift_factor(body) * G * PIER.tan_alpha == pytest.approx(threshold, rel=1e-14)


@pytest.mark.parametrize("plane", [None, 0.4])
def test_a_tendon_without_prestress_and_stiffness_changes_nothing(plane: float | None) -> None:
    motion = rw.el_centro_1940().scaled(2.0)
    with_it, without = (
        reduced.simulate(rw.Case(PIER, motion, duration=10.0, tendon=tendon), plane=plane, rtol=1e-10)
        for tendon in (Tendon(), None)
    )
    assert np.array_equal(with_it.tilt, without.tilt)
    assert with_it.uplift_time == without.uplift_time


@pytest.mark.parametrize("length", [0.0, 0.02])
@pytest.mark.parametrize("seed", range(3))
def test_a_fall_cut_short_still_counts_as_overturned(seed: int, length: float) -> None:
    rng = np.random.default_rng(seed)
    tendon = Tendon(prestress=rng.uniform(0, 1), stiffness=rng.uniform(0, 6))
    scales = np.geomspace(1.5, 30.0, 10)
    motion, options = rw.el_centro_1940(vertical=True), {"tendon": tendon, "rolling_resistance": length}
    peaks = reduced.peak_tilts([PIER.semidiagonal], 0.2, motion, scales, **options)[0]
    for scale, peak in zip(scales, peaks, strict=True):
        # the same without the early exit from a fall: a pulse at the very end keeps it open
        a = np.vstack([motion.acceleration * scale, np.zeros((500, 3)), [[1e4, 0.0, 0.0]], np.zeros((2, 3))])
        open_end = GroundMotion(a, motion.time_step, "open")
        trace = reduced.simulate(rw.Case(PIER, open_end, duration=motion.duration, **options), rtol=1e-7)
        assert (peak == 0.5 * math.pi) == (trace.outcome == "overturned")


@pytest.mark.parametrize("gamma", BODIES.values(), ids=BODIES)
def test_forces_balance_momentum_of_column_and_slab(gamma: float) -> None:
    tendon = Tendon(prestress=0.5, stiffness=6.0)
    release = rw.InitialState(0.7 * PIER.alpha, rolling_rate=0.6)
    body = body_of(PIER, gamma)
    case = rw.Case(body, initial=release, duration=2.0, tendon=tendon)
    step = 1e-3
    trace = reduced.simulate(case, rtol=1e-12, sample_step=step)
    velocity = np.gradient(trace.centre_of_mass, step, axis=0, edge_order=2)
    acceleration = np.gradient(velocity, step, axis=0, edge_order=2)[5:-5]
    phi, half = trace.rolling_angle[5:-5], 0.5 * trace.tilt[5:-5]
    tension = trace.tendon_force[5:-5] * G  # N for 1 kg
    towards = np.column_stack([np.sin(half) * np.cos(phi), np.sin(half) * np.sin(phi), np.cos(half)])
    pull = -tension[:, None] * towards  # of the anchor on the base
    weight = np.array([0.0, 0.0, -G])
    whole = (1.0 + gamma) * G * trace.contact_force[5:-5]
    # column and slab together; second differences over 1 ms
    left = whole + pull + (1.0 + gamma) * weight - (1.0 + 2.0 * gamma) * acceleration
    assert np.abs(left).max() < 2e-4 * G
    if gamma:
        top = gamma * G * trace.top_contact_force[5:-5]
        slab = top + pull + gamma * weight - 2.0 * gamma * acceleration
        assert np.abs(slab).max() < 2e-4 * G


def test_tendon_yield_is_reported_from_the_time_at_which_it_begins() -> None:
    motion = rw.el_centro_1940().scaled(2.5)
    free = reduced.simulate(rw.Case(PIER, motion, tendon=Tendon(prestress=0.2, stiffness=4.0)), rtol=1e-10)
    force = 0.2 + 0.6 * (free.peak_tendon_force - 0.2)
    tendon = Tendon(prestress=0.2, stiffness=4.0, yield_force=force)
    trace = reduced.simulate(rw.Case(PIER, motion, tendon=tendon), rtol=1e-10)
    fact = next(each for each in trace.diagnostics if each.code == "tendon_yield")
    assert fact.size == pytest.approx(trace.peak_tendon_force)
    assert fact.bound == force
    before = trace.time < fact.time
    assert (trace.tendon_force[before] <= force * (1.0 + 1e-9)).all()
    assert np.interp(fact.time, trace.time, trace.tendon_force) == pytest.approx(force, rel=1e-3)
    assert not [each for each in free.diagnostics if each.code == "tendon_yield"]


@pytest.mark.slow
@pytest.mark.parametrize("tendon", [None, *TENDONS], ids=repr)
@pytest.mark.parametrize("gamma", BODIES.values(), ids=BODIES)
def test_the_verdict_at_a_balance_has_the_acceleration_of_the_model(
    gamma: float, tendon: Tendon | None
) -> None:
    body = Problem(case=Case(body_of(PIER, gamma), duration=1.0, tendon=tendon)).body
    for tilt in (0.05, 0.9 * PIER.alpha, 1.3 * PIER.alpha, 1.2):
        for L in (0.0, 0.3):
            expected = recess_rhs(body, tilt, 0.0, 0.0, L, 0.0, 0.0, 0.0)[1]
            # two sums of some five terms, each rounded
            assert free_acceleration(body, tilt, L) == pytest.approx(expected, rel=1e-13, abs=1e-14)


@pytest.mark.parametrize("slab", [0.0, 1.0])
@pytest.mark.parametrize("tan_alpha", [1e-1, 1e-3])
def test_a_slender_tied_column_moves_as_a_larger_free_one(tan_alpha: float, slab: float) -> None:
    """Linear couple: a tendon multiplies its value upright by 1 + n p0/w and lowers its slope by a share."""
    prestress, share = 0.5, 0.4
    gaps, w = (2, 1.0 + 2.0 * slab) if slab else (1, 1.0)
    tendon = Tendon(prestress=prestress, stiffness=share * w / (gaps**2 * tan_alpha))
    raised = 1.0 + gaps * prestress / w
    motion = rw.el_centro_1940()
    motion = motion.scaled(2.5 * 9.81 * tan_alpha / motion.peak)

    def tilts(size: float, shaking: float, held: Tendon | None) -> np.ndarray:
        body = body_of(rw.Cylinder(semidiagonal=size, tan_alpha=tan_alpha), slab)
        case = Case(body, motion.scaled(shaking), duration=12.0, tendon=held)
        return reduced.simulate(case, rtol=1e-11, rest_tilt=0.0).tilt / body.alpha

    tied, free = tilts(6.0, raised, tendon), tilts(6.0 / (1.0 - share), 1.0, None)
    assert free.max() > 0.25
    # error of the order of alpha^2, measured 0.05 to 0.16 of it
    assert np.abs(tied * (1.0 - share) / raised - free).max() < 0.3 * tan_alpha**2


def test_the_constants_of_a_tied_body_begin_with_those_of_the_body() -> None:
    """Both are passed to the same compiled functions by position."""
    assert TiedBody._fields[: len(Body._fields)] == Body._fields
