from __future__ import annotations

import math

import numpy as np
import pytest

from rockwobble import reduced
from rockwobble.compare.metrics.pair import energy_loss
from rockwobble.models import Case, Cylinder, GroundMotion, InitialState, el_centro_1940

# the path is known at samples 0.01 s apart: what the fourth differences leave of the work
SAMPLING = 2e-5
ROUNDING = 1e-9


def test_energy_lost_in_free_motion_is_the_difference(make_trace):
    time = np.arange(1001) * 0.01
    trace = make_trace(time, np.full_like(time, 0.1), energy=2.0 - 0.05 * time)
    assert energy_loss(trace, None) == pytest.approx(0.25, rel=ROUNDING)


@pytest.mark.parametrize("record_step", [0.005, 0.01, 0.02, 0.013])
def test_work_of_the_ground_is_no_loss(make_trace, record_step):
    """A free mass on moving ground moves by -u relative to it; its energy is the work of -a."""
    own = np.arange(0.0, 8.0 + 0.5 * record_step, record_step)
    # it fades out, because the fine sums below know no jump
    a = np.column_stack([np.sin(2.0 * own), 0.5 * np.cos(3.0 * own)]) * (1.0 - own / own[-1])[:, None]
    motion = GroundMotion(a, record_step)
    time = np.arange(1001) * 0.01
    fine = np.arange(0, 80001) * 1.25e-4
    at = np.column_stack([np.interp(fine, own, column, right=0.0) for column in a.T])
    h = 1.25e-4
    v = -np.vstack([np.zeros(2), np.cumsum(0.5 * (at[1:] + at[:-1]) * h, axis=0)])
    x = np.vstack([np.zeros(2), np.cumsum(0.5 * (v[1:] + v[:-1]) * h, axis=0)])
    place = np.column_stack([x, np.zeros(len(x))])[::80]
    energy = 0.5 * (v[::80] ** 2).sum(axis=1)
    trace = make_trace(time, np.full_like(time, 0.1), centre_of_mass=place, energy=energy)
    assert energy_loss(trace, motion) == pytest.approx(0.0, abs=1e-5)
    lossy = make_trace(time, np.full_like(time, 0.1), centre_of_mass=place, energy=energy - 0.01 * time)
    assert energy_loss(lossy, motion) * lossy.energy.max() == pytest.approx(0.1, abs=1e-5)


def test_the_reduced_model_loses_nothing(cylinder):
    release = InitialState(tilt=0.5 * cylinder.alpha, rolling_rate=0.5)
    free = reduced.simulate(Case(cylinder, initial=release, duration=8.0))
    assert energy_loss(free, None) == pytest.approx(0.0, abs=1e-6)  # rtol 1e-8 over some hundred steps
    motion = el_centro_1940()
    shaken = reduced.simulate(Case(cylinder, motion))
    assert energy_loss(shaken, motion) == pytest.approx(0.0, abs=SAMPLING)


def test_energies_that_say_nothing(make_trace):
    time = np.arange(11) * 0.1
    assert energy_loss(make_trace(time, np.zeros_like(time)), None) == 0.0
    broken = make_trace(time, np.zeros_like(time), energy=np.full_like(time, np.nan))
    assert math.isnan(energy_loss(broken, None))


def test_the_work_between_two_samples_counts(cylinder: Cylinder) -> None:
    push = GroundMotion([[3.0, 0.0], [3.0, 0.0]], 0.3)
    trace = reduced.simulate(Case(cylinder, push, duration=0.003))
    assert len(trace.time) == 2
    assert energy_loss(trace, push) == pytest.approx(0.0, abs=0.01)  # of 1, which is all of the motion's
