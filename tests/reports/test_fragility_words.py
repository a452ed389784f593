"""Sentences of the page of a fragility: they say what its tables hold, and nothing of what there is not."""

from __future__ import annotations

import dataclasses
import re
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
from fragility_example import METHODS, made_up

from rockwobble.compare.metrics.statistics import Interval
from rockwobble.reports.figures.fragility import pictures
from rockwobble.reports.pages import page_of
from rockwobble.reports.pages.fragility import fragility_values
from rockwobble.reports.pages.risk import risk_values
from rockwobble.studies import Fragility
from rockwobble.studies.fragility.study import fragility_of, main_contrasts
from rockwobble.studies.fragility.tables import margin_of

pytestmark = pytest.mark.checkout


@pytest.fixture(scope="module")
def found() -> Fragility:
    return made_up()


def with_contrasts(found: Fragility, table: pd.DataFrame) -> Fragility:
    return dataclasses.replace(found, tables={**found.tables, "contrasts": table})


@pytest.mark.slow
def test_the_words_are_those_of_the_tables(found):
    words = " ".join(page_of(found).markdown().split())
    row = next(r for r in main_contrasts(found)["planar"] if r["cylinder"] == "all")
    ends = f"{row['ratio']:.2f} ({row['ratio_low']:.2f} to {row['ratio_high']:.2f})"
    assert f"planar x against recess model: {ends}, not equivalent." in words
    assert "mujoco recess against recess model: 1.00 (1.00 to 1.00), equivalent within 0 %." in words
    assert "15 motions: made up, each at 6 levels" in words
    # all uplift at the lowest level
    assert "| pier | recess model | < 1.5 |" in words


@pytest.mark.parametrize(
    ("ends", "words"),
    [
        ((0.97, 1.04), "equivalent within 4 %"),
        ((1.0, 1.9), "inconclusive: interval wider than ±10 % (up to 90 %)"),
        ((1.0, np.inf), "inconclusive: interval wider than ±10 % (unbounded)"),
        ((1.2, 1.9), "not equivalent"),
    ],
)
def test_a_sentence_calls_equivalent_what_its_table_does(found, ends, words):
    ratio = Interval(value=1.0, low=ends[0], high=ends[1])
    row = {**ratio.columns("ratio"), "within": margin_of(ratio), "verdict": ratio.about_one(0.1)}
    table = found.contrasts.assign(**row)
    page = page_of(with_contrasts(found, table)).markdown()
    said = re.findall(r"^- (.+) against (.+): \d\.\d\d \(.*?\), (.*)\.$", page, re.M)
    assert len(said) > 3
    assert {verdict for *_, verdict in said} == {words}


def by_one_method(found: Fragility, **changes: Any) -> str:
    runs = found.runs[(found.runs["method"] == "recess model") & (found.runs["cylinder"] == "pier")]
    points = found.points[found.points["cylinder"] == "pier"]
    about = {**found.facts, "methods": {"recess model": METHODS["recess model"][1]}}
    about["cylinders"] = {"pier": {"semidiagonal": 6.0, "tan_alpha": 0.2}}
    one = fragility_of(runs.assign(**changes), points, about)
    return " ".join(page_of(one).markdown().split())


@pytest.mark.slow
def test_what_is_too_few_for_a_curve_is_counted(found):
    kept = [f"m{n}" for n in range(4)]
    few = fragility_of(
        *(table[table["motion"].isin(kept)] for table in (found.runs, found.points)),
        {**found.facts, "motions": 4},
    )
    page = page_of(few)
    words = page.markdown()
    assert "**Too few for a curve" in words
    assert "Medians" not in words
    k = few.counts.query("cylinder == 'pier' and method == 'planar x' and limit == 'overturned'")["k"].sum()
    assert f"| pier | planar x | overturned | {k} of 24 |" in words.replace(
        "\u00a0", " "
    )  # each count in one line
    assert [picture.name for picture in page.pictures] == ["fragility-1", "fragility-2"]


@pytest.mark.parametrize("factor", [1.0, 30.0, 1.0 / 30.0])
def test_every_mark_of_a_ratio_lies_within_its_axis(found, factor):
    scaled = [name for name in found.contrasts if name.startswith("ratio") and name != "ratio_p"]
    far = found.contrasts.assign(**{name: found.contrasts[name] * factor for name in scaled})
    ratios = next(p for p in pictures(with_contrasts(found, far)) if p.name == "fragility-ratios")
    marks = 0
    for panel in ratios.panels:
        for layer in panel.layers:
            if getattr(layer, "style", None) is not None and layer.style.symbol:
                marks += 1
                assert ((layer.x > panel.x.low) & (layer.x < panel.x.high)).all()
                assert (layer.style.symbol == "diamond") == (factor == 1.0)
    assert marks > 3


def test_one_method_is_not_asked_whether_it_agrees(found):
    words = by_one_method(found)
    fit = found.fits.set_index(["cylinder", "method", "limit"]).loc["pier", "recess model", "overturned"]
    ends = f"{fit['median']:.3g} ({fit['median_low']:.3g} to {fit['median_high']:.3g})"
    assert f"**Median overturning intensity [-] (95 % interval): {ends} by recess model.**" in words
    for nothing in ("Ratios of the median", "equivalent"):
        assert nothing not in words


def test_without_overturning_no_curve_is_spoken_of(found):
    words = by_one_method(found, outcome="stands", peak_tilt=0.5)
    assert "**Nothing overturns at these intensities.**" in words


@pytest.mark.slow
@pytest.mark.parametrize("cylinders", [("pier",), ("pier", "tower")])
def test_each_reason_for_no_curve_is_one_line_with_all_limits_of_it(cylinders):
    found = made_up(cylinders)
    kinds = {0: "separated", 1: "not increasing", 2: "one motion", 3: "fitted"}
    fits = found.fits.assign(kind=[kinds[place % 4] for place in range(len(found.fits))])
    values: Any = fragility_values(dataclasses.replace(found, tables={**found.tables, "fits": fits}))
    lines = [line for line in values["remarks"] if line.startswith("No curve")]
    assert len(lines) == 3
    for kind, words in (
        ("separated", "(separated)"),
        ("not increasing", "not increase"),
        ("one motion", "of one motion"),
    ):
        (line,) = [each for each in lines if words in each.split(":")[0]]
        for row in fits[fits["kind"] == kind].to_dict("records"):
            name = f"{row['method']} of {row['cylinder']}" if len(cylinders) > 1 else row["method"]
            if (kind, row["limit"]) != (
                "one motion",
                "overturned",
            ):  # whose median is a bound above the tables
                assert any(
                    row["limit"] in part and name in part for part in line.split(": ", 1)[1].split(";")
                )
    # a step has no dispersion that is known, nor has a difference from it
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
    ("kind", "exceeded", "why"),
    [
        ("one motion", 1, "all overturning runs are of one motion"),
        ("one motion", 7, "all runs that stand are of one motion"),
        ("extrapolated", 2, "outside the intensities that were run"),
        ("always", 8, "everything overturns"),
    ],
)
def test_what_bounds_a_median_is_said(kind: str, exceeded: int, why: str) -> None:
    found = made_up(("pier",))
    fits = found.fits.copy()
    chosen = (fits["limit"] == "overturned") & (fits["method"] == "recess model")
    fits.loc[chosen, ["kind", "exceeded", "runs"]] = [kind, exceeded, 8]
    values: Any = fragility_values(dataclasses.replace(found, tables={**found.tables, "fits": fits}))
    (line,) = [each for each in values["undetermined"] if "recess model" in each]
    assert line.endswith(f", {why}.")


@pytest.mark.parametrize(
    ("total", "words"), [(None, ""), (0.45, ". The total dispersion of the lognormal curves is 0.45")]
)
def test_a_dispersion_that_was_given_for_the_curves_is_stated(total, words):
    published = Fragility.load(Path(__file__).parents[2] / "reports" / "published" / "risk" / "p695")
    hazard = {**published.facts["hazard"], "total_dispersion": total}
    values: Any = risk_values(dataclasses.replace(published, facts={**published.facts, "hazard": hazard}))
    assert values["dispersion"] == words
