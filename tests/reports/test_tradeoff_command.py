"""`rockwobble tradeoff` from the outside, on tables that were stored: a measurement takes minutes."""

from __future__ import annotations

import json
from pathlib import Path

import pandas as pd
import pytest

from rockwobble.compare.tradeoff import Tradeoff, tradeoff_tables
from rockwobble.reports.main import main

FILES = {
    "tradeoff.html", "tradeoff.md", "tradeoff.svg", "points.parquet", "problems.parquet", "scenes.parquet",
    "about.json",
}  # fmt: skip


def call(*arguments: str) -> int:
    with pytest.raises(SystemExit) as ended:
        main(["tradeoff", *arguments])
    assert isinstance(ended.value.code, int)
    return ended.value.code


@pytest.fixture
def stored(tmp_path: Path) -> Path:
    rows = []
    for family, line, knob, cost in (
        ("reduced", "reduced, recess", "tolerance", 1.0),
        ("scipy", "scipy LSODA, Python", "tolerance", 300.0),
        ("mujoco", "MuJoCo guided", "time step", 700.0),
    ):
        rows += [
            {
                "problem": "shaken", "model": "recess", "family": family, "line": line, "support": "",
                "knob": knob, "value": 10.0**-n, "settings": "", "ratio": cost * n,
                "milliseconds": 0.2 * cost * n,
                "error": 10.0 ** -(n + 1), "message": "",
            }
            for n in (2, 3, 4)
        ]  # fmt: skip
    problem = {
        "problem": "shaken", "title": "Shaken", "error_title": "largest error of the tilt [α]",
        "model": "recess",
        "source": "tight solution", "doubt": 1e-12, "members": 1, "chance": float("nan"),
    }  # fmt: skip
    scene = {"engine": "mujoco", "degrees_of_freedom": 6, "contacts": 1, "constraint_rows": 3}
    found = Tradeoff(
        points=pd.DataFrame(rows),
        problems=pd.DataFrame([problem]),
        scenes=pd.DataFrame(
            [
                scene | {"support": "free", "option": "released", "microseconds": 4.0, "ratio": 1.0},
                scene | {"support": "ring", "option": "128 walls", "microseconds": 10.0, "ratio": 2.5},
            ]
        ),
        about={"command": "rockwobble tradeoff", "processor": "a", "versions": {"numpy": "2"}, "rounds": 3},
    )
    folder = tmp_path / "stored"
    folder.mkdir()
    for name, content in tradeoff_tables(found).items():
        (folder / name).write_bytes(content)
    return folder


def test_pages_are_drawn_from_stored_tables_and_conclude_from_them(stored: Path, tmp_path: Path, capsys):
    out = tmp_path / "out"
    assert call("--stored", str(stored), "--out", str(out)) == 0
    assert {path.name for path in out.iterdir()} == FILES
    printed = " ".join(capsys.readouterr().out.split())
    assert "takes 700 times the time of the reduced model" in printed
    assert "scipy's solvers on the same equations takes 300 to 300 times" in printed
    page = (out / "tradeoff.html").read_text()
    assert page.count("plotly-graph-div") >= 1
    assert "takes 2.5 times its time a step" in page
    assert len(page) < 8e6
    assert "(tradeoff.svg)" in (out / "tradeoff.md").read_text()
    assert json.loads((out / "about.json").read_text())["rounds"] == 3

    # other numbers, other conclusions
    points = pd.read_parquet(stored / "points.parquet")
    points.loc[points["family"] == "mujoco", "ratio"] *= 2.0
    points.to_parquet(stored / "points.parquet")
    assert call("--stored", str(stored), "--out", str(out)) == 0
    assert "takes 1,400 times the time of the reduced model" in " ".join(capsys.readouterr().out.split())


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--stored", "nowhere"], "holds no measurement of rockwobble tradeoff: points.parquet is missing"),
        (["--stored", "nowhere", "--quick"], "--quick goes without --stored"),
        (["--out", "taken"], "the output folder must be a folder"),
    ],
)
def test_bad_input_is_one_line(arguments, words, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "taken").write_text("")
    assert call(*arguments) == 2
    captured = capsys.readouterr()
    assert words in captured.err
    assert captured.err.count("\n") == 1
