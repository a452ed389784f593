"""The limits of the model as numbers, each a function of the measured tables alone."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping

import numpy as np
import pandas as pd

from ...comparison.prediction import IN_TIME
from .distributions import (
    Array,
    Numbers,
    Tables,
    cells,
    column,
    first_failing,
    largest,
    peak_ratios,
    single_peaks,
    up_to,
    vertical,
)
from .el_centro import FREE

# [b] in one period: less is the creep of a contact that never lets go
SLIPPED = 1e-3
# [weight times base radius]: a tenth of what would tip the cylinder about its rim
SLIGHT = 0.1


def needs(tables: Tables) -> pd.DataFrame:
    """Return what ground and recess must supply, by slenderness and intensity.

    What nine in ten of the records that rock a cylinder without overturning it need at most, of the size that
    needs most: sizes differ by a few percent, slenderness and intensity by factors.

    Returns
    -------
    DataFrame
        tan_alpha, intensity, sizes with enough such records, motions that rock them, friction over
        tan(alpha), normal [weights] (at least), and moment over weight and base radius. No row where no size
        has enough.
    """
    known = cells(tables).dropna(subset="moment_90")
    return known.groupby(["tan_alpha", "intensity"], as_index=False).agg(
        sizes=("semidiagonal", "count"),
        motions=("standing", "sum"),
        friction=("friction_90", "max"),
        normal=("normal_10", "min"),
        moment=("moment_90", "max"),
    )


def friction(tables: Tables) -> Numbers:
    """Return the friction needed over tan(alpha), and where the engine slips with less than needed."""
    free, slip = tables["free_response"], tables["slip"]
    moving = tables["peaks"][tables["peaks"]["friction"].notna()]
    share, slipped = column(slip, "share"), column(slip, "slip") > SLIPPED
    slips_at, sticks = largest(share[slipped]), share[~slipped]
    sticks = sticks[~(sticks <= slips_at)]  # what slips at one release does not hold at all
    nearest = slip[share == slips_at]
    return {
        "free_response": largest(column(free, "friction") / column(free, "tan_alpha")),
        "shaken": largest(column(moving, "friction") / column(moving, "tan_alpha")),
        "slips_at": slips_at,
        "holds_from": float(sticks.min()) if len(sticks) else math.nan,
        "tilt_error": largest(column(nearest, "tilt_rms")),
        "slip": largest(column(nearest, "slip")),
    }


def contact(tables: Tables) -> Numbers:
    """Return the least normal force [weights], and from which slenderness and intensity contact is lost."""
    moving = tables["peaks"][tables["peaks"]["least_normal"].notna()]
    tan_alpha, normal = column(moving, "tan_alpha"), column(moving, "least_normal")
    in_free = column(tables["free_response"], "least_normal")
    lost = moving[normal <= 0.0]
    held = up_to(tan_alpha, normal > 0.0)
    within = normal[tan_alpha <= held]
    return {
        "held_up_to": held,
        "lost_from": first_failing(tan_alpha, normal > 0.0),
        "lost_intensity": float(lost["intensity"].min()) if len(lost) else math.nan,
        "least_held": float(within.min()) if len(within) else math.nan,
        "least": float(np.concatenate([normal, in_free]).min()),
        "lost": float(len(lost)),
        "runs": float(len(moving)),
        "free_least": float(in_free.min()),
        "free_lost_from": first_failing(column(tables["free_response"], "tan_alpha"), in_free > 0.0),
    }


def restraining_moment(tables: Tables) -> Numbers:
    """Return the restraining moment over weight and base radius."""
    moving = tables["peaks"][tables["peaks"]["moment"].notna()]
    tan_alpha, needed = column(moving, "tan_alpha"), column(moving, "moment")
    return {
        "free_response": largest(column(tables["free_response"], "moment")),
        "shaken": largest(needed),
        "slight_up_to": up_to(tan_alpha, needed <= SLIGHT),
        "heavy_from": first_failing(tan_alpha, needed <= SLIGHT),
    }


ALIKE = 0.01  # of period, angle of turn or peak: below what a test on a shake table would see
SMALL = 0.05  # of the peak tilt: less cannot be told from chance
# an engine confirms a model if it is nearer to it than this share of the difference of the models
_CONFIRMS = 0.5
# and contradicts it where turn or period is off by more than this; the step of an engine errs by less
_CONTRADICTS = 1e-3


def free_passes(tables: Tables) -> Numbers:
    """Return the difference of recess and flat ground in a pass, and the releases that an engine decides."""
    table = tables["free_response"]
    tan_alpha, turn, flat = (column(table, name) for name in ("tan_alpha", "turn", "flat_turn"))
    turns = np.abs(flat / turn - 1.0)
    periods = np.abs(column(table, "flat_period") / column(table, "period") - 1.0)
    holds = (turns <= ALIKE) & (periods <= ALIKE)
    worst = table.iloc[int(np.nanargmax(np.abs(flat - turn)))]
    confirmed, contradicted, points = _decided(tables["verification"])
    return {
        "alike_up_to": up_to(tan_alpha, holds),
        "apart_from": first_failing(tan_alpha, holds),
        "turn_largest": largest(turns),
        "turn_largest_deg": math.degrees(largest(np.abs(flat - turn))),
        **{f"worst_{name}": float(worst[name]) for name in ("tan_alpha", "release", "spin")},
        "period_largest": largest(periods),
        "peak_gain": max(largest(column(table, "flat_peak")) - 1.0, 0.0),
        "confirmed": confirmed,
        "contradicted": contradicted,
        "points": points,
    }


def _decided(table: pd.DataFrame) -> tuple[float, float, float]:
    """Count the runs that confirm their model, those that contradict it, and all whose pass is resolved."""
    resolved = table[table["resolved"].astype(bool)]
    error = np.abs(column(resolved, "engine_turn") - column(resolved, "turn"))
    limits = models_apart(table)[table["resolved"].to_numpy(bool)]
    turn_off = error / np.abs(column(resolved, "turn"))
    period_off = np.abs(column(resolved, "engine_half_period") / column(resolved, "half_period") - 1.0)
    contradicts = ~((turn_off <= _CONTRADICTS) & (period_off <= _CONTRADICTS))
    confirms = ~contradicts & (error < _CONFIRMS * limits)
    return float(confirms.sum()), float(contradicts.sum()), float(len(resolved))


def models_apart(table: pd.DataFrame) -> Array:
    """Return how far the turns of the recess and of the flat model are apart in the release of each row."""
    keys = ["tan_alpha", "release", "spin"]
    models = table.pivot_table("turn", keys, "support", dropna=False)
    apart = (models["recess"] - models["flat"]).abs()
    return apart.reindex(table.set_index(keys).index).to_numpy(dtype=np.float64)


def traces(tables: Tables) -> Numbers:
    """Return agreement times [s] of engine and model, and the count that diverge earlier than predicted.

    NAME and NAME_longest: the shortest and the longest; NAME_whole, runs that agree to their end.
    """
    table = tables["following"]
    numbers: Numbers = {"duration": largest(column(table, "duration")), "comparisons": float(len(table))}
    for name, support, reference in (
        ("recess", "recess", "recess"),
        ("flat", "flat", "recess"),
        ("own", "flat", "flat"),
    ):
        own = table[(table["support"] == support) & (table["reference_support"] == reference)]
        peaks = column(own, "peak_tilt") / column(own, "reference_peak_tilt")
        numbers |= {
            name: -largest(-column(own, "agreement_time")),
            f"{name}_longest": largest(column(own, "agreement_time")),
            f"{name}_runs": float(len(own)),
            f"{name}_whole": float((~own["diverged"].to_numpy(dtype=bool)).sum()),
            f"{name}_peak_alike": float((np.abs(peaks - 1.0) <= ALIKE).sum()),
            f"{name}_peak_worst": largest(np.abs(peaks - 1.0)),
        }
    agreed, predicted = column(table, "agreement_time"), column(table, "predicted_agreement_time")
    early = table["diverged"].to_numpy(dtype=bool) & (agreed * IN_TIME < predicted)
    return numbers | {"early": float(early.sum())}


def rings(tables: Tables) -> Numbers:
    """Return the effects of a ring: peaks as ratios, place [b], twist [rad], energy where it is touched."""
    table = tables["rings"]
    ring, shaken = table["support"] == "ring", table["motion"] != FREE
    touched = table[ring & (table["contact_time"] > 0.0)]
    numbers: Numbers = {
        "touched": float(len(touched)),
        "runs": float(ring.sum()),
        "failed": float((table["outcome"] == "failed").sum()),
        "loss_worst": largest(column(touched, "loss")),
        "rolled": largest(column(table[ring & shaken], "rolled_out")),
        "flat_rolled": largest(column(table[(table["support"] == "flat") & shaken], "rolled_out")),
        "twist": largest(np.abs(column(table[ring & shaken], "twist"))),
    }
    for support in ("recess", "ring", "flat"):
        own = table[(table["support"] == support) & shaken]
        ratio = column(own, "peak") / column(own, "recess_peak")
        numbers |= {
            f"{support}_least": -largest(-ratio),
            f"{support}_largest": largest(ratio),
        }
    own = table[ring & shaken]
    halved = np.abs(column(own, "halved_peak") / column(own, "peak") - 1.0)
    best = own.groupby("clearance")["at_end"].max()
    return numbers | {
        "halved_alike": float((halved <= SMALL).sum()),
        "halved_known": float(np.isfinite(halved).sum()),
        "halved_worst": largest(halved),
        "tightest": float(str(best.idxmin())) if len(best) else math.nan,
        "tightest_at_end": float(best.min()) if len(best) else math.nan,
    }


def soft_contact(tables: Tables) -> Numbers:
    """Return up to which softness, its time constant times p, contact leaves the peak as it is."""
    table = tables["contact"]
    failed = (table["free_outcome"] == "failed") | (table["outcome"] == "failed")
    known = table[~failed]
    # one contact is one point, though its softness differs by slenderness in the third digit
    softness, constant = column(known, "softness"), column(known, "time_constant")
    off = np.abs(column(known, "peak") / column(known, "recess_peak") - 1.0)
    held, left = up_to(constant, off <= SMALL), first_failing(constant, off <= SMALL)
    within = constant <= held  # none where it is NaN
    return {
        "held_up_to": -largest(-softness[constant == held]),
        "left_from": -largest(-softness[constant == left]),
        "held_peak": largest(off[within]),
        "held_loss": max(largest(column(known, "loss")[within]), 0.0),
        "failed": float(failed.sum()),
        "points": float(len(table)),
    }


def damping(tables: Tables) -> pd.DataFrame:
    """Return the least and largest ratio of the peak, and the largest loss, by the damping of contact."""
    rows = []
    for ratio, own in tables["contact"].groupby("damping"):
        failed = (own["free_outcome"] == "failed") | (own["outcome"] == "failed")
        known = own[~failed]
        peaks = column(known, "peak") / column(known, "recess_peak")
        rows.append(
            {
                "damping": ratio,
                "points": len(own),
                "failed": int(failed.sum()),
                "least": -largest(-peaks),
                "largest": largest(peaks),
                "loss": largest(column(known, "loss")),
            }
        )
    return pd.DataFrame(rows)


LIMITS: Mapping[str, Callable[[Tables], Numbers]] = {
    "records": peak_ratios,
    "single_peaks": single_peaks,
    "traces": traces,
    "free_response": free_passes,
    "friction": friction,
    "contact": contact,
    "restraining_moment": restraining_moment,
    "rings": rings,
    "soft_contact": soft_contact,
    "vertical": vertical,
}


def limits_of(tables: Tables) -> dict[str, Numbers]:
    """Return the numbers of all limits by name.

    Parameters
    ----------
    tables : mapping of DataFrame
        Of each part by its name, as `measure_all` returns them.
    """
    return {name: limit(tables) for name, limit in LIMITS.items()}
