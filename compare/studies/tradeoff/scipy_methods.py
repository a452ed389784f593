"""scipy's solvers on the equations of the recess model, as somebody without this package would use them.

They start with a release, or just after the uplift that the reduced kernel finds: at rest the equations are
singular for them. They neither seat the cylinder nor uplift it again.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rockwobble import reduced
from rockwobble.models import Case, GroundMotion
from rockwobble.reduced.solution import Solution

from .problem import TIGHT, Answer, Problem
from .scipy_equations import TOLERANCE_SCALE, InitialValueProblem, SolverName, compiled_rates, python_rates

Array = NDArray[np.float64]

_AFTER_UPLIFT = 2e-3  # [s]
_INSTANT = 1e-9  # of motion, for the momentum of a release [s]


@dataclass(frozen=True, slots=True, kw_only=True)
class Rates:
    """The right-hand side of a case and where it starts."""

    function: Any
    start: InitialValueProblem


def plain(case: Case) -> Rates:
    """Return the equations in plain Python."""
    start = _start(case)
    return Rates(function=python_rates(start), start=start)


def compiled(case: Case) -> Rates:
    """Return the equations compiled by numba, which scipy still calls through Python."""
    start = _start(case)
    return Rates(function=compiled_rates(start), start=start)


def _start(case: Case) -> InitialValueProblem:
    motion = case.motion or GroundMotion(np.zeros((2, 2)), case.length)
    # a sample more than the run is long: the last stage of a solver stands at its end
    samples = np.vstack([motion.acceleration[:, :2], np.zeros((2, 2))])
    padded = GroundMotion(samples, motion.time_step)
    begin = _departure(case) if case.initial is None else _INSTANT
    reach = reduced.simulate(dataclasses.replace(case, duration=begin), rtol=TIGHT)
    assert isinstance(reach.source, Solution)
    state = reach.source.states[-1, :4]
    return InitialValueProblem(
        cylinder=case.cylinder, motion=padded, start=begin, end=case.length, state=state
    )


def _departure(case: Case) -> float:
    """Return a time just after the last uplift before the peak [s]: what is before it is at rest."""
    run = reduced.simulate(case, rtol=TIGHT)
    resting = np.flatnonzero(np.isnan(run.rolling_angle[: int(np.argmax(run.tilt)) + 1]))
    last = int(resting[-1]) if len(resting) else 0
    if math.isnan(run.uplift_time):
        raise ValueError(f"{case.name} never uplifts: scipy has nothing to solve")
    return max(float(run.time[last + 1]), run.uplift_time + _AFTER_UPLIFT)


def scipy_answer(
    problem: Problem, name: SolverName, rates: Mapping[str, Rates], rtol: float
) -> Callable[[Case], Answer]:
    """Return what solves a case by one of scipy's solvers at a tolerance."""

    def solve(case: Case) -> Answer:
        quantity = _solve(problem, case, name, rates[case.name], rtol)
        missing = "" if quantity.size else "failed: the solver gave up, or jumped over upright"
        return Answer(quantity=quantity, message=missing)

    return solve


def _solve(problem: Problem, case: Case, name: SolverName, rates: Rates, rtol: float) -> Array:
    from scipy.integrate import solve_ivp

    start = rates.start
    times = problem.sample_step * np.arange(
        math.ceil(start.start / problem.sample_step), math.floor(start.end / problem.sample_step) + 2
    )
    times = times[: int(np.searchsorted(times, start.end + 1e-9))]
    sampled = problem.name == "shaken"

    def turns_back(t: float, y: Array) -> float:
        return float(y[1])

    def falls(t: float, y: Array) -> float:
        return float(y[0]) - 0.5 * math.pi

    turns_back.direction, falls.terminal = -1.0, True  # type: ignore[attr-defined]
    with np.errstate(all="ignore"):
        run = solve_ivp(
            rates.function,
            (start.start, start.end),
            start.state,
            name,
            t_eval=np.minimum(times, start.end) if sampled else None,
            events=None if sampled else (turns_back, falls),
            rtol=rtol,
            atol=rtol * TOLERANCE_SCALE,
        )
    if not run.success or not np.isfinite(run.y).all() or run.y[0].min() < 0.0:
        return np.empty(0)
    maxima, instants = np.empty((0, 4)), np.empty(0)
    if run.y_events is not None and run.t_events is not None and len(run.t_events[0]):
        maxima, instants = np.asarray(run.y_events[0]), np.asarray(run.t_events[0])
    if problem.name == "turn":
        # the release is a maximum itself
        later = maxima[instants > 0.1]
        return np.degrees(np.abs(later[:1, 2] - start.state[2])) if len(later) else np.empty(0)
    if problem.name == "peaks":
        peak = max(float(run.y[0].max()), float(maxima[:, 0].max(initial=0.0)))
        return np.array([min(peak / case.cylinder.alpha, 1.0)])
    first = len(problem.references["recess"][0]) - run.y.shape[1]
    return np.concatenate([problem.references["recess"][0][:first], run.y[0] / case.cylinder.alpha])
