"""Failed runs are reported: settings and steps at which the engines fail."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np
import pytest

from rockwobble import multibody, reduced
from rockwobble.models import Case, Cylinder, InitialState
from rockwobble.multibody.guard import energy_scale, first_breach
from rockwobble.multibody.kinematics import Kinematics, kinematics
from rockwobble.multibody.passes import STEPS_OF_A_PASS
from rockwobble.multibody.protocol import Steps
from rockwobble.multibody.scene import scaled_body, starting_state

PIER = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
RELEASE = InitialState(PIER.alpha / 2, rolling_rate=0.5)
BODY = scaled_body(PIER, 1.0)


@pytest.mark.parametrize(
    ("settings", "reason"),
    [
        # a spring that the step cannot follow, stiff and undamped contact, a guide stiffer than the step
        ({"contact_time_constant": 2e-5}, "energy_gain"),
        ({"contact_time_constant": 1e-6}, "energy_gain"),
        ({"contact_damping_ratio": 1e-3}, "energy_gain"),
        ({"guide_stiffness": 1e10}, "energy_gain"),
        ({"engine": "pybullet", "guide_stiffness": 1e10}, "energy_gain"),
        ({"engine": "pybullet", "guide_stiffness": 1e14}, ""),
        # contact that sinks in by centimetres
        ({"contact_time_constant": 0.2}, "penetration"),
        ({"engine": "pybullet", "contact_slop": 0.1, "contact_erp": 1e-9}, "penetration"),
    ],
)
def test_failure_is_an_outcome_with_a_diagnostic(settings: dict[str, Any], reason: str) -> None:
    if settings.get("engine") == "pybullet" and "pybullet" not in multibody.available_engines():
        pytest.skip("no wheel of pybullet here")
    run = multibody.simulate(Case(PIER, initial=RELEASE, duration=2.0), **settings)
    assert run.outcome == "failed"
    assert reason in ("", run.facts[0].code)
    assert np.isnan(run.peak_tilt)
    # the trajectory ends where the failure begins, and is right until then
    assert run.time[-1] < 2.0
    for name in ("tilt", "energy", "centre_of_mass", "twist"):
        assert np.isfinite(getattr(run, name)).all()
    assert (run.energy_error < 0.05 * energy_scale(BODY, 9.81)).all()
    assert isinstance(run.to_frame(), object)


def test_a_guide_that_gives_way_fails() -> None:
    squat = Cylinder(semidiagonal=6.0, tan_alpha=3.0)
    initial = InitialState(squat.alpha / 2, rolling_rate=0.5)
    run = multibody.simulate(Case(squat, initial=initial, duration=4.0), guide_stiffness=0.001)
    assert run.outcome == "failed"
    assert run.facts[0].code == "guide"
    free = multibody.simulate(Case(squat, initial=initial, duration=4.0), support="flat")
    assert free.outcome == "stands"
    assert abs(free.residual_twist) > 0.02


@pytest.mark.slow
@pytest.mark.parametrize("support", ["recess", "flat"])
@pytest.mark.parametrize(
    "given",
    [
        # the truncation error of the step is far below 1 % of alpha in all of these
        {"time_step": 1e-6, "length": 0.01},
        {"time_step": 1e-3, "length": 2.0},
        {"tan_alpha": 0.05},
        {"tan_alpha": 10.0},
        {"rate": 3.0},
        {"tan_alpha": 3.0, "friction": 10.0},
    ],
)
def test_extremes_agree_without_diagnostics(engine: str, support: str, given: dict[str, float]) -> None:
    body = Cylinder(semidiagonal=6.0, tan_alpha=given.get("tan_alpha", 0.2))
    release = InitialState(0.5 * body.alpha, rolling_rate=given.get("rate", 0.5))
    case = Case(body, initial=release, duration=given.get("length", 0.5), friction=given.get("friction", 1.0))
    run = multibody.simulate(case, engine=engine, support=support, time_step=given.get("time_step"))
    assert run.facts == ()
    until = run.time <= case.length  # after that a fall multiplies every difference
    model = reduced.simulate(case, support=support).tilt[: until.sum()]
    assert run.tilt[until] == pytest.approx(model, abs=0.01 * body.alpha)


@pytest.mark.parametrize(
    ("engine", "settings", "code"),
    [
        ("mujoco", {"contact_time_constant": 0.1}, "energy"),
        ("mujoco", {"iterations": 1}, "solver"),
        ("pybullet", {"contact_slop": 0.01}, "energy"),
        ("pybullet", {"iterations": 1}, "solver"),
    ],
)
def test_doubtful_runs_have_diagnostics(engine: str, settings: dict[str, Any], code: str) -> None:
    if engine not in multibody.available_engines():
        pytest.skip(f"no wheel of {engine} here")
    case = Case(PIER, initial=RELEASE, duration=1.5)
    run = multibody.simulate(case, engine=engine, support="flat", **settings)
    assert code in {fact.code for fact in run.facts}


def test_insufficient_friction_is_reported(engine: str) -> None:
    case = Case(PIER, initial=RELEASE, duration=0.5, friction=0.05)
    assert {"slip", "energy"} <= {fact.code for fact in multibody.simulate(case, engine=engine).facts}


def test_steps_too_large_for_contact_or_lost_in_rounding_are_refused(engine: str) -> None:
    for step, words in ((1e-2, "at most 0.001 s"), (1e-300, "at least 1e-09 s")):
        with pytest.raises(ValueError, match=f"^time_step must be {words}"):
            multibody.simulate(Case(PIER, initial=RELEASE, duration=0.1), engine=engine, time_step=step)


def test_flight_is_reported(engine: str) -> None:
    # thirty radians in a second at half of alpha throw it up
    run = multibody.simulate(
        Case(PIER, initial=InitialState(PIER.alpha / 2, rolling_rate=30.0), duration=0.2), engine=engine
    )
    assert run.first("lift_off") < 0.1


def test_passes_too_close_to_upright_are_marked(engine: str, time_step: float | None) -> None:
    # a spin of 1e-6 rad/s passes at 1e-7 rad, far less than the tilt that a step crosses
    case = Case(PIER, initial=InitialState(PIER.alpha / 2, rolling_rate=1e-6), duration=2.5)
    near = multibody.simulate(case, engine=engine, time_step=time_step)
    assert not near.passes["resolved"].any()
    (close,) = (fact for fact in near.facts if fact.code == "unresolved_pass")
    assert (close.size, close.bound) == (len(near.passes), near.contact_resolution)
    # the tilt rate just before upright, in steps; samples miss its largest value by a little
    step = near.time_step * np.abs(near.tilt_rate).max()
    assert near.contact_resolution == pytest.approx(STEPS_OF_A_PASS * step, rel=0.02)


def test_an_energy_gain_is_relative_to_the_energy_of_the_motion() -> None:
    scale, n = energy_scale(BODY, 9.81), 10
    start = starting_state(BODY, RELEASE, 1.0)
    steps = Steps(*(np.tile(part, (n, 1)) for part in
                    (start.position, start.quaternion, start.velocity, start.angular_velocity)))  # fmt: skip
    moving = kinematics(steps, steps, BODY, 9.81)
    still = dataclasses.replace(moving, energy=1e-3 * moving.energy)
    assert moving.energy[0] == pytest.approx(0.8 * scale, rel=0.01)

    def fails(state: Kinematics, gain: float, largest: float = 0.0) -> bool:
        breach = first_breach(
            state, np.full(n, gain * scale), BODY, 9.81, in_recess=False, largest=largest * scale
        )
        return breach is not None

    # two percent of the energy of the motion, and of a twentieth of its balance where that is more
    assert (fails(moving, 0.0155), fails(moving, 0.0165)) == (False, True)
    assert (fails(still, 9e-4), fails(still, 1.1e-3)) == (False, True)
    # energy at the start counts
    assert (fails(still, 0.015, 0.8), fails(still, 0.0165, 0.8)) == (False, True)


def test_the_first_breach_counts() -> None:
    n = 10
    upright = np.tile([1.0, 0.0, 0.0, 0.0], (n, 1))
    position = np.tile([0.0, 0.0, BODY.mass_centre_height], (n, 1))
    position[7:, 2] -= 0.1
    position[9, 0] = np.nan
    steps = Steps(position, upright, np.zeros((n, 3)), np.zeros((n, 3)))
    state = kinematics(steps, steps, BODY, 9.81)
    energy = np.zeros(n)
    breach = first_breach(state, energy, BODY, 9.81, in_recess=True)
    assert breach is not None
    assert (breach.index, breach.code) == (7, "penetration")
    energy[4] = np.inf
    breach = first_breach(state, energy, BODY, 9.81, in_recess=True)
    assert breach is not None
    assert (breach.index, breach.code) == (4, "energy_gain")
