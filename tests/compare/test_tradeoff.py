"""Error against computing time: references, errors of methods, and what is concluded from points."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from rockwobble import reduced
from rockwobble.compare.studies.tradeoff import conclusions, fastest, plateaus, rest_tilt_price
from rockwobble.compare.studies.tradeoff.methods import methods_for
from rockwobble.compare.studies.tradeoff.problem import FINE_REST_TILT, PIER, _turn, _wasserstein, problems

# a release at a tolerance of 1e-8 turns by 1.5e-7 deg too much or too little
TURN_ERROR = 1e-6
# of the reference on open ground: it changes by 5e-11 deg with its tolerance
CONVERGED = 1e-8


@pytest.fixture(scope="module")
def turn():
    return _turn()


def test_the_reference_in_a_recess_is_the_quadrature_and_that_on_open_ground_has_converged(turn):
    case = turn.cases[0]
    exact = math.degrees(reduced.angle_of_turn(PIER, case.initial))
    assert turn.references["recess"][0] == pytest.approx([exact], rel=1e-15)
    assert turn.doubt["recess"] == 0.0
    assert 0.0 < turn.doubt["flat"] < CONVERGED


def test_the_kernel_and_scipy_find_the_angle_of_turn(turn):
    chosen = [m for m in methods_for(turn, quick=True) if m.family in ("reduced", "scipy")]
    errors = {(m.line, m.value): turn.error(m.model, [m.solve(turn.cases[0]).quantity]) for m in chosen}
    assert errors["reduced, recess", 1e-8] < TURN_ERROR
    assert errors["reduced, rolling", 1e-8] < TURN_ERROR
    assert errors["reduced, recess", 1e-4] > 10.0 * errors["reduced, recess", 1e-8]
    # coarse solvers, a thousandth of a turn and better
    assert errors["scipy DOP853, Python", 1e-5] < 1e-3
    assert sum(m.base for m in chosen) == 1


def test_an_engine_comes_closer_with_its_step(turn):
    line = [m for m in methods_for(turn, quick=True) if m.line == "MuJoCo recess"]
    errors = [turn.error(m.model, [m.solve(turn.cases[0]).quantity]) for m in line]
    assert errors[0] > 2.0 * errors[1] > 4.0 * errors[2] > 0.0


def test_a_refused_run_has_a_message_and_no_error(turn):
    method = next(m for m in methods_for(turn, quick=True) if m.line == "MuJoCo recess")
    # a step that is right for a pier is not for a cylinder of 6 mm
    answer = method.solve(replace(turn.cases[0], cylinder=replace(PIER, semidiagonal=0.006)))
    assert answer.message.startswith("refused: time_step must be at most")
    assert math.isnan(turn.error("recess", [answer.quantity]))


def test_the_distance_of_distributions_does_not_know_the_order():
    ours, theirs = [np.array([0.1]), np.array([0.4])], [np.array([0.5]), np.array([0.1])]
    assert _wasserstein(ours, theirs) == pytest.approx(0.05)


def points(line: str, family: str, rows: list[tuple[float, float, float]], knob: str = "time step"):
    return pd.DataFrame(
        [
            {
                "problem": "turn",
                "model": "recess",
                "family": family,
                "line": line,
                "knob": knob,
                "value": value,
                "ratio": ratio,
                "milliseconds": ratio,
                "error": error,
            }
            for value, ratio, error in rows
        ]
    )


def test_the_fastest_holds_its_error_at_the_next_finer_setting():
    lucky = points(
        "lucky", "mujoco", [(4.0, 1.0, 0.5), (2.0, 2.0, 0.001), (1.0, 4.0, 0.2), (0.5, 8.0, 0.001)]
    )
    steady = points("steady", "pybullet", [(4.0, 3.0, 0.5), (2.0, 6.0, 0.008), (1.0, 12.0, 0.004)])
    found = fastest(pd.concat([lucky, steady]), "turn", "recess", 0.01)
    assert [(each.family, each.value) for each in found] == [("pybullet", 2.0), ("mujoco", 0.5)]
    assert fastest(steady, "turn", "recess", 1e-6) == []


def test_a_plateau_begins_where_the_error_stops_falling():
    falls = points("falls", "mujoco", [(4.0, 1.0, 0.4), (2.0, 2.0, 0.1), (1.0, 4.0, 0.02)])
    flat = points("flat", "mujoco", [(4.0, 1.0, 0.4), (2.0, 2.0, 0.1), (1.0, 4.0, 0.08), (0.5, 8.0, 0.09)])
    rises = points("rises", "mujoco", [(4.0, 1.0, 0.4), (2.0, 2.0, 0.01), (1.0, 4.0, 0.2)])
    found = {each.line: each for each in plateaus(pd.concat([falls, flat, rises]))}
    assert math.isnan(found["falls"].begins)
    assert found["falls"].level == pytest.approx(0.02)
    assert (found["flat"].begins, found["flat"].level) == (2.0, pytest.approx(0.09))
    assert found["rises"].begins == 2.0


def test_the_price_of_seating_is_told_at_equal_tolerance():
    none = points(f"reduced, rest threshold {FINE_REST_TILT:g}", "reduced", [(1e-6, 2.0, 1e-7)], "tolerance")
    coarse = points(
        "reduced, rest threshold 0.1", "reduced", [(1e-6, 1.0, 0.2), (1e-4, 1.0, 0.2)], "tolerance"
    )
    price = rest_tilt_price(pd.concat([none, coarse]))
    assert price[["tolerance", "speed_up", "error_without"]].to_numpy().tolist() == [[1e-6, 2.0, 1e-7]]


def test_the_ensemble_knows_what_chance_alone_does():
    from rockwobble.compare.studies.tradeoff.problem import sampling_distance

    peaks = problems(quick=True)[2]
    assert 0.0 < sampling_distance(peaks, "recess") < 1.0
    assert max(peaks.doubt.values()) < CONVERGED
    assert conclusions.FLAT > 1.0
