"""A comparison comes back from its files."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest

from rockwobble.compare import Comparison, compare
from rockwobble.compare.storage.parquet_file import read_about
from rockwobble.models import Case, Cylinder, GroundMotion, InitialState, Run, Suite

PIER = Cylinder(semidiagonal=6.0, tan_alpha=0.2, height=11.0)
SHAKE = GroundMotion(
    np.array([[0.0, 0.0, 0.0], [4.0, 1.0, 0.1], [-4.0, 1.0, 0.0], [0.0, 0.0, 0.0]]), 0.25, "shake"
)
CASES = [
    Case(
        PIER,
        initial=InitialState(0.5 * PIER.alpha, rolling_rate=0.5),
        duration=1.0,
        gravity=9.8,
        name="release",
    ),
    Case(Cylinder(semidiagonal=6.0, tan_alpha=0.1), SHAKE, friction=2.0, name="shake"),
]


@pytest.fixture(scope="module")
def saved(tmp_path_factory) -> tuple[Comparison, Comparison]:
    folder = tmp_path_factory.mktemp("comparison")
    runs = [Run("mujoco", "recess", 1e-3), Run("mujoco", "flat", 1e-3)]
    comparison = compare(Suite(CASES, runs), workers=1, out=folder, budget=True)
    return comparison, Comparison.load(folder)


def test_the_summary_is_the_same(saved):
    pd.testing.assert_frame_equal(saved[0].summary, saved[1].summary, check_exact=True)
    assert (saved[0].versions, saved[0].until) == (saved[1].versions, saved[1].until)


def test_cases_are_the_same(saved):
    for case, again in zip(saved[0].cases.values(), saved[1].cases.values(), strict=True):
        for name in ("name", "cylinder", "initial", "duration", "gravity", "friction", "length"):
            assert getattr(case, name) == getattr(again, name)
        if case.motion is None:
            assert again.motion is None
        else:
            assert np.array_equal(case.motion.acceleration, again.motion.acceleration)
            assert (case.motion.time_step, case.motion.name) == (again.motion.time_step, again.motion.name)


@pytest.mark.parametrize("kind", ["responses", "trajectories"])
def test_runs_are_the_same(saved, kind):
    first, again = (getattr(comparison, kind) for comparison in saved)
    assert list(first) == list(again)
    for trace, loaded in zip(first.values(), again.values(), strict=True):
        pd.testing.assert_frame_equal(trace.to_frame(), loaded.to_frame(), check_exact=True)
        pd.testing.assert_frame_equal(trace.passes, loaded.passes, check_exact=True)
        for name in ("contact_point", "centre_of_mass", "contact_force", "energy", "peak_tilt", "outcome"):
            assert np.array_equal(getattr(trace, name), getattr(loaded, name), equal_nan=name != "outcome"), (
                name
            )
    if kind == "responses":
        assert [trace.assumptions for trace in first.values()] == [
            trace.assumptions for trace in again.values()
        ]


def test_budgets_are_the_same(saved):
    first, again = (comparison.budgets for comparison in saved)
    assert list(first) == list(again)
    assert first
    for budget, loaded in zip(first.values(), again.values(), strict=True):
        pd.testing.assert_frame_equal(budget.to_frame(), loaded.to_frame(), check_exact=True)
        assert budget.columns() == pytest.approx(loaded.columns(), rel=0.0, abs=0.0, nan_ok=True)


def test_saving_what_was_loaded_writes_the_same_tables(saved, tmp_path):
    first, again = saved[0].files(), saved[1].files()
    assert first.keys() == again.keys()
    for name in first:
        assert first[name] == again[name], name


def test_the_tables_say_what_made_them(saved):
    for name, content in saved[0].files().items():
        if name.endswith(".parquet"):
            about = read_about(content)
            assert about["versions"]["mujoco"] == saved[0].versions["mujoco"]
            assert len(about["inputs"]) == 32


def test_a_folder_without_a_comparison(tmp_path):
    with pytest.raises(ValueError, match="must be the folder of a comparison"):
        Comparison.load(tmp_path)
