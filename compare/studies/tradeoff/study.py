"""Errors and computing times of all methods on all problems, in turn: in this process, one after another."""

from __future__ import annotations

import math
import os
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from rockwobble.models import Case

from .methods import Answer, Method, methods_for
from .problem import Problem, problems, sampling_distance
from .scene_cost import scene_costs

if TYPE_CHECKING:
    import pandas as pd

STAGES = ("turn", "shaken", "peaks", "scenes")
# a run shorter than this is repeated, so that a tick of the clock does not show [s]
_SHORT = 2e-3
_REPEATS = 5
ROUNDS = 3  # of a single case; an ensemble has as many as members

Tell = Callable[[str, float], None]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Tradeoff:
    """What was measured.

    Attributes
    ----------
    points : DataFrame
        One row for each problem, line and value of its knob: problem, support, panel, family, line, knob,
        value, ratio, ratio_low, ratio_high (of computing times, to the recess model at its default tolerance
        on the same problem: median and quartiles over the rounds), milliseconds (of processor time of one
        run, median), error (in the unit of the problem; NaN where a run failed), said.
    scenes : DataFrame
        What each part of a scene costs, see `scene_costs`.
    problems : DataFrame
        One row for each problem and support: problem, support, source and doubt of the reference, members,
        chance (what two ensembles of as many members differ by chance [alpha]; NaN for a single case).
    load : tuple of float
        Of the machine before and after: how many processes wanted to run, ours included, over a minute;
        NaN where the system does not tell.
    """

    points: pd.DataFrame
    scenes: pd.DataFrame
    problems: pd.DataFrame
    load: tuple[float, float]


def measure_tradeoff(*, quick: bool = False, tell: Tell | None = None) -> Tradeoff:
    """Measure all methods on all problems.

    Parameters
    ----------
    quick : bool, optional
        Fewer points and fewer members.
    tell : callable, optional
        Called with a stage of `STAGES` and the fraction of it done.
    """
    import pandas as pd

    say = tell or (lambda stage, fraction: None)
    before = _load()
    points, described = [], []
    for problem in problems(quick=quick):
        say(problem.name, 0.0)
        points.append(_points(problem, methods_for(problem, quick=quick), say))
        described.append(_described(problem))
    rounds = 3 if quick else 9
    scenes = scene_costs(
        rounds=rounds, steps=500 if quick else 2000, tell=lambda done: say("scenes", done / rounds)
    )
    return Tradeoff(
        points=pd.concat(points, ignore_index=True),
        scenes=scenes,
        problems=pd.concat(described, ignore_index=True),
        load=(before, _load()),
    )


def _described(problem: Problem) -> pd.DataFrame:
    import pandas as pd

    many = len(problem.cases) > 1
    return pd.DataFrame(
        {
            "problem": problem.name,
            "support": support,
            "source": reference.source,
            "doubt": reference.doubt,
            "members": len(problem.cases),
            "chance": sampling_distance(problem, support) if many else math.nan,
        }
        for support, reference in problem.references.items()
    )


def _points(problem: Problem, methods: list[Method], say: Tell) -> pd.DataFrame:
    import pandas as pd

    visits = list(problem.cases) if len(problem.cases) > 1 else list(problem.cases) * ROUNDS
    answers: list[list[Answer]] = [[] for _ in methods]
    seconds = np.full((len(visits), len(methods)), np.nan)
    # compiled, imported, fetched: by the first point of each line, the coarsest
    for place, method in enumerate(methods):
        if not place or method.line != methods[place - 1].line:
            method.solve(problem.cases[0])
    for number, case in enumerate(visits):
        for place, method in enumerate(methods):
            seconds[number, place], answer = _timed(method, case)
            if len(answers[place]) < len(problem.cases):
                answers[place].append(answer)
            say(problem.name, _share_done(seconds, number, place))
    base = next(place for place, method in enumerate(methods) if method.base)
    ratios = seconds / seconds[:, [base]]
    low, middle, high = np.quantile(ratios, (0.25, 0.5, 0.75), axis=0)
    return pd.DataFrame(
        {
            "problem": problem.name,
            "support": method.support,
            "panel": method.panel,
            "family": method.family,
            "line": method.line,
            "knob": method.knob,
            "value": method.value,
            "ratio": middle[place],
            "ratio_low": low[place],
            "ratio_high": high[place],
            "milliseconds": 1e3 * float(np.median(seconds[:, place])),
            "error": problem.error(method.support, [answer.quantity for answer in answers[place]]),
            "said": next((answer.said for answer in answers[place] if answer.said), ""),
        }
        for place, method in enumerate(methods)
    )


def _share_done(seconds: np.ndarray[tuple[int, int], np.dtype[np.float64]], number: int, place: int) -> float:
    """How much of the work is done: the first round says what each method costs."""
    rounds, methods = seconds.shape
    if number == 0:
        return (place + 1) / methods / rounds
    return (number + float(seconds[0, : place + 1].sum() / seconds[0].sum())) / rounds


def _timed(method: Method, case: Case) -> tuple[float, Answer]:
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
