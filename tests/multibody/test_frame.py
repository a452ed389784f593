"""The slab of a frame in an engine: one column under a slab that can only translate."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from rockwobble import multibody, reduced
from rockwobble.models import Case, Cylinder, InitialState, Trace, WobblingFrame, el_centro_1940
from rockwobble.multibody.engines.mujoco import MujocoEngine
from rockwobble.multibody.engines.registry import find_engine

pytestmark = pytest.mark.slow

SQUAT = Cylinder(semidiagonal=6.0, tan_alpha=0.5)
COARSE = 2.5e-4  # [s] for Drake, whose steps cost ten times another's
# of alpha at the default step, in the recess and on flat ground; measured up to 7.8e-7, in Drake 4.5e-6, in
# Exudyn 3.3e-9 and in Rapier 1.0e-4
RELEASED = {
    "mujoco": 2e-6,
    "pybullet": 2e-6,
    "dart": 1.2e-6,  # 1.9e-6 without compensation of the slip at the top
    "drake": 1e-5,
    "exudyn": 2e-8,
    "rapier": 2e-4,
}
ENGINES = [name for name in RELEASED if name in multibody.available_engines()]
# relative RMS at the default step; measured 5.0e-6 to 1.3e-5, of a cylinder alone 6.4e-6 to 1.0e-5
SHAKEN = 5e-5
UNTIL = {"mujoco": 15.0, "pybullet": 15.0, "dart": 6.0}  # [s]; a step of DART costs four times another's
# weights; a window of 65 steps has the curvature of the force, measured 5e-5; 4e-3 in single precision
FORCE, ROUNDED_FORCE = 1e-3, 1e-2


def both(case: Case, **options: object) -> tuple[Trace, Trace]:
    support = options.get("support", "recess")
    return multibody.simulate(case, **options), reduced.simulate(case, support=str(support))  # type: ignore[arg-type]


def release(ratio: float = 1.0, rate: float = 0.5, friction: float = 1.0) -> Case:
    frame = WobblingFrame(SQUAT, ratio, columns=1)
    start = InitialState(0.5 * SQUAT.alpha, rolling_rate=rate)
    return Case(frame, initial=start, duration=3.0, friction=friction)


@pytest.mark.parametrize(
    ("name", "support"), [(name, support) for name in ENGINES for support in find_engine(name).supports[:2]]
)
@pytest.mark.parametrize("ratio", [0.2, 5.0])
def test_a_release_follows_the_reduced_model(ratio: float, name: str, support: str) -> None:
    step = COARSE if name == "drake" else None
    engine, model = both(release(ratio), engine=name, support=support, time_step=step)
    released, force = RELEASED[name], ROUNDED_FORCE if name == "rapier" else FORCE
    assert np.abs(engine.tilt - model.tilt).max() < released * SQUAT.alpha
    assert np.abs(engine.energy - model.energy).max() < 2.0 * released * model.energy[0]
    assert np.abs(engine.contact_force - model.contact_force)[1:-1].max() < force
    assert engine.slab_displacement == pytest.approx(model.slab_displacement, abs=max(1e-4, 10.0 * released))
    assert engine.diagnostics == ()


@pytest.mark.parametrize("name", [name for name in ENGINES if name in UNTIL])
@pytest.mark.parametrize(("size", "tan_alpha", "scale"), [(10.0, 0.1, 1.0), (6.0, 0.2, 2.0)])
def test_el_centro_follows_the_model(size: float, tan_alpha: float, scale: float, name: str) -> None:
    frame = WobblingFrame(Cylinder(semidiagonal=size, tan_alpha=tan_alpha), 1.0, columns=1)
    motion = el_centro_1940().scaled(scale)
    engine, model = both(Case(frame, motion, duration=UNTIL[name]), engine=name)
    assert np.sqrt(np.mean((engine.tilt - model.tilt) ** 2) / np.mean(model.tilt**2)) < SHAKEN
    assert engine.uplift_time == pytest.approx(model.uplift_time, abs=1e-5)
    # the difference of a frame from its column is above the budget
    alone = reduced.simulate(Case(frame.cylinder, motion, duration=UNTIL[name]))
    assert np.sqrt(np.mean((alone.tilt - model.tilt) ** 2) / np.mean(model.tilt**2)) > 0.1


def test_a_joint_that_pulls_or_drags_the_slab_is_reported() -> None:
    pytest.importorskip("exudyn")
    # under a light slab the top slips before the base
    engine, model = both(release(0.1, rate=3.0), engine="exudyn", support="flat")
    pulls, expected = (next(d for d in each.diagnostics if d.code == "tension") for each in (engine, model))
    assert pulls.time == pytest.approx(expected.time, abs=2e-3)
    assert model.time[np.argmax(model.contact_force[:, 2] < 0.0)] > pulls.time + 0.01
    engine, model = both(release(0.1, friction=0.4), engine="exudyn", support="flat")
    assert model.friction_needed.max() < 0.35
    assert [each.code for each in engine.diagnostics] == ["friction_needed"]


def test_one_column_represents_any_number_with_a_diagnostic() -> None:
    start = InitialState(0.1, rolling_rate=0.5)
    one, many = (
        multibody.simulate(Case(WobblingFrame(SQUAT, 1.0, columns=number), initial=start, duration=0.2))
        for number in (1, 4)
    )
    assert np.array_equal(one.tilt, many.tilt)
    (fact,) = (fact for fact in many.facts if fact not in one.facts)
    assert (fact.code, fact.size) == ("one_column", 4)
    assert "one_column" not in [fact.code for fact in one.facts]


def test_walls_under_a_slab_are_refused_in_a_line() -> None:
    case = Case(WobblingFrame(SQUAT, 1.0, columns=1), initial=InitialState(0.1), duration=1.0)
    with pytest.raises(ValueError, match="support must have no walls under a slab") as refused:
        multibody.simulate(case, engine="mujoco", support="ring")
    assert "\n" not in str(refused.value)


def test_an_engine_without_a_slab_refuses_it_by_name(monkeypatch: pytest.MonkeyPatch) -> None:
    without = dataclasses.replace(MujocoEngine.facts, carries_slab=False)
    monkeypatch.setattr(MujocoEngine, "facts", without)
    with pytest.raises(ValueError, match="mujoco has no scene of a frame"):
        multibody.simulate(release(), engine="mujoco")
