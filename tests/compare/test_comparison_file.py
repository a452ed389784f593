"""Comparisons restored from their files."""

from __future__ import annotations

import dataclasses
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from rockwobble import comparison
from rockwobble.compare import Comparison
from rockwobble.compare.storage.manifest import read_results
from rockwobble.models import Case, Cylinder, GroundMotion, InitialState, Run, Suite
from rockwobble.models.trace_file import read_about

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
    comparison_ = comparison(Suite(CASES, runs), workers=1, out=folder, budget=True)
    return comparison_, Comparison.load(folder)


def test_cases_of_a_saved_comparison_are_restored(saved):
    for case, again in zip(saved[0].cases.values(), saved[1].cases.values(), strict=True):
        for name in ("name", "cylinder", "initial", "duration", "gravity", "friction", "length"):
            assert getattr(case, name) == getattr(again, name)
        if case.motion is None:
            assert again.motion is None
        else:
            assert np.array_equal(case.motion.acceleration, again.motion.acceleration)
            assert (case.motion.time_step, case.motion.name) == (again.motion.time_step, again.motion.name)


def test_runs_of_a_saved_comparison_are_restored(saved):
    first, again = (comparison.traces for comparison in saved)
    assert list(first) == list(again)
    for trace, loaded in zip(first.values(), again.values(), strict=True):
        pd.testing.assert_frame_equal(trace.to_frame(), loaded.to_frame(), check_exact=True)
        pd.testing.assert_frame_equal(trace.passes, loaded.passes, check_exact=True)
        assert (trace.outcome, trace.diagnostics) == (loaded.outcome, loaded.diagnostics)
        for name in ("contact_point", "centre_of_mass", "contact_force", "energy", "peak_tilt"):
            assert np.array_equal(getattr(trace, name), getattr(loaded, name), equal_nan=True), name
        if trace.run.is_model:
            assert trace.assumptions == loaded.assumptions


def test_budgets_of_a_saved_comparison_are_restored(saved):
    first, again = (comparison.budgets for comparison in saved)
    assert list(first) == list(again)
    assert first
    for budget, loaded in zip(first.values(), again.values(), strict=True):
        pd.testing.assert_frame_equal(budget.to_frame(), loaded.to_frame(), check_exact=True)
        np.testing.assert_equal(loaded.columns(), budget.columns())
        assert loaded.steps == budget.steps


def test_folders_of_0_3_are_read_and_older_ones_refused_by_release(saved, tmp_path):
    saved_now, trace = saved[0], saved[0].traces["release", "recess model"]
    columns = {"time": trace.time, "tilt [rad]": trace.tilt, "azimuth [deg]": np.degrees(trace.rolling_angle)}
    pd.DataFrame(columns).to_csv(path := tmp_path / "table.csv", index=False)
    saved_now = comparison(CASES[0], runs=[], external=[path], workers=1)
    # version 0.3 had one table, and no mode
    whole = saved_now.rows("release").drop(columns=["mode", "error_source", "twist_rms"])
    tables = {name: table for name, table in saved_now.tables.items() if name != "external"}
    dataclasses.replace(saved_now, tables=tables | {"summary": whole}).save(tmp_path / "old")
    read = Comparison.load(tmp_path / "old")
    assert [*map(str, read.findings())] == [*map(str, saved_now.findings())]
    assert set(read.summary) == set(saved_now.summary)
    assert read.external["differs_in"].tolist() == saved_now.external["differs_in"].tolist() == [()]
    older = tables | {"summary": whole.drop(columns="energy_loss")}
    dataclasses.replace(saved_now, tables=older).made_by().save(tmp_path / "older")
    with pytest.raises(
        ValueError, match=f"no energy_loss; the release .* reads it, {saved_now.versions['rockwobble']}"
    ):
        Comparison.load(tmp_path / "older")


def test_manifest_and_tables_state_their_origin(saved, tmp_path):
    saved[0].made_by("rockwobble compare").save(tmp_path, pages={"report.md": b"# Report"})
    manifest = read_results(tmp_path, "comparison").manifest
    assert manifest.headline["rows"] == len(saved[0].summary)
    assert manifest.headline["diverged"] == saved[0].summary["diverged"].sum()
    assert (manifest.command, manifest.pages) == ("rockwobble compare", ("report.md",))
    for path in tmp_path.glob("*.parquet"):
        about = read_about(path)
        assert about["versions"]["mujoco"] == saved[0].versions["mujoco"]
        assert len(about["inputs"]) == 32


def test_a_median_needs_six_rows(saved):
    rows = pd.concat([saved[0].summary] * 3, ignore_index=True)
    assert len(rows) >= 6
    rows["agreement_time"] = 10.0 + np.arange(len(rows))
    many, few = (
        replace(saved[0], tables={**saved[0].tables, "summary": part}).headline() for part in (rows, rows[:5])
    )
    assert many["median agreement time [s]"] == rows["agreement_time"].median()
    assert few["median agreement time [s]"] is None
