"""The table of extremes: what each verdict means, and that nothing wrong passes in silence."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest

from rockwobble import multibody
from rockwobble.compare.studies.extremes import EXTREMES, conditions, methods, scan
from rockwobble.models import InitialState
from rockwobble.multibody.engines.registry import find_engine

RECESS = ("reduced recess", "recess", "")
GUIDED = ("MuJoCo recess", "mujoco", "recess")


def at(extreme: str, value: str) -> Any:
    return next(each for each in conditions() if (each.extreme, each.value) == (extreme, value))


def test_every_extreme_has_conditions_and_quick_keeps_its_ends():
    assert {each.extreme for each in conditions()} == set(EXTREMES)
    quick = conditions(quick=True)
    assert len(quick) == 2 * len(EXTREMES)
    assert len({(each.extreme, each.value) for each in conditions()}) == len(conditions())


@pytest.mark.parametrize("extreme", [("size", "R = 0.001 m"), ("slenderness", "tan α = 100")])
def test_a_fine_answer_of_the_recess_model_is_backed_by_the_exact_one(extreme):
    row = scan.run(at(*extreme), RECESS)
    assert row["verdict"] == "fine"
    assert "the energy kept" in row["backed_by"]
    # the integration is good to 1e-8 a step
    assert row["error"] < 1e-5


@pytest.mark.parametrize(
    ("extreme", "method", "verdict", "words"),
    [
        (("time step", "100 times the default"), GUIDED, "refused", "time_step must be at most"),
        (("contact stiffness", "time constant 0.1 steps"), GUIDED, "caught", "energy"),
        (("friction", "0"), RECESS, "inaccurate", "slips"),
        (("time step", "100 times the default"), RECESS, "n/a", ""),
        (("contact stiffness", "time constant 0.1 steps"), ("PyBullet flat", "pybullet", "flat"), "n/a", ""),
    ],
)
def test_what_goes_wrong_is_refused_caught_or_said(extreme, method, verdict, words):
    row = scan.run(at(*extreme), method)
    assert row["verdict"] == verdict
    assert words in row["message"]


def test_the_answer_to_another_question_is_called_silent(monkeypatch):
    condition = at("duration", "0.001 s")
    longer = replace(condition, case=replace(condition.case, duration=0.2))
    case = longer.case
    other = multibody.simulate(
        case.cylinder, initial=InitialState(0.45 * case.cylinder.alpha, rolling_rate=0.5), duration=0.2
    )
    monkeypatch.setattr(scan.multibody, "simulate", lambda *_, **__: other)
    row = scan.run(longer, GUIDED)
    assert row["verdict"] == "silent"
    assert row["error"] == pytest.approx(0.05, rel=0.5)


def test_methods_are_the_three_models_and_each_support_of_each_engine():
    names = [name for name, *_ in methods()]
    assert len(set(names)) == len(names)
    supports = sum(len(find_engine(name).supports) for name in multibody.available_engines())
    assert len(names) == 3 + supports
