"""A tendon in an engine: in the recess against the reduced model, on flat ground against Newton and Euler."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from engine_samples import scene_of
from tendon import Pier
from tendon_on_flat_ground import rolled

from rockwobble import multibody, reduced
from rockwobble.models import (
    Case,
    Cylinder,
    InitialState,
    Tendon,
    Trace,
    WobblingFrame,
    el_centro_1940,
)
from rockwobble.models.support import SUPPORTS
from rockwobble.multibody.engines.mujoco import MujocoEngine
from rockwobble.multibody.engines.registry import find_engine
from rockwobble.multibody.restraint import Restraint, scaled_restraint

G = 9.81
PIER = Cylinder(semidiagonal=6.0, tan_alpha=1.0 / 3.0)
RELEASE = InitialState(0.5 * PIER.alpha, rolling_rate=0.3)
TENDONS = [Tendon(prestress=0.5), Tendon(stiffness=2.0), Tendon(prestress=0.3, stiffness=12.0)]
COARSE = {"drake": 2.5e-4}  # [s] where a step costs ten times another's
# of alpha in 1.5 s at the default step; measured up to 1.2e-6, of which the depth of the anchor makes 4e-7,
# and in Rapier 1.1e-4: without a tendon 3e-7 to 6e-7, 3e-9 in Exudyn and 2.2e-4 in Rapier
RELEASED = {
    "mujoco": 3e-6,
    "pybullet": 3e-6,
    "dart": 3e-6,
    "drake": 5e-6,
    "exudyn": 2e-6,
    "rapier": 4e-4,
}
ENGINES = [name for name in RELEASED if name in multibody.available_engines()]
RECESS = [name for name in ENGINES if "recess" in find_engine(name).supports]
# of alpha and of b, on flat ground; measured 1.3e-6, in Exudyn 2.3e-7 and in Rapier 3.5e-4
ROLLED = {name: 1e-3 if name == "rapier" else 4e-6 for name in RELEASED} | {"drake": 1e-5}
# of the energy at the start; measured 3.4e-6, in Rapier 3.5e-4
ENERGY = {name: 1e-3 if name == "rapier" else 1e-5 for name in ENGINES}
# weights; a window of 65 steps has the curvature of the force at a pass: measured 5.6e-3, at 2.5e-4 s 3.5e-2
FORCE = {name: 0.06 if name in COARSE else 0.012 for name in ENGINES}
SHAKEN = 2e-5  # relative RMS at the default step; measured 2.9e-6 to 8.5e-6, as without a tendon


def body_of(gamma: float, cylinder: Cylinder = PIER) -> Cylinder:
    return WobblingFrame(cylinder, gamma, columns=1) if gamma else cylinder


def released(tendon: Tendon | None, gamma: float = 0.0, duration: float = 1.5) -> Case:
    return Case(body_of(gamma), initial=RELEASE, duration=duration, tendon=tendon)


def run(case: Case, name: str, support: str = "recess", **options: object) -> Trace:
    options = {"time_step": COARSE.get(name), **options}
    return multibody.simulate(case, engine=name, support=support, **options)  # type: ignore[arg-type]


@pytest.mark.slow
@pytest.mark.parametrize("name", RECESS)
@pytest.mark.parametrize(("tendon", "gamma"), [(TENDONS[0], 0.0), (TENDONS[2], 0.0), (TENDONS[2], 1.0)])
def test_a_release_in_the_recess_follows_the_reduced_model(name: str, tendon: Tendon, gamma: float) -> None:
    if name == "dart" and gamma:
        return  # half a minute: a slab on flat ground is compared below, for a shorter time
    case = released(tendon, gamma)
    engine, model = run(case, name), reduced.simulate(case)
    assert np.abs(engine.tilt - model.tilt).max() < RELEASED[name] * PIER.alpha
    # the contact of MuJoCo's slab is iterated, and conserves energy to 9e-5 under this tendon
    share = 20.0 * ENERGY[name] if gamma and name == "mujoco" else ENERGY[name]
    assert np.abs(engine.energy - model.energy).max() < share * model.energy[0]
    assert np.abs(engine.contact_force - model.contact_force)[1:-1].max() < FORCE[name]
    assert engine.tendon_force == pytest.approx(model.tendon_force, abs=20.0 * RELEASED[name])
    assert engine.peak_tendon_force == pytest.approx(model.peak_tendon_force, abs=20.0 * RELEASED[name])
    assert engine.diagnostics == ()


@pytest.mark.slow
@pytest.mark.parametrize("name", ENGINES)
@pytest.mark.parametrize("gamma", [0.0, 1.0])
def test_a_release_on_flat_ground_follows_newton_and_euler(name: str, gamma: float) -> None:
    # squat, so that the base moves off its anchor by a hundred times the error of an engine
    squat, tendon = Cylinder(semidiagonal=6.0, tan_alpha=1.0), Tendon(prestress=0.3, stiffness=2.0)
    start, b = InitialState(0.3 * squat.alpha, rolling_rate=0.5), squat.base_radius
    duration = 0.8 if name in ("dart", "drake") else 1.5
    case = Case(body_of(gamma, squat), initial=start, duration=duration, tendon=tendon, friction=3.0)
    engine = run(case, name, "flat")
    pier = Pier(
        b=b,
        h=squat.mass_centre_height,
        slab=gamma,
        prestress=tendon.prestress * G,
        stiffness=tendon.stiffness * G / b,
    )
    tilt, distance = rolled(pier, start.tilt, start.rolling_rate, engine.time)
    assert np.abs(engine.tilt - tilt).max() < ROLLED[name] * squat.alpha
    # each gap has its share of the elongation
    gaps = 2.0 if gamma else 1.0
    assert np.abs(engine.elongation - gaps * distance).max() < ROLLED[name] * b
    assert np.abs(engine.energy - engine.energy[0]).max() < 2.0 * ENERGY[name] * engine.energy[0]
    if name != "rapier":
        assert np.abs(gaps * (distance - 2.0 * b * np.sin(0.5 * tilt))).max() > 10.0 * ROLLED[name] * b


@pytest.mark.slow
@pytest.mark.parametrize("name", [name for name in ("mujoco", "pybullet") if name in ENGINES])
@pytest.mark.parametrize(
    ("size", "tan_alpha", "scale", "gamma"), [(10.0, 0.1, 1.0, 0.0), (6.0, 0.2, 2.0, 1.0)]
)
def test_el_centro_follows_the_model(
    size: float, tan_alpha: float, scale: float, gamma: float, name: str
) -> None:
    tendon, body = (
        Tendon(prestress=0.3, stiffness=4.0),
        body_of(gamma, Cylinder(semidiagonal=size, tan_alpha=tan_alpha)),
    )
    motion = el_centro_1940().scaled(scale * tendon.uplift_factor(body))
    case = Case(body, motion, duration=10.0, tendon=tendon)
    engine, model = run(case, name), reduced.simulate(case)
    assert model.peak_tilt > 0.2 * body.alpha
    assert np.sqrt(np.mean((engine.tilt - model.tilt) ** 2) / np.mean(model.tilt**2)) < SHAKEN
    assert engine.uplift_time == pytest.approx(model.uplift_time, abs=1e-5)
    assert engine.uplift_direction == pytest.approx(model.uplift_direction, abs=1e-5)


@pytest.mark.parametrize("name", [name for name in ("mujoco", "pybullet") if name in ENGINES])
def test_a_tendon_scales_by_froude(name: str) -> None:
    tendon, factor = Tendon(prestress=0.5, stiffness=3.0), 16.0
    large = Cylinder(semidiagonal=6.0 * factor, tan_alpha=PIER.tan_alpha)
    slow = InitialState(RELEASE.tilt, rolling_rate=RELEASE.rolling_rate / 4.0)
    small = run(released(tendon, duration=1.0), name, "flat")
    big = run(Case(large, initial=slow, duration=4.0, tendon=tendon), name, "flat", sample_step=0.04)
    assert np.abs(big.tilt - small.tilt).max() < 1e-11
    assert big.elongation == pytest.approx(factor * small.elongation, rel=1e-9)
    assert big.tendon_force == pytest.approx(small.tendon_force, rel=1e-9)
    assert big.energy == pytest.approx(factor * small.energy, rel=1e-9)


def test_a_swing_that_yields_the_tendon_is_reported() -> None:
    free = run(released(Tendon(prestress=0.2, stiffness=4.0)), "mujoco")
    force = 0.2 + 0.9 * (free.peak_tendon_force - 0.2)
    late = InitialState(0.3 * PIER.alpha, tilt_rate=0.3)
    case = Case(
        PIER, initial=late, duration=1.0, tendon=Tendon(prestress=0.2, stiffness=4.0, yield_force=force)
    )
    engine, model = run(case, "mujoco"), reduced.simulate(case)
    (said,), (expected,) = ([d for d in each.facts if d.code == "tendon_yield"] for each in (engine, model))
    assert said.time == pytest.approx(expected.time, abs=5e-4)
    assert said.size == pytest.approx(expected.size, rel=1e-4)
    assert said.bound == force
    assert "tendon_yield" not in [d.code for d in run(released(TENDONS[0]), "mujoco").facts]


def test_an_engine_without_tendons_refuses_one_in_a_line(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(MujocoEngine, "facts", dataclasses.replace(MujocoEngine.facts, terms=frozenset()))
    with pytest.raises(
        ValueError, match=r"^mujoco has no tendon: tendon must be None, got Tendon"
    ) as refused:
        multibody.simulate(released(TENDONS[0]), engine="mujoco")
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize("gamma", [0.0, 1.0])
def test_the_balance_of_a_scene_is_that_of_the_reduced_model(gamma: float) -> None:
    body = body_of(gamma)
    for tendon in (Tendon(prestress=0.8, stiffness=0.5), None, Tendon(stiffness=30.0)):
        case = Case(body, duration=1.0, tendon=tendon)
        restraint = scaled_restraint(case, body.base_radius, G)
        scene = scene_of(body, support=SUPPORTS["recess"], restraint=restraint)
        assert scene.balance_tilt == pytest.approx(reduced.balance_tilt_of_case(case), rel=1e-12)


def test_the_tendon_force_is_the_gradient_of_its_energy() -> None:
    tendon = Restraint(prestress=3.0, stiffness=40.0, gaps=2, depth=1e-3)
    place, d = np.array([0.05, -0.02, 0.08]), 1e-6
    shifts = place + d * np.vstack([np.eye(3), -np.eye(3)])
    energy = tendon.energy(shifts, shifts, 0.0)
    slope = (energy[:3] - energy[3:]) / (2.0 * d)
    # base and slab have equal forces, so both gaps share the energy
    assert 2.0 * np.array(tendon.force(*place)) == pytest.approx(-slope, rel=1e-8)
    pulled = tendon.forces(place[None], place[None], 0.0)[:, 0]
    assert pulled == pytest.approx(tendon.force(*place), rel=1e-14)


def test_the_couple_of_a_restraint_is_the_slope_of_its_energy() -> None:
    # an anchor at the origin: its depth, 1e-9 of an elongation, is in the energy and not in the couple
    restraint = Restraint(prestress=3.0, stiffness=40.0, gaps=2, depth=1e-9)
    b, h, tilt, d = 1.5, 4.0, 0.3, 1e-5
    tilts = tilt + d * np.array([-1.0, 0.0, 1.0])
    sine, cosine, zero = np.sin(tilts), np.cos(tilts), np.zeros(3)
    axis = np.column_stack([sine, zero, cosine])
    place = np.column_stack([b * (1.0 - cosine), zero, b * sine]) + h * axis
    energy, couples = restraint.energy(place, axis, h), [restraint.couple(each, b) for each in tilts]
    # differences over d^2, and rounding over d
    assert restraint.couple(tilt, b) == pytest.approx((energy[2] - energy[0]) / (2.0 * d), rel=1e-8)
    assert restraint.couple_slope(tilt, b) == pytest.approx((couples[2] - couples[0]) / (2.0 * d), rel=1e-8)
