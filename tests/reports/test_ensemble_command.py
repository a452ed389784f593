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
from rockwobble.compare.describe_store import describe_store
from rockwobble.models import p695
from rockwobble.reports.ensemble_figure import ensemble_figure
from rockwobble.reports.ensemble_output import print_ensemble
from rockwobble.reports.ensemble_page import ensemble_page
from rockwobble.reports.ensemble_words import contrast_rows, method_rows, overturning_rows, statements
from rockwobble.reports.main import main

PUBLISHED = Path(__file__).parents[2] / "reports" / "published" / "ensemble"
RELEASE = ["--release-tilt-deg", "5", "--duration", "0.5", "--engine", "none", "--members", "3"]


def call(*arguments: str) -> int:
    with pytest.raises(SystemExit) as ended:
        main(list(arguments))
    assert isinstance(ended.value.code, int)
    return ended.value.code


def made_up(*, probability: float = 0.5) -> Ensemble:
    """Four members by a model and its engine: one falls in both, one in the engine alone."""
    peaks = {"recess": [0.1, 0.2, 0.3, 7.9], "mujoco guided": [0.1, 0.4, 7.9, 7.9]}
    rows = [
        {
            "member": f"record {i + 1}",
            "method": method,
            "peak_tilt": peak,
            "outcome": "overturned" if peak > 7.0 else "completed",
            "message": "",
            "wall_time": 1.0,
        }
        for method, values in peaks.items()
        for i, peak in enumerate(values)
    ]
    methods = [
        {
            "method": method,
            "own_model": "recess" if method != "recess" else "",
            "runs": 4,
            "rocked": 4,
            "overturned": int(np.sum(np.array(values) > 7.0)),
            "failed": 0,
            "failed_members": "",
            "peak_16": values[0],
            "peak_median": values[1],
            "peak_84": math.inf,
        }
        for method, values in peaks.items()
    ]
    contrast = {
        "method": "mujoco guided",
        "against": "recess",
        "count": 4,
        **{f"{name}{end}": 0.25 for name in ("ks", "wasserstein") for end in ("", "_low", "_high")},
        **{f"median_ratio{end}": math.nan for end in ("", "_low", "_high")},
        "ks_p": probability,
        "member_factor": 1.5,
        "overturned": 2,
        "against_overturned": 1,
        "both_overturned": 1,
        "overturned_p": 1.0,
        "masked": "",
    }
    span = {"from": 6.0, "to": 6.0, "count": 1}
    about = {
        "members": "records",
        "draws": 1000,
        "seeds": {"ensemble": 3},
        "versions": {"mujoco": "4.0.0"},
        "semidiagonal": span,
        "tan_alpha": span,
    }
    return Ensemble(
        members=pd.DataFrame(rows),
        methods=pd.DataFrame(methods),
        contrasts=pd.DataFrame([contrast]),
        about=about,
    )


def test_tables_say_what_falls_instead_of_its_tilt():
    found = made_up()
    assert method_rows(found)[1] == ("mujoco guided", "4", "4", "2", "0", "0.400", "0.100 to falls")
    assert contrast_rows(found)[0][2:5] == ("0.25 (0.25 to 0.25)", "0.50", "0.25 (0.25 to 0.25)")
    assert contrast_rows(found)[0][5] == "-"  # the median of one side falls
    assert overturning_rows(found) == [("mujoco guided", "recess", "1", "1", "0", "2", "1.00")]


def test_sentences_say_what_is_told_apart_and_what_cannot_be_seen():
    headline, chance, engine = statements(made_up())
    assert headline.startswith("No method is told from another")
    assert "With 4 members a KS distance below 0.96 is within chance" in chance
    assert "mujoco guided against recess, its own model" in engine
    assert "2 and 1 of 4 overturn" in engine
    assert statements(made_up(probability=1e-4))[0] == (
        "The distributions of peak tilt tell mujoco guided from recess (p = 0.0001)."
    )
    assert contrast_rows(made_up(probability=1e-4))[0][3] == "<0.01"


@pytest.mark.parametrize(("columns", "intervals"), [(200, True), (80, False)])
def test_a_narrow_terminal_leaves_out_the_intervals_and_cuts_nothing(monkeypatch, capsys, columns, intervals):
    monkeypatch.setenv("COLUMNS", str(columns))
    monkeypatch.setenv("FORCE_COLOR", "1")
    print_ensemble(made_up())
    printed = capsys.readouterr().out
    assert ("0.25 (0.25 to 0.25)" in printed) is intervals
    assert "…" not in printed


def test_page_and_figure_show_every_method():
    found = made_up()
    page, figure = ensemble_page(found), ensemble_figure(found).decode()
    assert statements(found)[0] in page
    for method in ("recess", "mujoco guided"):
        assert f'<td class="name">{method}</td>' in page
    assert figure == ensemble_figure(found).decode()


def test_files_of_a_small_ensemble(tmp_path, capsys):
    assert call("ensemble", *RELEASE, "--out", str(tmp_path)) == 0
    printed = capsys.readouterr().out
    assert "alpha = 11.31 deg" in printed
    assert "Members: 3, starts perturbed by 1 %" in printed
    assert "single peaks" in printed
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
