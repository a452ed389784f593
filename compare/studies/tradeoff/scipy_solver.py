"""scipy's solvers on the equations of the recess model, as somebody without this package would use them.

The equations stand here as one writes them for scipy, in plain Python; numba may compile them, and scipy
still calls them through Python. A solver starts with a release, or just after the uplift that the recess
model finds: at rest the equations are singular. It neither brings the cylinder to rest nor uplifts it again.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable
from dataclasses import dataclass
from math import cos, sin
from typing import Literal

import numba
import numpy as np
from scipy.integrate import solve_ivp

from rockwobble import reduced
from rockwobble.models import Case, GroundMotion
from rockwobble.reduced.solution import Solution

from .problem import TIGHT, Array, Problem

RatesFunction = Callable[[float, Array], list[float]]  # (t, y) -> y'
SolverName = Literal["RK45", "DOP853", "LSODA"]
SOLVERS: tuple[SolverName, ...] = ("RK45", "DOP853", "LSODA")
# of tilt, its rate, rolling angle and momentum: times the relative tolerance they are the absolute ones
TOLERANCE_SCALE = np.array([1e-3, 1e-3, 1.0, 1e-3])
_SWING = 10.0  # of sqrt(R/g): for which a swing is followed past the end
_AFTER_UPLIFT = 2e-3  # [s]
_INSTANT = 1e-9  # of motion, for the momentum of a release [s]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Rates:
    """The equations of a case and where they start.

    Attributes
    ----------
    function : callable
        (t, y) -> y'; Python or compiled.
    start, end : float
        In the time of the ground motion [s].
    state : ndarray, shape (4,)
        Tilt [rad], its rate [rad/s], rolling angle [rad] and momentum per mass [m^2/s] at the start.
    """

    function: RatesFunction
    start: float
    end: float
    state: Array


def start_of(case: Case, *, compiled: bool) -> Rates:
    """Return the equations of a case from its release, or from just after its uplift."""
    begin = _departure(case) if case.initial is None else _INSTANT
    reach = reduced.simulate(dataclasses.replace(case, duration=begin), rtol=TIGHT)
    assert isinstance(reach.source, Solution)
    function = rates_of(case, compiled=compiled)
    return Rates(function=function, start=begin, end=case.length, state=reach.source.states[-1, :4])


def rates_of(case: Case, *, compiled: bool) -> RatesFunction:
    """Return the equations of a case, (t, y) -> y', as plain Python or compiled."""
    motion = case.motion or GroundMotion(np.zeros((2, 2)), case.length)
    # still ground for the swing that goes on at the end, and a sample more for the last stage of a solver
    beyond = math.ceil(_SWING / (motion.time_step * math.sqrt(9.81 / case.cylinder.semidiagonal))) + 2
    padded = np.vstack([motion.acceleration[:, :2], np.zeros((beyond, 2))])
    # numbers of Python are quicker than those of an array, where nothing compiles
    samples: Array | list[tuple[float, ...]] = padded if compiled else [tuple(row) for row in padded.tolist()]
    per_second, cylinder = 1.0 / motion.time_step, case.cylinder
    b, h = cylinder.base_radius, cylinder.half_height
    I1, I2, g = (3.0 * b * b + 4.0 * h * h) / 12.0, 0.5 * b * b, 9.81
    A, J, C, E = I1 + h * h + b * b, I1 + h * h, I2 + b * b, h * b

    def rates(t: float, y: Array) -> list[float]:
        theta, omega, phi, L = y
        position = t * per_second
        i = int(position)
        part = position - i
        (ax, ay), (bx, by) = samples[i], samples[i + 1]
        ax += (bx - ax) * part
        ay += (by - ay) * part
        s, c = sin(theta), cos(theta)
        v = s * s / (1.0 + c)
        B = J * s * s + (2.0 * E * s + C * v) * v
        phi_rate = L / B
        sp, cp = sin(phi), cos(phi)
        lever = h * s + b * v
        acceleration = ((J * c + C * v) * s + E * (c * v + s * s)) * phi_rate * phi_rate
        acceleration -= g * (b * c - h * s) + (b * s + h * c) * (ax * cp + ay * sp)
        return [omega, acceleration / A, phi_rate, lever * (ax * sp - ay * cp)]

    if not compiled:
        return rates
    found: RatesFunction = numba.njit()(rates)
    return found


def _departure(case: Case) -> float:
    """Return a time just after the last uplift before the peak [s]: what is before it is at rest."""
    run = reduced.simulate(case, rtol=TIGHT)
    resting = np.flatnonzero(np.isnan(run.rolling_angle[: int(np.argmax(run.tilt)) + 1]))
    last = int(resting[-1]) if len(resting) else 0
    if math.isnan(run.uplift_time):
        raise ValueError(f"{case.name} never uplifts: scipy has nothing to solve")
    return max(float(run.time[last + 1]), run.uplift_time + _AFTER_UPLIFT)


def solve(problem: Problem, case: Case, name: SolverName, rates: Rates, rtol: float) -> Array:
    """Return the answer to a problem by one of `SOLVERS`; nothing where it gave up or jumped over upright."""
    step, reference = problem.sample_step, problem.references["recess"].quantities[0]
    times = step * np.arange(math.ceil(rates.start / step), math.floor(rates.end / step) + 2)
    times = times[: int(np.searchsorted(times, rates.end + 1e-9))]
    sampled = problem.name == "shaken"

    def turns_back(t: float, y: Array) -> float:
        return float(y[1])

    def overturns(t: float, y: Array) -> float:
        return float(y[0]) - 0.5 * math.pi

    turns_back.direction, overturns.terminal = -1.0, True  # type: ignore[attr-defined]
    with np.errstate(all="ignore"):
        run = solve_ivp(
            rates.function,
            (rates.start, rates.end),
            rates.state,
            name,
            t_eval=np.minimum(times, rates.end) if sampled else None,
            events=None if sampled else (turns_back, overturns),
            rtol=rtol,
            atol=rtol * TOLERANCE_SCALE,
        )
    if not run.success or not np.isfinite(run.y).all() or run.y[0].min() < 0.0:
        return np.empty(0)
    if sampled:  # before the start it stood, or moved as the recess model does
        return np.concatenate([reference[: len(reference) - run.y.shape[1]], run.y[0] / case.cylinder.alpha])
    instants = (run.t_events or [np.empty(0)])[0]
    maxima = np.asarray((run.y_events or [np.empty(0)])[0]).reshape(-1, 4)
    if problem.name == "turn":  # the release is a maximum itself
        return np.asarray(np.degrees(np.abs(maxima[instants > 0.1][:1, 2] - rates.state[2])))
    peak = max(float(run.y[0].max()), float(maxima[:, 0].max(initial=0.0)))
    if run.status == 0:  # it moves, and swings on to its next maximum
        turns_back.terminal = True  # type: ignore[attr-defined]
        span = rates.end, rates.end + _SWING / math.sqrt(9.81 / case.cylinder.semidiagonal)
        swing = solve_ivp(
            rates.function,
            span,
            run.y[:, -1],
            name,
            events=turns_back,
            rtol=rtol,
            atol=rtol * TOLERANCE_SCALE,
        )
        peak = max(peak, float(swing.y[0].max()))
    return np.array([min(peak / case.cylinder.alpha, 1.0)])
