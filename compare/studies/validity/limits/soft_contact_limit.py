"""Contact stiffness and damping: how soft contact may be."""

from __future__ import annotations

import math

import numpy as np

from .limit import Limit, Tables, column, first_failing, largest, percent, short, up_to

SMALL = 0.05  # of the peak tilt: less cannot be told from chance


def soft_contact(tables: Tables) -> Limit:
    """Draw the limit from the engine with softer contact."""
    table = tables["contact"]
    table = table[table["free_outcome"] != "failed"]
    softness, loss = column(table, "softness"), column(table, "loss")
    off = np.abs(column(table, "peak") / column(table, "recess_peak") - 1.0)
    off = np.where(np.isfinite(off), off, math.inf)
    stiff = column(table, "time_constant")
    hard, soft = up_to(stiff, off <= SMALL), first_failing(stiff, off <= SMALL)
    within = stiff <= hard if math.isfinite(hard) else np.zeros(len(stiff), dtype=bool)
    numbers = {
        "hard_up_to": hard,
        "soft_from": soft,
        "hard_softness": largest(softness[within]),
        "hard_peak": largest(off[within]),
        "hard_loss": largest(loss[within]),
        "largest_peak": largest(off),
        "largest_loss": largest(loss),
    }
    use = (
        f"Where contact is stiff: it takes up a blow in at most {short(numbers['hard_softness'])}/p "
        f"({short(1e3 * hard)} ms at R = 6 m)."
        if math.isfinite(hard)
        else f"At no contact tried is the peak tilt within {percent(SMALL)}."
    )
    avoid = (
        f"For soft ground or bearings, from {short(1e3 * soft)} ms at R = 6 m on: a pass loses up to "
        f"{percent(numbers['largest_loss'])} of the energy and the peak is off by up to "
        f"{percent(numbers['largest_peak'])}."
        if math.isfinite(soft)
        else "At no contact tried for this reason."
    )
    return Limit(
        subject="Contact that gives",
        use=use,
        error=f"Up to there a pass loses at most {percent(max(numbers['hard_loss'], 0.0))} of the energy "
        "and the "
        f"peak tilt is off by at most {percent(numbers['hard_peak'])}.",
        avoid=avoid,
        numbers=numbers,
    )
