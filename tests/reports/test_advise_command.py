"""`rockwobble advise` from the outside, without an engine."""

from __future__ import annotations

import shlex
from pathlib import Path

import numpy as np
import pytest

from rockwobble.models import el_centro_1940
from rockwobble.models.plain_json import loads
from rockwobble.reports.cli.main import main
from rockwobble.reports.pages.advice.document import advice_document

PAGE_LIMIT = 8e6  # bytes, of every page
PUBLISHED = Path(__file__).parents[2] / "reports" / "published" / "advice"
# of what is computed before traces part: rounding
SAME = 1e-9
FAST = ["--engine", "none", "--starts", "20"]


def call(*arguments: str) -> int:
    with pytest.raises(SystemExit) as ended:
        main(["advise", *arguments])
    assert isinstance(ended.value.code, int)
    return ended.value.code


@pytest.fixture(scope="module")
def records(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("records")
    strong = el_centro_1940(vertical=True).acceleration[:800] / 9.81
    columns = {name: strong[:, i] for i, name in enumerate("xyz")} | {"still": np.zeros(len(strong))}
    for name, values in columns.items():
        rows = "\n".join(f"{0.01 * i:.2f}, {value:.8f}" for i, value in enumerate(values))
        (folder / f"{name}.csv").write_text(f"time [s], acceleration [g]\n{rows}\n")
    return folder


def options_of(records: Path, **names: str) -> list[str]:
    return [
        word for axis, name in names.items() for word in (f"--record-{axis}", str(records / f"{name}.csv"))
    ]


@pytest.mark.parametrize(
    ("names", "more", "verdict", "topics"),
    [
        ({"x": "x", "y": "y"}, [], "Use the recess model", {"Trust", "Friction", "Planar analysis"}),
        ({"x": "x", "y": "y", "z": "z"}, ["--scale", "2"], "Use the recess model", {"Trust", "Contact"}),
        ({"x": "x", "y": "y"}, ["--scale", "0.3"], "The cylinder stays at rest", {"Uplift", "Overturning"}),
        ({"x": "still", "y": "y"}, ["--scale", "2"], "Use the recess model", {"Largest tilt", "Couple"}),
        ({"x": "x", "y": "y"}, ["--scale", "6"], "the cylinder overturns", {"Overturning", "Trust"}),
        ({"x": "x", "y": "y"}, ["--friction", "0.1"], "Do not rely on the recess model", {"Friction"}),
        ({"x": "x", "y": "y"}, ["--support", "flat"], "Use the flat-ground model", {"Trust"}),
        ({}, ["--release-tilt-deg", "5", "--rolling-rate", "0.5"], "its trace holds to the end", {"Trust"}),
    ],
)
def test_every_kind_of_case_gets_its_page(names, more, verdict, topics, records, tmp_path, capsys):
    assert call(*options_of(records, **names), *more, *FAST, "--out", str(tmp_path)) == 0
    printed = " ".join(capsys.readouterr().out.split())
    assert verdict in printed
    record = loads((tmp_path / "advice.json").read_text())
    assert verdict in record["verdict"]
    assert topics <= {statement["topic"] for statement in record["statements"]}
    assert all(statement["text"] and statement["run"] for statement in record["statements"])
    text = " ".join(statement["text"] for statement in record["statements"])
    assert "nan" not in text.split()
    assert "inf" not in text.split()
    page = (tmp_path / "advice.html").read_text()
    assert len(page) < PAGE_LIMIT
    assert record["verdict"] in page.replace("&#39;", "'")
    assert {path.name for path in tmp_path.iterdir()} == {
        f"advice.{ending}" for ending in ("html", "md", "svg", "json")
    }


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--friction", "-1"], "friction must not be negative"),
        (["--starts", "5"], "--starts must be from 20 to 10000, got 5"),
        (["--seed", "-1"], "--seed must not be negative"),
        (["--engine", "none", "--time-step", "1e-4"], "--time-step belongs to an engine"),
        (["--engine", "none", "--support", "glued"], "--support must be one of guided, free, ring"),
        (["--engine", "abacus"], "abacus"),
        (["--support", "glued"], "glued"),
        (["--tan-alpha", "0"], "tan_alpha must be positive"),
    ],
)
def test_bad_input_is_one_line_and_writes_nothing(arguments, words, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert call(*arguments) == 2
    captured = capsys.readouterr()
    assert words in captured.err
    assert captured.err.count("\n") == 1
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("name", ["pier", "column", "tower"])
def test_published_advice_is_what_its_numbers_say_and_what_the_command_says_today(name, tmp_path):
    published = loads((PUBLISHED / name / "advice.json").read_text())
    assert (PUBLISHED / name / "advice.md").read_text() == advice_document(published)
    assert published["verdict"] in (PUBLISHED / name / "advice.md").read_text()
    assert f"`{published['command']}`" in (PUBLISHED / "README.md").read_text()
    _, command, *options = shlex.split(published["command"])
    assert command == "advise"
    assert call(*options, *FAST, "--out", str(tmp_path)) == 0
    fresh, stored = loads((tmp_path / "advice.json").read_text())["numbers"], published["numbers"]
    for number in ("uplift_time", "uplift_factor"):
        assert fresh[number] == pytest.approx(stored[number], rel=SAME)
    assert (fresh["planar_kind"], fresh["outcome"]) == (stored["planar_kind"], stored["outcome"])
