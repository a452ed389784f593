"""What follows from the points: computed from them, never typed in."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from .problem import FINE_REST_TILT

if TYPE_CHECKING:
    import pandas as pd

# a line has ended on its plateau if its last halvings change the error by less than this factor
FLAT = 2.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Fastest:
    """The cheapest point of a family below an error; ratio NaN where none reaches it."""

    problem: str
    model: str
    target: float
    family: str
    line: str
    knob: str
    value: float
    ratio: float
    milliseconds: float
    error: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Plateau:
    """Where the error of a line stops falling with its knob.

    Attributes
    ----------
    begins : float
        Largest value of the knob from which on the error stays within a factor `FLAT` of its level; NaN if
        it still falls at the smallest.
    level : float
        Median error from there on; the smallest error where it still falls.
    """

    problem: str
    model: str
    line: str
    knob: str
    begins: float
    level: float
    smallest: float


def reaches(line: pd.DataFrame, target: float) -> pd.DataFrame:
    """Return the points of a line below an error that hold it at the next finer value of the knob, too.

    An error that happens to be small at one value does not count.
    """
    ordered = line.sort_values("value", ascending=False)
    good = (ordered["error"] <= target).to_numpy()
    held = np.append(good[1:], good[-1:]) if len(good) else good
    return ordered[good & held]


def fastest(points: pd.DataFrame, problem: str, model: str, target: float) -> list[Fastest]:
    """Return the fastest point of each family below an error, the fastest family first."""
    chosen = points[(points["problem"] == problem) & (points["model"] == model)]
    found = []
    for family, members in chosen.groupby("family", sort=False):
        held = [reaches(line, target) for _, line in members.groupby("line", sort=False)]
        rows = [row for part in held for row in part.to_dict("records")]
        if not rows:
            continue
        best = min(rows, key=lambda row: row["ratio"])
        found.append(
            Fastest(
                problem=problem,
                model=model,
                target=target,
                family=str(family),
                line=best["line"],
                knob=best["knob"],
                value=best["value"],
                ratio=best["ratio"],
                milliseconds=best["milliseconds"],
                error=best["error"],
            )
        )
    return sorted(found, key=lambda each: each.ratio)


def plateaus(points: pd.DataFrame) -> list[Plateau]:
    """Return where each line of an engine stops gaining from smaller steps; lines of three points or more."""
    found = []
    engines = points[points["knob"] == "time step"]
    for (problem, model, line), rows in engines.groupby(["problem", "model", "line"], sort=False):
        ordered = rows.dropna(subset=["error"]).sort_values("value", ascending=False)
        if len(ordered) < 3:
            continue
        errors, values = ordered["error"].to_numpy(float), ordered["value"].to_numpy(float)
        begins, level = math.nan, float(errors.min())
        for first in range(len(errors) - 1):
            tail = errors[first:]
            if tail.max() <= FLAT * tail.min():
                begins, level = float(values[first]), float(np.median(tail))
                break
        # errors that rise again are a plateau, too: smaller steps gain nothing
        if math.isnan(begins) and errors[-1] > errors.min():
            first = int(errors.argmin())
            begins = float(values[first])
        found.append(
            Plateau(
                problem=str(problem),
                model=str(model),
                line=str(line),
                knob="time step",
                begins=begins,
                level=level,
                smallest=float(values[-1]),
            )
        )
    return found


def rest_tilt_price(points: pd.DataFrame) -> pd.DataFrame:
    """Return what the rest rule saves and costs: problem, line, tolerance, speed-up and both errors.

    Each line is held against the one with next to no rule at the same tolerance.
    """
    import pandas as pd

    reduced = points[(points["family"] == "reduced") & (points["model"] == "recess")]
    almost_none = f"reduced, rest threshold {FINE_REST_TILT:g}"
    without = reduced[reduced["line"] == almost_none].set_index(["problem", "value"])
    rows = []
    for row in reduced[reduced["line"] != almost_none].to_dict("records"):
        key = row["problem"], row["value"]
        if key not in without.index:
            continue
        other = without.loc[key]
        rows.append(
            {
                "problem": row["problem"],
                "line": row["line"],
                "tolerance": row["value"],
                "speed_up": float(other["ratio"]) / row["ratio"],
                "error": row["error"],
                "error_without": float(other["error"]),
            }
        )
    columns = ["problem", "line", "tolerance", "speed_up", "error", "error_without"]
    return pd.DataFrame(rows, columns=columns)
