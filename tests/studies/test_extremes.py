"""The extremes: what each verdict means, and that nothing wrong passes in silence."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest

from rockwobble.compare.runs.execution import simulate_run
from rockwobble.models import Case, Diagnostic, InitialState, Run, Trace
from rockwobble.models.cylinder import PIER
from rockwobble.multibody.engines.registry import find_engine, own_engines
from rockwobble.studies import extremes
from rockwobble.studies.extremes import FINE, Condition, conditions, judge, methods

PLANAR, RECESS, *_ = extremes.methods()
ENGINE, RING = Run("mujoco", "recess"), Run("mujoco", "ring")


def at(extreme: str, value: str) -> Condition:
    return next(each for each in conditions() if (each.extreme, each.value) == (extreme, value))


def test_every_extreme_has_conditions_and_quick_keeps_its_ends() -> None:
    every = [(each.extreme, each.value) for each in conditions()]
    assert len(set(every)) == len(every)
    names = {extreme for extreme, _ in every}
    assert len(names) == 10
    quick = [(each.extreme, each.value) for each in conditions(quick=True)]
    for name in names:
        own = [each for each in every if each[0] == name]
        assert [each for each in quick if each[0] == name] == [own[0], own[-1]]


@pytest.mark.parametrize("extreme", [("size", "R = 0.001 m"), ("slenderness", "tan α = 100")])
def test_a_fine_answer_of_the_recess_model_is_backed_by_the_exact_one(extreme: tuple[str, str]) -> None:
    found = judge(at(*extreme), RECESS)
    assert found.verdict == "fine"
    assert "energy" in found.reference
    # the integration is good to 1e-8 a step
    assert found.error < 1e-5


@pytest.mark.slow
@pytest.mark.parametrize(
    ("extreme", "run", "wanted", "limit"),
    [
        (("time step", "100 times the default"), ENGINE, "refused", "time_step must be at most"),
        (("spin", "3 rad/s"), PLANAR, "refused", "planar motion has no rolling_rate"),
        (("spin", "0 rad/s"), PLANAR, "fine", ""),
        (("size", "R = 0.01 m"), PLANAR, "fine", ""),  # there without the spin
        (("contact stiffness", "time constant 0.1 steps"), ENGINE, "caught", "energy_gain"),
        (("friction", "0"), RECESS, "flagged", "friction_needed"),
        (("friction", "0"), ENGINE, "no reference", "slip"),  # on ice the model holds for no time
        (("size", "R = 0.01 m"), RING, "fine", ""),
        (("time step", "100 times the default"), RECESS, "n/a", ""),
        (("contact stiffness", "time constant 0.1 steps"), Run("pybullet", "flat"), "n/a", ""),
    ],
)
def test_what_goes_wrong_is_refused_caught_or_flagged(
    extreme: tuple[str, str], run: Run, wanted: str, limit: str
) -> None:
    found = judge(at(*extreme), run)
    assert found.verdict == wanted
    assert limit in (found.refusal or found.limit)
    # an error of what nothing is known about is no number
    assert math.isnan(found.error) == (wanted not in ("fine", "flagged"))


def test_every_refusal_is_one_line_before_anything_runs(monkeypatch: pytest.MonkeyPatch) -> None:
    def none(*_: object, **__: object) -> Trace:
        raise ZeroDivisionError("it runs")

    monkeypatch.setattr(extremes, "simulate_run", none)
    refused = []
    for condition in conditions():
        for run in (PLANAR, RECESS, ENGINE, RING):
            try:
                found = judge(condition, run)
            except ZeroDivisionError:
                continue
            if found.verdict == "refused":
                refused.append((condition.extreme, condition.value, str(run)))
                assert found.refusal.splitlines() == [found.refusal]
    spins = [("spin", f"{rate} rad/s", "planar model") for rate in ("1e-09", "0.001", "3", "10", "1000")]
    steps = [("time step", "100 times the default", str(run)) for run in (ENGINE, RING)]
    assert refused == spins + steps


def test_an_error_in_the_middle_of_a_run_is_no_refusal(monkeypatch: pytest.MonkeyPatch) -> None:
    def broken(*_: object, **__: object) -> Trace:
        raise ValueError("operands could not be broadcast together")

    monkeypatch.setattr(extremes, "simulate_run", broken)
    with pytest.raises(ValueError, match="broadcast"):
        judge(at("size", "R = 0.001 m"), RECESS)


def test_a_ring_is_compared_with_itself_at_half_the_step(monkeypatch: pytest.MonkeyPatch) -> None:
    steps = []

    def counted(case: Case, run: Run, *, sample_step: float) -> Trace:
        steps.append((run.support, run.time_step))
        return simulate_run(case, run, sample_step=sample_step)

    monkeypatch.setattr(extremes, "simulate_run", counted)
    condition = at("time step", "5 times the default")
    assert judge(condition, RING).reference == "half_step"
    (ours, step), (other, half) = steps
    assert ours == other == "ring"
    assert isinstance(step, float)
    assert half == 0.5 * step


# a tilt off by 0.05 alpha from the start, of which the run says
@pytest.mark.parametrize(
    ("facts", "wanted"),
    [
        ((), "silent"),
        ((Diagnostic(code="slip", time=0.0),), "flagged"),
        ((Diagnostic(code="slip", time=0.1),), "silent"),  # it begins later than the error
        ((Diagnostic(code="settled", time=0.0),), "silent"),  # it explains no error
        ((Diagnostic(code="solver", size=3.0),), "silent"),  # it has no time
        (
            (Diagnostic(code="wall_contact", time=0.0),),
            "silent",
        ),  # its reference meets the wall, too
        ((Diagnostic(code="energy", time=0.05), Diagnostic(code="slip", time=0.0)), "flagged"),
    ],
)
def test_only_a_diagnostic_that_explains_an_error_and_is_no_later_flags_it(
    monkeypatch: pytest.MonkeyPatch, facts: tuple[Diagnostic, ...], wanted: str
) -> None:
    condition = at("duration", "0.001 s")
    longer = dataclasses.replace(condition, case=dataclasses.replace(condition.case, duration=0.2))
    alpha = longer.case.cylinder.alpha

    def other(case: Case, run: Run, *, sample_step: float) -> Trace:
        if run.is_model:
            return simulate_run(case, run, sample_step=sample_step)
        moved = dataclasses.replace(case, initial=InitialState(0.45 * alpha, rolling_rate=0.5))
        found = simulate_run(moved, run, sample_step=sample_step)
        return dataclasses.replace(found, facts=facts, case=case)

    monkeypatch.setattr(extremes, "simulate_run", other)
    found = judge(longer, ENGINE)
    assert found.verdict == wanted
    assert found.limit == (min(facts, key=lambda fact: fact.time).code if wanted == "flagged" else "")
    assert found.error == pytest.approx(0.05, rel=0.5)
    assert found.error > FINE
    assert found.begins == 0.0
    assert np.isinf(found.until)


def test_methods_are_the_three_models_and_each_support_of_each_engine() -> None:
    found = methods()
    assert len({str(run) for run in found}) == len(found)
    engines = {run.engine for run in found} - {None}
    assert engines == set(own_engines())
    assert all(
        {run.support for run in found if run.engine == name} == set(find_engine(name).supports)
        for name in own_engines()
    )
    assert sum(run.is_model for run in found) == 3


def test_one_thing_at_a_time_is_taken_to_its_extreme() -> None:
    for condition in conditions():
        case = condition.case
        assert (case.cylinder == PIER) == (condition.extreme not in ("size", "slenderness")), condition
        assert (case.gravity == 9.81) == (condition.extreme != "gravity"), condition
