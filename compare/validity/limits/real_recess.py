"""A real recess: what clearance, inclination and contact with its walls change."""

from __future__ import annotations

import math

import numpy as np

from .limit import Limit, Tables, column, largest, percent, short


def real_recess(tables: Tables) -> Limit:
    """Draw the limit from the ring of walls, the ideal recess and open ground in the engine."""
    table = tables["real_recess"]
    shaken = table[table["motion"] != "free response"]
    off = np.abs(column(shaken, "peak") / column(shaken, "recess_peak") - 1.0)
    clearance = column(shaken, "clearance")
    ring, opened = (clearance > 0.0) & np.isfinite(clearance), np.isinf(clearance)
    tightest, widest = (
        (float(clearance[ring].min()), float(clearance[ring].max())) if ring.any() else (math.nan, math.nan)
    )
    tight, wide = clearance == tightest, clearance == widest
    free = table[
        (table["motion"] == "free response") & (table["clearance"] > 0.0) & np.isfinite(table["clearance"])
    ]
    residual, rolled = column(shaken, "residual"), column(shaken, "rolled_out")
    numbers = {
        "tightest": tightest,
        "widest": widest,
        "ideal_peak": largest(off[clearance == 0.0]),
        "tight_peak": largest(off[tight]),
        "wide_peak": largest(off[wide]),
        "open_peak": largest(off[opened]),
        "free_loss": largest(column(free, "loss")),
        "tight_residual": largest(residual[tight]),
        "wide_residual": largest(residual[wide]),
        "open_residual": largest(residual[opened]),
        "open_rolled": largest(rolled[opened]),
        "open_twist": largest(np.abs(column(shaken, "twist")[opened])),
        "tight_twist": largest(np.abs(column(shaken, "twist")[tight])),
    }
    return Limit(
        subject="A real recess",
        use=f"With a clearance of {tightest:g} b the cylinder ends within "
        f"{short(numbers['tight_residual'])} b "
        f"of its place, with {widest:g} b within {short(numbers['wide_residual'])} b; on open ground it "
        "rolls out "
        f"by up to {short(numbers['open_rolled'])} b and twists by up to {short(numbers['open_twist'])} rad.",
        error=f"Peak tilt under El Centro: off by up to {percent(numbers['tight_peak'])} at {tightest:g} b "
        "and "
        f"{percent(numbers['wide_peak'])} at {widest:g} b, {percent(numbers['open_peak'])} on open ground, "
        "and "
        f"{percent(numbers['ideal_peak'])} in the ideal recess. Walls take up to "
        f"{percent(numbers['free_loss'])} of "
        "the energy of a free response.",
        avoid=f"For the twist: between walls it reaches {short(numbers['tight_twist'])} rad, where the "
        "model has "
        "none; and for a single peak where the walls are touched.",
        numbers=numbers,
    )
