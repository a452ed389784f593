"""`rockwobble tradeoff` from the outside, on points that are given: a measurement takes minutes."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from pathlib import Path

import pandas as pd
import pytest
from showing import loads_as_it_was, shows_itself
from typer.testing import CliRunner

from rockwobble.reports.cli.main import app
from rockwobble.reports.pages.tradeoff import page_of
from rockwobble.studies.tradeoff import study
from rockwobble.studies.tradeoff.study import Tradeoff

TABLES = ("points", "problems", "scenes")


@pytest.fixture
def found() -> Tradeoff:
    rows = [
        {"problem": "shaken", "support": "recess", "panel": panel, "family": family, "line": line,
         "knob": knob, "value": 10.0**-n, "ratio": cost * n, "ratio_low": 0.9 * cost * n,
         "ratio_high": 1.2 * cost * n, "milliseconds": 0.2 * cost * n, "error": 10.0 ** -(n + 1), "said": ""}
        for panel, family, line, knob, cost in (
            ("methods", "reduced", "recess model", "tolerance", 1.0),
            ("scipy", "scipy", "LSODA, Python", "tolerance", 300.0),
            ("methods", "mujoco", "mujoco recess", "time step", 700.0),
        )
        for n in (2, 3, 4)
    ]  # fmt: skip
    problem = {"problem": "shaken", "support": "recess", "source": "tight", "doubt": 1e-12, "members": 1,
               "chance": float("nan")}  # fmt: skip
    scene = {"engine": "mujoco", "degrees_of_freedom": 6, "contacts": 1, "constraint_rows": 3}
    scenes = [
        scene | {"support": "flat", "option": "released", "microseconds": 4.0, "ratio": 1.0},
        scene | {"support": "ring", "option": "128 walls", "microseconds": 10.0, "ratio": 2.5},
    ]
    tables = {"points": rows, "problems": [problem], "scenes": scenes}
    return Tradeoff(
        tables={name: pd.DataFrame(table) for name, table in tables.items()}, facts={"load": [0.1, 1.2]}
    )


@pytest.mark.slow
def test_the_command_writes_its_pages_and_all_that_they_are_drawn_from(
    found: Tradeoff, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(study, "measure_tradeoff", lambda *_, **__: found)
    done = CliRunner().invoke(app, ["tradeoff", "--quick", "--out", str(tmp_path)])
    assert done.exit_code == 0
    assert {path.name for path in tmp_path.iterdir() if path.is_file()} >= {
        *(f"{name}.parquet" for name in TABLES), "tradeoff.html", "tradeoff.md", "tradeoff-shaken.svg",
        "manifest.json",
    }  # fmt: skip
    # multiples of the recess model at its default tolerance, not of another family at that error
    printed = " ".join(done.stdout.split())
    assert (
        "an engine takes 1,400 to 2,100 times the computing time of the recess model at its default"
        in printed
    )
    assert "scipy's solvers on the same equations takes 600 to 900 times" in printed
    page = (tmp_path / "tradeoff.html").read_text()
    assert page.count('class="chart"') >= 2
    assert "The load of the machine was 0.1 before and 1.2 after." in page
    assert len(page) < 2e6
    stored = Tradeoff.load(tmp_path)
    assert stored.facts == found.facts
    for name in TABLES:
        pd.testing.assert_frame_equal(getattr(stored, name), getattr(found, name), check_exact=True)
    assert json.loads((tmp_path / "manifest.json").read_text())["kind"] == "tradeoff"


@pytest.mark.slow
def test_other_stored_numbers_have_other_conclusions(found: Tradeoff, tmp_path: Path) -> None:
    points = found.points.copy()
    points.loc[points["family"] == "mujoco", "ratio"] *= 2.0
    replace(found, tables={**found.tables, "points": points}).made_by("rockwobble tradeoff").save(tmp_path)
    assert CliRunner().invoke(app, ["report", str(tmp_path)]).exit_code == 0
    for name in ("tradeoff.html", "tradeoff.md"):
        assert "an engine takes 2,800 to 4,200 times" in (tmp_path / name).read_text()
    manifest = Tradeoff.load(tmp_path).manifest
    assert manifest is not None
    assert manifest.command == "rockwobble tradeoff"


def test_nothing_is_said_of_what_reaches_no_error(found: Tradeoff) -> None:
    exact = found.points["family"] == "reduced"
    points = found.points.assign(error=found.points["error"].where(exact, 1.0))
    none = replace(found, tables={**found.tables, "points": points}, facts={"load": [math.nan, math.nan]})
    words = page_of(none.made_by()).markdown()
    assert "**No engine reaches any of the target errors.**" in words
    assert "scipy's solvers" not in words
    assert "load of the machine" not in words


def test_variants_stand_beside_what_they_vary_on_shared_axes(found: Tradeoff) -> None:
    (picture,) = page_of(found.made_by()).pictures
    methods, scipy = picture.panels
    assert methods.entries() == ["recess model", "mujoco recess"]
    assert scipy.entries() == ["recess model", "LSODA, Python"]
    assert (methods.x, methods.y) == (scipy.x, scipy.y)


def test_bad_input_is_one_line(tmp_path: Path) -> None:
    (tmp_path / "taken").write_text("")
    done = CliRunner().invoke(app, ["tradeoff", "--out", str(tmp_path / "taken")])
    assert done.exit_code == 2
    assert "the output folder must be a folder" in done.stderr
    assert done.stderr.count("\n") == 1


@pytest.mark.slow
def test_a_measurement_shows_itself(found: Tradeoff, tmp_path: Path) -> None:
    shows_itself(found, "engine over recess model, largest 2100")
    loads_as_it_was(found, tmp_path)
