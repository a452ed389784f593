"""The methods that solve a problem: a line each, with the tolerances or time steps it is solved at."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from rockwobble import reduced
from rockwobble.models import Case, Run, Trace
from rockwobble.models.diagnostic import joined
from rockwobble.multibody.engines.registry import engine_facts, find_engine, own_engines

from ...runs.choice import require_runnable
from ...runs.execution import simulate_run
from .problem import FINE_REST_TILT, Array, Problem
from .scipy_solver import SOLVERS, Rates, SolverName, solve, start_of

# of the recess model as it comes: every computing time is told as a multiple of its own
BASE_TOLERANCE = 1e-8
BASE_LINE = "recess model"
REST_PANEL = "rest threshold"
_TOLERANCES = (1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11)
# what a held contact time constant is: that of the default settings at a step of 1e-3 s [s]
_HELD = 2e-3
_CHEAP = 5e-5  # [s] of a step: of such an engine the finest steps are worth their time
_DOUBLE = 2.0**-53  # rounding of double precision
_SUPPORTS = ("recess", "flat", "ring")


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class MethodResult:
    """Result of a method on one case: the quantity, empty where it failed, and codes or its refusal."""

    quantity: Array
    said: str = ""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Method:
    """One point of one line.

    Attributes
    ----------
    line : str
        What is the same at all its points.
    family : str
        "reduced", "scipy" or the name of an engine.
    support : {"recess", "flat", "ring"}
        Whose answer is the reference.
    panel : {"methods", "rest threshold", "scipy", "integrator", "contact"}
        What the line is compared with: all kinds of methods, or the variants of one.
    knob : {"tolerance", "time step"}
    value : float
        Of the knob; the smaller the more accurate.
    solve : callable
        (case) -> MethodResult. This is what is timed.
    """

    line: str
    family: str
    support: str
    panel: str
    knob: str
    value: float
    solve: Callable[[Case], MethodResult]

    @property
    def base(self) -> bool:
        """Whether all times are multiples of this one's."""
        return self.line == BASE_LINE and self.value == BASE_TOLERANCE


def methods_for(problem: Problem, *, quick: bool = False) -> list[Method]:
    """Return all methods that can answer a problem with what is installed here."""
    return [*_reduced(problem, quick), *_scipy(problem, quick), *_engines(problem, quick)]


def _reduced(problem: Problem, quick: bool) -> Iterator[Method]:
    tolerances = sorted({*(_TOLERANCES[1::2] if quick else _TOLERANCES), BASE_TOLERANCE}, reverse=True)
    lines = [("methods", Run(None, "recess")), ("methods", Run(None, "flat"))]
    if problem.name != "turn":  # on still ground nothing comes to rest
        lines += [(REST_PANEL, Run(None, "recess", rest_tilt=at)) for at in (FINE_REST_TILT, 1e-5, 0.1)]
    for panel, run in lines:
        rest_tilt = run.settings.get("rest_tilt", reduced.REST_TILT)
        for rtol in tolerances:
            yield Method(
                line=str(run) if panel == "methods" else rest_line(rest_tilt),
                family="reduced",
                support=run.support,
                panel=panel,
                knob="tolerance",
                value=rtol,
                solve=partial(_by_model, problem, run.support, rtol, rest_tilt),
            )


def rest_line(rest_tilt: float) -> str:
    """Return the line of the recess model with a rest threshold of its own."""
    return f"rest threshold {rest_tilt:g}"


def _by_model(problem: Problem, support: str, rtol: float, rest_tilt: float, case: Case) -> MethodResult:
    # not by a `Run`, which has forces computed that nobody asks for here
    trace = reduced.simulate(
        case, support=support, rtol=rtol, rest_tilt=rest_tilt, sample_step=problem.sample_step
    )
    return _result(problem, trace)


def _scipy(problem: Problem, quick: bool) -> Iterator[Method]:
    tolerances: tuple[float, ...] = (1e-3, 1e-5, 1e-7, 1e-9)
    languages = {"Python": False, "numba": True}
    if problem.name == "peaks":  # a compilation for every member would be all that is measured
        tolerances, languages = tolerances[:3], {"Python": False}
    if quick:
        tolerances, languages = tolerances[:2], {"Python": False}
    for language, compiled in languages.items():
        rates = {case.name: start_of(case, compiled=compiled) for case in problem.cases}
        for name in SOLVERS:
            for rtol in tolerances:
                yield Method(
                    line=f"{name}, {language}",
                    family="scipy",
                    support="recess",
                    panel="scipy",
                    knob="tolerance",
                    value=rtol,
                    solve=partial(_by_scipy, problem, name, rates, rtol),
                )


def _by_scipy(
    problem: Problem, name: SolverName, rates: Mapping[str, Rates], rtol: float, case: Case
) -> MethodResult:
    quantity = solve(problem, case, name, rates[case.name], rtol)
    return MethodResult(quantity=quantity, said="" if quantity.size else "gave up, or jumped over upright")


def _engines(problem: Problem, quick: bool) -> Iterator[Method]:
    for engine in own_engines():
        known = find_engine(engine)
        # in single precision a step below the default gains nothing: a line of its own would say only that
        if known.facts.rounding > _DOUBLE or (problem.name != "turn" and not known.uplifts):
            continue
        for support in (each for each in _SUPPORTS if each in known.supports and each in problem.references):
            all_steps = known.facts.step_time < _CHEAP and support != "ring"
            steps = problem.steps if all_steps else problem.few_steps
            yield from _line(problem, f"{engine} {support}", "methods", engine, support, steps, {})
        if problem.name != "peaks" and known.facts.contact_time:
            yield from _variants(problem, engine, quick)


def _variants(problem: Problem, engine: str, quick: bool) -> Iterator[Method]:
    """Other integrators and other contact than the default, in a recess."""
    facts, steps = engine_facts(engine), problem.few_steps
    for given in facts.alternatives.values():
        name = given.get("integrator")
        if name == "RK4" or (name and not quick):
            yield from _line(problem, name, "integrator", engine, "recess", steps, given)
    held = {facts.contact_time: _HELD}
    yield from _line(problem, f"contact time {_HELD:g} s", "contact", engine, "recess", steps, held)
    for count in (20.0,) if quick else (4.0, 20.0):
        line = f"contact time {count:g} steps"
        yield from _line(problem, line, "contact", engine, "recess", steps, {}, count)


def _line(
    problem: Problem,
    line: str,
    panel: str,
    engine: str,
    support: str,
    steps: Sequence[float],
    settings: Mapping[str, object],
    contact_steps: float = math.nan,
) -> Iterator[Method]:
    for step in steps:
        contact = (
            {engine_facts(engine).contact_time: contact_steps * step} if math.isfinite(contact_steps) else {}
        )
        yield Method(
            line=line,
            family=engine,
            support=support,
            panel=panel,
            knob="time step",
            value=step,
            solve=partial(_by_engine, problem, Run(engine, support, step, **settings, **contact)),
        )


def _by_engine(problem: Problem, run: Run, case: Case) -> MethodResult:
    try:
        require_runnable(case, run)
    except ValueError as refusal:
        return MethodResult(quantity=np.empty(0), said=str(refusal))
    return _result(problem, simulate_run(case, run, sample_step=problem.sample_step))


def _result(problem: Problem, trace: Trace) -> MethodResult:
    quantity = np.empty(0) if trace.outcome == "failed" else problem.quantity(trace)
    return MethodResult(quantity=quantity, said=joined(fact.code for fact in trace.facts))
