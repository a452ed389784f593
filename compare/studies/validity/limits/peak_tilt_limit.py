"""Single peak tilts under shaking: recess against flat ground, and against the model's own twin."""

from __future__ import annotations

import numpy as np

from .limit import Limit, Tables, column, largest, percent, quantile
from .peaks import peak_difference


def peak_tilt(tables: Tables) -> Limit:
    """Draw the limit from the maps under shaking, and the engine's peaks."""
    table = tables["shaking"]
    recess, overturning = column(table, "recess"), column(table, "overturning")
    rolling = peak_difference(recess, column(table, "flat"), overturning)
    twin = peak_difference(recess, column(table, "twin"), overturning)
    guided = tables["following"]
    guided = guided[guided["support"] == "recess"]
    off = np.abs(column(guided, "peak_tilt") / column(guided, "reference_peak_tilt") - 1.0)
    engine, worst = quantile(off, 0.5), largest(off)
    numbers = {
        "half": rolling.half,
        "nine_in_ten": rolling.nine_in_ten,
        "verdicts": rolling.verdicts,
        "twin_half": twin.half,
        "twin_nine_in_ten": twin.nine_in_ten,
        "twin_verdicts": twin.verdicts,
        "engine": engine,
        "engine_worst": worst,
        "cells": float(rolling.standing),
        "falls": float(rolling.falls),
    }
    return Limit(
        subject="Peak tilt under one record",
        use="Where the recess is real, and the peak of one record is read as one draw of many. In an ideal "
        "recess "
        f"the engine has the peak of the model to {percent(engine)} (median of {len(off)} runs; at worst "
        f"{percent(worst)}).",
        error=f"Against a cylinder on open ground half of the single peaks are off by up to "
        f"{percent(rolling.half)}, nine in ten by up to {percent(rolling.nine_in_ten)} ({rolling.standing} "
        "cells). "
        "Chance alone, a record stronger by 0.1 %, moves the model's own peak by up to "
        f"{percent(twin.half)} and "
        f"{percent(twin.nine_in_ten)}.",
        avoid=f"For whether one cylinder falls under one record: of {rolling.falls} cells where either model "
        f"falls, the other stands in {percent(rolling.verdicts)} (recess against its own twin: "
        f"{percent(twin.verdicts)}).",
        numbers=numbers,
    )
