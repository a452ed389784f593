"""Energy lost in contact, relative to the energy of the motion, however small."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from rockwobble import multibody
from rockwobble.models import Case, Cylinder, GroundMotion, InitialState
from rockwobble.multibody.guard import DRIFT, EnergyWatch

PIER = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
# samples at the steps equal the steps, but for the rounding of their times
STEPS_AS_SAMPLES = 1e-6
P = math.sqrt(12.0 * 9.81 / (6.0 * (15.0 + math.cos(PIER.alpha) ** 2)))  # [1/s], section of the equations


@pytest.mark.slow
@pytest.mark.parametrize("support", ["recess", "flat"])
def test_a_small_motion_that_loses_its_energy_is_reported(engine: str, support: str) -> None:
    # a sixth in MuJoCo, half in Bullet, 4 % in DART, 1.5 % in Drake: all far below 1e-3 of the energy of its
    # balance, and far above the reporting threshold
    start = InitialState(0.002 * PIER.alpha, rolling_rate=0.3 * P)
    case = Case(PIER, initial=start, duration=1.0)
    run = multibody.simulate(case, engine=engine, support=support, time_step=1e-4, sample_step=1e-4)
    lost = 1.0 - run.energy[-1] / run.energy[0]
    assert lost > 10.0 * DRIFT
    (said,) = (fact for fact in run.facts if fact.code == "energy")
    # largest loss at any step: a pass loses energy for some steps and then returns it, which samples may miss
    largest = run.energy_error[np.abs(run.energy_error).argmax()] / run.energy.max()
    assert said.size == pytest.approx(largest, rel=STEPS_AS_SAMPLES)
    late = run.time[np.argmax(-run.energy_error > DRIFT * run.energy.max())]
    assert said.time == pytest.approx(late, abs=0.02)


def test_a_base_that_opens_and_closes_at_once_is_not_reported(engine: str) -> None:
    # 15 % over the uplift for 26 ms: the base closes again, which takes all its energy
    push = 9.81 * PIER.tan_alpha * np.array([0.0, 1.15, 0.0, 0.0, 0.0])
    run = multibody.simulate(Case(PIER, GroundMotion(np.outer(push, [1.0, 0.0]), 0.1)), engine=engine)
    assert 2e-6 < run.peak_tilt < 1e-4 * PIER.alpha
    assert run.rests
    assert "energy" not in {fact.code for fact in run.facts}


def watch(energy: Any, error: Any, **given: float) -> EnergyWatch:
    watch = EnergyWatch(1e-3, given.get("least", 0.0), given.get("balance", 0.0))
    for part in np.split(np.arange(len(energy)), [300]):
        watch.take(1e-3 * part, np.asarray(energy)[part], np.asarray(error)[part])
    return watch


def test_the_drift_of_energy_has_its_share_and_time() -> None:
    energy, error = np.full(1000, 2.0), np.zeros(1000)
    error[450:] = -0.003
    error[700] = -0.005
    drift = watch(energy, error)
    assert drift.remark(math.inf) == (pytest.approx(0.4), pytest.approx(-0.0025), DRIFT)
    # up to the block of 0.1 s in which it happens
    assert drift.remark(0.65) == (pytest.approx(0.4), pytest.approx(-0.0015), DRIFT)
    assert math.isnan(drift.remark(0.3)[0])
    assert drift.remark(math.inf)[1] == -watch(energy, -error).remark(math.inf)[1]
    # the same error is a thousandth of a larger motion, and the energy of the balance a bound from below
    assert math.isnan(watch(3.0 * energy, error).remark(math.inf)[0])
    assert math.isnan(watch(-energy, error, balance=6.0).remark(math.inf)[0])
    assert math.isnan(watch(energy, error, least=2.1).remark(math.inf)[0])


@pytest.mark.parametrize("length", [1e-4, 3e-3, 0.03])
@pytest.mark.parametrize("rolling", ["mujoco", "pybullet"])
def test_a_rolling_resistance_does_not_hide_the_loss_of_contact(rolling: str, length: float) -> None:
    start = InitialState(0.002 * PIER.alpha, rolling_rate=0.3 * P)
    case = Case(PIER, initial=start, duration=0.6, rolling_resistance=length * PIER.base_radius)
    run = multibody.simulate(case, engine=rolling, time_step=1e-4)
    (said,) = (fact for fact in run.facts if fact.code == "energy")
    (rolled,) = (fact for fact in run.facts if fact.code == "rolling_loss")
    # contact alone takes some percent here; contact and couple together take all the missing energy
    assert said.size < -10.0 * DRIFT
    assert rolled.size == pytest.approx(run.energy_lost[-1] / run.energy.max(), rel=0.01)
    missing = run.energy[0] - run.energy
    assert run.energy_lost - run.energy_error == pytest.approx(missing, abs=1e-12 * run.energy[0])
