"""Error against computing time: references, errors of methods, and what is concluded from points."""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pandas as pd
import pytest

from rockwobble import reduced
from rockwobble.compare.runs.progress import Progress
from rockwobble.models.cylinder import PIER
from rockwobble.multibody.engines import registry
from rockwobble.studies.plans import QuickPlan
from rockwobble.studies.tradeoff import problem as problems
from rockwobble.studies.tradeoff import study
from rockwobble.studies.tradeoff.methods import (
    BASE_LINE,
    BASE_TOLERANCE,
    REST_PANEL,
    Method,
    methods_for,
    rest_line,
)
from rockwobble.studies.tradeoff.problem import FINE_REST_TILT, Problem
from rockwobble.studies.tradeoff.study import costs, engine_factors, plateaus, rest_tilt_price

# a release at a tolerance of 1e-8 turns by 1.5e-7 deg too much or too little
TURN_ERROR = 1e-6
# of the reference on flat ground: it changes by 5e-11 deg with its tolerance
CONVERGED = 1e-8
MOST_LINES = 6  # of a panel


@pytest.fixture(scope="module")
def turn() -> Problem:
    return problems.turn(quick=True)


@pytest.fixture(scope="module")
def methods(turn: Problem) -> list[Method]:
    return methods_for(turn, quick=True)


def error(problem: Problem, method: Method) -> float:
    return problem.error(method.support, [method.solve(problem.cases[0]).quantity])


def test_each_support_has_its_own_answer(turn: Problem) -> None:
    initial = turn.cases[0].initial
    assert initial is not None
    recess, flat, ring = (turn.references[support] for support in ("recess", "flat", "ring"))
    exact = math.degrees(reduced.angle_of_turn(PIER, initial))
    assert recess.quantities[0] == pytest.approx([exact], rel=1e-15)
    assert (recess.doubt, recess.source) == (0.0, "exact")
    assert flat.source == "tight"
    assert 0.0 < flat.doubt < CONVERGED
    # a ring that is not yet touched lets the cylinder roll as flat ground does: but for the engine's error
    assert ring.source == "half_step"
    assert ring.quantities[0] == pytest.approx(flat.quantities[0], abs=20.0 * ring.doubt)


def test_the_models_and_scipy_find_the_angle_of_turn(turn: Problem, methods: list[Method]) -> None:
    chosen = [m for m in methods if m.family in ("reduced", "scipy")]
    errors = {(m.line, m.value): error(turn, m) for m in chosen}
    assert errors["recess model", 1e-8] < TURN_ERROR
    assert errors["flat-ground model", 1e-8] < TURN_ERROR
    assert errors["recess model", 1e-4] > 10.0 * errors["recess model", 1e-8]
    # coarse solvers, a thousandth of a turn and better
    assert errors["DOP853, Python", 1e-5] < 1e-3
    assert sum(m.base for m in methods) == 1


@pytest.mark.parametrize("line", ["mujoco recess", "mujoco ring"])
def test_an_engine_comes_closer_with_its_step(turn: Problem, methods: list[Method], line: str) -> None:
    errors = [error(turn, m) for m in methods if m.line == line]
    assert all(coarse > 1.9 * fine > 0.0 for coarse, fine in pairwise(errors))


def test_a_refused_run_says_so_and_has_no_error(turn: Problem, methods: list[Method]) -> None:
    method = next(m for m in methods if m.line == "mujoco recess")
    # a step that is right for a pier is not for a cylinder of 6 mm
    answer = method.solve(replace(turn.cases[0], cylinder=replace(PIER, semidiagonal=0.006)))
    assert answer.said.startswith("time_step must be at most")
    assert math.isnan(turn.error("recess", [answer.quantity]))


def test_no_panel_has_more_lines_than_can_be_read(turn: Problem) -> None:
    lines = {(m.support, m.panel, m.line) for m in methods_for(turn)}
    counts = pd.DataFrame(list(lines), columns=["support", "panel", "line"]).groupby(["support", "panel"])
    assert counts.size().max() <= MOST_LINES


def test_the_distance_of_distributions_does_not_know_the_order() -> None:
    ours, theirs = [np.array([0.1]), np.array([0.4])], [np.array([0.5]), np.array([0.1])]
    assert problems._wasserstein(ours, theirs) == pytest.approx(0.05)


def test_the_ensemble_knows_what_chance_alone_does(monkeypatch: pytest.MonkeyPatch) -> None:
    # a ring of walls is answered as in the turn, by engine runs that take longer than all the rest here
    monkeypatch.setattr(problems, "own_engines", tuple)
    peaks = problems.peaks(quick=True)
    assert 0.0 < problems.sampling_distance(peaks, "recess") < 1.0
    assert max(peaks.references[support].doubt for support in ("recess", "flat")) < CONVERGED


@pytest.mark.slow
def test_all_methods_are_timed_in_turn_and_told_in_times_of_one(
    turn: Problem, monkeypatch: pytest.MonkeyPatch
) -> None:
    # two steps: a cost is that of an error which the next finer one holds
    few = replace(turn, steps=turn.steps[:2], few_steps=turn.steps[:2])
    monkeypatch.setattr(study, "problems", lambda **_: [few])

    def standard_here() -> tuple[str, ...]:
        return tuple(name for name in registry.standard_engines() if name in registry.own_engines())

    for each in ("tradeoff.methods", "scene_cost"):  # what is installed beyond these is timed in the same way
        monkeypatch.setattr(f"rockwobble.studies.{each}.own_engines", standard_here)
    events: list[Progress] = []
    found = study.measure_tradeoff(QuickPlan(quick=True), progress=events.append)
    assert (events[-1].state, events[-1].done, events[-1].share) == ("finished", events[-1].total, 1.0)
    base = found.points[(found.points["line"] == BASE_LINE) & (found.points["value"] == BASE_TOLERANCE)]
    assert base[["ratio", "ratio_low", "ratio_high"]].to_numpy().tolist() == [[1.0, 1.0, 1.0]]
    assert (found.points["ratio_low"] <= found.points["ratio"]).all()
    assert (found.points["ratio"] <= found.points["ratio_high"]).all()
    assert set(found.problems["support"]) == {"recess", "flat", "ring"}
    # an engine takes a step of some microseconds, the model a few for the whole release
    low, high = engine_factors(found.points)
    assert 2.0 < low < high
    assert found.headline()["engine over recess model, least"] == low


def points(
    line: str,
    family: str,
    rows: list[tuple[float, float, float]],
    knob: str = "time step",
    panel: str = "methods",
) -> pd.DataFrame:
    found = pd.DataFrame(rows, columns=["value", "ratio", "error"])
    return found.assign(problem="turn", support="recess", panel=panel, family=family, line=line, knob=knob)


def test_the_cheapest_holds_its_error_at_the_next_finer_setting() -> None:
    lucky = points(
        "lucky", "mujoco", [(4.0, 1.0, 0.5), (2.0, 2.0, 0.001), (1.0, 4.0, 0.2), (0.5, 8.0, 0.001)]
    )
    steady = points("steady", "pybullet", [(4.0, 3.0, 0.5), (2.0, 6.0, 0.008), (1.0, 12.0, 0.004)])
    both = pd.concat([lucky, steady])
    found = costs(both)
    at = found[found["target"] == 0.01]
    assert at[["family", "value"]].to_numpy().tolist() == [["pybullet", 2.0], ["mujoco", 0.5]]
    # times are multiples of that of the recess model at its default tolerance, and of nothing else
    assert engine_factors(both) == (6.0, 8.0)
    assert costs(points("none", "mujoco", [(1.0, 1.0, 1.0)])).empty


@pytest.mark.parametrize(
    ("errors", "verdict", "begins"),
    [
        ((0.4, 0.2, 0.1), "falls", math.nan),  # of first order: a factor of two at each halving
        ((0.4, 0.1, 0.08, 0.09), "flat", 2.0),
        ((0.4, 0.01, 0.02, 0.04), "grows", 2.0),
        ((0.1, 0.2, 0.4), "grows", 4.0),
    ],
)
def test_a_plateau_is_flat_and_an_error_that_falls_or_grows_is_none(
    errors: tuple[float, ...], verdict: str, begins: float
) -> None:
    rows = [(4.0 / 2**n, 1.0, each) for n, each in enumerate(errors)]
    found = plateaus(points("line", "mujoco", rows)).iloc[0]
    assert found["verdict"] == verdict
    np.testing.assert_equal(found["begins"], begins)
    assert found["best"] == 4.0 / 2 ** int(np.argmin(errors))


def test_the_price_of_the_rest_rule_is_told_at_equal_tolerance() -> None:
    none = points(rest_line(FINE_REST_TILT), "reduced", [(1e-6, 2.0, 1e-7)], "tolerance", REST_PANEL)
    usual = points(BASE_LINE, "reduced", [(1e-6, 1.0, 0.2), (1e-4, 1.0, 0.2)], "tolerance")
    coarse = points("a tenth", "reduced", [(1e-6, 0.5, 0.4)], "tolerance", REST_PANEL)
    price = rest_tilt_price(pd.concat([none, usual, coarse]))
    assert price[["line", "value", "speed_up", "error", "error_without"]].to_numpy().tolist() == [
        [BASE_LINE, 1e-6, 2.0, 0.2, 1e-7],
        ["a tenth", 1e-6, 4.0, 0.4, 1e-7],
    ]
