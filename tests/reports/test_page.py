"""Page of a comparison: complete, small and reproducible; its statements on runs and trajectories."""

from __future__ import annotations

import math
import re
from types import SimpleNamespace
from typing import Any

import pandas as pd
import pytest
from showing import is_golden

import rockwobble as rw
from rockwobble.compare import SUMMARY_COLUMNS
from rockwobble.compare.comparison.findings import parts_finding
from rockwobble.compare.external.mistakes import WORDS, Mistake
from rockwobble.compare.external.verdict import NO_VERDICT
from rockwobble.models import Case, Cylinder, Diagnostic, InitialState, Run
from rockwobble.models.diagnostic import REASONS
from rockwobble.reports.pages import page_of
from rockwobble.reports.pages.comparison import counted_diagnostics, external_rows, run_diagnostics
from rockwobble.reports.pages.diagnostics import failure, remarks, sentence

PAGE_LIMIT, PICTURE_LIMIT = 2_000_000, 300_000  # [bytes]
PIER = Cylinder(semidiagonal=6.0, tan_alpha=0.2)


@pytest.mark.slow
def test_page_is_selfcontained_small_and_reproducible(comparison):
    made = comparison.made_by("rockwobble compare")
    files = page_of(made).files()
    assert set(files) == {"report.html", "report.md", "figure.svg"}
    page, picture = files["report.html"].decode(), files["figure.svg"]
    assert page == page_of(made).html()
    assert len(files["report.html"]) < PAGE_LIMIT
    assert picture.startswith(b"<?xml")
    assert len(picture) < PICTURE_LIMIT
    assert not re.search(r'<(img|iframe|object|script[^>]* src=|link[^>]* href="(?!data:,"))', page)
    assert set(re.findall(r'<div class="chart" id="([^"]*)"', page)) == {
        *(f"figure-{panel}" for panel in range(4)),  # two supports, two references
        *(f"orbits-0-{run}" for run in range(4)),
        *(f"contact-0-{panel}" for panel in range(3)),  # azimuth, drift by support
        "turns-0-0",
        *(f"residuals-0-{panel}" for panel in range(2)),
        "excitation-0-0",
    }
    text = re.sub(r"<(script|style).*?</\1>|<[^>]*>", " ", page, flags=re.DOTALL)
    shown = [name.replace("_", " ") for name in SUMMARY_COLUMNS if name not in ("case", "run", "reference")]
    assert [name for name in shown if name not in text] == []
    assert "nan" not in re.findall(r"\w+", text)


def test_release_page_matches_golden_file(no_engines):
    no_engines()
    cube = Cylinder(semidiagonal=6.0, tan_alpha=1.0)
    case = Case(cube, initial=InitialState(0.5 * cube.alpha, rolling_rate=0.5), duration=8.0, name="release")
    is_golden(rw.comparison(case, runs=[Run("mujoco", "recess"), Run("mujoco", "flat")]))


def test_still_ground_has_no_excitation_and_markup_in_a_name_stays_text(no_engines):
    no_engines()
    release = InitialState(tilt=0.5 * PIER.alpha, rolling_rate=0.5)
    case = Case(PIER, initial=release, duration=2.0, name="<b>name</b> & co")
    page = page_of(rw.comparison(case, runs=[Run("mujoco", "recess")]).made_by()).html()
    parts = ("excitation-0", "<b>name</b>", "&lt;b&gt;name&lt;/b&gt; &amp; co")
    assert [part in page for part in parts] == [False, False, True]


@pytest.mark.slow
def test_runs_at_rest_and_failed_runs_can_be_drawn(no_engines):
    case, runs = Case(PIER, duration=1.0, name="still"), [Run("mujoco", "recess")]
    gained = (Diagnostic(code="energy_gain", time=0.5),)
    failed = {"outcome": "failed", "facts": gained, "peak_tilt": math.nan}
    for fields, said in (({}, "stay at rest"), (failed, sentence(gained[0]))):
        no_engines(**fields)
        files = page_of(rw.comparison(case, runs=runs).made_by()).files()
        assert said in files["report.html"].decode()
        assert files["figure.svg"]


@pytest.mark.parametrize(("code", "reason"), [(code, each) for code in REASONS for each in REASONS[code]])
def test_each_diagnostic_detail_has_words_and_unknown_ones_are_refused(code, reason):
    words, others = (
        sentence(Diagnostic(code=code, time=2.0, size=2.0, bound=1.0, detail=each))
        for each in (reason, next(each for each in REASONS[code] if each != reason))
    )
    assert words
    assert words != others  # distinct words
    with pytest.raises(ValueError, match=f"detail must be one of .*{reason}.*, got 'because'"):
        Diagnostic(code=code, detail="because")


def test_shared_diagnostics_are_merged_and_failures_listed_separately():
    slipped, gained = Diagnostic(code="slip", time=1.0), Diagnostic(code="energy_gain", time=2.0)
    assert remarks([slipped, slipped]) == f"{sentence(slipped)}; {sentence(slipped)}"
    assert failure([slipped, gained]) == sentence(gained)
    view: Any = SimpleNamespace(
        rows=pd.DataFrame({"run": ["a", "a", "b", "c"]}), facts={"a": [slipped], "b": [slipped], "c": []}
    )
    assert run_diagnostics(view) == [f"a and b: {sentence(slipped)}."]


def test_diagnostic_counts_exclude_failed_runs():
    ends = {"outcome": ["stands", "stands", "failed"], "reference_outcome": "stands"}
    codes = ["slip, lift_off", "slip, lift_off", "slip"]
    rows = pd.DataFrame({"case": "El Centro", "run": ["a", "a", "b"], "diagnostics": codes, **ends})
    (text,) = counted_diagnostics(rows)
    assert re.findall(r"\d \w+", text) == ["1 slipped", "1 left"]
    assert counted_diagnostics(rows.assign(outcome="failed")) == []


@pytest.mark.parametrize("reason", ["", "order"])
def test_unsplit_error_budget_states_no_numerical_part(reason):
    budget: Any = SimpleNamespace(not_split=reason, rms=lambda _: 1e-3, covered=1.6, steps=(2e-4, 1e-4))
    stated = dict(parts_finding(budget, "recess model").values)
    assert ("difference_numerics" in stated) == (not reason)
    assert (stated["difference_whole"], stated["names"]) == (1e-3, ("0.0002", "0.0001"))
    assert parts_finding(None, "flat-ground model").key == "comparison.no_parts"


@pytest.mark.parametrize("code", WORDS)
def test_each_diagnostic_code_is_worded_with_its_value(code: str) -> None:
    values = {"length_unit": (1e-2, 1e3)}.get(code, (0.905, 1.005))
    low, high = (Mistake(code=code, concerns="axes", value=value).words for value in values)
    assert "{" not in low + high
    has_value = "{" in "".join(WORDS[code]).replace("{its}", "")
    assert (low != high) == (has_value or not isinstance(WORDS[code], str))


def table(**values: Any) -> pd.DataFrame:
    common = {"run": "table", "support": "external", "uplift_time_difference": 0.004}
    return pd.DataFrame([common | {"uplift_direction_difference": -0.5} | NO_VERDICT | values])


def test_the_table_has_the_numbers_and_codes_of_each_external_trajectory() -> None:
    numbers = {"azimuth_rms": 10.0, "azimuth_differs_from": 2.8, "path_rms": 0.001, "path_differs_from": 5.96}
    likely = {"likely_mistake": ("turned_back",), "likely_mistake_in": ("axes",)}
    likely |= {"likely_mistake_value": (math.nan,)}
    wrong = table(differs_in=("azimuth", "path"), **numbers, **likely, uplift_time_uncertainty=0.012)
    engine = table(support="recess", run="mujoco recess")
    (line,) = external_rows(pd.concat([engine, wrong]))
    shown = numbers | {"run": "table", "uplift": 0.004, "differs_in": "azimuth; path", "direction": None}
    # direction unknown
    shown |= {"likely_mistake": "axes: turned_back", "direction_uncertainty": None}
    assert {name: line[name] for name in shown} == shown
    (other,) = external_rows(table(uplift_direction_uncertainty=4.0))
    assert (other["direction"], other["direction_uncertainty"]) == (math.degrees(-0.5), 180.0)
    assert external_rows(engine) == []
