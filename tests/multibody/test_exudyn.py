"""Exudyn's ideal rim against the equations of the flat-ground model, and what it refuses."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from rockwobble import multibody, reduced
from rockwobble.models import Case, Cylinder, GroundMotion, InitialState, Trace

if "exudyn" not in multibody.available_engines():
    pytest.skip("exudyn is not installed", allow_module_level=True)

TILT = 2e-6  # of alpha; 8e-7 at 2e-4 s for the squattest, less for all others
FORCED = 3e-7  # of alpha; 5e-8 at 2e-4 s, of which half is the excitation
ORDER = 0.2

Solve = Callable[..., Any]
_STATED = {"motion", "duration", "friction", "gravity"}  # by a case; all else is of the run


def free(cylinder: Cylinder, initial: InitialState | None, **changes: Any) -> Trace:
    stated = {name: changes.pop(name) for name in _STATED & changes.keys()}
    case = Case(cylinder, initial=initial, **stated)
    return multibody.simulate(case, engine="exudyn", **{"support": "flat", **changes})


@pytest.mark.slow
@pytest.mark.parametrize("integrator", ["trapezoidal", "generalized-alpha"])
def test_error_is_second_order_under_excitation(integrator: str, pier: Cylinder) -> None:
    # not zero at the start, and rough: a force shifted within a step is first order
    motion = GroundMotion([[0.6, -0.4], [0.9, 0.5], [-0.8, 0.7], [0.3, -0.9], [0.2, 0.1]], 0.4)
    release = InitialState(pier.alpha / 2, rolling_rate=0.5)
    steps = np.array([8e-4, 4e-4, 2e-4])
    runs = [
        free(pier, release, motion=motion, time_step=step, sample_step=0.05, integrator=integrator)
        for step in steps
    ]
    case = Case(pier, motion, initial=release)
    exact = reduced.simulate(case, support="flat", sample_step=0.05, rtol=1e-11, rest_tilt=0.0).tilt
    errors = [np.abs(run.tilt - exact).max() / pier.alpha for run in runs]
    slope = np.polyfit(np.log(steps), np.log(errors), 1)[0]
    assert slope == pytest.approx(2.0, abs=ORDER)
    assert errors[-1] < FORCED


def test_rolling_through_upright_ends_the_run(
    pier: Cylinder, solve_free: Solve, capfd: pytest.CaptureFixture[str]
) -> None:
    release = InitialState(pier.alpha / 2, rolling_rate=1e-6)
    run = free(pier, release, duration=3.0)
    assert run.outcome == "failed"
    assert math.isnan(run.peak_tilt)
    assert run.facts[0].code == "not_finite"
    assert run.facts[0].detail.startswith("the rim rolled through upright, where it has no")
    # cut at the first pass, and right until then
    assert 1.1 < run.time[-1] < 1.3
    exact = solve_free(pier, release, run.time[:-1], rolls_out=True)
    assert np.abs(run.tilt[:-1] - exact.tilt).max() / pier.alpha < TILT
    assert capfd.readouterr() == ("", "")


@pytest.mark.parametrize("friction", [0.0, 0.01, 0.3])
def test_a_rim_that_would_slip_is_reported(pier: Cylinder, friction: float) -> None:
    # the release needs a friction of about 0.13
    run = free(pier, InitialState(pier.alpha / 2, rolling_rate=0.5), duration=0.5, friction=friction)
    assert ("friction_needed" in {fact.code for fact in run.facts}) == (friction < 0.1)


def test_contact_that_would_be_lost_is_reported(pier: Cylinder) -> None:
    squat = Cylinder(semidiagonal=6.0, tan_alpha=3.0)
    run = free(squat, InitialState(squat.alpha / 2, rolling_rate=10.0), duration=1.0)
    first = run.first("tension")
    assert 0.1 <= first < 0.2
    pulled = run.time[run.contact_force[:, 2] < -1e-2]
    assert pulled[0] == pytest.approx(first, abs=0.02)
    assert free(pier, InitialState(pier.alpha / 2, rolling_rate=0.5), duration=1.5).facts == ()


def test_a_step_that_does_not_converge_ends_the_run_in_silence(
    pier: Cylinder, capfd: pytest.CaptureFixture[str]
) -> None:
    run = free(pier, InitialState(pier.alpha / 2, rolling_rate=0.5), duration=0.2, iterations=1)
    assert run.outcome == "failed"
    assert run.facts[0].code == "not_finite"
    assert run.facts[0].detail.startswith("Newton's iteration did not converge")
    assert capfd.readouterr() == ("", "")


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"initial": None}, "exudyn cannot uplift a cylinder that stands: give a release with a tilt, got a"),
        ({"support": "recess"}, "support must be flat in exudyn, got 'recess'"),
        ({"integrator": "RK44"}, "integrator must be one of trapezoidal, generalized-alpha, got 'RK44'"),
        ({"spectral_radius": 1.1}, "spectral_radius must be from 0 to 1, got 1.1"),
        ({"relative_tolerance": 0.0}, "relative_tolerance must be above 0 and at most 0.001, got 0"),
    ],
)
def test_bodies_it_cannot_simulate_are_refused_in_one_line(change: dict[str, Any], message: str) -> None:
    cylinder = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    given = {"initial": InitialState(0.1), "duration": 1.0, **change}
    with pytest.raises(ValueError, match=r"must|setting|uplift") as caught:
        free(cylinder, **given)
    assert str(caught.value).startswith(message)
    assert "\n" not in str(caught.value)
