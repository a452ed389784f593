"""The table of what a ring costs: its runs, and its lines."""

from __future__ import annotations

import math

import pytest

from benchmarks.ring_losses import Row, measure, ring_cases, ring_runs, table
from rockwobble.models import Case, Cylinder, InitialState, Run

SQUAT = Cylinder(semidiagonal=6.0, tan_alpha=1.0)
ENGINE = 1e-4  # error at the default step, in the tilt against its own model, over 1.2 s


def row(support: str, loss: float, **settings: float) -> Row:
    return {
        "case": "short", "support": support, "settings": settings, "outcome": "completed",
        "first_contact": math.nan, "contact_time": 0.0, "passes": 2, "loss": loss, "rolled_out": 0.0,
        "at_end": 0.0, "residual": 0.0, "twist": 0.0, "peak": 0.5, "recess": 1e-5, "flat": 1e-2,
    }  # fmt: skip


def test_the_cases_turn() -> None:
    straight, turned = ring_cases(0.0), ring_cases(0.1)
    assert [case.name for case in straight] == [case.name for case in turned]
    assert turned[0].initial is not None
    assert turned[0].initial.rolling_angle == pytest.approx(0.1)
    assert straight[1].motion is not None
    assert turned[1].motion is not None
    assert turned[1].motion.peak == pytest.approx(straight[1].motion.peak)
    # as many times the acceleration that uplifts as the table says
    assert straight[1].motion.peak / (9.81 * 0.2) == pytest.approx(2.0)


def test_rows_hold_each_support_against_its_model() -> None:
    case = Case(SQUAT, initial=InitialState(SQUAT.alpha / 2, rolling_rate=0.5), duration=1.2, name="short")
    steep = Run("mujoco", "ring", ring_inclination=0.1)
    runs = [Run("mujoco", "recess"), Run("mujoco", "flat"), Run("mujoco", "ring"), steep]
    rows = measure([case], runs, workers=1)
    recess, flat, ring = rows  # the release would start inside of the steep walls
    assert recess["recess"] < ENGINE < recess["flat"]
    assert flat["flat"] < ENGINE < flat["recess"]
    # in a recess the cylinder would always come down in its place, on open ground it rolls away from it
    assert recess["rolled_out"] < 1e-5 < 1e-3 < flat["rolled_out"]
    assert abs(flat["loss"]) < ENGINE
    assert 0.5 < ring["first_contact"] < 1.2
    assert ring["contact_time"] > 0.0
    assert ring["loss"] > 100 * abs(flat["loss"])


def test_every_run_of_the_table_differs() -> None:
    runs = ring_runs()
    assert [run.support for run in runs[:2]] == ["recess", "flat"]
    assert len({(run.support, *run.settings.items()) for run in runs}) == len(runs)


def test_a_line_holds_the_medians_of_the_turns() -> None:
    rings = [row("ring", loss, ring_clearance=0.01) for loss in (0.01, 0.02, 0.06)]
    lines = table([row("recess", 0.0), *rings]).splitlines()
    assert lines[1] == "short"
    assert [line.split()[0] for line in lines[4:]] == ["recess", "clearance"]
    # percent: median, least and most, and the median over two passes
    assert lines[-1].split()[5:9] == ["2.000", "1.000", "6.000", "1.000"]
