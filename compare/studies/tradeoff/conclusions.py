"""Conclusions from the points of a trade-off: computed from them, never typed in."""

from __future__ import annotations

import math

import numpy as np
import pandas as pd

from .methods import BASE_LINE, REST_PANEL, rest_line
from .problem import FINE_REST_TILT

# in the unit of each problem: errors that are asked for
TARGETS = {"turn": (0.1, 0.01, 1e-3), "shaken": (1e-2, 1e-3, 1e-4), "peaks": (0.05, 1e-2, 1e-3)}
# an error that falls with a lower power of the step than this has stopped falling; engines are of first order
FLAT = 0.5


def reaches(line: pd.DataFrame, target: float) -> pd.DataFrame:
    """Return the points of a line below an error that hold it at the next finer value of the knob, too.

    An error that happens to be small at one value does not count, but at the finest, which none follows.
    """
    ordered = line.sort_values("value", ascending=False)
    good = (ordered["error"] <= target).to_numpy()
    held = np.append(good[1:], good[-1:]) if len(good) else good
    return ordered[good & held]


def costs(points: pd.DataFrame) -> pd.DataFrame:
    """Return the cheapest point of each family for each problem, support and error asked for.

    Returns
    -------
    DataFrame
        The columns of the points, and target; families that do not reach it have no row. Cheapest first.
    """
    rows = []
    for (problem, _), chosen in points.groupby(["problem", "support"], sort=False):
        for target in TARGETS[str(problem)]:
            for _, members in chosen.groupby("family", sort=False):
                held = pd.concat([reaches(line, target) for _, line in members.groupby("line", sort=False)])
                rows.append(held.nsmallest(1, "ratio").assign(target=target))
    found = pd.concat(rows, ignore_index=True)
    keys = {name: pd.factorize(found[name])[0] for name in ("problem", "support")}
    return found.assign(**{f"_{name}": codes for name, codes in keys.items()}).sort_values(
        ["_problem", "_support", "target", "ratio"], ascending=[True, True, False, True], ignore_index=True
    )[[*points.columns, "target"]]


def plateaus(points: pd.DataFrame) -> pd.DataFrame:
    """Return the course of the error of each line of an engine with its step; lines of three points or more.

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
    """Return the savings and the cost of the rest rule: problem, line, value, speed_up, error, error_without.

    Each line is held against the one with next to no rule at the same tolerance.
    """
    reduced = points[(points["family"] == "reduced") & (points["support"] == "recess")]
    none = reduced["line"] == rest_line(FINE_REST_TILT)
    kept = (reduced["line"] == BASE_LINE) | (reduced["panel"] == REST_PANEL)
    columns = ["problem", "line", "value", "ratio", "error"]
    pairs = reduced.loc[~none & kept, columns].merge(
        reduced.loc[none, columns[:1] + columns[2:]], on=["problem", "value"], suffixes=("", "_without")
    )
    pairs["speed_up"] = pairs["ratio_without"] / pairs["ratio"]
    return pairs[["problem", "line", "value", "speed_up", "error", "error_without"]]


def engine_factors(points: pd.DataFrame) -> tuple[float, float]:
    """Return the least and the largest cost of an engine in a recess at an error asked for; NaN of none.

    In computing times of the recess model at its default tolerance, as everywhere.
    """
    found = costs(points)
    engines = ~found["family"].isin(("reduced", "scipy")) & (found["support"] == "recess")
    ratios = found.loc[engines, "ratio"]
    return float(ratios.min()), float(ratios.max())
