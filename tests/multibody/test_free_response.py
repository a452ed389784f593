"""Released engines against the rolling models, solved independently."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from rockwobble import multibody
from rockwobble.models import Case, Cylinder, InitialState

pytestmark = pytest.mark.slow

# Largest tilt difference over 8 s at the default step, in alpha, for each tan(alpha). What is left is the
# creep of the rim while it rolls, (1/1.8 - 1/2) h of its acceleration in every engine: 9e-7, 2e-6, 1.4e-5 and
# 6.8e-5 at most.
TILT = {0.2: 2e-6, 0.3: 3e-6, 1.0: 3e-5, 3.0: 1e-4}


def release(cylinder: Cylinder) -> InitialState:
    """Release at half of alpha, with 0.5 rad/s at the reference size, scaled by Froude to any size."""
    rate = 0.5 * (6.0 / cylinder.semidiagonal) ** 0.5
    return InitialState(cylinder.alpha / 2, rolling_angle=0.3, rolling_rate=rate)


@pytest.mark.parametrize(("support", "tan_alpha"), [("flat", 0.2), ("recess", 3.0)])
def test_free_response_follows_the_model_of_its_support(
    engine: str, support: str, tan_alpha: float, solve_free: Callable[..., Any]
) -> None:
    cylinder = Cylinder(semidiagonal=6.0, tan_alpha=tan_alpha)
    initial = release(cylinder)
    run = multibody.simulate(Case(cylinder, initial=initial, duration=8.0), engine=engine, support=support)
    exact = solve_free(cylinder, initial, run.time, rolls_out=support == "flat")
    assert run.outcome == "stands"
    assert run.facts == ()
    budget = TILT[tan_alpha]
    assert np.abs(run.tilt - exact.tilt).max() < budget * cylinder.alpha
    # the rolling angle magnifies a difference of tilt near upright by 20
    assert np.abs(run.rolling_angle - exact.rolling_angle).max() < 20 * budget
    # the recess limits the twist to the yield of its stiffness, 5e-6 rad; flat ground lets it grow
    assert np.abs(run.twist - exact.twist).max() < 20 * budget + 6e-6
    assert (np.abs(run.twist).max() > 2e-3) == (support == "flat")
    # a kinetic energy of 0.5 m^2/s^2 for the pier; the creep of the rim takes or gives 1e-6 of it
    if tan_alpha == 0.2:
        assert np.abs(run.energy_error).max() < 5e-6
        np.testing.assert_allclose(run.energy, run.energy[0], atol=5e-6)
        height = run.centre_of_mass[0, 2] - cylinder.mass_centre_height
        assert run.energy[0] > 9.81 * height > 0.0
    # the two supports differ: at tan alpha 3 by 0.05 alpha
    other = solve_free(cylinder, initial, run.time, rolls_out=support != "flat")
    assert np.abs(run.tilt - other.tilt).max() > 8e-4 * cylinder.alpha


def test_a_body_with_given_inertias_follows_the_model(engine: str, solve_free: Callable[..., Any]) -> None:
    # pier with a deck: mass high up, an outline that is not twice the mass centre
    column = Cylinder(semidiagonal=3.0, tan_alpha=0.3, height=4.0, transverse_inertia=1.25, axial_inertia=1.0)
    initial = release(column)
    run = multibody.simulate(Case(column, initial=initial, duration=3.0), engine=engine)
    exact = solve_free(column, initial, run.time)
    assert np.abs(run.tilt - exact.tilt).max() < TILT[0.3] * column.alpha
    homogeneous = Cylinder(semidiagonal=3.0, tan_alpha=0.3)
    other = solve_free(homogeneous, initial, run.time)
    assert np.abs(run.tilt - other.tilt).max() > 0.05 * column.alpha


def test_error_falls_with_the_step_at_its_order(engine: str, solve_free: Callable[..., Any]) -> None:
    squat = Cylinder(semidiagonal=6.0, tan_alpha=1.0)
    initial = release(squat)
    steps = np.array([8e-4, 4e-4, 2e-4])

    def errors(**settings: float) -> np.ndarray:
        errors = []
        for step in steps:
            case = Case(squat, initial=initial, duration=2.5)
            run = multibody.simulate(case, engine=engine, time_step=step, **settings)
            exact = solve_free(squat, initial, run.time)
            errors.append(np.abs(run.tilt - exact.tilt).max() / squat.alpha)
        return np.array(errors)

    # friction that only stops the slip lets the rim creep, which is first order; budget of the slope 0.2
    stopping = errors(friction_damping=1.0)
    slope = np.polyfit(np.log(steps), np.log(stopping), 1)[0]
    assert slope == pytest.approx(1.0, abs=0.2)
    # the remaining creep at the default is a ninth: 2 (1/1.8 - 1/2)
    assert (errors() < stopping / 6).all()
