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
from rockwobble.models.diagnostic import CODES, REASONS
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


WORDS = {
    "energy_gain": ("the engine gained energy that nothing supplied at 2 s", {}),
    "died": ("the run ended its process: status -11", {"time": math.nan, "detail": "status -11"}),
    "step_budget": ("the 500 steps allowed were used up at 2 s", {"size": 500.0}),
    "tolerance": ("no step met the tolerance of 1e-08 at 2 s", {"bound": 1e-8}),
    "slip": ("contact slipped from 2 s on", {}),
    "lift_off": ("the cylinder left the ground at 2 s", {}),
    "tension": ("contact is lost at 2 s: a joint holds the rim down", {}),
    "friction_needed": (
        "the rim would slip at 2 s, for 0.5 s in all: friction demand 0.4, friction coefficient 0.3",
        {"duration": 0.5, "size": 0.4, "bound": 0.3},
    ),
    "wall_contact": ("the cylinder touched a wall from 2 s on", {}),
    "energy": (
        "contact dissipated 2.2 % of the energy of the motion; above the reporting threshold from 2 s on",
        {"size": -0.022},
    ),
    "solver": ("the solver had not converged in 3 of 90 steps examined", {"size": 3, "bound": 90}),
    "early_uplift": ("the base opened at 2 s at 3 % less load than uplifts it", {"size": 0.03}),
    "unresolved_pass": ("1 pass is closer to upright than the 8.1e-06 rad", {"size": 1, "bound": 8.1e-6}),
    "settled": (
        "until 3 s the tilt is within 1.0e-05 alpha",
        {"duration": 3.0, "size": 1e-5, "bound": 1.0},
    ),
    "unsettled": (
        "the tilt has not converged by halving the step: a smaller step fails",
        {"detail": "fails"},
    ),
    "extrapolated": (
        "until 3 s the motion is the Richardson extrapolation of three time steps, of order 2; estimated "
        "error 1.0e-06 alpha",
        {"duration": 3.0, "size": 1e-6, "bound": 2.0},
    ),
    "not_extrapolated": (
        "no extrapolation from 2 s on, where it is the run at the finest time step: the runs diverge there",
        {"detail": "diverged"},
    ),
    "large_peak": (
        "its peak is 1.53e+03 g, more than 5 g, which few records have: it would be 1.6 g with its numbers "
        "in cm/s2",
        {"size": 1532.0, "bound": 5.0, "detail": "cm/s2"},
    ),
    "unlike_components": (
        "the peaks of its components differ by a factor of 981, y is the larger",
        {"size": 981.0, "detail": "y"},
    ),
    "one_column": ("the engine runs one of the 4 columns", {"size": 4.0}),
    "same_components": ("its components x and y are the same", {"detail": "x and y"}),
    "unlikely_length": (
        "a length of 9000 m is that of no structure (above 300 m): with the number in mm it would be 9 m",
        {"size": 9000.0, "bound": 300.0, "detail": "mm"},
    ),
    "unlikely_gravity": (
        "32.2 m/s2 is the gravity of no planet (above 25 m/s2): with the number in ft/s2 it would be 9.815",
        {"size": 32.2, "bound": 25.0, "detail": "ft/s2"},
    ),
    "offset": ("the mean of x is 67 % of its peak", {"size": 0.67, "detail": "x"}),
    "gravity_in_record": ("the mean of z is 1 g: gravity is in the record", {"size": 1.0, "detail": "z"}),
    "unlikely_step": ("its time step is 1 s, above 0.1 s", {"size": 1.0, "bound": 0.1}),
    "ends_in_strong_motion": ("it ends in strong motion, 40 % of its peak", {"size": 0.4}),
    "other_direction": ("by its file, the component given as x is y", {"detail": "x is y"}),
    "missed_pass": ("2 near passes fell between two samples, first at 2 s", {"size": 2}),
    "note": ("positions are in mm", {"detail": "positions are in mm"}),
}


def test_a_friction_that_would_have_to_be_infinite_does_not_exist():
    text = sentence(Diagnostic(code="friction_needed", time=2.0, duration=0.5, size=math.inf, bound=1.0))
    assert text == "the rim would slip at 2 s, for 0.5 s in all: no friction suffices"


@pytest.mark.parametrize("code", CODES)
def test_each_code_has_words_with_its_numbers(code):
    words, values = WORDS.get(code, ("", {}))
    text = sentence(Diagnostic(**{"code": code, "time": 2.0} | values))
    assert text.startswith(words)
    assert text
    assert "nan" not in text


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
