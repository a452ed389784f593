"""`rockwobble advise` from the outside, without an engine, and the words of its page."""

from __future__ import annotations

import copy
import dataclasses
import math
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from rockwobble.compare.storage.manifest import read_results
from rockwobble.compare.studies.advice import scales
from rockwobble.compare.studies.advice.advice import KIND
from rockwobble.models import el_centro_1940
from rockwobble.models.records import p695
from rockwobble.reports.cli.main import main
from rockwobble.reports.pages import page
from rockwobble.reports.pages.advice import advice_page, advice_values
from rockwobble.reports.pages.advice import stored_page as draw
from rockwobble.reports.pages.page import Page
from rockwobble.reports.pages.registry import stored_page

PAGE_LIMIT = 8e6  # bytes, of every page
FAST = ["--engine", "none", "--copies", "20"]
DATA = {f"{name}.parquet" for name in ("members", "band", "scales", "planar", "trace", "engine")}


def call(*arguments: str) -> int:
    with pytest.raises(SystemExit) as ended:
        main(["advise", *arguments])
    assert isinstance(ended.value.code, int)
    return ended.value.code


@pytest.fixture(scope="module", autouse=True)
def few_runs() -> Iterator[None]:
    """Hold planar analysis against 3D at two intensities, of six records: more of them tell no more."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(scales, "PLANAR_SCALES", (1.0, 2.0))
        patch.setattr(p695, "PAIRS", 6)
        yield


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
    ("names", "more", "words"),
    [
        ({"x": "x", "y": "y"}, [], ["of copies of this record", "Largest tilt (5 / 50 / 95 %)"]),
        ({"x": "x", "y": "y", "z": "z"}, ["--scale", "2"], ["It is in this record: "]),
        ({"x": "x", "y": "y", "z": "z"}, ["--scale", "0.3"], ["no soil, no neighbours.", "stays at rest"]),
        (
            {"x": "x", "y": "y"},
            ["--scale", "0.3"],
            ["no neighbours, no vertical component", "The cylinder stays at rest: it takes"],
        ),
        ({"x": "still", "y": "y"}, ["--scale", "2"], ["This motion stays in one plane"]),
        (
            {"x": "still", "y": "still", "z": "z"},
            ["--scale", "7"],
            ["0 of 20 copies of this record, which are all one run", "its margin is not tested"],
        ),
        ({"x": "x", "y": "y"}, ["--scale", "6"], ["It overturns as given. Overturning: 100 %"]),
        ({"x": "x", "y": "y"}, ["--friction", "0.1"], ["A friction of 0.1 is below b/h = 0.2"]),
        ({"x": "x", "y": "y"}, ["--support", "flat"], ["flat-ground model", "rolling out of its place"]),
        (
            {},
            ["--release-tilt-deg", "5", "--rolling-rate", "0.5"],
            ["copies of this release", "knows no release out of its plane"],
        ),
    ],
)
def test_every_kind_of_case_gets_its_page(names, more, words, records, tmp_path, monkeypatch, capsys):
    if len(names) == 2:  # its page has the panels of the others: they are drawn as a file, too
        monkeypatch.setattr(page, "svg", lambda *_, **__: b"")
    assert call(*options_of(records, **names), *more, *FAST, "--out", str(tmp_path)) == 0
    printed = " ".join(capsys.readouterr().out.split())
    text = (tmp_path / "advice.md").read_text()
    for word in words:
        assert word in text
        assert word in printed
    assert not {"nan", "inf", "None"} & set(text.replace("|", " ").split())
    assert len((tmp_path / "advice.html").read_text()) < PAGE_LIMIT
    pages = {f"advice.{ending}" for ending in ("html", "md", "svg")}
    assert {path.name for path in tmp_path.iterdir()} == DATA | pages | {"manifest.json"}
    again = stored_page(KIND, tmp_path)
    assert again.markdown() == text
    if more == ["--scale", "2"]:  # twice: with a vertical component, and in one plane
        assert again.html() == (tmp_path / "advice.html").read_text()  # with all that the pictures show


def test_nothing_is_said_of_a_ground_motion_where_there_is_none(tmp_path):
    assert call("--release-tilt-deg", "0", "--duration", "2", *FAST, "--out", str(tmp_path)) == 0
    text = (tmp_path / "advice.md").read_text()
    assert "stays at rest: without a ground motion nothing moves it.**" in text


@pytest.fixture(scope="module")
def stored(tmp_path_factory: pytest.TempPathFactory, records: Path) -> Path:
    folder = tmp_path_factory.mktemp("advice")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Page, "files", lambda _: {})  # its numbers are looked at, and no picture
        assert call(*options_of(records, x="x", y="y"), *FAST, "--out", str(folder)) == 0
    return folder


def said(folder: Path, **changes: object) -> str:
    """Return the document of stored advice with other numbers."""
    results = read_results(folder, KIND)
    facts = copy.deepcopy(dict(results.manifest.about["advice"])) | changes
    tables = {name.removesuffix(".parquet"): results.table(name.removesuffix(".parquet")) for name in DATA}
    manifest = type(results.manifest)(kind=KIND, command="rockwobble advise", about={"advice": facts})
    return advice_page(tables, manifest).markdown()


def test_displacements_are_those_of_the_tilted_cylinder(stored):
    facts = read_results(stored, KIND).manifest.about["advice"]
    values = advice_values({**facts, "peak": 1.0})
    theta, b, h = facts["alpha"], facts["b"], facts["h"]
    assert values["given"]["rim"] == pytest.approx(2.0 * b * math.sin(theta), rel=1e-12)
    # at alpha the centre of mass stands over the rim: halfway up, so the axis meets the rim's vertical there
    assert values["given"]["top"] == pytest.approx(b * (1.0 - math.cos(theta)) + 2.0 * h * math.sin(theta))
    fallen = advice_values({**facts, "answers": [{**facts["answers"][0], "peak_tilt_95": math.inf}]})
    assert (fallen["groups"][0]["top_95"], fallen["groups"][0]["rim_95"]) == (math.inf, math.inf)


def test_grades_by_other_criteria_are_not_drawn_as_these(stored):
    results = read_results(stored, KIND)
    facts = {name: value for name, value in results.manifest.about["advice"].items() if name != "bound"}
    manifest = dataclasses.replace(results.manifest, about={"advice": facts})
    with pytest.raises(ValueError, match="run its command again"):
        draw(dataclasses.replace(results, manifest=manifest))


ENGINE = {
    "label": "mujoco recess",
    "version": "4.0.0",
    "time_step": 1e-4,
    "outcome": "stands",
    "diagnostics": "",
    "peak_tilt": 0.25,
    "moves": True,
    "agreed_until": 22.0,
    "diverged": True,
    "divergence": "in time",
}


RATIOS = {"members": 20, "overturned": 2, "against_overturned": 0, "count": 18, "higher": 12, "lower": 6}
RATIOS |= {"ratio": 1.2, "low": 1.1, "high": 1.4, "ratio_05": 0.8, "ratio_95": 1.9}


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"engine": ENGINE}, "agreed until 22 s, as predicted; its largest tilt is 0.25 α."),
        ({"engine": ENGINE | {"diverged": False}}, "agreed to the end, as predicted;"),
        (
            {"engine": ENGINE | {"divergence": "much later"}},
            "ten times as long as predicted, which tests nothing",
        ),
        ({"engine": ENGINE | {"moves": False}}, "; it stays at rest."),
        ({"engine": ENGINE | {"divergence": "earlier"}}, "rely on neither before you know why"),
        ({"engine": ENGINE | {"outcome": "overturned"}}, "as predicted; it overturns."),
        (
            {"engine": ENGINE | {"outcome": "failed", "diagnostics": "energy_gain"}},
            "could not verify that: energy",
        ),
        ({"trust": {"kind": "trace", "until": 8.0, "because": ""}}, "To its end: neither the method nor"),
        ({"trust": {"kind": "peak", "until": 7.0, "because": "data"}}, "s) included: the copies are spread"),
        ({"predicted": {"until": 7.0, "reason": "pass"}}, ", until 7 s: a pass then"),
        ({"predicted": {"until": 7.0, "reason": "growth"}}, "have multiplied the error"),
        ({"bound": 2e-5}, "within a tenth of the largest tilt, 2e-5 α,"),
        ({"form": RATIOS}, "a copy tilts 1.2 times as much there in the median (95 %: 1.1 to 1.4; 5 to 95 %"),
        (
            {"form": RATIOS | {"ratio": math.nan}},
            ": of 18 copies 12 tilt more there, 6 less; 2 of 20 overturn",
        ),
        (
            {"form": RATIOS | {"ratio_95": math.nan}},
            "in the median (95 %: 1.1 to 1.4); 2 of 20 overturn there, 0",
        ),
        ({"beside": (0.2, math.inf)}, "0.2 to ∞ α (∞: it overturns)"),
        ({"lowest": {"3d": {"factor": 0.8, "confirmed": True, "start": 0.5}}}, "it stands in a gap"),
        ({"lowest": {"3d": {"factor": 1.4, "confirmed": False, "start": 0.5}}}, "a matter of chance"),
        ({"lowest": {"3d": {"factor": math.nan, "confirmed": False, "start": 0.5}}}, "No scale up to 16"),
        ({"model_grade": "not satisfied"}, "; do not rely on the recess model ("),
        ({"records": "synthetic"}, "22 made-up ground motions"),
        ({"recess": None}, "no recess holds that"),
        (
            {"outcome": "failed", "moves": False, "failure": ["step_budget"]},
            "the recess model failed (the steps",
        ),
    ],
)
def test_words_turn_with_the_numbers(stored, changes, words):
    assert words in said(stored, **changes)
    # which records are installed is the machine's affair
    assert words not in said(stored, records="p695")


def test_planar_analysis_is_called_unconservative_only_where_the_interval_says_so(stored):
    row = {"scale": 1.0, "moving": 20, "larger": 17, "larger_share": 0.85, "larger_low": 0.62}
    row |= {"larger_high": 0.97, "missed": 0, "missed_share": 0.0, "missed_low": 0.0, "missed_high": 0.17}
    assert "It is more likely unconservative than not: at this intensity" in said(stored, planar=[row])
    unsure = said(stored, planar=[row | {"larger_low": 0.49}])
    assert "more likely unconservative" not in unsure
    assert "tilts more than both planes under 17 of 20 records (85 %, 95 %: 49 % to 97 %)" in unsure


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--friction", "-1"], "friction must not be negative"),
        (["--copies", "5"], "--copies must be from 20 to 10000, got 5"),
        (["--seed", "-1"], "'--seed': must be at least 0, got -1"),
        (["--engine", "none", "--time-step", "1e-4"], "--time-step belongs to an engine"),
        (["--engine", "none", "--support", "glued"], "--support must be one of recess, flat, ring"),
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
