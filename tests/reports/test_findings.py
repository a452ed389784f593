from __future__ import annotations

import dataclasses
import math
from types import SimpleNamespace

import pandas as pd
import pytest

from rockwobble import comparison, reduced
from rockwobble.compare.comparison import driver
from rockwobble.compare.runs.execution import Job
from rockwobble.models import (
    Case,
    Cylinder,
    Diagnostic,
    InitialState,
    Run,
    Trace,
    el_centro_1940,
)
from rockwobble.models.diagnostic import REASONS
from rockwobble.reports.figures.case_view import case_views, rows_of
from rockwobble.reports.pages import findings as budget_of_run
from rockwobble.reports.pages.comparison import main_rows
from rockwobble.reports.pages.diagnostics import code_counts, failure, remarks, sentence
from rockwobble.reports.pages.findings import (
    CAUSES,
    budget_sentences,
    cause,
    cause_of,
    counted_remarks,
    early_sentences,
    headline,
    notes,
)
from rockwobble.reports.pages.sentences import small

LENGTH = 50.0


def row(**values):
    """A row of a summary, under shaking: the reference uplifts at 1.7 s."""
    values = {
        "case": "El Centro",
        "run": "mujoco recess",
        "engine": "mujoco",
        "support": "recess",
        "reference": "recess model",
        "reference_engine": "reduced",
        "reference_support": "recess",
        "outcome": "stands",
        "reference_outcome": "stands",
        "peak_tilt": 0.25,
        "reference_peak_tilt": 0.25,
        "agreement_time": 20.0,
        "diverged": True,
        "agreed_passes": 7,
        "predicted_agreement_time": 18.0,
        "predicted_by": "pass",
        "contact_resolution": 2e-5,
        "closest_pass": 3e-3,
        "likely_mistake": (),
        "divergence": "",
        "whole_rms": math.nan,
    } | values
    return SimpleNamespace(
        **{
            "reference_uplift_time": 1.7,
            "tolerance": 0.01,
            "left_tolerance": values["diverged"],
            "within_tolerance_until": values["agreement_time"] + (1.7 if values["diverged"] else 0.0),
            "predicted_until": values["predicted_agreement_time"] + 1.7,
        }
        | values
    )


def case_view(*rows, **fields):
    case = SimpleNamespace(length=LENGTH, name="El Centro", cylinder=None)
    facts = {name: () for each in rows for name in (each.run, each.reference)}
    return SimpleNamespace(**{"case": case, "rows": table(*rows), "traces": {}, "facts": facts} | fields)


FLAT = {"run": "mujoco flat", "support": "flat"}
OWN = {"reference": "flat-ground model", "reference_support": "flat"}
RING = {"run": "mujoco ring", "support": "ring"}
HALF = {"reference": "mujoco ring, half the step", "reference_support": "ring"}
TOUCHED = {"touched": True}


@pytest.mark.parametrize(
    ("values", "options", "found"),
    [
        ({}, {}, "pass"),
        ({"predicted_agreement_time": 30.0}, {}, "near passes"),
        ({"predicted_agreement_time": 30.0, "closest_pass": math.nan}, {}, "method"),
        # agreed for a hundred times as long as predicted: that pass is not why
        ({"predicted_agreement_time": 0.2}, {}, "near passes"),
        (FLAT, {}, "support"),
        (FLAT, {"models_differ": False}, "pass"),
        (FLAT | OWN, {}, "pass"),
        (RING, {}, "walls"),
        (RING | OWN, TOUCHED, "walls"),
        (RING | OWN, {}, "pass"),
        # its own walls, at a finer step: no difference of support
        (RING | HALF, TOUCHED, "pass"),
    ],
)
def test_the_cause_of_a_divergence_follows_from_the_numbers(values, options, found):
    assert cause(row(**values), LENGTH, **options) == found
    assert found in CAUSES


# a release without rolling is planar, and the same by both models
@pytest.mark.parametrize(
    ("moved_by", "of_support"),
    [({"initial": InitialState(0.1), "duration": 20.0}, False), ({"motion": el_centro_1940()}, True)],
)
def test_the_support_divides_only_what_its_models_tell_apart(monkeypatch, moved_by, of_support):
    pier = Cylinder(semidiagonal=6.0, tan_alpha=0.2)

    def simulated(jobs: list[Job], **_: object) -> list[Trace]:  # by an engine that errs by 0.2 % in size
        found = []
        for job in jobs:
            off = dataclasses.replace(pier, semidiagonal=6.0 if job.run.is_model else 6.012)
            trace = reduced.simulate(dataclasses.replace(job.case, cylinder=off), support=job.run.support)
            given = {"case": job.case, "run": job.run, "contact_resolution": 2e-5, "time_step": 1e-4}
            found.append(trace if job.run.is_model else dataclasses.replace(trace, **given))
        return found

    monkeypatch.setattr(driver, "simulate_all", simulated)
    (view,) = case_views(comparison(Case(pier, **moved_by), runs=[Run("mujoco", "flat")]))
    against_recess, own = rows_of(view.rows)
    assert against_recess.diverged
    assert own.diverged
    assert cause_of(view, own) != "support"
    assert cause_of(view, against_recess) == ("support" if of_support else cause_of(view, own))


def test_an_external_trajectory_cannot_diverge_too_early():
    early = {"run": "table", "divergence": "earlier"}
    assert early_sentences(table(row(**early, support="external"))) == []
    assert len(early_sentences(table(row(**early)))) == 1


def test_a_motion_below_the_bound_agrees_within_a_tenth_of_its_peak():
    small = row(tolerance=2.3e-6, agreement_time=50.0, diverged=False, left_tolerance=True)
    small.within_tolerance_until = 9.0
    text = headline(table(small), LENGTH)
    assert "2\u00a0×\u00a010⁻⁶ alpha" in text
    assert "9.0 s" in text


def test_the_table_ends_an_agreement_where_the_headline_does():
    small = row(tolerance=2e-3, diverged=False, left_tolerance=True, predicted_until=8.0)
    small.within_tolerance_until = 9.0
    (line,) = main_rows(case_view(small))
    assert (line["agrees"], line["predicted"], line["cause"]) == ("9.00", 8.0, "unresolved pass")


def test_a_peak_after_the_end_of_its_curve_is_named():
    times = {"mujoco recess": 12.5, "recess model": 11.0}
    traces = {
        label: SimpleNamespace(peak_time=peak, time=[0.0, 12.0], uplift_time=1.7)
        for label, peak in times.items()
    }
    text = notes(case_view(row(), traces=traces))
    assert "The peak of mujoco recess comes after the end of the run" in text


def test_runs_with_one_diagnostic_are_named_together_and_what_failed_says_why():
    slipped = Diagnostic(code="slip", time=1.0)
    both = row(), row(run="b", predicted_agreement_time=30.0)
    facts = {"mujoco recess": (slipped,), "b": (slipped,), "recess model": ()}
    text = notes(case_view(*both, facts=facts))
    assert text.count(sentence(slipped)) == 1
    assert "mujoco recess and b: " in text
    gained = Diagnostic(code="energy_gain", time=2.0)
    facts = {"mujoco recess": (slipped, gained), "recess model": ()}
    text = notes(case_view(row(outcome="failed", peak_tilt=math.nan), facts=facts))
    assert sentence(gained) in text
    assert sentence(slipped) not in text


def table(*rows):
    return pd.DataFrame([vars(r) for r in rows])


def test_headline_is_of_each_run_and_the_model_of_its_support():
    first = row(agreement_time=20.0)
    second = row(run="pybullet recess", engine="pybullet", agreement_time=12.0)
    other = row(**FLAT, agreement_time=2.0)
    own = row(**FLAT, **OWN, diverged=False, agreement_time=50.0)
    assert headline(table(first, second, other, own), LENGTH) == (
        "Ideal recess: mujoco and pybullet within 1 % of alpha of the recess model until 13.7 s to 21.7 s. "
        "Flat ground: mujoco within 1 % of alpha of the flat-ground model to the end at 50.0 s."
    )
    assert headline(table(row(outcome="failed")), LENGTH) == "No run could be compared."
    ring = row(**RING), row(**RING, **HALF, diverged=False)
    assert "mujoco within 1 % of alpha of the recess model until 21.7 s" in headline(table(*ring), LENGTH)


@pytest.mark.parametrize(("code", "reason"), [(code, each) for code in REASONS for each in REASONS[code]])
def test_each_reason_has_words_and_others_are_refused(code, reason):
    words, others = (
        sentence(Diagnostic(code=code, time=2.0, size=2.0, bound=1.0, detail=each))
        for each in (reason, next(each for each in REASONS[code] if each != reason))
    )
    assert words
    assert words != others  # each is said in its own words
    with pytest.raises(ValueError, match=f"detail must be one of .*{reason}.*, got 'because'"):
        Diagnostic(code=code, detail="because")


def test_words_are_joined_counted_and_told_from_failures():
    slipped, gained = Diagnostic(code="slip", time=1.0), Diagnostic(code="energy_gain", time=2.0)
    assert remarks([slipped, slipped]) == "contact slipped from 1 s on; contact slipped from 1 s on"
    assert failure([slipped, gained]) == "the engine gained energy that nothing supplied at 2 s"
    assert code_counts([["slip", "slip"], ["slip", "lift_off"], ["energy_gain"], [""]]) == [
        "2 slipped",
        "1 left the ground",
    ]
    rows = table(row(diagnostics="slip, lift_off"), row(diagnostics="slip, lift_off", reference="other"))
    (text,) = counted_remarks(rows)
    assert "1 slipped, 1 left the ground" in text
    assert (
        counted_remarks(table(row(diagnostics=""), row(diagnostics="slip", run="b", outcome="failed"))) == []
    )


@pytest.mark.parametrize(
    ("value", "text"), [(0.0213, "0.02"), (0.001, "0.001"), (2.4e-5, "2 × 10⁻⁵"), (9.7e-11, "1 × 10⁻¹⁰")]
)
def test_small_numbers_can_be_read(value, text):
    assert small(value) == text


def budgets(*reasons: str) -> pd.DataFrame:
    """Return a summary whose differences are split where the reason is empty."""
    rows = [
        {"case": "one", "run": "a", "reference": "b", "reference_engine": "reduced", "limit_error": 1e-4}
        | {"whole_rms": 1e-3, "unexplained_share": math.nan if reason else 0.1, "not_split": reason}
        for reason in reasons
    ]
    return pd.DataFrame(rows)


def test_a_difference_that_is_not_split_is_neither_explained_nor_unexplained():
    text = " ".join(budget_sentences(budgets("order", "order")))
    assert "2 rows is not split" in text
    assert "explain all" not in text
    text = " ".join(budget_sentences(budgets("", "unresolved_pass")))
    assert "in 1 of the 1 rows" in text
    assert "1 row is not split" in text


@pytest.mark.parametrize("reason", ["unresolved_pass", "order", "error"])
def test_the_budget_of_a_run_advises_nothing_where_it_is_not_split(monkeypatch, reason):
    part = pd.Series([1e-3])
    found = SimpleNamespace(
        not_split=reason, rms=lambda _: float(part[0]), covered=1.6, steps=(2e-4, 1e-4), order=-1.4
    )
    comparison = SimpleNamespace(
        traces={("case", "model"): SimpleNamespace(run="reference")},
        summary=table(row(reference="model", diverged=False)),
        budgets={("case", "run", "model"): found},
    )
    monkeypatch.setattr(budget_of_run.rw, "comparison", lambda *_, **__: comparison)
    *parts, last = budget_of_run.budget_of_run(None, None, "reference")
    assert last.startswith("It is not split")
    assert not any(line.strip().startswith(("numerics", "unexplained")) for line in parts)
