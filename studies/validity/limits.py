"""The limits of the model as numbers, each a function of the measured tables alone."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from rockwobble.compare.comparison.prediction import IN_TIME
from rockwobble.compare.metrics.contrast import log_ratios, pairs_in
from rockwobble.compare.metrics.pair import overturned
from rockwobble.compare.metrics.statistics import MARGIN, quantile_interval
from rockwobble.models.support import FLAT, RECESS, RECESSES_FIRST, RING, SUPPORTS
from rockwobble.models.trace import NO_PEAK

from .measurements import FREE, HALVED, PERTURBED
from .plan import EL_CENTRO, RELEASE
from .plan import POINT as POINT_NAMES

Tables = Mapping[str, "pd.DataFrame"]
Array = NDArray[np.float64]
Flags = NDArray[np.bool_]
Numbers = dict[str, float]

POINT = list(POINT_NAMES)
# two methods that are compared, and the name of their ratio; the last says how far a ring has converged
_NAMES: Mapping[tuple[str, str], str] = {
    **{(support, RECESS.model): support for support in RECESSES_FIRST},
    (FLAT.model, RECESS.model): "model",
    (PERTURBED, RECESS.model): "copy",
    (HALVED, RING): "halved",
}
CONTRASTS = tuple(_NAMES)
_SHARE = 0.9
FEWEST = 10  # nine in ten of fewer motions is all of them
# [b], or of alpha, in one period: less is the creep of a contact that never lets go
SLIPPED = 1e-3
# [weight times base radius]: a tenth of what would tip the cylinder about its rim
SLIGHT = 0.1
ALIKE = 0.01  # relative difference of period, angle of turn or peak that no shake-table test would see
SMALL = 0.05  # relative difference of peak tilt: less cannot be told from chance
# an engine confirms a model if it is nearer to it than this share of the difference of the models
CONFIRMS = 0.5
# and contradicts it where turn or period is off by more than this; the step of an engine errs by less
_CONTRADICTS = 1e-3
_ROUNDING = 1e-9  # relative, of a peak that was stored over alpha


def column(table: pd.DataFrame, name: str) -> Array:
    """Return a column as numbers."""
    return table[name].to_numpy(dtype=np.float64)


def quotient(table: pd.DataFrame, name: str = "peak", by: str = "recess_peak") -> Array:
    """Return a column over another."""
    return column(table, name) / column(table, by)


def largest(values: Array) -> float:
    """Return the largest finite value; NaN where there is none."""
    finite = values[np.isfinite(values)]
    return float(finite.max()) if len(finite) else math.nan


def least(values: Array) -> float:
    """Return the least finite value; NaN where there is none."""
    return -largest(-values)


def quantile_reached(values: Array, share: float) -> float:
    """Return a value that a share of all does not exceed, infinite ones included; NaN of nothing."""
    known = values[~np.isnan(values)]
    return float(np.quantile(known, share, method="inverted_cdf")) if len(known) else math.nan


def limit_of(points: Array, holds: Flags) -> tuple[float, float]:
    """Return the largest point up to which every point holds, and the least that does not.

    Several rows may share a point, which holds where all of its rows do. NaN where already the first does
    not hold, and where all do.
    """
    every = pd.Series(holds).groupby(points).all()
    held, failing = every.index[every.cummin()], every.index[~every]
    return float(held.max()), float(failing.min())


def contrasts(tables: Tables) -> pd.DataFrame:
    """Return the contrasts of the methods with one another at each point, member by member.

    Returns
    -------
    DataFrame
        tan_alpha, semidiagonal, intensity, method, against, and the attributes of `Contrast`: of the ratio
        of the two peaks of a record the median, what 5 % and 95 % of the records do not exceed, each with its
        95 % interval, and more. 0 and infinity: it overturns by one of the two alone.
    """
    rows = []
    for point, runs in tables["records"].groupby(POINT, sort=False):
        for method, against in CONTRASTS:
            found = pairs_in(runs, method, against, member="motion", peak="peak").contrast()
            if found is not None:
                at = dict(zip(POINT, point, strict=True)) | {"method": method, "against": against}
                rows.append(at | found.columns())
    return pd.DataFrame(rows)


def records(tables: Tables) -> Numbers:
    """Return the range over the points of the contrasts of each method.

    NAME_least and NAME_largest, of the median ratio to the recess model; NAME_05_least to NAME_95_largest, of
    what 5 % and 95 % of the records of a point do not exceed; NAME_within and NAME_beyond, the number of
    points where the median is known to be within the margin, and beyond it. NAME "halved" is the ring at half
    the step against itself; under a slab neither is there.
    """
    table, runs = contrasts(tables), tables["records"]
    numbers: Numbers = {
        "members": float(table["count"].max()),
        "points": float(len(table[POINT].drop_duplicates())),
    }
    for (method, against), name in _NAMES.items():
        if not {method, against} <= set(runs["method"]):  # under a slab there is no ring
            continue
        own = table[(table["method"] == method) & (table["against"] == against)]
        for share in ("", "_05", "_95"):
            numbers[f"{name}{share}_least"] = float(own[f"ratio{share}"].min())
            numbers[f"{name}{share}_largest"] = float(own[f"ratio{share}"].max())
        for verdict in ("within", "beyond"):
            numbers[f"{name}_{verdict}"] = float((own["verdict"] == verdict).sum())
    touched = runs[(runs["method"] != HALVED) & (runs["contact_time"] > 0.0)]
    standing = column(runs[(runs["method"] == RING) & (runs["outcome"] == "stands")], "peak")
    strays = table[table["against"] == RECESS.model]
    return numbers | {
        "undecided": float((runs["outcome"] == "undecided").sum()),
        "ring_standing": float(len(standing)),
        "ring_passed": float((standing >= 1.0).sum()),
        "ring_passed_largest": largest(standing),
        "strays_bounded": float(np.isfinite(column(strays, "ratio_95_high")).sum()),
        "touched": float(len(touched)),
        "ring_loss_worst": largest(column(touched, "loss")),
        "failed": float(runs["outcome"].isin(NO_PEAK).sum()),
        "runs": float(len(runs)),
    }


def cells(tables: Tables) -> pd.DataFrame:
    """Return the maps of the reduced models: one row for each slenderness, size and intensity.

    Returns
    -------
    DataFrame
        tan_alpha, semidiagonal, intensity; members, records of the cell; rocked, those that uplift; for flat
        (the flat-ground model) and copy (the perturbed copy) against the recess model the median ratio of the
        peaks (NAME_ratio, low, high) and the factor that nine in ten records do not exceed to either side
        (NAME_90); overturned and flat_overturned, shares of the records; standing, records that rock without
        overturning, and of these friction_90 over tan(alpha), normal_10 [weights] and moment_90, which nine
        in ten do not exceed, or keep (NaN of fewer than `FEWEST`), with a tendon tension_90 [weights of a
        column], and lost, the share that loses contact. Without a flat-ground model its columns are NaN.
    """
    rows = []
    table = tables["peaks"]
    for point, members in table[table["motion"] != EL_CENTRO].groupby(POINT, sort=False):
        row = dict(zip(POINT, point, strict=True)) | {
            "members": len(members),
            "rocked": int((members[RECESS] > 0.0).sum()),
            "overturned": float(_fell(members, RECESS).mean()),
        }
        for name in (FLAT, "copy"):
            logarithms = _changes(members, name)
            logarithms = logarithms[~np.isnan(logarithms)]
            median = quantile_interval(logarithms, 0.5).exponential()
            row |= {
                f"{name}_ratio": median.value,
                f"{name}_low": median.low,
                f"{name}_high": median.high,
                f"{name}_90": math.exp(quantile_reached(np.abs(logarithms), _SHARE)),
                f"{name}_overturned": float(_fell(members, name).mean()),
            }
        normal = column(members, "least_normal")
        known = normal[~np.isnan(normal)]
        row |= {
            "standing": len(known),
            "friction_90": _nine_in_ten(column(members, "friction")) / members["tan_alpha"].iloc[0],
            "normal_10": -_nine_in_ten(-normal),
            "moment_90": _nine_in_ten(column(members, "moment")),
            "lost": float((known <= 0.0).mean()) if len(known) else math.nan,
        }
        if "tension" in members:
            row["tension_90"] = _nine_in_ten(column(members, "tension"))
        rows.append(row)
    return pd.DataFrame(rows)


def _nine_in_ten(values: Array) -> float:
    """90th percentile of the known values; NaN of too few."""
    enough = np.count_nonzero(~np.isnan(values)) >= FEWEST
    return quantile_reached(values, _SHARE) if enough else math.nan


def _fell(table: pd.DataFrame, name: str) -> Flags:
    """Whether the peaks of a column, over alpha, are those of overturned runs."""
    tilts = column(table, name) * np.arctan(column(table, "tan_alpha"))
    return overturned(tilts * (1.0 + _ROUNDING))


def _changes(table: pd.DataFrame, name: str) -> Array:
    """Return the logarithms of the peaks of a column over those of the recess model, see `log_ratios`."""
    return log_ratios(column(table, name), column(table, RECESS), _fell(table, name), _fell(table, RECESS))


def vertical(tables: Tables) -> Numbers:
    """Return the change of the peak by the vertical component of El Centro, beside a record 1 % stronger.

    NAME_apart counts the cells whose peak changes by more than the margin, those that overturn by one alone
    included; NAME_least and NAME_largest are of the others.
    """
    table = tables["peaks"]
    table = table[table["vertical"].notna()]
    fell = _fell(table, RECESS)
    numbers: Numbers = {"cells": float(len(table)), "fell": float(fell.sum())}
    for name in ("vertical", "copy"):
        theirs, logarithms = _fell(table, name), _changes(table, name)
        # the ratio is infinite or zero where one model alone overturns, undefined where both do
        numbers |= {
            f"{name}_compared": float((~np.isnan(logarithms)).sum()),
            f"{name}_apart": float((np.abs(logarithms) > math.log1p(MARGIN)).sum()),
            f"{name}_least": math.exp(least(logarithms)),
            f"{name}_largest": math.exp(largest(logarithms)),
            f"{name}_fell": float(theirs.sum()),
            f"{name}_other": float((theirs != fell).sum()),
        }
    return numbers


def needs(tables: Tables) -> pd.DataFrame:
    """Demands on ground and recess, by slenderness and intensity.

    What nine in ten of the records that rock a cylinder without overturning it need at most, of the size that
    needs most: sizes differ by a few percent, slenderness and intensity by factors.

    Returns
    -------
    DataFrame
        tan_alpha, intensity, sizes with enough such records, motions that rock them, friction over
        tan(alpha), normal [weights] (at least), moment over weight and base radius, and with a tendon tension
        [weights of a column]. No row where no size has enough.
    """
    known = cells(tables).dropna(subset="moment_90")
    tension = {"tension": ("tension_90", "max")} if "tension_90" in known else {}
    return known.groupby(["tan_alpha", "intensity"], as_index=False).agg(
        sizes=("semidiagonal", "count"),
        motions=("standing", "sum"),
        friction=("friction_90", "max"),
        normal=("normal_10", "min"),
        moment=("moment_90", "max"),
        **tension,
    )


def friction(tables: Tables) -> Numbers:
    """Return the friction needed over tan(alpha), and where the engine slips with less than needed."""
    slip = tables["slip"]
    share = column(slip, "share")
    # slip is counted at the base; under a slab it shows as a tilt that errs, or as energy that ends the run
    slipped = (slip[["slip", "tilt_rms"]] > SLIPPED).any(axis="columns") | slip["outcome"].isin(NO_PEAK)
    slips_at, sticks = largest(share[slipped]), share[~slipped]
    sticks = sticks[~(sticks <= slips_at)]  # a base that slips at one release does not stick at all
    nearest = slip[share == slips_at]
    return {
        "free_response": largest(quotient(tables["free_response"], "friction", "tan_alpha")),
        "shaken": largest(quotient(tables["peaks"], "friction", "tan_alpha")),
        "slips_at": slips_at,
        "holds_from": least(sticks),
        "tilt_error": largest(column(nearest, "tilt_rms")),
        "slip": largest(column(nearest, "slip")),
    }


def contact(tables: Tables) -> Numbers:
    """Return the least normal force [weights], and from which slenderness and intensity contact is lost."""
    free, moving = tables["free_response"], tables["peaks"].dropna(subset="least_normal")
    tan_alpha, normal = column(moving, "tan_alpha"), column(moving, "least_normal")
    in_free = column(free, "least_normal")
    lost = moving[normal <= 0.0]
    held, lost_from = limit_of(tan_alpha, normal > 0.0)
    return {
        "lost_from": lost_from,
        "lost_intensity": float(lost["intensity"].min()),
        "least_held": float(moving["least_normal"][tan_alpha <= held].min()),
        "least": float(np.concatenate([normal, in_free]).min()),
        "lost": float(len(lost)),
        "runs": float(len(moving)),
        "free_least": float(in_free.min()),
        "free_lost_from": limit_of(column(free, "tan_alpha"), in_free > 0.0)[1],
        "shaken_least": least(normal),
        "free_least_tan_alpha": float(column(free, "tan_alpha")[int(np.nanargmin(in_free))]),
    }


def restraining_moment(tables: Tables) -> Numbers:
    """Return the restraining moment over weight and base radius."""
    moving = tables["peaks"].dropna(subset="moment")
    needed = column(moving, "moment")
    slight, _ = limit_of(column(moving, "tan_alpha"), needed <= SLIGHT)
    return {
        "free_response": largest(column(tables["free_response"], "moment")),
        "shaken": largest(needed),
        "slight_up_to": slight,
    }


def tendon(tables: Tables) -> Numbers:
    """Return the largest tension of a tendon [weights of a column]."""
    parts = {"free_response": "free_response", "shaken": "peaks"}
    return {name: largest(column(tables[part], "tension")) for name, part in parts.items()}


def free_response(tables: Tables) -> Numbers:
    """Return the difference of recess and flat ground in a pass, and the releases that an engine decides.

    Without a flat-ground model there is no difference.
    """
    table = tables["free_response"]
    if table["flat_turn"].isna().all():
        return _confirmations(tables["verification"])
    off = np.abs(column(table, "flat_turn") - column(table, "turn"))
    turns = np.abs(quotient(table, "flat_turn", "turn") - 1.0)
    periods = np.abs(quotient(table, "flat_period", "period") - 1.0)
    alike, _ = limit_of(column(table, "tan_alpha"), (turns <= ALIKE) & (periods <= ALIKE))
    worst = table.iloc[int(np.nanargmax(off))]
    return {
        "alike_up_to": alike,
        "turn_largest": largest(turns),
        "turn_largest_deg": math.degrees(largest(off)),
        **{f"worst_{name}": float(worst[name]) for name in RELEASE},
        "period_largest": largest(periods),
        "peak_gain": max(largest(column(table, "flat_peak")) - 1.0, 0.0),
        **_confirmations(tables["verification"]),
    }


def _confirmations(table: pd.DataFrame) -> Numbers:
    """Count the runs that confirm their model, those that contradict it, and all whose pass is resolved.

    One that failed decides nothing: it has said so itself. Where there is one model it is confirmed by what
    does not contradict it.
    """
    decides = table["resolved"].astype(bool) & ~table["outcome"].isin(NO_PEAK)
    resolved = table.assign(apart=model_difference(table))[decides]
    error = np.abs(column(resolved, "engine_turn") - column(resolved, "turn"))
    turn_off = error / np.abs(column(resolved, "turn"))
    period_off = np.abs(quotient(resolved, "engine_half_period", "half_period") - 1.0)
    contradicts = ~((turn_off <= _CONTRADICTS) & (period_off <= _CONTRADICTS))
    apart = column(resolved, "apart")
    confirms = ~contradicts & (np.isnan(apart) | (error < CONFIRMS * apart))
    return {
        "confirmed": float(confirms.sum()),
        "contradicted": float(contradicts.sum()),
        "points": float(len(resolved)),
        "releases": float(len(resolved[list(RELEASE)].drop_duplicates())),
    }


def model_difference(table: pd.DataFrame) -> Array:
    """Difference of the angles of turn of the recess and flat models in the release of each row.

    NaN where there is one of them alone.
    """
    turns = table.groupby(list(RELEASE))["turn"]
    apart = turns.transform(lambda each: np.ptp(each.to_numpy())).to_numpy(dtype=np.float64)
    return np.where(turns.transform("size") > 1, apart, math.nan)


def traces(tables: Tables) -> Numbers:
    """Return agreement times [s] of engine and model, and the count that diverge earlier than predicted.

    NAME and NAME_longest: the shortest and the longest; NAME_whole, runs that agree to their end.
    """
    table = tables["following"]
    numbers: Numbers = {"duration": largest(column(table, "duration")), "comparisons": float(len(table))}
    compared = {RECESS: (RECESS, RECESS), FLAT: (FLAT, RECESS), "own": (FLAT, FLAT)}
    for name, (support, reference) in compared.items():
        own = table[(table["support"] == support) & (table["reference_support"] == reference)]
        off = np.abs(quotient(own, "peak_tilt", "reference_peak_tilt") - 1.0)
        numbers |= {
            name: least(column(own, "agreement_time")),
            f"{name}_longest": largest(column(own, "agreement_time")),
            f"{name}_runs": float(len(own)),
            f"{name}_whole": float((~own["diverged"].to_numpy(dtype=bool)).sum()),
            f"{name}_peak_alike": float((off <= ALIKE).sum()),
            f"{name}_peak_worst": largest(off),
        }
    early = column(table, "agreement_time") * IN_TIME < column(table, "predicted_agreement_time")
    return numbers | {"early": float((table["diverged"].to_numpy(dtype=bool) & early).sum())}


def rings(tables: Tables) -> Numbers:
    """Return the effects of a ring: peaks as ratios, place [b], twist [rad], energy where it is touched."""
    table = tables["rings"]
    ring = table[table["support"].map({name: support.walls for name, support in SUPPORTS.items()})]
    touched, shaken = ring[ring["contact_time"] > 0.0], ring[ring["motion"] != FREE]
    by_support = dict(list(table[table["motion"] != FREE].groupby("support")))
    numbers: Numbers = {
        "touched": float(len(touched)),
        "runs": float(len(ring)),
        "failed": float(table["outcome"].isin(NO_PEAK).sum()),
        "loss_worst": largest(column(touched, "loss")),
        "rolled": largest(column(shaken, "rolled_out")),
        "flat_rolled": largest(column(by_support[FLAT], "rolled_out")),
        "twist": largest(np.abs(column(shaken, "twist"))),
        "free_twist": largest(np.abs(column(ring[ring["motion"] == FREE], "twist"))),
    }
    for support in (each for each in RECESSES_FIRST if each in by_support):  # stored tables know no new one
        ratio = quotient(by_support[support])
        numbers |= {f"{support}_least": least(ratio), f"{support}_largest": largest(ratio)}
    halved = np.abs(quotient(shaken, "halved_peak", "peak") - 1.0)
    best = shaken.groupby("clearance")["at_end"].max()
    # the one whose peak is farthest from that of the recess model; walls of inclination 0 lean by alpha
    known = shaken[shaken["outcome"] != "failed"]
    with np.errstate(divide="ignore"):
        far = int(np.nanargmax(np.abs(np.log(quotient(known)))))
    names = ("tan_alpha", "turn", "clearance", "inclination", "friction")
    numbers |= {f"worst_{name}": float(known[name].iloc[far]) for name in names}
    numbers["worst_inclination"] = numbers["worst_inclination"] or math.nan
    numbers["worst_ratio"] = float(quotient(known)[far])
    return numbers | {
        "halved_alike": float((halved <= SMALL).sum()),
        "halved_known": float(np.isfinite(halved).sum()),
        "halved_worst": largest(halved),
        "tightest": float(str(best.idxmin())) if len(best) else math.nan,
        "tightest_at_end": float(best.min()),
    }


def _soft_contacts(tables: Tables) -> pd.DataFrame:
    """The runs with other contact settings: failed, ratio of the peaks, loss; NaN where one failed."""
    table = tables["contact"]
    failed = table[["free_outcome", "outcome"]].isin(NO_PEAK).any(axis="columns")
    known = table.assign(ratio=quotient(table))[["ratio", "loss"]].mask(failed)
    return table.assign(failed=failed, **known)


def soft_contact(tables: Tables) -> Numbers:
    """Return the largest softness of contact (time constant times p) that does not change the peak."""
    table = _soft_contacts(tables)
    known = table[~table["failed"]]
    # one contact is one point, though its softness differs by slenderness in the third digit
    softness, constant = column(known, "softness"), column(known, "time_constant")
    off = np.abs(column(known, "ratio") - 1.0)
    held, left = limit_of(constant, off <= SMALL)
    within = constant <= held  # none where it is NaN
    stiff = table[column(table, "time_constant") <= held]
    failed = stiff[stiff["failed"]]
    return {
        "held_runs": float(len(stiff)),
        "held_ended": float(len(stiff) - len(failed)),
        "failed_up_to": largest(column(failed, "softness")),
        "failed_damping_least": least(column(failed, "damping")),
        "failed_damping_largest": largest(column(failed, "damping")),
        "held_up_to": least(softness[constant == held]),
        "left_from": least(softness[constant == left]),
        "held_peak": largest(off[within]),
        "held_loss": max(largest(column(known, "loss")[within]), 0.0),
        "failed": float(table["failed"].sum()),
        "points": float(len(table)),
    }


def damping(tables: Tables) -> pd.DataFrame:
    """Return the least and largest ratio of the peak, and the largest loss, by the damping of contact."""
    return (
        _soft_contacts(tables)
        .groupby("damping", as_index=False)
        .agg(
            points=("failed", "size"),
            failed=("failed", "sum"),
            least=("ratio", "min"),
            largest=("ratio", "max"),
            loss=("loss", "max"),
        )
    )


# every limit, by the name of its function
LIMITS: Mapping[str, Callable[[Tables], Numbers]] = {
    limit.__name__: limit
    for limit in (
        *(records, traces, free_response, friction, contact),
        *(restraining_moment, tendon, rings, soft_contact, vertical),
    )
}


def limits_of(tables: Tables) -> dict[str, Numbers]:
    """Return the numbers of all limits by name.

    Parameters
    ----------
    tables : mapping of DataFrame
        Of each part by its name, as `measure_all` returns them: without rings there is no limit of them, nor
        of a tendon without one.
    """
    lacking = {rings.__name__} - set(tables)
    if "tension" not in tables["peaks"]:
        lacking.add(tendon.__name__)
    return {name: limit(tables) for name, limit in LIMITS.items() if name not in lacking}
