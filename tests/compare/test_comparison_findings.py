"""Findings of a comparison, by key and number: agreement, causes, mistakes of external files, budgets."""

from __future__ import annotations

import dataclasses
import math
from types import SimpleNamespace
from typing import Any

import pandas as pd
import pytest

import rockwobble as rw
from rockwobble import reduced
from rockwobble.compare.comparison import driver
from rockwobble.compare.comparison.findings import (
    agreements,
    budget_findings,
    case_findings,
    cause,
    explains_divergence,
)
from rockwobble.compare.external.verdict import NO_VERDICT
from rockwobble.compare.runs.execution import Job
from rockwobble.models import Case, Cylinder, InitialState, Run, Trace, el_centro_1940

LENGTH = 50.0
MODEL = {"reference": "recess model", "reference_engine": "reduced", "reference_support": "recess"}
FLAT = {"run": "mujoco flat", "support": "flat"}
OWN = {"reference": "flat-ground model", "reference_support": "flat"}
RING = {"run": "mujoco ring", "support": "ring"}
HALF = {"reference": "mujoco ring, half the step", "reference_support": "ring"}
TABLE = {"run": "table", "engine": "table", "support": "external", "tilt_bound": 0.01}
TURNED = {
    "differs_in": ("azimuth", "path"),
    "likely_mistake": ("turned_back",),
    "likely_mistake_in": ("axes",),
    "likely_mistake_value": (math.nan,),
    "agreement_without_mistake": 8.0,
}
SLOWER = TURNED | {
    "differs_in": ("tilt",),
    "likely_mistake": ("time_scale",),
    "likely_mistake_in": ("time",),
    "likely_mistake_value": (1.005,),
}


def row(agreement: float = 20.0, predicted: float = 18.0, **values: Any) -> Any:
    """Row of a summary, under shaking: the reference uplifts at 1.7 s."""
    common = {"case": "El Centro", "run": "mujoco recess", "engine": "mujoco", "support": "recess"}
    ended = {"outcome": "stands", "reference_outcome": "stands", "left_tolerance": True, "divergence": ""}
    pass_ = {"predicted_by": "pass", "closest_pass": 3e-3, "tolerance": 0.01}
    times = {
        "reference_uplift_time": 1.7,
        "within_tolerance_until": agreement + 1.7,
        "predicted_until": predicted + 1.7,
    }
    common |= {"mode": "rocks", "reference_mode": "rocks"}
    return SimpleNamespace(**common | MODEL | ended | pass_ | times | NO_VERDICT | values)


def table(*rows: Any) -> pd.DataFrame:
    return pd.DataFrame([vars(each) for each in rows])


def value(finding: Any, name: str) -> Any:
    return {name: value for name, value, _ in finding.quantities()}[name]


def found(*rows: Any, **traces: Any) -> dict[str, Any]:
    """Findings on a case by key."""
    causes = [cause(each, LENGTH) if each.left_tolerance else "" for each in rows]
    case = Case(Cylinder(semidiagonal=6.0, tan_alpha=0.2), el_centro_1940(), duration=LENGTH)
    findings = case_findings(case, table(*rows), traces, causes, pd.DataFrame())
    return {each.key.partition(".")[2]: each for each in findings}


@pytest.mark.parametrize(
    ("values", "options", "name"),
    [
        ({}, {}, "pass"),
        ({"predicted": 30.0}, {}, "near_passes"),
        ({"predicted": 30.0, "closest_pass": math.nan}, {}, "method"),
        # agreed for a hundred times as long as predicted: that pass is not the cause
        ({"predicted": 0.2}, {}, "near_passes"),
        ({"outcome": "failed"}, {}, "failed"),
        (FLAT, {}, "support"),
        (FLAT, {"models_differ": False}, "pass"),
        (FLAT | OWN, {}, "pass"),
        (RING, {}, "walls"),
        (RING | OWN, {"touched": True}, "walls"),
        (RING | OWN, {}, "pass"),
        # its own walls, at a finer step: no difference of support
        (RING | HALF, {"touched": True}, "pass"),
        ({"mode": "rocks and slides"}, {}, "slides"),
        ({"mode": "rocks and slides", "reference_mode": "rocks and slides"}, {}, "pass"),
        (RING | {"mode": "rocks and slides"}, {}, "walls"),
        # only a mistake that changes tilts makes them diverge
        (TABLE | SLOWER, {}, "mistake"),
        (TABLE | TURNED, {}, "near_passes"),
    ],
)
def test_the_cause_of_a_divergence_follows_from_the_numbers(values, options, name):
    assert cause(row(**values), LENGTH, **options) == name


# a release without rolling is planar, and the same by both models
@pytest.mark.parametrize(
    ("moved_by", "of_support"),
    [({"initial": InitialState(0.1), "duration": 20.0}, False), ({"motion": el_centro_1940()}, True)],
)
def test_the_support_is_a_cause_only_where_its_models_differ(monkeypatch, moved_by, of_support):
    pier = Cylinder(semidiagonal=6.0, tan_alpha=0.2)

    def simulated(jobs: list[Job], **_: object) -> list[Trace]:  # an engine with an error of 0.2 % in size
        traces = []
        for job in jobs:
            off = dataclasses.replace(pier, semidiagonal=6.0 if job.run.is_model else 6.012)
            trace = reduced.simulate(dataclasses.replace(job.case, cylinder=off), support=job.run.support)
            given = {"case": job.case, "run": job.run, "contact_resolution": 2e-5, "time_step": 1e-4}
            traces.append(trace if job.run.is_model else dataclasses.replace(trace, **given))
        return traces

    monkeypatch.setattr(driver, "simulate_all", simulated)
    comparison = rw.comparison(Case(pier, **moved_by), runs=[Run("mujoco", "flat")])
    (causes,) = comparison.causes.values()
    assert all(comparison.summary["diverged"])
    assert causes[1] != "support"
    assert (causes[0] == "support") == of_support
    keys = [each.key for each in comparison.findings()]
    assert keys[0].startswith("mode.")
    assert keys[1] == "comparison.agree"
    assert f"comparison.{causes[0]}" in keys


def test_agreement_is_between_runs_of_a_support_and_their_model():
    pybullet = row(run="pybullet recess", engine="pybullet", agreement=12.0)
    flat = row(**FLAT | OWN, left_tolerance=False, within_tolerance_until=LENGTH)
    recess, whole = agreements(table(row(), pybullet, row(**FLAT, agreement=2.0), flat), LENGTH)
    assert recess.key == "comparison.agree"
    assert value(recess, "names") == ("mujoco", "pybullet")
    assert [value(recess, each) for each in ("until", "until_last")] == [13.7, 21.7]
    assert whole.key == "comparison.agree_to_end"
    assert value(whole, "names_reference") == ("flat-ground model",)
    (slid,) = agreements(table(row(reference_mode="slides")), LENGTH)
    assert slid.key == "comparison.agree_slide"
    # a small motion agrees within a tenth of its peak, a measurement within that and its noise
    (small,) = agreements(table(row(tolerance=2.3e-6)), LENGTH)
    (noisy,) = agreements(table(row(**TABLE | {"tilt_bound": 0.034})), LENGTH)
    assert [value(each, "difference") for each in (small, noisy)] == pytest.approx([2.3e-6, 0.034])
    (none,) = agreements(table(row(outcome="failed")).iloc[:0], LENGTH)
    assert none.key == "comparison.none"


def test_runs_that_fail_rest_or_end_before_their_peak_are_named():
    trace = {"outcome": "stands", "peak_time": 12.5, "time": [0.0, 12.0], "mode": "rocks"}
    trace["run"] = SimpleNamespace(is_model=True)
    keys = found(row(), late=SimpleNamespace(**trace), lost=SimpleNamespace(**trace | {"outcome": "failed"}))
    assert value(keys["late_peak"], "names") == ("late", "lost")
    assert value(keys["failed"], "name") == "lost"
    assert "at_rest" not in keys
    assert "at_rest" in found(row(left_tolerance=False))


def test_a_mistake_of_a_file_is_reported_with_its_effect():
    mistake = found(row(**TABLE | SLOWER))
    assert value(mistake["mistake"], "until") == 8.0  # to the end
    diverges = found(row(**TABLE | SLOWER | {"differs_without_mistake": ("tilt",)}))
    assert value(diverges["mistake"], "until") == pytest.approx(9.7)  # uplift at 1.7 s and 8 s after it
    assert "distributions" not in mistake
    besides = found(row(**TABLE | TURNED | {"differs_in": ("tilt",)}))
    assert {"mistake_besides", "distributions"} <= {*besides}
    assert value(found(row(**TABLE | TURNED))["differs"], "names") == ("azimuth", "path")
    assert "unlike" in found(row(**TABLE | {"differs_in": ("path",)}))
    assert not explains_divergence(row(**TABLE | TURNED))


def budgets(*reasons: str) -> pd.DataFrame:
    """Budgets of differences that are split where the reason is empty."""
    shares = {reason: math.nan if reason else 0.1 for reason in reasons}
    return table(
        *(
            row(whole_rms=1e-3, not_split=each, unexplained_share=shares[each], limit_error=1e-4)
            for each in reasons
        )
    )


def test_a_difference_without_budget_is_not_classified():
    (unsplit,) = budget_findings(table(row(), row()), budgets("order", "order"))
    assert (unsplit.key, value(unsplit, "count")) == ("comparison.not_split", 2)
    explained, unsplit = budget_findings(table(row(), row()), budgets("", "unresolved_pass"))
    assert [value(explained, each) for each in ("count", "count_of", "count_less")] == [1, 1, 0]
    assert value(unsplit, "count") == 1


def test_a_large_rest_and_an_early_end_are_cautions():
    rest = budgets("", "").assign(unexplained_share=[0.5, 0.1])
    early, unexplained, explained = budget_findings(table(row(), row(divergence="earlier")), rest)
    assert [early.key, unexplained.key] == ["comparison.earlier", "comparison.unexplained"]
    assert {early.level, unexplained.level} == {"caution"}
    assert (value(unexplained, "share"), value(explained, "count")) == (0.5, 1)
    # the end of an external trajectory cannot be predicted
    assert not list(budget_findings(table(row(**TABLE | {"divergence": "earlier"})), rest.iloc[:0]))
