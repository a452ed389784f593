"""Errors and computing times of all methods on all problems, measured in this process in turns."""

from __future__ import annotations

import math
import os
import sys
import time
from dataclasses import dataclass

import numpy as np
import pandas as pd

from rockwobble.compare import Results
from rockwobble.models import Case
from rockwobble.reports.published.tradeoff.methods import (
    BASE_LINE,
    REST_PANEL,
    Method,
    MethodResult,
    methods_for,
    rest_line,
)
from rockwobble.reports.published.tradeoff.problem import (
    FINE_REST_TILT,
    RECESS,
    Problem,
    problems,
    sampling_distance,
)
from rockwobble.reports.published.tradeoff.scenes import scene_costs

# shorter runs are repeated, to hide the clock tick [s]
_SHORT = 2e-3
_REPEATS = 5
ROUNDS = 3  # of a single case; an ensemble has as many as members
# attributes of a method that its row has
_NAMES = ("support", "panel", "family", "line", "knob", "value")
# in the unit of each problem: errors that are asked for
TARGETS = {"turn": (0.1, 0.01, 1e-3), "shaken": (1e-2, 1e-3, 1e-4), "peaks": (0.05, 1e-2, 1e-3)}
# an error that falls with a lower power of the step than this has stopped falling; engines are of first order
FLAT = 0.5


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

    def headline(self) -> dict[str, float]:
        """Cost of engines over that of the recess model."""
        low, high = engine_factors(self.points)
        return {"engine over recess model, least": low, "engine over recess model, largest": high}


def measure(*, quick: bool) -> Tradeoff:
    """Measure all methods on all problems; `quick` with fewer steps, members and rounds."""
    before, asked = _load(), list(problems(quick=quick))
    points = [_points(each, methods_for(each, quick=quick)) for each in asked]
    scenes = scene_costs(rounds=3 if quick else 9, steps=500 if quick else 2000)
    tables = {
        "points": pd.concat(points, ignore_index=True),
        "scenes": scenes,
        "problems": pd.concat([_description(each) for each in asked], ignore_index=True),
    }
    return Tradeoff(tables=tables, facts={"load": [before, _load()]})


def _description(problem: Problem) -> pd.DataFrame:
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
    """Case of each measuring round."""
    return list(problem.cases) if len(problem.cases) > 1 else list(problem.cases) * ROUNDS


def _points(problem: Problem, methods: list[Method]) -> pd.DataFrame:
    visits = _visits(problem)
    results: list[list[MethodResult]] = [[] for _ in methods]
    seconds = np.full((len(visits), len(methods)), np.nan)
    for number, case in enumerate(visits):
        print(f"{problem.name}, round {number + 1} of {len(visits)}", file=sys.stderr, flush=True)
        if not number:
            _warm_up(methods, case)
        for place, method in enumerate(methods):
            seconds[number, place], result = _time_run(method, case)
            if len(results[place]) < len(problem.cases):
                results[place].append(result)
    base = next(place for place, method in enumerate(methods) if method.base)
    ratios = seconds / seconds[:, [base]]
    low, middle, high = np.quantile(ratios, (0.25, 0.5, 0.75), axis=0)
    return pd.DataFrame(
        {
            "problem": problem.name,
            **{name: getattr(method, name) for name in _NAMES},
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
    """Compile, import and load everything with the first, coarsest point of each series."""
    for place, method in enumerate(methods):
        if not place or method.line != methods[place - 1].line:
            method.solve(case)


def _time_run(method: Method, case: Case) -> tuple[float, MethodResult]:
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


def reaches(line: pd.DataFrame, target: float) -> pd.DataFrame:
    """Points of a series below an error bound that holds at the next finer setting too.

    An error that happens to be small at one value does not count, but at the finest, which none follows.
    """
    ordered = line.sort_values("value", ascending=False)
    good = (ordered["error"] <= target).to_numpy()
    return ordered[good & np.append(good[1:], good[-1:])]


def costs(points: pd.DataFrame) -> pd.DataFrame:
    """Cheapest point of each family for each problem, support and asked error.

    Returns
    -------
    DataFrame
        The columns of the points, and target; families that do not reach it have no row. Cheapest first.
    """
    rows = []
    for (problem, _), chosen in points.groupby(["problem", "support"], sort=False):
        for target in TARGETS[str(problem)]:
            lines = chosen.groupby(["family", "line"], sort=False)
            good = pd.concat([reaches(line, target) for _, line in lines])
            cheapest = good.sort_values("ratio", kind="stable").drop_duplicates("family")
            rows.append(cheapest.assign(target=target))
    return pd.concat(rows, ignore_index=True)


def plateaus(points: pd.DataFrame) -> pd.DataFrame:
    """Error over step of each engine line; lines of at least three points.

    Returns
    -------
    DataFrame
        problem, support, panel, line; verdict: "falls" where the last halving still gains, "flat" where the
        error from `begins` on changes with a power of the step below `FLAT`, "grows" where it grows by more
        than that power; begins [s], the step from which on nothing is gained, NaN where it falls; level,
        the median error from there on, or the smallest; best, the step of the smallest error [s].
    """
    rows = []
    engines = points[(points["knob"] == "time step") & points["error"].notna()]
    names = ["problem", "support", "panel", "line"]
    for key, line in engines.groupby(names, sort=False):
        ordered = line.sort_values("value", ascending=False)
        errors, steps = ordered["error"].to_numpy(float), ordered["value"].to_numpy(float)
        if len(ordered) < 3:
            continue
        with np.errstate(divide="ignore"):
            orders = np.diff(np.log(errors)) / np.diff(np.log(steps))
        falling = np.flatnonzero(orders >= FLAT)
        first = int(falling[-1]) + 1 if len(falling) else 0
        falls = first == len(errors) - 1
        grows = not falls and errors[-1] >= errors[first] * (steps[first] / steps[-1]) ** FLAT
        rows.append(
            dict(zip(names, key, strict=True))
            | {
                "verdict": "falls" if falls else "grows" if grows else "flat",
                "begins": math.nan if falls else float(steps[first]),
                "level": float(errors.min() if falls else np.median(errors[first:])),
                "best": float(steps[errors.argmin()]),
            }
        )
    return pd.DataFrame(rows, columns=[*names, "verdict", "begins", "level", "best"])


def rest_tilt_price(points: pd.DataFrame) -> pd.DataFrame:
    """Savings and the cost of the rest rule: problem, line, value, speed_up, error, error_without.

    Each line is compared with the one with next to no rule at the same tolerance.
    """
    reduced = points[(points["family"] == "reduced") & (points["support"] == RECESS)]
    none = reduced["line"] == rest_line(FINE_REST_TILT)
    kept = (reduced["line"] == BASE_LINE) | (reduced["panel"] == REST_PANEL)
    columns = ["problem", "line", "value", "ratio", "error"]
    pairs = reduced.loc[~none & kept, columns].merge(
        reduced.loc[none, columns[:1] + columns[2:]], on=["problem", "value"], suffixes=("", "_without")
    )
    pairs["speed_up"] = pairs["ratio_without"] / pairs["ratio"]
    return pairs[["problem", "line", "value", "speed_up", "error", "error_without"]]


def engine_factors(points: pd.DataFrame) -> tuple[float, float]:
    """Least and largest cost of an engine in a recess at a target error; NaN if none reaches any.

    In computing times of the recess model at its default tolerance, as everywhere.
    """
    table = costs(points)
    engines = ~table["family"].isin(("reduced", "scipy")) & (table["support"] == RECESS)
    ratios = table.loc[engines, "ratio"]
    return float(ratios.min()), float(ratios.max())
