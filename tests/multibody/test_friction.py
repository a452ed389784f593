"""One pair coefficient for every engine: distance of a sliding squat block."""

from __future__ import annotations

import numpy as np
import pytest

from rockwobble import multibody
from rockwobble.models import Case, Cylinder, GroundMotion

SQUAT = Cylinder(semidiagonal=6.0, tan_alpha=3.0)


@pytest.mark.slow
@pytest.mark.parametrize(("friction", "direction"), [(0.2, 0.0), (0.4, 0.7)])
def test_sliding_distance_is_coulombs(
    engine: str, friction: float, direction: float, time_step: float | None
) -> None:
    a = 0.5 * 9.81
    push = a * np.array([np.cos(direction), np.sin(direction)])
    motion = GroundMotion([push, push], 1.0)
    case = Case(SQUAT, motion, friction=friction)
    run = multibody.simulate(case, engine=engine, support="flat", time_step=time_step)
    # relative acceleration to the ground is a - mu g
    distance = 0.5 * (a - friction * 9.81)
    budget = 0.015 if engine == "mujoco" else 2e-3
    assert run.residual_displacement == pytest.approx(distance, rel=budget)
    if engine == "pybullet":
        assert run.slip[-1] == pytest.approx(distance, rel=budget)
    assert run.mode == "slides"
    assert run.facts == () or run.first("unresolved_slide") < 1.0


def test_sufficient_friction_holds_the_block(engine: str, time_step: float | None) -> None:
    motion = GroundMotion([[0.5 * 9.81, 0.0], [0.5 * 9.81, 0.0]], 1.0)
    case = Case(SQUAT, motion, friction=0.6)
    run = multibody.simulate(case, engine=engine, support="flat", time_step=time_step)
    # friction has no memory: creep of 1e-4 of the load in the time constant of contact
    assert run.slip[-1] < 1e-4
    assert run.facts == ()
