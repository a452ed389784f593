"""time_step="auto": halved until the tilt has settled, with an estimate of the error that holds."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from engine_samples import trace_of

from rockwobble import multibody
from rockwobble.models import Case, Cylinder, Diagnostic, InitialState, Trace
from rockwobble.multibody.auto_step import COARSEST, SMALLEST, Closeness, closeness, common_count, find_step

ALPHA = 0.2
# Richardson with a measured order is right within a factor; three is its error at the bounds of the order
ESTIMATE = 3.0


@pytest.mark.slow
@pytest.mark.parametrize(("support", "tan_alpha"), [("recess", 0.2), ("flat", 3.0)])
def test_the_actual_error_is_within_the_estimate(
    engine: str, support: str, tan_alpha: float, run_release: Callable[..., Any]
) -> None:
    run, exact = run_release(
        engine, support, tan_alpha, duration=2.0, time_step="auto", step_tolerance=0.0002
    )
    assert run.outcome == "stands"
    assert run.settled_until == 2.0
    error = float(np.abs(run.tilt - exact.tilt).max())
    assert error < ESTIMATE * run.error_estimate
    assert run.error_estimate < 2e-4 * run.case.cylinder.alpha
    assert step_fact(run).code == "settled"


def test_the_step_scales_with_size() -> None:
    small = Cylinder(semidiagonal=0.06, tan_alpha=0.2)
    release = InitialState(small.alpha / 2, rolling_rate=5.0)
    run = multibody.simulate(Case(small, initial=release, duration=0.1), time_step="auto")
    assert run.time_step == pytest.approx(0.1 * COARSEST / 2)


def step_fact(run: Trace) -> Diagnostic:
    """Result of the search for a step, from the diagnostics."""
    (fact,) = (fact for fact in run.facts if fact.code in ("settled", "unsettled"))
    return fact


def search(
    tilt_of: Callable[[float], Any], tolerance: float = 1e-3, **kept: Any
) -> tuple[Trace, list[float]]:
    """Search with a synthetic engine; return the run and the steps that were tried."""
    steps: list[float] = []

    def attempt(step: float, _: Any) -> Trace:
        steps.append(step)
        given = tilt_of(step)
        run = given if isinstance(given, Trace) else trace_of(given, **kept)
        return replace(run, time_step=step)

    return find_step(attempt, 1.0, ALPHA, tolerance, None), steps


@pytest.mark.parametrize("seed", range(10))
def test_times_are_common_until_one_differs(seed: int) -> None:
    chance = np.random.default_rng(seed)
    time = 0.01 * np.arange(60)
    ended, moved = time[:50], time.copy()
    first = int(chance.integers(2, 49))
    moved[first] += 0.004
    others = [moved, *(time[: int(chance.integers(51, 60))] for _ in range(3))]
    chance.shuffle(others)  # type: ignore[arg-type]  # a list of arrays
    assert common_count([time, ended, *others]) == common_count([*others, time]) == first
    assert common_count([time, ended]) == len(ended)
    assert common_count([time, time + 1e-12]) == len(time)


@pytest.mark.parametrize("code", ["unresolved_pass", "energy"])
def test_auto_step_is_unsettled_after_chance_events(code: str) -> None:
    left: dict[str, Any] = {"facts": (Diagnostic(code=code, time=0.2),)}
    if code == "unresolved_pass":  # contact resolves 1e-6 rad
        left = {"extrema": np.array([[0.1, 0.1, 0.0, 1.0], [0.2, 1e-7, 0.0, -1.0]])}
    run, steps = search(lambda step: replace(trace_of(np.full(50, 0.1)), **left))
    assert len(steps) == 2
    assert (step_fact(run).code, step_fact(run).detail) == ("unsettled", code)
    assert np.isnan(run.error_estimate)


@pytest.mark.parametrize("order", [1.0, 2.0])
def test_the_estimate_is_that_of_first_order(order: float) -> None:
    shape = np.sin(np.arange(100))
    run, steps = search(lambda step: 0.1 + 10.0 * (step / COARSEST) ** order * 2e-4 * shape, 2e-3)
    # unknown before the third run, from which on the order is measured
    assert len(steps) >= 3
    error = np.abs(run.tilt - 0.1).max()
    # for second order it is three times the remaining error
    assert run.error_estimate == pytest.approx((2.0**order - 1.0) * error, rel=1e-6)
    assert step_fact(run).bound == pytest.approx(1.0, rel=1e-3)


def test_halving_ends_where_it_no_longer_helps() -> None:
    # converges at first, then diverges with each step
    level = {COARSEST: 8e-4, COARSEST / 2: 4e-4, COARSEST / 4: 2e-4, COARSEST / 8: 6e-4}
    run, steps = search(lambda step: np.full(50, 0.1 + level[step]), 1e-4)
    assert (step_fact(run).code, step_fact(run).detail) == ("unsettled", "no_closer")
    assert run.time_step == COARSEST / 4
    assert len(steps) == 4


def test_halving_ends_at_the_smallest_step() -> None:
    run, steps = search(lambda step: 0.1 + np.full(50, 0.0015 * (step / COARSEST) ** 0.2), 1e-7)
    assert steps[-1] == pytest.approx(SMALLEST)
    assert (step_fact(run).code, step_fact(run).detail) == ("unsettled", "still_changes")


def test_a_divergence_that_stays_is_where_agreement_ends() -> None:
    def tilt(step: float) -> Any:
        side = 1.0 if round(np.log2(COARSEST / step)) % 2 else -1.0
        return 0.1 + np.where(np.arange(200) < 120, 1e-5 * step / COARSEST, 0.05 * side)

    run, _ = search(tilt, passes=(0.5, 1.1, 1.5))
    assert run.settled_until == 1.1
    assert run.error_estimate < 2e-5
    assert step_fact(run).duration == 1.1


def test_failed_steps_are_passed_over() -> None:
    fails = trace_of([0.1], outcome="failed")
    run, steps = search(lambda step: fails if step > 0.9 * COARSEST else np.full(50, 0.1))
    assert run.outcome == "stands"
    assert len(steps) == 3
    run, _ = search(lambda step: fails)
    assert run.outcome == "failed"
    assert [fact.detail for fact in run.facts] == ["why"]
    run, _ = search(lambda step: fails if step < 0.9 * COARSEST else np.full(50, 0.1))
    assert run.time_step == COARSEST
    assert step_fact(run).detail == "fails"


def test_closeness_stops_at_the_earlier_end() -> None:
    whole, short = trace_of(np.full(50, 0.1)), trace_of(np.full(30, 0.1), outcome="overturned")
    assert closeness(whole, short, ALPHA) == Closeness(0.0, pytest.approx(0.29), pytest.approx(0.29))


def test_closeness_ends_at_the_last_pass_before_a_divergence() -> None:
    fine = trace_of(np.full(50, 0.1), passes=(0.05, 0.1, 0.2, 0.4))
    off = np.where(fine.time < 0.15, 1e-6, np.where(fine.time < 0.3, 2e-6, 0.1))
    distance = closeness(trace_of(fine.tilt + off), fine, ALPHA)
    assert distance == Closeness(pytest.approx(2e-6), pytest.approx(0.2), pytest.approx(0.3))


@pytest.mark.parametrize(
    ("arguments", "line"),
    [
        ({"time_step": "fine"}, '"auto", "extrapolated" or a number'),
        ({"time_step": "auto", "step_tolerance": 0.0}, "step_tolerance must be positive"),
        ({"time_step": 1e-4, "step_tolerance": 1e-3}, 'goes with time_step="auto"'),
        ({"time_step": "auto", "nonsense": 1}, "not a setting"),
        ({"time_step": "extrapolated", "finest_step": 0.0}, "finest_step must be positive"),
        ({"time_step": "extrapolated", "finest_step": 3e-4}, "finest_step must be at most 0.00025"),
        ({"time_step": "auto", "finest_step": 1e-4}, "finest_step"),
        ({"time_step": 1e-4, "finest_step": 1e-4}, 'goes with time_step="extrapolated"'),
    ],
)
def test_bad_settings_are_refused(pier: Cylinder, arguments: dict[str, Any], line: str) -> None:
    with pytest.raises(ValueError, match=line):
        multibody.simulate(Case(pier, initial=InitialState(0.1), duration=0.1), **arguments)
