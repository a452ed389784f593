"""Errors and computing times of all methods on all problems, in turn: in this process, one after another."""

from __future__ import annotations

import math
import os
import time
from dataclasses import dataclass

import numpy as np
import pandas as pd

from rockwobble.models import Case

from ...runs.progress import ProgressCallback, Stage, Stages
from ...storage.manifest import Number
from ...storage.results import Results
from .conclusions import engine_factors
from .methods import Method, MethodResult, methods_for
from .problem import Problem, problems, sampling_distance
from .scene_cost import scene_costs

# a run shorter than this is repeated, so that a tick of the clock does not show [s]
_SHORT = 2e-3
_REPEATS = 5
ROUNDS = 3  # of a single case; an ensemble has as many as members
# rough computing time of a round, in any unit
_COSTS = {"turn": 1.0, "shaken": 4.0, "peaks": 3.0, "scenes": 0.5}


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class Tradeoff(Results, kind="tradeoff"):
    """Measurements of a trade-off.

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

    Its fact "load" is that of the machine before and after: how many processes wanted to run, this one
    included, over a minute; NaN where the system does not know.
    """

    def headline(self) -> dict[str, Number]:
        """Return the cost of engines over that of the recess model."""
        low, high = engine_factors(self.points)
        return {"engine over recess model, least": low, "engine over recess model, largest": high}


def measure_tradeoff(*, quick: bool = False, progress: ProgressCallback | None = None) -> Tradeoff:
    """Measure all methods on all problems.

    Parameters
    ----------
    quick : bool, optional
        Fewer points and fewer members.
    progress : callable, optional
        Called with a `Progress` at the start and the end of each round.
    """
    before = _load()
    scene_rounds = 3 if quick else 9
    asked = list(problems(quick=quick))
    rounds = [*((each.name, len(_visits(each))) for each in asked), ("scenes", scene_rounds)]
    stage = Stages(progress, [_COSTS[name] for name, count in rounds for _ in range(count)]).stage
    points = [_points(each, methods_for(each, quick=quick), stage) for each in asked]
    scenes = scene_costs(rounds=scene_rounds, steps=500 if quick else 2000, stage=stage)
    tables = {
        "points": pd.concat(points, ignore_index=True),
        "scenes": scenes,
        "problems": pd.concat([_described(each) for each in asked], ignore_index=True),
    }
    return Tradeoff(tables=tables, facts={"load": [before, _load()]})


def _described(problem: Problem) -> pd.DataFrame:
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


def _visits(problem: Problem) -> list[Case]:
    """The case of each round."""
    return list(problem.cases) if len(problem.cases) > 1 else list(problem.cases) * ROUNDS


def _points(problem: Problem, methods: list[Method], stage: Stage) -> pd.DataFrame:
    visits = _visits(problem)
    results: list[list[MethodResult]] = [[] for _ in methods]
    seconds = np.full((len(visits), len(methods)), np.nan)
    for number, case in enumerate(visits):
        with stage(f"{problem.name}, round {number + 1} of {len(visits)}"):
            if not number:
                _warm_up(methods, case)
            for place, method in enumerate(methods):
                seconds[number, place], result = _timed(method, case)
                if len(results[place]) < len(problem.cases):
                    results[place].append(result)
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
            "error": problem.error(method.support, [result.quantity for result in results[place]]),
            "said": next((result.said for result in results[place] if result.said), ""),
        }
        for place, method in enumerate(methods)
    )


def _warm_up(methods: list[Method], case: Case) -> None:
    """Let all be compiled, imported and fetched, by the first point of each line, the coarsest."""
    for place, method in enumerate(methods):
        if not place or method.line != methods[place - 1].line:
            method.solve(case)


def _timed(method: Method, case: Case) -> tuple[float, MethodResult]:
    """Processor time of this process in one run [s], and its result."""
    begin = time.process_time()
    result = method.solve(case)
    first = time.process_time() - begin
    if first >= _SHORT:
        return first, result
    again = []
    for _ in range(_REPEATS):
        begin = time.perf_counter()
        method.solve(case)
        again.append(time.perf_counter() - begin)
    # a finer clock, and the least of several: what another process took is not in it
    return min(again), result


def _load() -> float:
    return os.getloadavg()[0] if hasattr(os, "getloadavg") else math.nan
