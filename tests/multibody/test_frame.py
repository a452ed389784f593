"""The slab of a frame in an engine: one column under a slab that can only translate."""

from __future__ import annotations

import numpy as np
import pytest

from rockwobble import multibody, reduced
from rockwobble.models import Case, Cylinder, InitialState, Trace, WobblingFrame, el_centro_1940

SQUAT = Cylinder(semidiagonal=6.0, tan_alpha=0.5)
ENGINES = ("mujoco", "pybullet")
RELEASED = 2e-6  # of alpha at the default step; measured up to 7.7e-7 in the recess and on flat ground
ORDER = 0.2  # of the slope of the error
# relative RMS at the default step; measured 5.0e-6 to 8.2e-6, for a cylinder alone 6.5e-6 and 6.4e-6
SHAKEN = 5e-5
FORCE = 1e-3  # weights; a window of 65 steps has the curvature of the force, measured 8e-6


def both(case: Case, **options: object) -> tuple[Trace, Trace]:
    support = options.get("support", "recess")
    return multibody.simulate(case, **options), reduced.simulate(case, support=str(support))  # type: ignore[arg-type]


def release(ratio: float = 1.0) -> Case:
    frame = WobblingFrame(SQUAT, ratio, columns=1)
    return Case(frame, initial=InitialState(0.5 * SQUAT.alpha, rolling_rate=0.5), duration=3.0)


@pytest.mark.parametrize("name", ENGINES)
@pytest.mark.parametrize(("support", "ratio"), [("recess", 0.2), ("flat", 1.0), ("recess", 5.0)])
def test_a_release_follows_the_reduced_model(support: str, ratio: float, name: str) -> None:
    engine, model = both(release(ratio), engine=name, support=support)
    assert np.abs(engine.tilt - model.tilt).max() < RELEASED * SQUAT.alpha
    assert np.abs(engine.energy - model.energy).max() < 2.0 * RELEASED * model.energy[0]
    assert np.abs(engine.contact_force - model.contact_force)[1:-1].max() < FORCE
    assert engine.slab_displacement == pytest.approx(model.slab_displacement, abs=1e-4)
    assert engine.diagnostics == ()


@pytest.mark.parametrize("name", ENGINES)
def test_the_error_is_of_first_order(name: str) -> None:
    steps = np.array([4e-4, 2e-4, 1e-4])
    found = [both(release(), engine=name, time_step=float(step)) for step in steps]
    errors = [np.abs(engine.tilt - model.tilt).max() for engine, model in found]
    assert np.polyfit(np.log(steps), np.log(errors), 1)[0] == pytest.approx(1.0, abs=ORDER)


@pytest.mark.parametrize("name", ENGINES)
@pytest.mark.parametrize(("size", "tan_alpha", "scale"), [(10.0, 0.1, 1.0), (6.0, 0.2, 2.0)])
def test_el_centro_from_rest(size: float, tan_alpha: float, scale: float, name: str) -> None:
    frame = WobblingFrame(Cylinder(semidiagonal=size, tan_alpha=tan_alpha), 1.0, columns=1)
    engine, model = both(Case(frame, el_centro_1940().scaled(scale), duration=15.0), engine=name)
    assert np.sqrt(np.mean((engine.tilt - model.tilt) ** 2) / np.mean(model.tilt**2)) < SHAKEN
    assert engine.uplift_time == pytest.approx(model.uplift_time, abs=1e-5)
    # the case tells a frame from its column
    alone = reduced.simulate(Case(frame.cylinder, el_centro_1940().scaled(scale), duration=15.0))
    assert np.sqrt(np.mean((alone.tilt - model.tilt) ** 2) / np.mean(model.tilt**2)) > 0.1


@pytest.mark.parametrize("name", ENGINES)
def test_on_flat_ground_friction_creeps_less_the_more_of_the_slip_a_step_removes(name: str) -> None:
    frame = WobblingFrame(Cylinder(semidiagonal=6.0, tan_alpha=0.2), 1.0, columns=1)
    case = Case(frame, el_centro_1940().scaled(2.0), duration=8.0)
    model = reduced.simulate(case, support="flat")
    shares, errors = np.array([1.6, 1.8, 2.0]), []
    for share in shares:
        engine = multibody.simulate(case, engine=name, support="flat", friction_damping=share)
        errors.append(np.sqrt(np.mean((engine.tilt - model.tilt) ** 2) / np.mean(model.tilt**2)))
    # a material point of the rim creeps by (1/share - 1/2) of a step: 0.125, 0.056 and nothing
    assert errors[0] / errors[1] == pytest.approx(0.125 / (1.0 / 1.8 - 0.5), rel=0.2)
    assert errors[2] < 0.1 * errors[1]


def test_the_vertical_component_moves_the_slab_too() -> None:
    frame = WobblingFrame(Cylinder(semidiagonal=6.0, tan_alpha=0.2), 1.0, columns=1)
    engine, model = both(Case(frame, el_centro_1940(vertical=True), duration=6.0))
    assert np.abs(engine.tilt - model.tilt).max() < 1e-4 * frame.alpha
    assert model.peak_tilt > 0.05 * frame.alpha


@pytest.mark.parametrize(
    ("engine", "columns", "support", "named"),
    [
        ("dart", 1, "recess", "dart"),
        ("pybullet", 3, "recess", "columns"),
        ("mujoco", 3, "recess", "columns"),
        ("mujoco", 1, "ring", "support"),
    ],
)
def test_what_has_no_scene_is_refused_in_a_line(engine: str, columns: int, support: str, named: str) -> None:
    case = Case(WobblingFrame(SQUAT, 1.0, columns=columns), initial=InitialState(0.1), duration=1.0)
    with pytest.raises(ValueError, match=named) as refused:
        multibody.simulate(case, engine=engine, support=support)
    assert "\n" not in str(refused.value)


def test_a_frame_without_a_slab_is_its_column() -> None:
    initial = InitialState(0.1, rolling_rate=0.5)
    frame, alone = (
        multibody.simulate(Case(body, initial=initial, duration=0.5))
        for body in (WobblingFrame(SQUAT, 0.0), SQUAT)
    )
    assert np.array_equal(frame.tilt, alone.tilt)
