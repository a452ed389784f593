"""Exact solutions with a tendon, against energies from positions and springs in space and against motions."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import quad
from tendon import Pier, accelerations, inertia_about_the_vertical, potential

import rockwobble as rw
from rockwobble import reduced
from rockwobble.models import Tendon
from rockwobble.reduced.exact._turning import momentum_growth
from rockwobble.reduced.restoring import constants_of

G = 9.81
STILL = np.zeros(3)


def bodies(count: int) -> list[tuple[rw.Cylinder, Tendon, Pier, float]]:
    """Random bodies with tendons, those of the reference for each, and the largest tilt below the balance."""
    random = np.random.default_rng(7)
    chosen = []
    for i in range(count):
        tan_alpha = math.exp(random.uniform(math.log(0.08), math.log(1.5)))
        cylinder = rw.Cylinder(semidiagonal=2.0, tan_alpha=tan_alpha)
        slab = random.uniform(0.1, 3.0) if i % 2 else 0.0
        tendon = Tendon(
            prestress=random.uniform(0.0, 1.0), stiffness=(i % 3 > 0) * random.uniform(0.0, 1.5 / tan_alpha)
        )
        b = cylinder.base_radius
        pier = Pier(
            b=b,
            h=cylinder.mass_centre_height,
            slab=slab,
            prestress=tendon.prestress * G,
            stiffness=tendon.stiffness * G / b,
            g=G,
        )
        tilts = np.linspace(0.01, 1.57, 2000)
        top = tilts[int(np.argmax([potential(pier, tilt) for tilt in tilts]))]
        chosen.append((rw.WobblingFrame(cylinder, slab) if slab else cylinder, tendon, pier, top))
    return chosen


BODIES = bodies(8)


@pytest.mark.parametrize(("body", "tendon", "pier", "top"), BODIES)
def test_rocking_period_is_the_quadrature_of_the_energy(
    body: rw.Cylinder, tendon: Tendon, pier: Pier, top: float
) -> None:
    # theta'' of a body at rest is -V'/inertia
    inertia = (potential(pier, 0.1 + 1e-5) - potential(pier, 0.1 - 1e-5)) / 2e-5
    inertia /= -accelerations(pier, 0.1, 0.0, 0.0, STILL, 0.0)[0]
    for share in (0.1, 0.6, 0.95):
        tilt = share * top
        highest = potential(pier, tilt)

        def slowness(u: float, tilt: float = tilt, highest: float = highest) -> float:
            left = highest - potential(pier, tilt * (1.0 - u * u))
            return 2.0 * tilt * u / math.sqrt(2.0 * left / inertia)

        quarter = quad(slowness, 0.0, 1.0, epsabs=0.0, epsrel=1e-9)[0]
        assert reduced.planar_quarter_period(body, tilt, tendon=tendon) == pytest.approx(quarter, rel=1e-7)
        assert reduced.rocking_period(body, tilt, tendon=tendon) == pytest.approx(4.0 * quarter, rel=1e-7)


@pytest.mark.parametrize(("body", "tendon", "pier", "top"), BODIES)
def test_steady_wobble_balances_and_its_stability_is_the_slope(
    body: rw.Cylinder, tendon: Tendon, pier: Pier, top: float
) -> None:
    signs = set()
    for share in (0.1, 0.5, 0.98):
        tilt, d = share * top, 1e-4
        rate = reduced.steady_wobble_rate(body, tilt, tendon=tendon)
        assert reduced.wobbling_period(body, tilt, tendon=tendon) == pytest.approx(2.0 * math.pi / rate)
        here = inertia_about_the_vertical(pier, tilt)

        def push(at: float, rate: float = rate, here: float = here) -> float:
            spin = rate * here / inertia_about_the_vertical(pier, at)
            return float(accelerations(pier, at, 0.0, spin, STILL, 0.0)[0])

        scale = abs(accelerations(pier, tilt, 0.0, 0.0, STILL, 0.0)[0])
        assert abs(push(tilt)) < 1e-8 * max(scale, 1.0)
        slope = (push(tilt + d) - push(tilt - d)) / (2.0 * d)
        stability = reduced.wobble_stability(body, tilt, tendon=tendon)
        assert stability == pytest.approx(-slope, rel=1e-4, abs=1e-4)
        signs.add(stability > 0.0)
    assert True in signs


@pytest.mark.slow
@pytest.mark.parametrize(("body", "tendon", "pier", "top"), BODIES)
@pytest.mark.parametrize("spin", [1e-3, 0.3])
def test_a_release_turns_as_the_integrated_motion(
    body: rw.Cylinder, tendon: Tendon, pier: Pier, top: float, spin: float
) -> None:
    for share, tilt_rate in ((0.3, 0.0), (0.5, 0.3 * top)):
        release = rw.InitialState(share * top, tilt_rate=tilt_rate, rolling_rate=spin)
        exact = reduced.free_response(body, release, tendon=tendon)
        case = rw.Case(body, initial=release, duration=4.2 * exact.period, tendon=tendon)
        trace = reduced.simulate(case, rtol=1e-12, rest_tilt=0.0)
        highest = trace.extrema[trace.extrema[:, 3] > 0.0]
        assert np.allclose(np.diff(highest[:, 0]), exact.period, rtol=1e-10)
        assert np.allclose(np.diff(highest[:, 2]), exact.angle_of_turn, rtol=1e-10)
        assert np.allclose(highest[:, 1], exact.maximum_tilt, rtol=1e-10)
        assert exact.energy * (1.0 + 2.0 * pier.slab) == pytest.approx(
            potential(pier, share * top)
            + 0.5 * inertia_about_the_vertical(pier, share * top) * spin**2
            + 0.5 * constants_of(body, G).A * (1.0 + 2.0 * pier.slab) * tilt_rate**2,
            rel=1e-11,
        )


def test_the_turn_of_vanishing_spin_is_independent_of_the_tendon() -> None:
    for body, tendon, _, top in BODIES:
        turn = reduced.angle_of_turn(body, rw.InitialState(0.5 * top, rolling_rate=1e-12), tendon=tendon)
        assert turn == pytest.approx(reduced.limiting_angle_of_turn(body), rel=1e-10)


def test_a_release_overturns_beyond_its_barrier_and_only_there() -> None:
    for body, tendon, _, top in BODIES:
        if top > 1.5:
            continue
        # the fastest steady wobble with L just below and above that of this one: its unstable side
        tilt = next(
            share * top
            for share in np.linspace(0.7, 0.999, 60)
            if reduced.wobble_stability(body, share * top, tendon=tendon) < -0.1
        )
        rate = reduced.steady_wobble_rate(body, tilt, tendon=tendon)
        for factor, returns in ((1.0 - 1e-4, True), (1.0 + 1e-4, False)):
            release = rw.InitialState(tilt, rolling_rate=factor * rate)
            case = rw.Case(body, initial=release, duration=20.0, tendon=tendon)
            assert (reduced.simulate(case).outcome == "stands") == returns
            if returns:
                assert reduced.free_response(body, release, tendon=tendon).maximum_tilt == tilt
            else:
                with pytest.raises(ValueError, match="with this tendon"):
                    reduced.free_response(body, release, tendon=tendon)


def test_the_momentum_of_steady_wobble_has_one_maximum_at_most() -> None:
    """Unimodality, on which the search for the overturning barrier rests; without a tendon the maximum
    exists."""
    random = np.random.default_rng(3)
    for number in range(400):
        transverse = 10.0 ** random.uniform(-3.0, 1.0)
        cylinder = rw.Cylinder(
            semidiagonal=1.0,
            tan_alpha=10.0 ** random.uniform(-3.0, 3.0),
            transverse_inertia=transverse,
            axial_inertia=2.0 * transverse * 10.0 ** random.uniform(-5.0, 0.0),
        )
        if number % 2:
            cylinder = rw.Cylinder(semidiagonal=2.0, tan_alpha=math.exp(random.uniform(-2.5, 0.4)))
            prestress, stiffness = random.uniform(0.0, 1.0), random.uniform(0.0, 2.0)
            tendon = Tendon(prestress=prestress, stiffness=stiffness / cylinder.tan_alpha)
            body = constants_of(cylinder, G, tendon=tendon)
            balance = body.balance  # type: ignore[attr-defined]
        else:
            body = constants_of(cylinder, G)
            balance = body.alpha
        edge = math.tan(0.5 * min(balance, 0.5 * math.pi))
        t = np.concatenate([np.geomspace(1e-6, 0.5, 500), 1.0 - np.geomspace(0.5, 1e-6, 500)[1:]]) * edge
        growth = momentum_growth(body, 2.0, t, body.alpha - 2.0 * np.arctan(t))
        assert growth[0] > 0.0
        changes = np.count_nonzero(growth[1:] * growth[:-1] < 0.0)
        assert changes <= 1 if number % 2 else changes == 1


def test_a_tilt_beyond_the_balance_is_refused() -> None:
    cylinder, tendon = rw.Cylinder(semidiagonal=3.0, tan_alpha=0.4), Tendon(prestress=0.5)
    with pytest.raises(ValueError, match=r"below the balance tilt = 0\.5"):
        reduced.rocking_period(cylinder, 0.6, tendon=tendon)
    assert reduced.rocking_period(cylinder, 1.1 * cylinder.alpha, tendon=tendon) > 0.0
    with pytest.raises(ValueError, match="below pi/2"):
        reduced.wobbling_period(cylinder, 1.6, tendon=Tendon(stiffness=4.0))
