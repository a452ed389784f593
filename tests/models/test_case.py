from __future__ import annotations

import dataclasses
import math
import pickle
from typing import Any

import numpy as np
import pytest

from rockwobble.models import (
    Case,
    Cylinder,
    GroundMotion,
    InitialState,
    Run,
    Suite,
    Tendon,
)
from rockwobble.models.support import SUPPORTS

PIER = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
SHORT = GroundMotion(np.zeros((11, 2)), 0.1)
LONG = GroundMotion(np.zeros((21, 2)), 0.1)


def test_a_case_lasts_as_long_as_its_motion_by_default() -> None:
    case = Case(PIER, SHORT, friction=0, name="a")
    assert (case.length, case.gravity, case.friction) == (1.0, 9.81, 0.0)
    assert Case(PIER, SHORT, duration=5.0, name="a").length == 5.0
    assert Case(PIER, initial=InitialState(tilt=0.1), duration=8, name="a").length == 8.0
    assert dataclasses.replace(case, motion=LONG).length == 2.0
    with pytest.raises(ValueError, match=r"^duration \[s\] must be given where there is no ground motion$"):
        Case(PIER, initial=InitialState(tilt=0.1), name="a")


def test_a_start_is_between_upright_and_lying_and_has_rates_only_tilted() -> None:
    for tilt in (0.0, 1e-300, 1.5707):
        state = InitialState(tilt=tilt, rolling_angle=-20.0)
        assert (state.tilt, state.tilt_rate, state.rolling_rate) == (tilt, 0.0, 0.0)
    for tilt in (-1e-9, 0.5 * math.pi):
        with pytest.raises(ValueError, match=r"^tilt must be at least 0 and below pi/2 \[rad\], got "):
            InitialState(tilt=tilt)
    for rate in ("tilt_rate", "rolling_rate"):
        with pytest.raises(ValueError, match=r"^tilt must be above 0 where tilt_rate or rolling_rate"):
            InitialState(tilt=0.0, **{rate: 1e-3})


def test_the_settings_of_a_run_are_immutable() -> None:
    given = {"cone": "elliptic"}
    run = Run("mujoco", "recess", 1e-4, **given)
    given["cone"] = "pyramidal"
    assert (run.engine, run.support, run.time_step, dict(run.settings)) == (
        "mujoco",
        "recess",
        1e-4,
        {"cone": "elliptic"},
    )
    with pytest.raises(TypeError):
        run.settings["cone"] = "pyramidal"  # type: ignore[index]


@pytest.mark.parametrize(
    ("run", "is_model", "is_planar", "engine_name"),
    [
        (Run(None, "recess", plane=0.0), True, True, "reduced"),
        (Run("shaking table", "external"), False, False, "shaking table"),
    ],
)
def test_a_run_states_its_kind(run: Run, is_model: bool, is_planar: bool, engine_name: str) -> None:
    known = (run.is_model, run.is_planar, run.engine_name, run.time_step)
    assert known == (is_model, is_planar, engine_name, None)


@pytest.mark.parametrize(
    ("support", "own_model", "compared_with"),
    [
        ("recess", "recess", ["recess"]),
        ("flat", "flat", ["recess", "flat"]),
        ("ring", "flat", ["recess"]),
        ("external", "recess", ["recess"]),
    ],
)
def test_a_run_names_the_models_that_it_is_compared_with(
    support: str, own_model: str, compared_with: list[str]
) -> None:
    run = Run("mujoco", support)
    assert run.own_model == Run(None, own_model)
    assert run.compared_with == tuple(Run(None, each) for each in compared_with)


def test_a_pickled_run_keeps_its_support() -> None:
    run = Run("mujoco", "ring", 1e-4, cone="elliptic")
    again = pickle.loads(pickle.dumps(run))
    assert again == run != Run("mujoco", "recess", 1e-4)
    assert again.support.walls
    with pytest.raises(ValueError, match=f"^support must be one of {', '.join(SUPPORTS)}, got 'glued'$"):
        Run("mujoco", "glued")


def test_a_suite_takes_any_iterable_once_of_cases_of_different_names() -> None:
    suite = Suite((Case(PIER, SHORT, name=name) for name in "ab"), iter([Run("mujoco", "recess")]))
    assert ([case.name for case in suite.cases], len(suite.runs)) == (["a", "b"], 1)
    for names, words in (("", "must have at least one case"), ("abcb", "must have .* names, got 'b' twice")):
        with pytest.raises(ValueError, match=words):
            Suite([Case(PIER, SHORT, name=name) for name in names], [])


@pytest.mark.parametrize(
    ("given", "words"),
    [
        *(
            ({"name": name}, "the name of a case must be one line, got")
            for name in ("a\nb", "a\u2028b", "a\n")
        ),
        ({"cylinder": SHORT}, "cylinder must be a Cylinder or a WobblingFrame, got GroundMotion"),
        ({"motion": "record.csv"}, "motion must be GroundMotion or None, got 'record.csv'"),
        ({"initial": 0.1}, "initial must be InitialState or None, got 0.1"),
    ],
)
def test_a_part_of_a_wrong_type_is_refused_by_name(given: Any, words: str) -> None:
    with pytest.raises(ValueError, match=words):
        Case(**{"cylinder": PIER, "motion": SHORT, **given})


def test_friction_at_rest_is_the_slenderness_that_would_just_uplift():
    """A base of b/h = mu uplifts under a_xy = mu (g + a_z), at which a friction of mu is exceeded."""
    samples = np.random.default_rng(3).normal(scale=0.5, size=(40, 3))
    motion = GroundMotion(samples, 0.01)
    case = Case(Cylinder(semidiagonal=6.0, tan_alpha=0.2), motion)
    ratio = np.hypot(samples[:, 0], samples[:, 1]) / (9.81 + samples[:, 2])
    assert case.friction_at_rest == pytest.approx(ratio.max(), rel=1e-14)
    between = np.linspace(0.0, 39.0, 3901)
    fine = np.array([np.interp(between, np.arange(40), column) for column in samples.T])
    assert (np.hypot(fine[0], fine[1]) / (9.81 + fine[2])).max() <= case.friction_at_rest * (1.0 + 1e-12)
    held = dataclasses.replace(case, tendon=Tendon(prestress=1.0, stiffness=0.0))
    assert held.friction_at_rest < 0.55 * case.friction_at_rest


def test_friction_at_rest_ends_with_the_run_and_with_the_weight():
    pier = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    rising = GroundMotion([[0.1 * i, 0.0] for i in range(11)], 0.1)
    assert Case(pier, rising, duration=0.55).friction_at_rest == pytest.approx(0.55 / 9.81, rel=1e-12)
    assert Case(pier, duration=1.0).friction_at_rest == 0.0
    assert Case(pier, GroundMotion([[0.0, 0.0, -20.0], [1.0, 0.0, -20.0]], 0.1)).friction_at_rest == math.inf
