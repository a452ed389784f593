"""Counts that the report on the limits states beside them, each a function of the measured tables alone."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np
import pandas as pd

from rockwobble.models.support import FLAT, RECESS, RING
from rockwobble.models.trace import NO_PEAK
from rockwobble.studies.validity.criteria import Limits
from rockwobble.studies.validity.limits import (
    POINT,
    Numbers,
    Tables,
    cells,
    column,
    contrasts,
    largest,
    least,
    quotient,
)
from rockwobble.studies.validity.plan import EL_CENTRO, RELEASE
from rockwobble.studies.validity.shaken import FREE

from ..figures.validity import METHODS, has_walls

_FAR = 10.0  # a factor beyond every scale


def with_counts(limits: Limits, tables: Tables) -> dict[str, Numbers]:
    """Return the limits with the counts of the runs that they are of."""
    counts = {
        "records": _records(tables),
        "free_response": _releases(tables["verification"]),
        "contact": _forces(tables),
        "soft_contact": _soft_contact(tables["contact"], limits["soft_contact"]["held_up_to"]),
    }
    if "rings" in tables:
        counts["rings"] = _rings(tables["rings"])
    return {name: {**numbers, **counts.get(name, {})} for name, numbers in limits.items()}


def _records(tables: Tables) -> Numbers:
    """Runs that are undecided, runs in a ring that stand and those beyond alpha, quantiles with an end."""
    runs, table = tables["records"], contrasts(tables)
    standing = runs[(runs["method"] == RING) & (runs["outcome"] == "stands")]
    peaks = column(standing, "peak")
    strays = table[table["method"].isin(METHODS)]
    return {
        "undecided": float((runs["outcome"] == "undecided").sum()),
        "ring_standing": float(len(standing)),
        "ring_passed": float((peaks >= 1.0).sum()),
        "ring_passed_largest": largest(peaks),
        "strays_bounded": float(np.isfinite(column(strays, "ratio_95_high")).sum()),
    }


def _releases(table: pd.DataFrame) -> Numbers:
    """Releases whose pass an engine resolves."""
    decides = table["resolved"].astype(bool) & ~table["outcome"].isin(NO_PEAK)
    return {"releases": float(len(table.loc[decides, list(RELEASE)].drop_duplicates()))}


def _forces(tables: Tables) -> Numbers:
    """Least normal force of shaken motions [weights], and the slenderness of the least in free response."""
    free = tables["free_response"]
    at = int(np.nanargmin(column(free, "least_normal")))
    return {
        "shaken_least": least(column(tables["peaks"], "least_normal")),
        "free_least_tan_alpha": float(column(free, "tan_alpha")[at]),
    }


def _soft_contact(table: pd.DataFrame, held_up_to: float) -> Numbers:
    """Runs with a contact that is stiff enough, those of them that ended, and where the others failed."""
    # one contact is one point, though its softness differs by slenderness in the third digit
    held = table[column(table, "time_constant") <= _constant_of(table, held_up_to)]
    failed = held[held[["free_outcome", "outcome"]].isin(NO_PEAK).any(axis="columns")]
    return {
        "held_runs": float(len(held)),
        "held_ended": float(len(held) - len(failed)),
        "failed_up_to": largest(column(failed, "softness")),
        "failed_damping_least": least(column(failed, "damping")),
        "failed_damping_largest": largest(column(failed, "damping")),
    }


def _constant_of(table: pd.DataFrame, softness: float) -> float:
    """The time constant of a softness; NaN of none."""
    constants = column(table[column(table, "softness") == softness], "time_constant")
    return largest(constants)


def _rings(table: pd.DataFrame) -> Numbers:
    """Twist in free response [rad], which El Centro's is not."""
    free = table[has_walls(table) & (table["motion"] == FREE)]
    return {"free_twist": largest(np.abs(column(free, "twist")))}


def faint_factors(tables: Tables) -> Mapping[str, float] | None:
    """Return the finite factors of the maps that are beyond every scale, and how far their records tilt.

    Of each slenderness and intensity the largest factor over the sizes, as the table of the maps has it.

    Returns
    -------
    mapping of str to float, or None where there is no such factor
        above, least, largest: of the factors; peak: the smaller of the two peaks of each, at most [alpha].
    """
    table, peaks = cells(tables), tables["peaks"]
    peaks = peaks[peaks["motion"] != EL_CENTRO]
    factors, smaller = [], []
    for name in (FLAT, "copy"):
        known = table.dropna(subset=f"{name}_90")
        for _, own in known.groupby(["tan_alpha", "intensity"]):
            cell = own.iloc[int(np.argmax(column(own, f"{name}_90")))]
            factor = float(cell[f"{name}_90"])
            if not _FAR < factor < math.inf:
                continue
            at_cell = [column(peaks, axis) == float(cell[axis]) for axis in POINT]
            records = peaks.loc[np.logical_and.reduce(at_cell)]
            both = np.column_stack([column(records, name), column(records, RECESS)])
            ratio = np.abs(np.log(quotient(records, name, RECESS)))
            standing = both.max(axis=1) * math.atan(float(cell["tan_alpha"])) < 0.5 * math.pi * (1.0 - 1e-6)
            reached = int(np.nanargmin(np.where(standing, np.abs(ratio - math.log(factor)), math.nan)))
            factors.append(factor)
            smaller.append(float(both[reached].min()))
    if not factors:
        return None
    return {"above": _FAR, "least": min(factors), "largest": max(factors), "peak": max(smaller)}
