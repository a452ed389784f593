"""time_step="extrapolated": limit of runs at three steps, and the diagnostics where there is none."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from engine_samples import trace_of

from rockwobble import multibody
from rockwobble.models import (
    Case,
    Cylinder,
    Diagnostic,
    Trace,
    el_centro_1940,
)
from rockwobble.multibody.extrapolated_step import extrapolation

ALPHA = 0.2
# of alpha, after a release: remaining error of second order in an engine of first order
RELEASED = 1e-7
# relative RMS under El Centro on (10 m, 0.1) to 15 s, at the cost of one run at the default step
SHAKEN = {"mujoco": 5e-6, "pybullet": 2e-5, "dart": 2e-5}
ESTIMATE = 3.0  # factor within which Richardson is right


@pytest.mark.slow
@pytest.mark.parametrize("engine", [name for name in SHAKEN if name in multibody.available_engines()])
@pytest.mark.parametrize(
    ("support", "tan_alpha", "finest"),
    [
        ("recess", 0.35, 1.75e-4),
        # a squat body rolls on a large rim, whose second order is larger
        ("flat", 3.0, 3e-5),
    ],
)
def test_a_release_extrapolates_to_the_model(
    engine: str, support: str, tan_alpha: float, finest: float, run_release: Callable[..., Any]
) -> None:
    options = {"duration": 2.0, "time_step": "extrapolated", "finest_step": finest}
    run, exact = run_release(engine, support, tan_alpha, **options)
    assert np.abs(run.tilt - exact.tilt).max() < RELEASED * run.case.cylinder.alpha
    assert np.abs(run.tilt - exact.tilt).max() < ESTIMATE * run.error_estimate
    # the azimuth as well as the tilt: a pass at 0.3 alpha magnifies by ten
    assert np.abs(run.rolling_angle - exact.rolling_angle).max() < 100.0 * RELEASED
    (fact,) = (fact for fact in run.facts if fact.code.endswith("extrapolated"))
    assert (fact.code, fact.bound, fact.duration) == ("extrapolated", 1.0, run.time[-1])
    assert (run.time_step, run.run.time_step) == (pytest.approx(finest), "extrapolated")


@pytest.mark.slow
@pytest.mark.parametrize("engine", [name for name in SHAKEN if name in multibody.available_engines()])
def test_a_shaken_run_extrapolates_to_the_model(engine: str, solve_forced: Callable[..., Any]) -> None:
    motion, cylinder = el_centro_1940(), Cylinder(semidiagonal=10.0, tan_alpha=0.1)
    run = multibody.simulate(Case(cylinder, motion, duration=15.0), engine=engine, time_step="extrapolated")
    exact = solve_forced(cylinder, motion, 15.0)
    tilt = np.interp(exact.time, run.time, run.tilt)
    relative = np.sqrt(np.mean((tilt - exact.tilt) ** 2) / np.mean(exact.tilt**2))
    assert relative < SHAKEN[engine]
    # near passes make its error one of second order
    assert [(fact.code, fact.bound) for fact in run.facts] == [("extrapolated", 2.0)]


def three(error: Callable[[float], Any], **more: Any) -> list[Trace]:
    """Runs at steps of 4, 2 and 1, with a tilt in error by `error` of the step."""
    return [replace(trace_of(0.1 + error(step), **more), time_step=step) for step in (4.0, 2.0, 1.0)]


@pytest.mark.parametrize("order", [1, 2])
def test_a_series_of_one_term_extrapolates_exactly(order: int) -> None:
    shape = 1e-5 * np.sin(0.1 * np.arange(100))
    runs = three(lambda step: shape * step**order)
    limit = extrapolation(runs, ALPHA)
    np.testing.assert_allclose(limit.tilt, 0.1, atol=1e-15)
    np.testing.assert_allclose(limit.energy, 0.1, atol=1e-15)
    assert limit.peak_tilt == pytest.approx(0.1, abs=1e-15)
    assert [(fact.code, fact.bound) for fact in limit.facts] == [("extrapolated", order)]
    assert limit.settled_until == limit.time[-1]


def test_angles_a_turn_apart_are_one_angle() -> None:
    shape = 1e-5 * np.sin(0.1 * np.arange(100))
    # pushed along an axis, rounding decides between azimuths pi and -pi; a maximum, then a minimum
    turns = [math.pi, -math.pi, math.pi - 3e-5]
    runs = [
        replace(
            run,
            uplift_direction=turn,
            extrema=np.array([[0.2, 0.1, turn, 1.0], [0.4, 0.01, turn + 0.5, -1.0]]),
        )
        for run, turn in zip(three(lambda step: shape * step), turns, strict=True)
    ]
    limit = extrapolation(runs, ALPHA)
    assert limit.uplift_direction == pytest.approx(math.pi - 6e-5, abs=1e-12)
    np.testing.assert_allclose(limit.extrema[:, 2], [math.pi - 6e-5, math.pi - 6e-5 + 0.5], atol=1e-12)
    for others in (runs[1].extrema[::-1], runs[1].extrema[:1]):  # others, or fewer, have no common limit
        runs[1] = replace(runs[1], extrema=others)
        np.testing.assert_array_equal(extrapolation(runs, ALPHA).extrema, runs[2].extrema)


def test_the_estimate_is_what_a_halving_moves() -> None:
    shape = 1e-5 * np.sin(0.1 * np.arange(100))
    limit = extrapolation(three(lambda step: shape * (step + 0.05 * step**2)), ALPHA)
    error = np.abs(limit.tilt - 0.1).max()
    assert error > 1e-8
    # the remaining second order is quartered: three of four parts are gone by the last halving
    assert limit.error_estimate == pytest.approx(3.0 * error, rel=1e-6)


def test_a_landing_with_every_step_alike_is_no_agreement() -> None:
    # contact resolves 1e-6 rad: a swing that ends below it is known up to its maximum, and no further
    for low, until in ((1.01e-6, 0.99), (0.99e-6, 0.3)):
        runs = three(lambda step: 1e-5 * step * np.sin(0.1 * np.arange(100)))
        points = np.array([[0.1, 0.02, 0.0, -1.0], [0.3, 0.1, 0.0, 1.0], [0.4, low, 0.0, -1.0]])
        limit = extrapolation([replace(run, extrema=points) for run in runs], ALPHA)
        assert limit.settled_until == pytest.approx(until)


def left_to_chance(code: str, time: float) -> dict[str, Any]:
    """Fields of a trace that is known until this time: contact drives it, or its next swing ends too low."""
    if code == "energy":
        return {"facts": (Diagnostic(code=code, time=time),)}
    return {"extrema": np.array([[time, 0.1, 0.0, 1.0], [time + 0.1, 1e-7, 0.0, -1.0]])}


@pytest.mark.parametrize("code", ["unresolved_pass", "energy"])
def test_after_an_unresolved_pass_or_an_energy_error_it_is_the_finest_run(code: str) -> None:
    runs = three(lambda step: 1e-5 * step * np.sin(0.1 * np.arange(100)))
    runs[-1] = replace(runs[-1], **left_to_chance(code, 0.5))
    limit = extrapolation(runs, ALPHA)
    assert limit.settled_until == pytest.approx(0.5)
    np.testing.assert_array_equal(limit.tilt[51:], runs[-1].tilt[51:])
    noted = [(fact.code, fact.detail) for fact in limit.facts[-2:]]
    assert noted == [("extrapolated", ""), ("not_extrapolated", code)]
    runs[-1] = replace(runs[-1], **left_to_chance(code, -0.01))
    limit = extrapolation(runs, ALPHA)
    assert np.isnan(limit.error_estimate)
    assert (limit.facts[-1].code, limit.facts[-1].detail) == ("not_extrapolated", code)


def test_after_a_divergence_it_is_the_finest_run() -> None:
    side = {4.0: 1.0, 2.0: -1.0, 1.0: 1.0}
    late = np.arange(100) >= 60

    def error(step: float) -> Any:
        return 1e-5 * step * np.sin(0.1 * np.arange(100)) + np.where(late, 0.05 * side[step], 0.0)

    runs = three(error, passes=(0.3, 0.55))
    limit = extrapolation(runs, ALPHA)
    assert limit.settled_until == 0.55
    np.testing.assert_allclose(limit.tilt[:56], 0.1, atol=1e-15)
    np.testing.assert_array_equal(limit.tilt[56:], runs[-1].tilt[56:])
    codes = [(fact.code, fact.detail) for fact in limit.facts]
    assert codes == [("extrapolated", ""), ("not_extrapolated", "diverged")]
    assert limit.facts[1].time == 0.55


def test_runs_that_do_not_come_closer_are_not_extrapolated() -> None:
    off = {4.0: 1e-5, 2.0: -1e-5, 1.0: 1e-5}
    runs = three(lambda step: np.full(50, off[step]))
    limit = extrapolation(runs, ALPHA)
    np.testing.assert_array_equal(limit.tilt, runs[-1].tilt)
    assert [(fact.code, fact.detail) for fact in limit.facts] == [("not_extrapolated", "no_closer")]


def test_extrapolation_keeps_the_tilt_positive_and_the_side_of_upright() -> None:
    runs = three(lambda step: np.where(np.arange(50) == 20, -0.1 + 1e-5 * step**1.2, 1e-5 * step))
    limit = extrapolation(runs, ALPHA)
    assert (limit.tilt >= 0.0).all()
    assert limit.tilt[20] == runs[-1].tilt[20]
    turned = [
        replace(run, rolling_angle=np.full(50, angle))
        for run, angle in zip(three(lambda step: np.full(50, 1e-5 * step)), (0.0, 0.0, 6.0), strict=True)
    ]
    np.testing.assert_array_equal(extrapolation(turned, ALPHA).rolling_angle, 6.0)


def test_a_failed_run_is_reported() -> None:
    fails = trace_of([0.1], outcome="failed")
    good = three(lambda step: np.full(50, 1e-5 * step))
    (fact,) = extrapolation([fails, *good[1:]], ALPHA).facts
    assert (fact.code, fact.detail) == ("not_extrapolated", "fails")
    assert extrapolation([*good[:2], fails], ALPHA) is fails
