"""Errors and computing times of all methods on all problems, in turn."""

from __future__ import annotations

import math
import os
import time
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ...storage.origin import Origin, origin_now
from .methods import Method, methods_for
from .problem import Answer, Problem, problems, sampling_distance

if TYPE_CHECKING:
    import pandas as pd

# a run shorter than this is repeated, so that a tick of the clock does not show [s]
_SHORT = 2e-3
_REPEATS = 5
_ROUNDS = 3

Tell = Callable[[str, float], None]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Tradeoff:
    """What was measured.

    Parameters
    ----------
    points : DataFrame
        One row for each problem, line and value of its knob: problem, model, family, line, support, knob,
        value, settings, ratio (of computing times, to the recess kernel at its default tolerance, median
        over the rounds), milliseconds (of processor time of one run, median), error (in the unit of the
        problem; NaN where a run failed), message.
    scenes : DataFrame
        What each part of a scene costs, see `scene_costs`.
    problems : DataFrame
        One row for each problem and model: problem, title, error_title, model, source (what the reference
        is), doubt (its own error), members, chance (what two ensembles of as many members differ by
        chance [alpha]; NaN for a single case).
    rounds : int
        In which all methods ran in turn.
    load : tuple of float
        Of the machine before and after: how many processes wanted to run, ours included, over a minute;
        NaN where the system does not tell.
    origin : Origin
    """

    points: pd.DataFrame
    scenes: pd.DataFrame
    problems: pd.DataFrame
    rounds: int
    load: tuple[float, float]
    origin: Origin


def measure_tradeoff(*, quick: bool = False, command: str = "", tell: Tell | None = None) -> Tradeoff:
    """Measure all methods on all problems.

    Parameters
    ----------
    quick : bool, optional
        Fewer points and fewer members.
    command : str, optional
        What asked for it, to be told with the result.
    tell : callable, optional
        Called with a stage of `stages` and the fraction of it done.
    """
    import pandas as pd

    from .scene_cost import scene_costs

    say = tell or (lambda stage, fraction: None)
    say(STAGES[0], 0.0)
    load = _load()
    found = problems(quick=quick)
    tables = []
    for problem in found:
        methods = methods_for(problem, quick=quick)
        tables.append(_points(problem, methods, _ROUNDS, say))
    say("scenes", 0.0)
    rounds = 3 if quick else 9
    done = 0

    def count(line: str) -> None:
        nonlocal done
        say("scenes", done / rounds)
        done += 1

    scenes = scene_costs(rounds=rounds, steps=500 if quick else 2000, say=count)
    return Tradeoff(
        points=pd.concat(tables, ignore_index=True),
        scenes=scenes,
        problems=pd.DataFrame([row for problem in found for row in _described(problem)]),
        rounds=_ROUNDS,
        load=(load, _load()),
        origin=origin_now(command),
    )


def _described(problem: Problem) -> list[dict[str, Any]]:
    many = len(problem.cases) > 1
    return [
        {
            "problem": problem.name,
            "title": problem.title,
            "error_title": problem.error_title,
            "model": model,
            "source": problem.source[model],
            "doubt": problem.doubt[model],
            "members": len(problem.cases),
            "chance": sampling_distance(problem, model) if many else math.nan,
        }
        for model in problem.references
    ]


STAGES = ("turn", "shaken", "peaks", "scenes")


def _points(problem: Problem, methods: list[Method], rounds: int, say: Tell) -> pd.DataFrame:
    import pandas as pd

    visits = list(range(len(problem.cases))) if len(problem.cases) > 1 else [0] * rounds
    answers: list[list[Answer]] = [[] for _ in methods]
    times = np.full((len(visits), len(methods)), np.nan)
    # compiled, imported, fetched: by the first point of each line, the coarsest
    for place, method in enumerate(methods):
        if not place or method.line != methods[place - 1].line:
            method.solve(problem.cases[0])
    spent = _Cost(len(visits), len(methods))
    for number, visit in enumerate(visits):
        case = problem.cases[visit]
        for place, method in enumerate(methods):
            seconds, answer = _timed(method, case)
            times[number, place] = seconds
            if len(answers[place]) < len(problem.cases):
                answers[place].append(answer)
            say(problem.name, spent.after(number, place, seconds))
    base = next(place for place, method in enumerate(methods) if method.base)
    rows = [
        {
            "problem": problem.name,
            "model": method.model,
            "family": method.family,
            "line": method.line,
            "support": method.support,
            "knob": method.knob,
            "value": method.value,
            "settings": ", ".join(f"{name} {value}" for name, value in method.settings.items()),
            "ratio": float(np.median(times[:, place] / times[:, base])),
            "milliseconds": 1e3 * float(np.median(times[:, place])),
            "error": problem.error(method.model, [answer.quantity for answer in answers[place]]),
            "message": _first(answer.message for answer in answers[place]),
        }
        for place, method in enumerate(methods)
    ]
    return pd.DataFrame(rows)


class _Cost:
    """How much of the work is done: the first round says what each method costs."""

    def __init__(self, rounds: int, methods: int) -> None:
        self._rounds, self._seconds = rounds, np.zeros(methods)

    def after(self, number: int, place: int, seconds: float) -> float:
        if number == 0:
            self._seconds[place] = seconds
            return (place + 1) / len(self._seconds) / self._rounds
        share = float(self._seconds[: place + 1].sum() / self._seconds.sum())
        return (number + share) / self._rounds


def _timed(method: Method, case: Any) -> tuple[float, Answer]:
    """Processor time of this process in one run [s], and what it answered."""
    begin = time.process_time()
    answer = method.solve(case)
    first = time.process_time() - begin
    if first >= _SHORT:
        return first, answer
    again = []
    for _ in range(_REPEATS):
        begin = time.perf_counter()
        method.solve(case)
        again.append(time.perf_counter() - begin)
    # a finer clock, and the least of several: what another process took is not in it
    return min(again), answer


def _load() -> float:
    return os.getloadavg()[0] if hasattr(os, "getloadavg") else math.nan


def _first(messages: Iterable[str]) -> str:
    return next((message for message in messages if message), "")
