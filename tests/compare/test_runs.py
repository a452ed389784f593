from __future__ import annotations

import importlib.util

import pytest

from rockwobble.compare import default_runs, installed_engines, missing_engines
from rockwobble.compare.runs import references_of, run_labels
from rockwobble.models import Run


def test_default_runs_are_every_installed_engine_guided_and_free():
    runs = default_runs(engines=("mujoco", "pybullet"))
    assert [(run.engine, run.support) for run in runs] == [
        ("mujoco", "guided"),
        ("pybullet", "guided"),
        ("mujoco", "free"),
        ("pybullet", "free"),
    ]


def test_an_engine_without_a_wheel_is_left_out(monkeypatch):
    find = importlib.util.find_spec
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None if name == "pybullet" else find(name))
    assert installed_engines() == ("mujoco",)
    assert missing_engines() == ("pybullet",)
    assert {run.engine for run in default_runs()} == {"mujoco"}


def test_open_ground_is_held_against_both_models():
    assert references_of(Run("mujoco", "guided"), "recess") == ("recess",)
    assert references_of(Run("mujoco", "free"), "recess") == ("recess", "rolling")
    assert references_of(Run("mujoco", "free"), "rolling") == ("rolling",)


def test_labels_tell_runs_apart_with_as_little_as_possible():
    runs = [
        Run("mujoco", "guided"),
        Run("mujoco", "free", 1e-4),
        Run("mujoco", "free", 5e-5),
        Run("mujoco", "free", 5e-5, integrator="RK4"),
        Run("mujoco", "free", 5e-5, integrator="Euler"),
    ]
    assert run_labels(runs) == (
        "mujoco guided",
        "mujoco free 0.0001 s",
        "mujoco free 5e-05 s",
        "mujoco free 5e-05 s integrator=RK4",
        "mujoco free 5e-05 s integrator=Euler",
    )


def test_the_same_run_twice_is_refused():
    with pytest.raises(ValueError, match=r"must differ, got 'mujoco free' twice"):
        run_labels([Run("mujoco", "free"), Run("mujoco", "free")])
