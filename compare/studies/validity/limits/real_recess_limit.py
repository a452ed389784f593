"""A real recess: what clearance, inclination and contact with its walls change."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from .limit import Limit, Tables, column, largest, percent, quantile, short

if TYPE_CHECKING:
    import pandas as pd


def real_recess(tables: Tables) -> Limit:
    """Draw the limit from the ring of walls, the ideal recess and open ground in the engine."""
    table = tables["real_recess"]
    off = (table["peak"] / table["recess_peak"] - 1.0).abs()
    table = table.assign(off=off, walled=(table["clearance"] > 0.0) & np.isfinite(table["clearance"]))
    free = table[(table["motion"] == "free response") & table["walled"]]
    shaken = table[table["motion"] != "free response"]
    ring, ideal = shaken[shaken["walled"]], shaken[shaken["clearance"] == 0.0]
    opened = shaken[np.isinf(shaken["clearance"])]
    best = _tightest_in_place(ring)
    numbers = {
        "clearance": best,
        "at_end": largest(column(ring[ring["clearance"] == best], "at_end")),
        "ring_rolled": largest(column(ring, "rolled_out")),
        "open_rolled": largest(column(opened, "rolled_out")),
        "ring_peak_half": quantile(column(ring, "off"), 0.5),
        "ring_peak_worst": largest(column(ring, "off")),
        "open_peak_half": quantile(column(opened, "off"), 0.5),
        "ideal_peak_half": quantile(column(ideal, "off"), 0.5),
        "ideal_peak_worst": largest(column(ideal, "off")),
        "free_loss_half": quantile(column(free, "loss"), 0.5),
        "free_loss_worst": largest(column(free, "loss")),
        "ring_twist": largest(np.abs(column(ring, "twist"))),
        "open_twist": largest(np.abs(column(opened, "twist"))),
    }
    return Limit(
        subject="A real recess",
        use=f"For place: with a clearance of {best:g} b the cylinder stays within "
        f"{short(numbers['at_end'])} b of its "
        f"place at the end, and no ring lets it out by more than {short(numbers['ring_rolled'])} b; on "
        "open ground it "
        f"rolls out by up to {short(numbers['open_rolled'])} b.",
        error=f"Peak tilt under El Centro: off by {percent(numbers['ring_peak_half'])} (median) and at most "
        f"{percent(numbers['ring_peak_worst'])} in a ring, by {percent(numbers['open_peak_half'])} "
        "(median) on open "
        f"ground, and by {percent(numbers['ideal_peak_half'])} (at most "
        f"{percent(numbers['ideal_peak_worst'])}) in the "
        f"ideal recess. In free response walls take {percent(numbers['free_loss_half'])} of the energy "
        "(median), at "
        f"most {percent(numbers['free_loss_worst'])}.",
        avoid="For twist and energy: between walls the cylinder twists by up to "
        f"{short(numbers['ring_twist'])} rad "
        f"({short(numbers['open_twist'])} rad on open ground), where the model has none, and loses energy "
        "where "
        "the model conserves it.",
        numbers=numbers,
    )


def _tightest_in_place(ring: pd.DataFrame) -> float:
    """Return the clearance that leaves the cylinder nearest to its place, in the worst of its runs."""
    if not len(ring):
        return math.nan
    return float(str(ring.groupby("clearance")["at_end"].max().idxmin()))
