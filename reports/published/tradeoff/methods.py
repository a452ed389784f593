"""Methods that solve a problem, one line each over tolerances or time steps.

Among them scipy's solvers on the equations of the recess model, as somebody without this package would use
them: as one writes them for scipy, in plain Python; numba may compile them, and scipy still calls them
through Python. A solver starts with a release, or just after the uplift that the recess model finds: at rest
the equations are singular. It neither brings the cylinder to rest nor uplifts it again.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import partial
from math import cos, sin
from typing import Literal

import numba
import numpy as np
from scipy.integrate import solve_ivp

from rockwobble import multibody, reduced
from rockwobble.models import Case, GroundMotion, Run, Trace
from rockwobble.reports.published.tradeoff.problem import (
    ENGINES,
    FINE_REST_TILT,
    RECESS,
    SUPPORTS,
    TIGHT,
    Array,
    Problem,
    simulate,
)

RatesFunction = Callable[[float, Array], list[float]]  # (t, y) -> y'
SolverName = Literal["RK45", "DOP853", "LSODA"]
SOLVERS: tuple[SolverName, ...] = ("RK45", "DOP853", "LSODA")
# of tilt, its rate, rolling angle and momentum: times the relative tolerance they are the absolute ones
TOLERANCE_SCALE = np.array([1e-3, 1e-3, 1.0, 1e-3])
_SWING = 10.0  # of sqrt(R/g): for which a swing is followed past the end
_AFTER_UPLIFT = 2e-3  # [s]
_INSTANT = 1e-9  # of motion, for the momentum of a release [s]
# unit of all computing times: the recess model at its default tolerance
BASE_LINE = str(Run(None, RECESS))
BASE_TOLERANCE = 1e-8
REST_PANEL = "rest threshold"
_TOLERANCES = (1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11)
# what a fixed contact time constant is: that of the default settings at a step of 1e-3 s [s]
_FIXED = 2e-3
_CHEAP = 5e-5  # [s] of a step: of such an engine the finest steps are worth their time
_DOUBLE = 2.0**-53  # rounding of double precision


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class MethodResult:
    """Result of a method on one case: quantity (empty if failed), and diagnostic codes or refusal."""

    quantity: Array
    said: str = ""


Solve = Callable[[Case], MethodResult]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Method:
    """One point of a line: a method at one tolerance or time step.

    Attributes
    ----------
    support : {"recess", "flat", "ring"}
        Whose answer is the reference.
    panel : {"methods", "rest threshold", "scipy", "integrator", "contact"}
        What the line is compared with: all kinds of methods, or the variants of one.
    family : str
        "reduced", "scipy" or the name of an engine.
    line : str
        What is the same at all its points.
    knob : {"tolerance", "time step"}
    value : float
        Value of the knob; the smaller the more accurate.
    solve : callable
        (case) -> MethodResult. This is what is timed.
    """

    support: str
    panel: str
    family: str
    line: str
    knob: str
    value: float
    solve: Solve

    @property
    def base(self) -> bool:
        """Whether this method is the unit of all computing times."""
        return self.line == BASE_LINE and self.value == BASE_TOLERANCE


def methods_for(problem: Problem, *, quick: bool = False) -> list[Method]:
    """All installed methods that can solve a problem."""
    return [*_model_methods(problem, quick), *_scipy(problem, quick), *_engines(problem, quick)]


def _line(
    line: str,
    family: str,
    solved: Mapping[float, Solve],
    *,
    panel: str = "methods",
    support: str = RECESS,
    knob: str = "tolerance",
) -> Iterator[Method]:
    """Yield the points of a line; `solved`: solutions by setting value."""
    for value, solve in solved.items():
        yield Method(
            support=support, panel=panel, family=family, line=line, knob=knob, value=value, solve=solve
        )


def _model_methods(problem: Problem, quick: bool) -> Iterator[Method]:
    tolerances = sorted({*(_TOLERANCES[1::2] if quick else _TOLERANCES), BASE_TOLERANCE}, reverse=True)
    for support in reduced.SUPPORTS:
        solve = partial(_by_model, problem, support, reduced.REST_TILT)
        solved = {rtol: partial(solve, rtol) for rtol in tolerances}
        yield from _line(str(Run(None, support)), "reduced", solved, support=support)
    # a release on still ground never rests
    for rest_tilt in () if problem.name == "turn" else (FINE_REST_TILT, 1e-5, 0.1):
        solved = {rtol: partial(_by_model, problem, RECESS, rest_tilt, rtol) for rtol in tolerances}
        yield from _line(rest_line(rest_tilt), "reduced", solved, panel=REST_PANEL)


def rest_line(rest_tilt: float) -> str:
    """Name of the line of the recess model with this rest threshold."""
    return f"rest threshold {rest_tilt:g}"


def _by_model(problem: Problem, support: str, rest_tilt: float, rtol: float, case: Case) -> MethodResult:
    # not by a `Run`, which has forces computed that nobody asks for here
    trace = reduced.simulate(
        case, support=support, rtol=rtol, rest_tilt=rest_tilt, sample_step=problem.sample_step
    )
    return _result(problem, trace)


def _scipy(problem: Problem, quick: bool) -> Iterator[Method]:
    tolerances: tuple[float, ...] = (1e-3, 1e-5, 1e-7, 1e-9)
    languages = {"Python": False, "numba": True}
    if problem.name == "peaks":  # compilation would dominate every member
        tolerances, languages = tolerances[:3], {"Python": False}
    if quick:
        tolerances, languages = tolerances[:2], {"Python": False}
    for language, compiled in languages.items():
        rates = {case.name: start_of(case, compiled=compiled) for case in problem.cases}
        for name in SOLVERS:
            solved = {rtol: partial(_by_scipy, problem, name, rates, rtol) for rtol in tolerances}
            yield from _line(f"{name}, {language}", "scipy", solved, panel="scipy")


def _engines(problem: Problem, quick: bool) -> Iterator[Method]:
    for engine in ENGINES:
        known = multibody.find_engine(engine)
        # in single precision a step below the default gains nothing: a line of its own would say only that
        if known.facts.rounding > _DOUBLE or (problem.name != "turn" and not known.uplifts):
            continue
        for support in SUPPORTS:
            if support in known.supports and support in problem.references:
                all_steps = known.facts.step_time < _CHEAP and support != "ring"
                steps = problem.steps if all_steps else problem.few_steps
                runs = {step: Run(engine, support, step) for step in steps}
                yield from _engine_line(problem, f"{engine} {support}", "methods", runs)
        if problem.name != "peaks" and known.facts.contact_time:
            yield from _variants(problem, engine, quick)


def _variants(problem: Problem, engine: str, quick: bool) -> Iterator[Method]:
    """Lines of other integrators and contact settings, in a recess."""
    facts, steps = multibody.find_engine(engine).facts, problem.few_steps
    for given in facts.alternatives.values():
        name = given.get("integrator")
        if name == "RK4" or (name and not quick):
            runs = {step: Run(engine, RECESS, step, **given) for step in steps}
            yield from _engine_line(problem, str(name), "integrator", runs)
    times = {f"contact time {_FIXED:g} s": dict.fromkeys(steps, _FIXED)}
    for count in (20.0,) if quick else (4.0, 20.0):
        times[f"contact time {count:g} steps"] = {step: count * step for step in steps}
    for line, contact in times.items():
        runs = {
            step: Run(engine, RECESS, step, **{facts.contact_time: time}) for step, time in contact.items()
        }
        yield from _engine_line(problem, line, "contact", runs)


def _engine_line(problem: Problem, line: str, panel: str, runs: Mapping[float, Run]) -> Iterator[Method]:
    run = next(iter(runs.values()))
    solved = {step: partial(_by_engine, problem, each) for step, each in runs.items()}
    yield from _line(line, run.engine_name, solved, panel=panel, support=run.support, knob="time step")


def _by_engine(problem: Problem, run: Run, case: Case) -> MethodResult:
    try:
        return _result(problem, simulate(problem, case, run))
    except ValueError as refusal:
        return MethodResult(quantity=np.empty(0), said=str(refusal))


def _result(problem: Problem, trace: Trace) -> MethodResult:
    quantity = np.empty(0) if trace.outcome == "failed" else problem.quantity(trace)
    return MethodResult(quantity=quantity, said=", ".join(dict.fromkeys(fact.code for fact in trace.facts)))


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Rates:
    """Equations of motion of a case with their initial state.

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
    """Equations of a case with their initial state at release, or just after uplift."""
    begin = _departure(case) if case.initial is None else _INSTANT
    reach = reduced.simulate(dataclasses.replace(case, duration=begin), rtol=TIGHT)
    names = ("tilt", "tilt_rate", "rolling_angle", "rolling_rate")
    theta, omega, phi, phi_rate = (float(getattr(reach, name)[-1]) for name in names)
    state = np.array([theta, omega, phi, _inertia(case, theta) * phi_rate])
    return Rates(function=rates_of(case, compiled=compiled), start=begin, end=case.length, state=state)


def _inertia(case: Case, theta: float) -> float:
    """B of a homogeneous cylinder over its mass [m^2]: inertia of the rolling angle."""
    b, h = case.cylinder.base_radius, case.cylinder.half_height
    J, E, C = 0.25 * b * b + 4.0 / 3.0 * h * h, h * b, 1.5 * b * b
    t = math.tan(0.5 * theta)
    return sin(theta) ** 2 * (J + 2.0 * E * t + C * t * t)


def rates_of(case: Case, *, compiled: bool) -> RatesFunction:
    """Equations of a case, (t, y) -> y', as plain Python or compiled."""
    motion = case.motion or GroundMotion(np.zeros((2, 2)), case.length)
    # still ground for the swing at the end, and a sample more for the last stage of a solver
    beyond = math.ceil(_SWING / (motion.time_step * math.sqrt(9.81 / case.cylinder.semidiagonal))) + 2
    padded = np.vstack([motion.acceleration[:, :2], np.zeros((beyond, 2))])
    # Python floats are faster than arrays in uncompiled code
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
    function: RatesFunction = numba.njit()(rates)
    return function


def _departure(case: Case) -> float:
    """Time just after the last uplift before the peak [s]; earlier motion is irrelevant."""
    run = reduced.simulate(case, rtol=TIGHT)
    resting = np.flatnonzero(np.isnan(run.rolling_angle[: int(np.argmax(run.tilt)) + 1]))
    last = int(resting[-1]) if len(resting) else 0
    if math.isnan(run.uplift_time):
        raise ValueError(f"{case.name} never uplifts: scipy has nothing to solve")
    return max(float(run.time[last + 1]), run.uplift_time + _AFTER_UPLIFT)


def _by_scipy(
    problem: Problem, name: SolverName, rates: Mapping[str, Rates], rtol: float, case: Case
) -> MethodResult:
    quantity = solve(problem, case, name, rates[case.name], rtol)
    return MethodResult(quantity=quantity, said="" if quantity.size else "gave up, or jumped over upright")


def solve(problem: Problem, case: Case, name: SolverName, rates: Rates, rtol: float) -> Array:
    """Answer of a `SOLVERS` solver to a problem; empty if it gave up or a tilt is negative."""
    integrate = partial(solve_ivp, rates.function, method=name, rtol=rtol, atol=rtol * TOLERANCE_SCALE)
    step, reference = problem.sample_step, problem.references[RECESS].quantities[0]
    times = step * np.arange(math.ceil(rates.start / step), math.floor(rates.end / step) + 2)
    times = times[: int(np.searchsorted(times, rates.end + 1e-9))]
    sampled = problem.name == "shaken"

    def turns_back(t: float, y: Array) -> float:
        return float(y[1])

    def overturns(t: float, y: Array) -> float:
        return float(y[0]) - 0.5 * math.pi

    turns_back.direction, overturns.terminal = -1.0, True  # type: ignore[attr-defined]
    with np.errstate(all="ignore"):
        run = integrate(
            (rates.start, rates.end),
            rates.state,
            t_eval=np.minimum(times, rates.end) if sampled else None,
            events=None if sampled else (turns_back, overturns),
        )
    if not run.success or not np.isfinite(run.y).all() or run.y[0].min() < 0.0:
        return np.empty(0)
    if sampled:  # before the start: at rest, or as the recess model
        return np.concatenate([reference[: len(reference) - run.y.shape[1]], run.y[0] / case.cylinder.alpha])
    instants = (run.t_events or [np.empty(0)])[0]
    maxima = np.asarray((run.y_events or [np.empty(0)])[0]).reshape(-1, 4)
    if problem.name == "turn":  # release is a maximum itself
        return np.asarray(np.degrees(np.abs(maxima[instants > 0.1][:1, 2] - rates.state[2])))
    peak = max(float(run.y[0].max()), float(maxima[:, 0].max(initial=0.0)))
    if run.status == 0:  # still moving, so followed to its next maximum
        turns_back.terminal = True  # type: ignore[attr-defined]
        span = rates.end, rates.end + _SWING / math.sqrt(9.81 / case.cylinder.semidiagonal)
        peak = max(peak, float(integrate(span, run.y[:, -1], events=turns_back).y[0].max()))
    return np.array([min(peak / case.cylinder.alpha, 1.0)])
