"""Distributions of peak tilt: whether the statistics of the model are those of the engine."""

from __future__ import annotations

import numpy as np

from ...distributions import Contrast, contrast
from ..motions import source_of
from .limit import Limit, Tables, percent, short

_DRAWS = 400
TOLD_APART = 0.05  # probability below which two distributions are told apart
METHODS = ("engine, guided", "engine, free", "rolling")


def contrasts(tables: Tables) -> dict[tuple[float, str], Contrast]:
    """Return the recess model against each other method, by level."""
    table = tables["statistics"]
    found = {}
    for level, members in table.groupby("level"):
        peaks = members.pivot_table("peak", "motion", "method", dropna=False)
        fell = (
            members.assign(fell=members["outcome"] == "overturned")
            .pivot_table("fell", "motion", "method", aggfunc="max")
            .reindex(peaks.index)
            .astype(bool)
        )
        for method in METHODS:
            ours, theirs = (peaks[name].to_numpy(dtype=np.float64) for name in (method, "recess"))
            if np.count_nonzero(np.isfinite(ours) & np.isfinite(theirs)) < 2:
                continue
            found[float(str(level)), method] = contrast(
                ours, theirs, fell[method].to_numpy(bool), fell["recess"].to_numpy(bool), draws=_DRAWS
            )
    return found


def distribution(tables: Tables) -> Limit:
    """Draw the limit from the ensemble."""
    found = contrasts(tables)
    guided = [item for (_, method), item in found.items() if method == "engine, guided"]
    opened = [item for (_, method), item in found.items() if method == "engine, free"]
    members = max((item.count for item in found.values()), default=0)
    records = f"{members} {source_of(tables['statistics']['motion'])}"
    numbers = {
        "members": float(members),
        "guided_p": min((item.ks_p for item in guided), default=np.nan),
        "open_p": min((item.ks_p for item in opened), default=np.nan),
        "guided_median": _worst(guided),
        "open_median": _worst(opened),
        "open_low": min((item.median_ratio.low for item in opened), default=np.nan),
        "open_high": max((item.median_ratio.high for item in opened), default=np.nan),
        "recess_fell": float(sum(item.against_overturned for item in opened)),
        "open_fell": float(sum(item.overturned for item in opened)),
        "both_fell": float(sum(item.both_overturned for item in opened)),
    }
    apart = numbers["open_p"] < TOLD_APART
    return Limit(
        subject="Distributions of peak tilt",
        use=f"For statistics over records ({records}): the distribution of the engine "
        f"in an ideal recess cannot be told from the model's (p ≥ {short(numbers['guided_p'])})"
        + (
            f", but that on open ground can (p = {short(numbers['open_p'])})."
            if apart
            else f", nor that on open ground (p ≥ {short(numbers['open_p'])})."
        )
        if numbers["guided_p"] >= TOLD_APART
        else f"Not for statistics: already in an ideal recess the engine's distribution over {records} "
        f"is another (p = {short(numbers['guided_p'])}).",
        error=f"Median peak off by up to {percent(numbers['guided_median'])} in an ideal recess and "
        f"{percent(numbers['open_median'])} on open ground (95 % of the bootstrap: a ratio from "
        f"{short(numbers['open_low'])} to {short(numbers['open_high'])}).",
        avoid=f"To name the records that overturn: {numbers['recess_fell']:.0f} do in the model, "
        f"{numbers['open_fell']:.0f} on open ground, {numbers['both_fell']:.0f} in both.",
        numbers=numbers,
    )


def _worst(found: list[Contrast]) -> float:
    return max((abs(item.median_ratio.value - 1.0) for item in found), default=np.nan)
