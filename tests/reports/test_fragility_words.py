"""Findings and page of a fragility: only statements supported by its tables."""

from __future__ import annotations

import dataclasses
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
from fragility_example import METHODS, made_up
from showing import is_golden

from rockwobble.compare.metrics.statistics import FEWEST, Interval
from rockwobble.reports.figures.fragility import pictures
from rockwobble.reports.pages import page_of
from rockwobble.reports.pages.fragility import fragility_values
from rockwobble.reports.pages.wording import lines_of
from rockwobble.studies import Fragility
from rockwobble.studies.fragility.study import fragility_of
from rockwobble.studies.fragility.tables import margin_of

pytestmark = pytest.mark.checkout


@pytest.fixture(scope="module")
def study() -> Fragility:
    return made_up()


def with_contrasts(study: Fragility, table: pd.DataFrame) -> Fragility:
    return dataclasses.replace(study, tables={**study.tables, "contrasts": table})


@pytest.mark.slow
def test_page_matches_golden_file():
    is_golden(made_up(("pier",)))


Numbers = list[dict[str, Any]]


def numbers(study: Fragility, *keys: str) -> Numbers:
    """Numbers of the findings of some keys, with key and body."""
    return [
        {"key": each.key.partition(".")[2], "body": each.runs}
        | {name: value for name, value, _ in each.quantities()}
        for each in study.findings()
        if each.key.partition(".")[2] in keys
    ]


@pytest.mark.parametrize(
    ("ends", "key", "reach"),
    [
        ((0.97, 1.04), "equivalent", 0.04),
        ((1.0, 1.9), "undecided", 0.9),
        ((1.0, np.inf), "undecided", None),
        ((1.2, 1.9), "different", 0.9),
    ],
)
def test_equivalence_in_findings_matches_the_contrast_table(study, ends, key, reach):
    ratio = Interval(value=1.0, low=ends[0], high=ends[1])
    row = {**ratio.columns("ratio"), "within": margin_of(ratio), "verdict": ratio.about_one(0.1)}
    pairs = numbers(
        with_contrasts(study, study.contrasts.assign(**row)), "equivalent", "undecided", "different"
    )
    assert len(pairs) > 3
    assert {each["key"] for each in pairs} == {key}
    for each in pairs:
        assert each["ratio"] == (1.0, *ends)
        assert each["share"] == (reach if reach is None else pytest.approx(reach, rel=0.05))


def by_one_method(study: Fragility, **changes: Any) -> Fragility:
    runs = study.runs[(study.runs["method"] == "recess model") & (study.runs["cylinder"] == "pier")]
    points = study.points[study.points["cylinder"] == "pier"]
    about = {**study.facts, "methods": {"recess model": METHODS["recess model"][1]}}
    about["cylinders"] = {"pier": {"semidiagonal": 6.0, "tan_alpha": 0.2}}
    return fragility_of(runs.assign(**changes), points, about)


@pytest.mark.slow
def test_too_few_motions_are_counted_without_a_curve(study):
    kept = [f"m{n}" for n in range(4)]
    few = fragility_of(
        *(table[table["motion"].isin(kept)] for table in (study.runs, study.points)),
        {**study.facts, "motions": 4},
    )
    page = page_of(few)
    words = page.markdown()
    assert [each["count"] for each in numbers(few, "few", "median", "bounded")] == [FEWEST]
    assert "Medians" not in words
    k = few.counts.query("cylinder == 'pier' and method == 'planar x' and limit == 'overturned'")["k"].sum()
    assert f"| pier | planar x | overturned | {k} of 24 |" in words.replace(
        "\u00a0", " "
    )  # each count in one line
    assert [picture.name for picture in page.pictures] == ["fragility-1", "fragility-2"]


@pytest.mark.parametrize("factor", [1.0, 30.0, 1.0 / 30.0])
def test_ratio_marks_lie_within_the_axis(study, factor):
    scaled = [name for name in study.contrasts if name.startswith("ratio") and name != "ratio_p"]
    far = study.contrasts.assign(**{name: study.contrasts[name] * factor for name in scaled})
    ratios = next(p for p in pictures(with_contrasts(study, far)) if p.name == "fragility-ratios")
    marks = 0
    for panel in ratios.panels:
        for layer in panel.layers:
            if getattr(layer, "style", None) is not None and layer.style.symbol:
                marks += 1
                assert ((layer.x > panel.x.low) & (layer.x < panel.x.high)).all()
                assert (layer.style.symbol == "diamond") == (factor == 1.0)
    assert marks > 3


def test_single_method_states_its_median_and_no_agreement(study):
    one = by_one_method(study)
    fit = study.fits.set_index(["cylinder", "method", "limit"]).loc["pier", "recess model", "overturned"]
    (median,) = numbers(one, "median", "equivalent", "different", "undecided")
    assert median["intensity"] == tuple(fit[["median", "median_low", "median_high"]])
    still = by_one_method(study, outcome="stands", peak_tilt=0.5)
    assert [each["key"] for each in numbers(still, "nothing_overturns", "median", "bounded")] == [
        "nothing_overturns"
    ]


@pytest.mark.slow
@pytest.mark.parametrize("cylinders", [("pier",), ("pier", "tower")])
def test_each_reason_for_no_curve_lists_its_limits_once(cylinders):
    study = made_up(cylinders)
    kinds = {0: "separated", 1: "not increasing", 2: "one motion", 3: "fitted"}
    fits = study.fits.assign(kind=[kinds[place % 4] for place in range(len(study.fits))])
    changed = dataclasses.replace(study, tables={**study.tables, "fits": fits})
    values: Any = fragility_values(changed)
    lines = {each["reason"].removeprefix("no_curve_"): each["names"] for each in numbers(changed, "no_curve")}
    assert {*lines} == {"separated", "not increasing", "one motion"}
    for kind, names in lines.items():
        for row in fits[fits["kind"] == kind].to_dict("records"):
            name = f"{row['method']} of {row['cylinder']}" if len(cylinders) > 1 else row["method"]
            if (kind, row["limit"]) != ("one motion", "overturned"):  # of which the median is bounded
                assert any(row["limit"] in part and name in part for part in names)
    # steps and their differences have unknown dispersion
    steps = {(row["cylinder"], row["method"]) for row in values["fallen"] if row["kind"] == "separated"}
    assert steps
    for row in values["fallen"]:
        assert np.isnan(row["dispersion"]) == (row["kind"] == "separated")
    for row in values["contrasts"]:
        bodies = cylinders if row["cylinder"] == "all" else (row["cylinder"],)
        of_step = {(body, row[name]) for body in bodies for name in ("method", "against")} & steps
        assert np.isnan(row["dispersion_difference"]) == bool(of_step)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("kind", "exceeded", "reason"),
    [
        ("one motion", 1, "one_motion_overturns"),
        ("one motion", 7, "bounded_one motion"),
        ("extrapolated", 2, "bounded_extrapolated"),
        ("always", 8, "bounded_always"),
    ],
)
def test_bounds_of_a_median_are_stated(kind: str, exceeded: int, reason: str) -> None:
    study = made_up(("pier",))
    fits = study.fits.copy()
    chosen = (fits["limit"] == "overturned") & (fits["method"] == "recess model")
    fits.loc[chosen, ["kind", "exceeded", "runs"]] = [kind, exceeded, 8]
    changed = dataclasses.replace(study, tables={**study.tables, "fits": fits})
    (bound,) = (each for each in numbers(changed, "bounded") if each["name"] == "recess model")
    assert bound["reason"] == reason
    assert lines_of("word." + reason)


@pytest.mark.parametrize("total", [None, 0.45])
def test_given_total_dispersion_is_stated(total):
    published = Fragility.load(Path(__file__).parents[2] / "reports" / "published" / "risk" / "p695")
    hazard = {**published.facts["hazard"], "total_dispersion": total}
    findings = dataclasses.replace(published, facts={**published.facts, "hazard": hazard}).findings()
    stated = [value for one in findings if one.key == "risk.dispersion" for _, value, _ in one.quantities()]
    assert stated == [total] * bool(total)
