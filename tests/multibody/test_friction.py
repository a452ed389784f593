"""One pair coefficient for every engine: a squat block slides where it should, as far as it should."""

from __future__ import annotations

import numpy as np
import pytest

from rockwobble import multibody
from rockwobble.models import Case, Cylinder, GroundMotion, InitialState, el_centro_1940

SQUAT = Cylinder(semidiagonal=6.0, tan_alpha=3.0)


@pytest.mark.slow
@pytest.mark.parametrize("direction", [0.0, 0.7])
@pytest.mark.parametrize("friction", [0.2, 0.4])
def test_sliding_distance(engine: str, friction: float, direction: float, time_step: float | None) -> None:
    a = 0.5 * 9.81
    push = a * np.array([np.cos(direction), np.sin(direction)])
    motion = GroundMotion([push, push], 1.0)
    case = Case(SQUAT, motion, friction=friction)
    run = multibody.simulate(case, engine=engine, support="flat", time_step=time_step)
    # relative to the ground it is left behind with a - mu g
    distance = 0.5 * (a - friction * 9.81)
    budget = 0.015 if engine == "mujoco" else 2e-3
    assert run.residual_displacement == pytest.approx(distance, rel=budget)
    if engine == "pybullet":
        assert run.slip[-1] == pytest.approx(distance, rel=budget)
    assert run.mode == "slides"
    assert run.facts == () or run.first("unresolved_slide") < 1.0


def test_enough_friction_holds(engine: str, time_step: float | None) -> None:
    motion = GroundMotion([[0.5 * 9.81, 0.0], [0.5 * 9.81, 0.0]], 1.0)
    case = Case(SQUAT, motion, friction=0.6)
    run = multibody.simulate(case, engine=engine, support="flat", time_step=time_step)
    # friction has no memory: it creeps by 1e-4 of the load in the time constant of contact
    assert run.slip[-1] < 1e-4
    assert run.facts == ()


@pytest.mark.slow
def test_too_little_friction_in_a_release_is_said(engine: str, time_step: float | None) -> None:
    pier = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    initial = InitialState(pier.alpha / 2, rolling_rate=0.5)
    enough, little = (
        multibody.simulate(
            Case(pier, initial=initial, duration=2.0, friction=friction), engine=engine, time_step=time_step
        )
        for friction in (0.3, 0.1)
    )
    assert enough.facts == ()
    # rolling creeps by 1e-5 b
    assert enough.slip[-1] < 1e-4 * pier.base_radius
    assert "slip" in {fact.code for fact in little.facts}


def test_a_base_that_slides_in_dart_goes_as_far_by_the_solver_that_is_fast(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    dart = pytest.importorskip("rockwobble.multibody.engines.dart")
    pytest.importorskip("dartpy", reason="DART has no wheel for this Python")
    solvers: list[bool] = []
    use = dart._DartStepper._use_for
    monkeypatch.setattr(
        dart._DartStepper,
        "_use_for",
        lambda self, *, opening: (solvers.append(opening), use(self, opening=opening)),
    )
    friction, motion, end = 0.15, el_centro_1940().scaled(2.0), 2.5
    case = Case(Cylinder(semidiagonal=6.0, tan_alpha=0.2), motion, duration=end, friction=friction)
    run = multibody.simulate(case, engine="dart", support="flat")
    # a point with Coulomb friction on the moving ground
    step, velocity, way = 1e-4, np.zeros(2), np.zeros(2)
    times = np.arange(0.0, end, step)
    grid = motion.time_step * np.arange(len(motion.acceleration))
    for push in np.column_stack([np.interp(times, grid, column) for column in motion.acceleration.T]):
        velocity = velocity - push * step
        speed = float(np.hypot(*velocity))
        velocity *= max(0.0, 1.0 - friction * 9.81 * step / speed) if speed > 0.0 else 0.0
        way += velocity * step
    # friction in a box, which follows the load and not the slip: 3 % was measured
    assert run.residual_displacement == pytest.approx(float(np.hypot(*way)), rel=0.05)
    assert not any(solvers)
