"""The vertical component of the ground motion, which the paper leaves out."""

from __future__ import annotations

import numpy as np

from .limit import Limit, Tables, column, percent
from .peaks import peak_difference


def vertical(tables: Tables) -> Limit:
    """Draw the limit from runs with and without the vertical component."""
    table = tables["shaking"]
    table = table[table["vertical"].notna()]
    recess, overturning = column(table, "recess"), column(table, "overturning")
    found = peak_difference(recess, column(table, "vertical"), overturning)
    twin = peak_difference(recess, column(table, "twin"), overturning)
    fell, raised_fell = (
        float(np.count_nonzero(peaks >= overturning * (1.0 - 1e-9)))
        for peaks in (recess, column(table, "vertical"))
    )
    chance = found.nine_in_ten <= 2.0 * twin.nine_in_ten
    numbers = {
        "half": found.half,
        "nine_in_ten": found.nine_in_ten,
        "verdicts": found.verdicts,
        "twin_half": twin.half,
        "twin_nine_in_ten": twin.nine_in_ten,
        "cells": float(found.standing),
        "fell": fell,
        "vertical_fell": raised_fell,
    }
    return Limit(
        subject="Vertical component",
        use=f"With it where the record has it: the model takes it at no cost. Without it {fell:.0f} cells "
        "fall, with "
        f"it {raised_fell:.0f}"
        + ("; what it changes in single peaks is of the size of chance." if chance else "."),
        error=f"Leaving it out moves half of the peaks by up to {percent(found.half)} and nine in ten by "
        "up to "
        f"{percent(found.nine_in_ten)} ({found.standing} cells); a record stronger by 0.1 % does "
        f"{percent(twin.half)} and {percent(twin.nine_in_ten)}.",
        avoid="Without it for whether one cylinder falls: the verdict changes in "
        f"{percent(found.verdicts)} of "
        f"the {found.falls} cells where it falls with or without.",
        numbers=numbers,
    )
