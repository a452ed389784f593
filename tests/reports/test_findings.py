from __future__ import annotations

import dataclasses
import math
from types import SimpleNamespace

import pandas as pd
import pytest

from rockwobble import reduced
from rockwobble.compare import compare
from rockwobble.compare.comparison import driver
from rockwobble.compare.runs.execution import Job
from rockwobble.models import (
    Case,
    Cylinder,
    Diagnostic,
    GroundMotion,
    InitialState,
    Run,
    Trace,
    el_centro_1940,
)
from rockwobble.models.diagnostic import CODES, REASONS
from rockwobble.reports.figures.comparison.view import case_views
from rockwobble.reports.pages.comparison.external import within
from rockwobble.reports.pages.comparison.findings import (
    Finding,
    counted_remarks,
    divergence_sentences,
    finding,
    finding_sentences,
    findings,
    headline,
    reason,
)
from rockwobble.reports.pages.words.diagnostics import counted, failure, remarks, sentence
from rockwobble.reports.pages.words.sentences import small

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


def said(touched=False, failed="", uplifted=True, end=math.nan, **values):
    given = row(**values)
    return finding(
        Finding(
            row=given,
            failed=failed,
            uplifted=uplifted,
            reference_uplifted=uplifted,
            reason=reason(given, LENGTH, touched=touched),
            bound=within(given),
            passes=7,
            end=end,
        )
    )


FLAT = {"run": "mujoco flat", "support": "flat"}
OWN = {"reference": "flat-ground model", "reference_support": "flat"}
RING = {"run": "mujoco ring", "support": "ring"}
HALF = {"reference": "mujoco ring, half the step", "reference_support": "ring"}


def test_agreement_to_the_end():
    text = said(diverged=False, agreement_time=50.0)
    assert text.startswith(
        "mujoco recess stays within 1 % of alpha of the recess model for the whole run (50.0 s"
    )
    assert "diverge" not in text


@pytest.mark.parametrize(
    ("values", "words"),
    [
        ({}, "at 19.7 s a pass comes closer to upright than the contact resolves (2\u00a0×\u00a010⁻⁵ rad)"),
        ({"predicted_agreement_time": 30.0}, "the closest of which comes within 0.003 alpha of upright"),
        (
            {"predicted_agreement_time": 30.0, "closest_pass": math.nan},
            "an error of the method and not of chance",
        ),
        (FLAT, "on flat ground the cylinder may roll out"),
        (FLAT | OWN, "a pass comes closer to upright"),
        (RING, "only where it has rolled out as far as their clearance"),
        (RING | OWN | {"touched": True}, "each touch takes energy"),
        (RING | OWN, "a pass comes closer to upright"),
        # its own walls, at a finer step: no difference of support
        (RING | HALF | {"touched": True}, "a pass comes closer to upright"),
    ],
)
def test_a_divergence_and_its_reason_follow_from_the_numbers(values, words):
    text = said(**values)
    assert "until 21.7 s of the run (7 passes by upright), then they diverge" in text
    assert words in text


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
            off = dataclasses.replace(pier, semidiagonal=6.0 if job.run.engine is None else 6.012)
            trace = reduced.simulate(dataclasses.replace(job.case, cylinder=off), support=job.run.support)
            given = {"case": job.case, "run": job.run, "contact_resolution": 2e-5, "time_step": 1e-4}
            found.append(trace if job.run.engine is None else dataclasses.replace(trace, **given))
        return found

    monkeypatch.setattr(driver, "simulate_all", simulated)
    (view,) = case_views(compare(Case(pier, **moved_by), runs=[Run("mujoco", "flat")]))
    against_recess, own = findings(view)
    assert against_recess.row.diverged
    assert own.row.diverged
    assert own.reason != "support"
    assert against_recess.reason == ("support" if of_support else own.reason)


def test_of_two_reduced_models_nothing_is_said_about_contact():
    models = {"run": "planar model", "engine": "reduced", "contact_resolution": math.nan, "predicted_by": ""}
    text = said(**models)
    assert text.startswith("planar model stays within 1 % of alpha of the recess model")
    assert "the closest pass until then comes within 0.003 alpha of upright; near passes" in text
    assert "resolve" not in text


def test_an_external_trajectory_cannot_diverge_too_early():
    early = {"run": "table", "divergence": "earlier"}
    assert divergence_sentences(table(row(**early, support="external"))) == []
    assert "a finding" in divergence_sentences(table(row(**early)))[0]


def test_peaks_are_told_apart_only_where_they_differ():
    assert "Peak tilt is the same to 0.4 %" in said(peak_tilt=0.251)
    assert "Peak tilt is 0.3 alpha against 0.25 alpha." in said(peak_tilt=0.3)


def test_a_peak_that_is_the_release_tells_nothing(no_engines):
    def words(tilt: float, motion: GroundMotion | None) -> str:
        no_engines()
        pier = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
        case = Case(pier, motion, initial=InitialState(tilt * pier.alpha), duration=15.0)
        (view,) = case_views(compare(case, runs=[Run("mujoco", "recess")]))
        return " ".join(finding_sentences(view))

    assert "eak tilt" not in words(0.5, None)
    assert "Peak tilt is" in words(0.02, el_centro_1940())  # which the shaking raises


def test_a_motion_below_the_bound_agrees_within_a_tenth_of_its_peak():
    small = row(
        tolerance=2.3e-6, agreement_time=50.0, diverged=False, left_tolerance=True, within_tolerance_until=9.0
    )
    text = said(**vars(small))
    assert (
        "within a tenth of the peak (2\u00a0×\u00a010⁻⁶ alpha) of the recess model until 9.0 s of the run"
        in text
    )
    assert "a tenth of the peak (2\u00a0×\u00a010⁻⁶ alpha) until 9.0 s" in headline(table(small), LENGTH)


def test_outcomes_that_are_no_traces():
    fell = said(outcome="overturned", end=9.0)
    assert fell.endswith("Only mujoco recess overturns; compared up to 9 s.")
    assert said(outcome="overturned", reference_outcome="overturned").endswith("Both overturn.")
    assert said(failed="mujoco recess failed: why", outcome="failed", peak_tilt=math.nan) == (
        "mujoco recess against the recess model: mujoco recess failed: why."
    )
    assert said(uplifted=False, peak_tilt=0.0) == (
        "mujoco recess and the recess model both stay at rest: this excitation does not uplift the cylinder."
    )


def table(*rows):
    return pd.DataFrame([vars(r) for r in rows])


def test_headline_speaks_of_each_run_against_the_model_of_its_support():
    first = row(agreement_time=20.0)
    second = row(run="pybullet recess", engine="pybullet", agreement_time=12.0)
    other = row(**FLAT, agreement_time=2.0)
    own = row(**FLAT, **OWN, diverged=False, agreement_time=50.0)
    assert headline(table(first, second, other, own), LENGTH) == (
        "In an ideal recess, mujoco and pybullet follow the recess model within 1 % of alpha "
        "until 13.7 s to 21.7 s of the run. "
        "On flat ground, mujoco follows the flat-ground model within 1 % of alpha "
        "for the whole run (50.0 s). "
        "Once traces have diverged, compare distributions."
    )
    assert headline(table(row(diverged=False)), LENGTH).endswith(
        "within 1 % of alpha for the whole run (50.0 s)."
    )
    assert headline(table(row(outcome="failed")), LENGTH) == "No run could be compared."
    ring = row(**RING), row(**RING, **HALF, diverged=False)
    assert "In a ring of walls, mujoco follows the recess model" in headline(table(*ring), LENGTH)


WORDS = {
    "energy_gain": ("the engine gained energy that nothing supplied at 2 s", {}),
    "died": ("the run ended its process: status -11", {"time": math.nan, "detail": "status -11"}),
    "step_budget": ("the 500 steps allowed were used up at 2 s", {"size": 500.0}),
    "tolerance": ("no step met the tolerance of 1e-08 at 2 s", {"bound": 1e-8}),
    "slip": ("contact slipped from 2 s on", {}),
    "lift_off": ("the cylinder left the ground at 2 s", {}),
    "tension": ("contact is lost at 2 s: a joint holds the rim down", {}),
    "friction_needed": (
        "the rim would slip at 2 s, for 0.5 s in all: it needs a friction of 0.4, where there is 0.3",
        {"duration": 0.5, "size": 0.4, "bound": 0.3},
    ),
    "wall_contact": ("the cylinder touched a wall from 2 s on", {}),
    "energy": ("contact took 2.2e-02 of the energy of the motion, which shows from 2 s on", {"size": -0.022}),
    "solver": ("the solver had not converged in 3 of the 90 steps looked at", {"size": 3, "bound": 90}),
    "unresolved_pass": ("1 pass is closer to upright than the 8.1e-06 rad", {"size": 1, "bound": 8.1e-6}),
    "settled": (
        "the tilt is, until 3 s, within 1.0e-05 alpha",
        {"duration": 3.0, "size": 1e-5, "bound": 1.0},
    ),
    "unsettled": ("the tilt has not settled by halving the step: a smaller step fails", {"detail": "fails"}),
    "extrapolated": (
        "the motion is, until 3 s, what runs at three time steps tend to, with order 2: within 1.0e-06 alpha",
        {"duration": 3.0, "size": 1e-6, "bound": 2.0},
    ),
    "not_extrapolated": (
        "it is not extrapolated from 2 s on, but the run at the finest time step: the runs diverge there",
        {"detail": "diverged"},
    ),
    "large_peak": (
        "its peak is 1.53e+03 g, more than any record has (5 g): it would be 1.6 g with its numbers in cm/s2",
        {"size": 1532.0, "bound": 5.0, "detail": "cm/s2"},
    ),
    "unlike_components": (
        "the peaks of its components differ by a factor of 981, y is the larger",
        {"size": 981.0, "detail": "y"},
    ),
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
    assert sentence(Diagnostic(code=code, time=2.0, detail=reason)).split(": ")[1] not in ("", reason)
    with pytest.raises(ValueError, match=f"detail must be one of .*{reason}.*, got 'because'"):
        Diagnostic(code=code, detail="because")


def test_words_are_joined_counted_and_told_from_failures():
    slipped, gained = Diagnostic(code="slip", time=1.0), Diagnostic(code="energy_gain", time=2.0)
    assert remarks([slipped, slipped]) == "contact slipped from 1 s on; contact slipped from 1 s on"
    assert failure([slipped, gained]) == "the engine gained energy that nothing supplied at 2 s"
    assert counted([["slip", "slip"], ["slip", "lift_off"], ["energy_gain"], [""]]) == [
        "2 slipped",
        "1 left the ground",
    ]
    rows = table(row(diagnostics="slip, lift_off"), row(diagnostics="slip, lift_off", reference="other"))
    assert counted_remarks(rows) == [
        "By their own account, of the runs 1 slipped, 1 left the ground; see the column diagnostics of "
        "summary.csv."
    ]
    assert (
        counted_remarks(table(row(diagnostics=""), row(diagnostics="slip", run="b", outcome="failed"))) == []
    )


@pytest.mark.parametrize(
    ("value", "text"), [(0.0213, "0.02"), (0.001, "0.001"), (2.4e-5, "2 × 10⁻⁵"), (9.7e-11, "1 × 10⁻¹⁰")]
)
def test_small_numbers_can_be_read(value, text):
    assert small(value) == text
