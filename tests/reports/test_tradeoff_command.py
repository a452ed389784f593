"""`rockwobble tradeoff` from the outside, on points that are given: a measurement takes minutes."""

from __future__ import annotations

from pathlib import Path

import pandas as pd
import pytest

from rockwobble.compare.storage.origin import Origin
from rockwobble.compare.studies import tradeoff
from rockwobble.compare.studies.tradeoff import Tradeoff, read_tradeoff, tradeoff_tables
from rockwobble.reports.cli.main import main

FILES = {
    "tradeoff.html", "tradeoff.md", "tradeoff.svg", "points.parquet", "problems.parquet", "scenes.parquet",
    "tradeoff.json",
}  # fmt: skip


def call(*arguments: str) -> int:
    with pytest.raises(SystemExit) as ended:
        main(list(arguments))
    assert isinstance(ended.value.code, int)
    return ended.value.code


@pytest.fixture
def found() -> Tradeoff:
    rows = []
    for family, line, knob, cost in (
        ("reduced", "reduced, recess", "tolerance", 1.0),
        ("scipy", "scipy LSODA, Python", "tolerance", 300.0),
        ("mujoco", "MuJoCo recess", "time step", 700.0),
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
    return Tradeoff(
        points=pd.DataFrame(rows),
        problems=pd.DataFrame([problem]),
        scenes=pd.DataFrame(
            [
                scene | {"support": "flat", "option": "released", "microseconds": 4.0, "ratio": 1.0},
                scene | {"support": "ring", "option": "128 walls", "microseconds": 10.0, "ratio": 2.5},
            ]
        ),
        rounds=3,
        load=(0.1, 1.2),
        origin=Origin(
            command="rockwobble tradeoff", date="2026-01-02", processor="an abacus", versions={"numpy": "2"}
        ),
    )


@pytest.fixture
def stored(found: Tradeoff, tmp_path: Path) -> Path:
    folder = tmp_path / "stored"
    folder.mkdir()
    for name, content in tradeoff_tables(found).items():
        (folder / name).write_bytes(content)
    return folder


def test_the_command_writes_its_pages_and_all_that_they_are_drawn_from(found, tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(tradeoff, "measure_tradeoff", lambda **_: found)
    out = tmp_path / "out"
    assert call("tradeoff", "--quick", "--out", str(out)) == 0
    assert {path.name for path in out.iterdir()} == FILES
    printed = " ".join(capsys.readouterr().out.split())
    assert "takes 700 times the time of the reduced model" in printed
    assert "scipy's solvers on the same equations takes 300 to 300 times" in printed
    page = (out / "tradeoff.html").read_text()
    assert page.count("plotly-graph-div") >= 1
    assert "takes 2.5 times its time a step" in page
    assert "The load of the machine was 0.1 before and 1.2 after." in page
    assert len(page) < 8e6
    assert "(tradeoff.svg)" in (out / "tradeoff.md").read_text()
    stored = read_tradeoff(out)
    assert (stored.origin, stored.rounds, stored.load) == (found.origin, found.rounds, found.load)
    for name in ("points", "problems", "scenes"):
        pd.testing.assert_frame_equal(getattr(stored, name), getattr(found, name))


def test_other_stored_numbers_have_other_conclusions(stored: Path, capsys):
    points = pd.read_parquet(stored / "points.parquet")
    points.loc[points["family"] == "mujoco", "ratio"] *= 2.0
    points.to_parquet(stored / "points.parquet")
    assert call("report", str(stored)) == 0
    for name in ("tradeoff.html", "tradeoff.md"):
        text = (stored / name).read_text()
        assert "takes 1,400 times the time of the reduced model" in text
        assert "on 2026-01-02, on an abacus, with numpy 2." in text


def test_bad_input_is_one_line(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "taken").write_text("")
    assert call("tradeoff", "--out", "taken") == 2
    captured = capsys.readouterr()
    assert "the output folder must be a folder" in captured.err
    assert captured.err.count("\n") == 1
