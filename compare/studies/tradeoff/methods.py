"""The methods that answer a problem: a line each, with the points of the knob that trades speed for error."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rockwobble import multibody, reduced
from rockwobble.models import Case, Run
from rockwobble.multibody.engines.registry import engine_facts, engine_packages, find_engine

from ...runs.choice import own_model
from ...runs.execution import run_engine
from .problem import FINE_REST_TILT, Answer, Problem
from .scipy_equations import SOLVERS
from .scipy_methods import Rates, compiled, plain, scipy_answer

Array = NDArray[np.float64]

# of the kernel as it comes: computing times are told as multiples of its own
BASE_TOLERANCE = 1e-8
_TOLERANCES = (1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11)
_STEPS = (1e-3, 5e-4, 2e-4, 1e-4, 5e-5, 2e-5)
_QUICK_STEPS = (1e-3, 5e-4, 2e-4)
# what a held contact time constant is: that of the default settings at a step of 1e-3 s [s]
_HELD = 2e-3
_CHEAP = 2e-5  # [s] of a step: of such an engine the finest steps are worth their time


@dataclass(frozen=True, slots=True, kw_only=True)
class Method:
    """One point of one line.

    Parameters
    ----------
    line : str
        The line: what is the same at all its points.
    family : str
        "reduced", "scipy" or the name of an engine.
    model : {"recess", "flat"}
        Whose answer is the reference.
    knob : {"tolerance", "time step"}
    value : float
        Of the knob; the smaller the more accurate.
    solve : callable
        (case) -> Answer. This is what is timed.
    support, settings :
        Of an engine, for the table.
    """

    line: str
    family: str
    model: str
    knob: str
    value: float
    solve: Callable[[Case], Answer]
    support: str = ""
    settings: dict[str, Any] = field(default_factory=dict)

    @property
    def base(self) -> bool:
        """Whether times are told as multiples of this one's."""
        return self.line == _BASE_LINE and self.value == BASE_TOLERANCE


_BASE_LINE = "reduced, recess"


def methods_for(problem: Problem, *, quick: bool = False) -> list[Method]:
    """Return all methods that can answer a problem with what is installed here."""
    return [
        *_reduced(problem, quick),
        *_scipy(problem, quick),
        *(method for line in _engine_lines(problem, quick) for method in line),
    ]


def _reduced(problem: Problem, quick: bool) -> list[Method]:
    chosen = _TOLERANCES[1::2] if quick else _TOLERANCES
    tolerances = sorted({*chosen, BASE_TOLERANCE}, reverse=True)
    lines: list[tuple[str, str, float | None]] = [
        (_BASE_LINE, "recess", None),
        ("reduced, rolling", "flat", None),
    ]
    if problem.name != "turn":  # still ground seats nobody
        lines[1:1] = [
            (f"reduced, rest threshold {FINE_REST_TILT:g}", "recess", FINE_REST_TILT),
            ("reduced, rest threshold 1e-05", "recess", 1e-5),
            ("reduced, rest threshold 0.1", "recess", 1e-1),
        ]

    def solver(model: str, rtol: float, rest_tilt: float | None) -> Callable[[Case], Answer]:
        def solve(case: Case) -> Answer:
            given = {} if rest_tilt is None else {"rest_tilt": rest_tilt}
            response = reduced.simulate(
                case.cylinder,
                case.motion,
                initial=case.initial,
                duration=case.duration,
                rtol=rtol,
                sample_step=problem.sample_step,
                model=model,
                **given,
            )
            return _answer(problem, response, case)

        return solve

    return [
        Method(
            line=line,
            family="reduced",
            model=model,
            knob="tolerance",
            value=rtol,
            solve=solver(model, rtol, rest_tilt),
            settings={} if rest_tilt is None else {"rest_tilt": rest_tilt},
        )
        for line, model, rest_tilt in lines
        for rtol in tolerances
    ]


def _scipy(problem: Problem, quick: bool) -> list[Method]:
    tolerances: tuple[float, ...] = (
        (1e-3, 1e-5, 1e-7, 1e-9) if problem.name != "peaks" else (1e-3, 1e-5, 1e-7)
    )
    languages: list[tuple[str, Callable[[Case], Rates]]] = [("Python", plain)]
    if quick:
        tolerances = tolerances[:2]
    elif problem.name != "peaks":  # a compilation for every member would be all that is measured
        languages.append(("numba", compiled))
    found = []
    for language, make in languages:
        rates = {case.name: make(case) for case in problem.cases}
        found += [
            Method(
                line=f"scipy {name}, {language}",
                family="scipy",
                model="recess",
                knob="tolerance",
                value=rtol,
                solve=scipy_answer(problem, name, rates, rtol),
            )
            for name in SOLVERS
            for rtol in tolerances
        ]
    return found


def _engine_lines(problem: Problem, quick: bool) -> list[list[Method]]:
    steps: tuple[float, ...] = _QUICK_STEPS if quick else _STEPS
    few = steps[:2] if quick else steps[:5]
    if problem.name == "peaks":
        steps = few = steps[:2] if quick else steps[:4]
    lines: list[list[Method]] = []

    def line(
        name: str, steps: Sequence[float], given: Mapping[str, Any] | None = None, contact: float = math.nan
    ) -> None:
        # of the engine and the support of the loops below
        lines.append([_engine(problem, name, engine, support, step, given or {}, contact) for step in steps])

    installed = [name for name in engine_packages() if name in multibody.available_engines()]
    # what cannot uplift has a part only where a cylinder is released
    able = [name for name in installed if problem.name == "turn" or find_engine(name).uplifts]
    for engine in able:
        facts, supports = engine_facts(engine), find_engine(engine).supports
        for support in supports:
            cheap = facts.step_time < _CHEAP and support != "ring"
            line(f"{facts.title} {support}", steps if cheap else few)
        if problem.name == "peaks" or not facts.contact_time:
            continue
        support = supports[0]
        integrators = [each for each in facts.alternatives.items() if "integrator" in each[1]]
        for option, given in integrators:
            if quick and given["integrator"] != "RK4":
                continue
            line(f"{facts.title} {option.removeprefix('integrator ')}", few, given)
        for contact in (20.0,) if quick else (4.0, 20.0):
            line(f"{facts.title} contact {contact:g} steps", few, contact=contact)
        line(f"{facts.title} contact {1e3 * _HELD:g} ms", few, {facts.contact_time: _HELD})
    return lines


def _engine(
    problem: Problem,
    name: str,
    engine: str,
    support: str,
    step: float,
    given: Mapping[str, Any],
    contact: float,
) -> Method:
    settings = dict(given)
    if math.isfinite(contact):
        settings[engine_facts(engine).contact_time] = contact * step

    def solve(case: Case) -> Answer:
        try:
            run = Run(engine, support, step, **settings)
            trajectory = run_engine(case, run, sample_step=problem.sample_step)
        except ValueError as refusal:
            return Answer(quantity=np.empty(0), message=f"refused: {refusal}")
        return _answer(problem, trajectory, case)

    return Method(
        line=name,
        family=engine,
        model=own_model(support),
        knob="time step",
        value=step,
        solve=solve,
        support=support,
        settings=settings,
    )


def _answer(problem: Problem, trace: Any, case: Case) -> Answer:
    if trace.outcome == "failed":
        return Answer(quantity=np.empty(0), message=f"failed: {trace.message}")
    return Answer(quantity=problem.quantity(trace, case), message=trace.message)
