"""`rockwobble show` and `rockwobble sweep` from the outside."""

from __future__ import annotations

import json
from pathlib import Path

import pandas as pd
import pytest

from rockwobble.compare import SweepProgress, compare
from rockwobble.compare.storage.parquet_file import read_about
from rockwobble.models import Case, Cylinder, InitialState, Run
from rockwobble.reports.cli.main import main
from rockwobble.reports.console.sweep_progress import sentence

GRID = ["--semidiagonal", "1:20:4", "--tan-alpha", "0.1,0.2", "--scale", "0.3,2", "--workers", "1"]
PIER = Cylinder(semidiagonal=6.0, tan_alpha=0.2)


def call(*arguments: str) -> int:
    with pytest.raises(SystemExit) as ended:
        main(list(arguments))
    assert isinstance(ended.value.code, int)
    return ended.value.code


def described(folder: Path, capsys) -> dict:
    capsys.readouterr()
    assert call("show", str(folder), "--json") == 0
    (result,) = json.loads(capsys.readouterr().out)["results"]
    return result


def made_with(result: dict) -> None:
    assert len(result["inputs"]["fingerprint"]) == 32
    assert {"python", "numpy", "mujoco", "rockwobble"} <= set(result["versions"])


def test_a_sweep_prints_what_it_keeps_and_show_prints_it_again(tmp_path, capsys):
    assert call("sweep", *GRID, "--out", str(tmp_path)) == 0
    printed = capsys.readouterr().out
    assert "alpha = 5.711 to 11.31 deg" in printed
    assert "Runs: 16 (4 sizes, 2 slendernesses, 2 scales, 1 records, models recess)" in printed
    assert "complete, 16 runs" in printed
    result = described(tmp_path, capsys)
    table = pd.read_parquet(tmp_path / "chunks")
    assert result["kind"] == "a sweep"
    assert (result["complete"], result["runs"], result["chunks"]) == (True, 16, 2)
    assert result["outcomes"] == table["outcome"].value_counts().to_dict()
    assert result["inputs"]["semidiagonals"] == {"from": 1.0, "to": 20.0, "count": 4}
    assert {"numba", "mujoco", "rockwobble"} <= set(result["versions"])
    (row,) = result["figures"]
    assert row["overturned [%]"] == 100.0 * (table["outcome"] == "overturned").mean()


def test_a_sweep_that_was_ended_says_how_far_it_is(tmp_path, capsys):
    assert call("sweep", *GRID, "--chunk", "4", "--out", str(tmp_path)) == 0
    next((tmp_path / "chunks").glob("*.parquet")).unlink()
    result = described(tmp_path, capsys)
    assert (result["complete"], result["runs_finished"], result["chunks_finished"]) == (False, 12, 3)
    assert call("show", str(tmp_path)) == 0
    assert "12 of 16 runs are finished (75 %)" in " ".join(capsys.readouterr().out.split())
    assert call("sweep", *GRID, "--chunk", "4", "--out", str(tmp_path)) == 0
    assert "16 of 16 runs (12 of them found finished)" in capsys.readouterr().err


def test_a_comparison_and_one_that_is_not_finished(tmp_path, capsys):
    case = Case(PIER, initial=InitialState(0.5 * PIER.alpha, rolling_rate=0.5), duration=0.5, name="release")
    compare(case, runs=[Run("mujoco", "recess", 1e-3)], workers=1, resume=tmp_path)
    result = described(tmp_path, capsys)
    assert result["kind"] == "a comparison that is not finished"
    kept = len(list((tmp_path / "runs").glob("*.parquet")))
    assert kept >= 2
    assert (result["complete"], result["runs_finished"]) == (False, kept)
    compare(case, runs=[Run("mujoco", "recess", 1e-3)], workers=1, resume=tmp_path, out=tmp_path)
    result = described(tmp_path, capsys)
    assert (result["kind"], result["complete"], result["runs"]) == ("a comparison", True, 2)
    assert result["outcomes"] == {"completed": 1}
    assert result["figures"][0]["run"] == "mujoco recess against recess"
    assert len(result["inputs"]["fingerprint"]) == 32


def test_a_spectrum_and_a_run(tmp_path, capsys):
    assert call("spectrum", "--sizes", "3", "--intensities", "4", "--out", str(tmp_path / "a")) == 0
    result = described(tmp_path / "a", capsys)
    assert (result["kind"], result["runs"]) == ("an overturning spectrum", 36)
    assert sum(result["outcomes"].values()) == 36
    assert [row["run"] for row in result["figures"]] == ["3d", "planar_x", "planar_y"]
    made_with(result)
    for name in ("lowest", "islands", "contrast", "checked"):
        about = read_about(tmp_path / "a" / f"{name}.parquet")
        assert (about["kind"], about["inputs"]) == (f"rockwobble {name}", result["inputs"]["fingerprint"])
    release = ["--release-tilt-deg", "5", "--duration", "0.5", "--out", str(tmp_path / "b")]
    assert call("simulate", *release) == 0
    result = described(tmp_path / "b", capsys)
    assert (result["kind"], result["outcomes"]) == ("a single run", {"completed": 1})
    made_with(result)
    assert read_about(tmp_path / "b" / "run.parquet")["inputs"] == result["inputs"]["fingerprint"]


def test_an_ensemble_and_one_that_is_not_finished(tmp_path, capsys):
    release = ["--release-tilt-deg", "5", "--duration", "0.5", "--engine", "none", "--members", "3"]
    assert call("ensemble", *release, "--out", str(tmp_path)) == 0
    result = described(tmp_path, capsys)
    assert (result["kind"], result["complete"], result["runs"]) == ("an ensemble", True, 6)
    assert result["inputs"]["members"] == "3: starts of free response, perturbed by 1 %"
    assert (result["seeds"], result["outcomes"]) == ({"ensemble": 0}, {"completed": 6})
    made_with(result)
    (tmp_path / "members.parquet").unlink()
    result = described(tmp_path, capsys)
    assert (result["kind"], result["runs_finished"]) == ("an ensemble that is not finished", 6)


@pytest.mark.parametrize("folder", ["", "nowhere"])
def test_what_is_no_store_gets_one_clear_line(tmp_path, capsys, folder):
    assert call("show", str(tmp_path / folder)) == 2
    error = capsys.readouterr().err
    assert error.count("\n") == 1
    assert str(tmp_path / folder) in error


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--semidiagonal", "a"], "--semidiagonal must be a number, a list such as 1,2,6 or a range"),
        (["--scale", "1:2"], "--scale must be a number"),
        (["--tan-alpha", "1:2:1"], "--tan-alpha must be a number"),
        (["--model", "flat"], "models must be of recess, flat, planar, got 'flat'"),
        (["--record-x", "a.at2"], "each record needs both horizontal components"),
        (["--units", "g"], "--record-z and --units belong to a record"),
        (["no-such-suite"], "no-such-suite"),
        (["quick", "--units", "g"], "the records of a suite stand in its file"),
    ],
)
def test_bad_input_of_a_sweep_gets_one_clear_line(tmp_path, capsys, arguments, words):
    assert call("sweep", *arguments, "--out", str(tmp_path / "out")) == 2
    error = capsys.readouterr().err
    assert error.count("\n") == 1
    assert words in error
    assert not (tmp_path / "out").exists()


def test_progress_in_words():
    assert sentence(SweepProgress(done=0, total=10, found=0, left=float("nan"))) == "0 of 10 runs"
    event = SweepProgress(done=1500, total=3000, found=500, left=200.0)
    assert sentence(event) == "1,500 of 3,000 runs (500 of them found finished), about 3 min left"
