"""`rockwobble ensemble`: what it prints, writes and refuses."""

from __future__ import annotations

import itertools
import json
import math
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from rockwobble.compare import Ensemble
from rockwobble.compare.describe.folder import describe_store
from rockwobble.compare.studies.ensemble.study import ensemble_of
from rockwobble.models.records import p695
from rockwobble.reports.cli.main import main
from rockwobble.reports.console.ensemble_output import print_ensemble
from rockwobble.reports.figures.ensemble_chart import curves, ratio_chart
from rockwobble.reports.figures.ensemble_figure import ensemble_figure
from rockwobble.reports.figures.ensemble_ratios import ratio_rows, ratio_span, ratio_ticks
from rockwobble.reports.pages.ensemble.page import ensemble_page
from rockwobble.reports.pages.ensemble.words import contrast_rows, method_rows, overturning_rows, statements

PUBLISHED = Path(__file__).parents[2] / "reports" / "published" / "ensemble"
FALLEN = 7.9  # [alpha]
RELEASE = ["--release-tilt-deg", "5", "--duration", "0.5", "--engine", "none", "--members", "3"]


def call(*arguments: str) -> int:
    with pytest.raises(SystemExit) as ended:
        main(list(arguments))
    assert isinstance(ended.value.code, int)
    return ended.value.code


def made_up(factor: float = 1.1, model: str = "recess", engine: str = "mujoco recess") -> Ensemble:
    """Ten members by a model and an engine: one overturns by both, one by the engine alone."""
    first = np.array([*np.arange(1, 9) / 10.0, 0.9, FALLEN])
    peaks = {model: first, engine: np.array([*factor * first[:8], FALLEN, FALLEN])}
    rows = [
        {
            "member": f"record {i + 1}",
            "method": method,
            "peak_tilt": peak,
            "outcome": "overturned" if peak == FALLEN else "completed",
            "message": "",
            "wall_time": 1.0,
        }
        for method, values in peaks.items()
        for i, peak in enumerate(values)
    ]
    span = {"from": 6.0, "to": 6.0, "count": 1}
    about = {
        "members": "records",
        "methods": {model: "", engine: model},
        "seeds": {"ensemble": 3},
        "versions": {"mujoco": "4.0.0"},
        "semidiagonal": span,
        "tan_alpha": span,
    }
    return ensemble_of(pd.DataFrame(rows), about)


def test_tables_say_what_overturns_instead_of_its_tilt():
    found = made_up()
    # of ten the median is between the fifth and the sixth, of which 95 % exclude the largest two on each side
    assert method_rows(found)[1] == (
        *("mujoco recess", "10", "10", "2", "0"),
        "0.605 (0.272 to overturned)",
        "0.194 to overturned",
    )
    (row,) = contrast_rows(found)
    assert row[:6] == ("mujoco recess", "recess", "9", "9", "0", "1.100 (1.100 to 1.100)")
    assert row[6:] == ("1.100 to ∞", "0.004", "0.004", "no", "-")
    assert overturning_rows(found) == [
        ("mujoco recess", "recess", "1", "1", "0", "8", "+10 (-20 to +36)", "1.00")
    ]


def test_sentences_say_what_agrees_what_is_told_and_what_cannot_be_seen():
    headline, pair, told, falls = statements(made_up())
    assert headline == (
        "Peaks of the same member do not agree within 5 % in the median: mujoco recess with recess."
    )
    assert pair == (
        "mujoco recess against recess: median ratio 1.100 (1.100 to 1.100), higher in 9 and lower in 0 of 9 "
        "members (p = 0.004); 9 members so scattered tell no ratio on one side of 1; 2 and 1 of 10 "
        "overturn, 1 by both (p = 1.00)."
    )
    assert told == "Told apart (p below 0.05): mujoco recess from recess (higher in 9, lower in 0)."
    assert "it takes at least 6 that overturn by one of two methods alone" in falls


def test_what_is_told_apart_may_agree_and_what_is_not_need_not():
    close = statements(made_up(1.001))
    assert close[0] == "Peaks of the same member agree within 5 % in the median: mujoco recess with recess."
    assert close[2].startswith("Told apart")
    # the first five: so few bound no median, and nothing overturns
    found = made_up()
    few = found.members[found.members["member"].isin([f"record {i}" for i in range(1, 6)])]
    open_ = statements(ensemble_of(few, found.about))
    assert open_[0].startswith("It is undecided whether peaks of the same member agree within 5 %")
    assert "1.100 (0 to ∞)" in open_[1]
    assert "5 members so scattered tell no ratio on one side of 1" in open_[1]
    assert open_[2] == "No peaks are told apart (p below 0.05), which does not make them the same."
    assert open_[3] == "No member overturns by any method: the share that would is below 45 % (95 %)."


def test_the_picture_marks_who_overturns_by_one_method_alone():
    found = made_up(1.2)
    (row,) = ratio_rows(found)
    assert row.label == ("mujoco recess", "/ recess, n = 9")
    assert row.members == [f"record {i}" for i in range(1, 10)]
    assert row.ratios.tolist() == pytest.approx([*[1.2] * 8, math.inf])
    low, high = ratio_span([row])
    assert low < 1.0 / 1.2 < 1.2 < high == pytest.approx(1.0 / low)
    ticks = ratio_ticks(low, high)
    assert 1.0 in ticks
    assert low <= min(ticks) < max(ticks) <= high
    assert ratio_ticks(0.07, 14.0) == [0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0]
    figure = ratio_chart(found)
    assert figure is not None
    counts = [trace.text for trace in figure.data if trace.mode == "markers+text"]
    assert counts == [("1",)]
    fallen = [curve.overturned for curve in curves(found)]
    assert fallen == [1, 2]
    assert [curve.share[-1] for curve in curves(found)] == [0.9, 0.8]
    assert [curve.label for curve in curves(found)][1] == "mujoco recess (2 of 10 overturn)"


@pytest.mark.parametrize(("columns", "intervals"), [(200, True), (80, False)])
def test_a_narrow_terminal_leaves_out_the_intervals_and_cuts_nothing(monkeypatch, capsys, columns, intervals):
    monkeypatch.setenv("COLUMNS", str(columns))
    monkeypatch.setenv("FORCE_COLOR", "1")
    found = made_up(model="pybullet flat", engine="pybullet recess")
    # the widest words that its tables have
    found.contrasts["verdict"] = "undecided"
    print_ensemble(found)
    printed = capsys.readouterr().out
    assert ("0.605 (0.272 to overturned)" in printed) is intervals
    assert "…" not in printed


def test_page_and_figure_show_every_method():
    found = made_up()
    page, figure = ensemble_page(found), ensemble_figure(found).decode()
    assert statements(found)[0] in page
    for method in ("recess", "mujoco recess"):
        assert f'<td class="name">{method}</td>' in page
    assert figure == ensemble_figure(found).decode()


def test_files_of_a_small_ensemble(tmp_path, capsys):
    assert call("ensemble", *RELEASE, "--out", str(tmp_path)) == 0
    printed = capsys.readouterr().out
    assert "alpha = 11.31 deg" in printed
    assert "Members: 3, starts perturbed by 1 %" in printed
    assert "rolling against recess: median ratio 1.000" in printed
    table = pd.read_parquet(tmp_path / "members.parquet")
    assert table["peak_tilt"].to_numpy() == pytest.approx(
        pd.read_csv(tmp_path / "members.csv")["peak_tilt"].to_numpy(), rel=1e-12
    )
    about = json.loads((tmp_path / "ensemble.json").read_text())
    assert (about["kind"], about["seeds"]) == ("rockwobble ensemble", {"ensemble": 0})
    assert "| rolling | recess |" in (tmp_path / "ensemble.md").read_text()


def test_made_up_records_are_the_members(tmp_path, capsys):
    options = ["--synthetic", "1.5", "--members", "2", "--duration", "2", "--engine", "none", "--seed", "7"]
    assert call("ensemble", *options, "--out", str(tmp_path)) == 0
    assert "Members: 2, made-up ground motions, with peaks of 1.5 g tan alpha" in capsys.readouterr().out
    table = pd.read_parquet(tmp_path / "members.parquet")
    assert sorted(set(table["member"])) == ["synthetic 7-1", "synthetic 7-2"]


def test_without_the_records_one_clear_line_says_how_to_get_them(tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(p695.importlib.util, "find_spec", lambda name: None)
    p695.p695_far_field.cache_clear()
    assert call("ensemble", "--p695", "2", "--engine", "none", "--out", str(tmp_path / "out")) == 2
    error = capsys.readouterr().err
    assert error.count("\n") == 1
    assert "pip install 'rockwobble[records]'" in error
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--synthetic", "2", "--p695", "2"], "made-up ground motions or those of FEMA P-695"),
        (["quick", "--members", "4"], "--members does not go with a suite"),
        (["quick", "--p695", "2"], "--p695 does not go with a suite"),
        (["quick", "--semidiagonal", "4"], "--semidiagonal does not go with a suite"),
        (["--synthetic", "0"], "peak must be positive"),
        (["--members", "1"], "at least 2 members"),
        (["--perturbation", "1"], "perturbation must be above 0 and at most 0.1"),
    ],
)
def test_bad_input_gets_one_clear_line(tmp_path: Path, capsys, arguments, words):
    assert call("ensemble", *arguments, "--engine", "none", "--out", str(tmp_path / "out")) == 2
    error = capsys.readouterr().err
    assert error.count("\n") == 1
    assert words in error
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("name", ["p695-2", "p695-3.5", "starts", "synthetic-3"])
def test_published_pages_say_what_their_tables_hold(name):
    folder = PUBLISHED / name
    (result,) = describe_store(folder)
    assert (result["kind"], result["complete"]) == ("an ensemble", True)
    page = (folder / "ensemble.md").read_text()
    table = pd.read_parquet(folder / "members.parquet")
    for method, runs in table.groupby("method", sort=False):
        counts = (
            len(runs),
            (runs["peak_tilt"] > 0.0).sum(),
            *((runs["outcome"] == outcome).sum() for outcome in ("overturned", "failed")),
        )
        assert f"| {method} | {' | '.join(map(str, counts))} |" in page
    for method, against in itertools.combinations(table["method"].unique(), 2):
        assert f"| {against} | {method} |" in page
