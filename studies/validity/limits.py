"""Limits of the model, as numbers, maps and findings from the measured tables."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from rockwobble.compare.comparison.prediction import IN_TIME
from rockwobble.compare.metrics.contrast import Pairs, pairs_in
from rockwobble.compare.metrics.pair import overturned
from rockwobble.compare.metrics.statistics import MARGIN, quantile_interval
from rockwobble.models.finding import Finding, Findings, Level, Value
from rockwobble.models.support import FLAT, RECESS, RECESSES_FIRST, RING, SUPPORTS
from rockwobble.models.trace import NO_PEAK

from .plan import EL_CENTRO, FREE, HALVED, PERTURBED, RELEASE, Structure
from .plan import POINT as POINT_NAMES

Tables = Mapping[str, "pd.DataFrame"]
Flags = NDArray[np.bool_]

POINT = list(POINT_NAMES)
# pairs of compared methods; the last one measures convergence of a recess with clearance
CONTRASTS = (
    *((support, RECESS.model) for support in RECESSES_FIRST),
    (FLAT.model, RECESS.model),
    (PERTURBED, RECESS.model),
    (HALVED, RING),
)
_SHARE = 0.9
FEWEST = 10  # fewest motions for a 90th percentile
# [b] or alpha per period: creep of a contact that never opens is smaller
SLIPPED = 1e-3
# [weight times base radius]: a tenth of what would tip the cylinder about its rim
SLIGHT = 0.1
ALIKE = 0.01  # relative difference of period, angle of turn or peak that no shake-table test would see
SMALL = 0.05  # relative difference of peak tilt: less cannot be told from chance
# an engine confirms a model within this share of the difference of the models
CONFIRMS = 0.5
# and contradicts it where turn or period is off by more than this; the step of an engine errs by less
_CONTRADICTS = 1e-3
_ROUNDING = 1e-9  # relative rounding of a peak stored over alpha


def largest(values: pd.Series[float]) -> float:
    """Largest finite value; NaN if none."""
    return float(values[np.isfinite(values)].max())


def least(values: pd.Series[float]) -> float:
    """Least finite value; NaN if none."""
    return -largest(-values)


def quantile_reached(values: pd.Series[float], share: float) -> float:
    """Quantile of the known values, infinite ones included; NaN without any."""
    known = values.dropna()
    return float(np.quantile(known, share, method="inverted_cdf")) if len(known) else math.nan


def limit_of(points: pd.Series[float], holds: pd.Series[bool]) -> tuple[float, float]:
    """Largest point up to which every point holds, and the least that fails.

    Several rows may share a point, which holds where all of its rows do. NaN where already the first does
    not hold, and where all do.
    """
    every = holds.groupby(points).all()
    return float(every.index[every.cummin()].max()), float(every.index[~every].min())


def contrasts(tables: Tables) -> pd.DataFrame:
    """Contrasts of the methods with one another at each point, member by member.

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
            contrast = pairs_in(runs, method, against, member="motion", peak="peak").contrast()
            if contrast is not None:
                at = dict(zip(POINT, point, strict=True)) | {"method": method, "against": against}
                rows.append(at | contrast.columns())
    return pd.DataFrame(rows)


def _ends(table: pd.DataFrame, method: str, column: str = "ratio", name: str = "ratio") -> dict[str, float]:
    """NAME_least and NAME_largest: range of a column of a method over the points; NaN without any."""
    values = table.loc[table["method"] == method, column]
    return {
        f"{name}_{end}": float(each) for end, each in (("least", values.min()), ("largest", values.max()))
    }


def cells(tables: Tables) -> pd.DataFrame:
    """Maps of the reduced models: one row for each slenderness, size and intensity.

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
            "overturned": _fell(members, RECESS).mean(),
        }
        for name in (FLAT, "copy"):
            logarithms = _changes(members, name).dropna()
            median = quantile_interval(np.asarray(logarithms, dtype=np.float64), 0.5).exponential()
            row |= {
                f"{name}_ratio": median.value,
                f"{name}_low": median.low,
                f"{name}_high": median.high,
                f"{name}_90": math.exp(quantile_reached(logarithms.abs(), _SHARE)),
                f"{name}_overturned": _fell(members, name).mean(),
            }
        normal = members["least_normal"]
        row |= {
            "standing": normal.count(),
            "friction_90": _nine_in_ten(members["friction"]) / members["tan_alpha"].iloc[0],
            "normal_10": -_nine_in_ten(-normal),
            "moment_90": _nine_in_ten(members["moment"]),
            "lost": (normal.dropna() <= 0.0).mean(),
        }
        if "tension" in members:
            row["tension_90"] = _nine_in_ten(members["tension"])
        rows.append(row)
    return pd.DataFrame(rows)


def _nine_in_ten(values: pd.Series[float]) -> float:
    """90th percentile of the known values; NaN with fewer than `FEWEST`."""
    return quantile_reached(values, _SHARE) if values.count() >= FEWEST else math.nan


def _fell(table: pd.DataFrame, name: str) -> Flags:
    """Whether the peaks of a column, over alpha, are of overturned runs."""
    tilts = (table[name] * np.arctan(table["tan_alpha"])).to_numpy(dtype=np.float64)
    return overturned(tilts * (1.0 + _ROUNDING))


def _changes(table: pd.DataFrame, name: str) -> pd.Series[float]:
    """Log ratios of the peaks of a column to those of the recess model, see `Pairs.log_ratios`."""
    peaks, recess = (table[each].to_numpy(dtype=np.float64) for each in (name, RECESS))
    return pd.Series(Pairs(peaks, recess, _fell(table, name), _fell(table, RECESS)).log_ratios())


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


def vertical(tables: Tables) -> pd.DataFrame:
    """Change of the peak due to the vertical component of El Centro, compared with a record 1 % stronger.

    Returns
    -------
    DataFrame
        A row for vertical, for copy, and for the recess model without either: cells, all; overturned;
        compared, those that do not overturn twice; apart, those whose peak changes by more than the margin,
        those that overturn by one alone included; least and largest factor of the others; other, cells that
        overturn by one alone.
    """
    table = tables["peaks"].dropna(subset="vertical")
    fell = _fell(table, RECESS)
    rows = {}
    for name in ("vertical", "copy"):
        logarithms = _changes(table, name)
        rows[name] = {
            "cells": len(table),
            "compared": logarithms.count(),
            "apart": (logarithms.abs() > math.log1p(MARGIN)).sum(),
            "least": math.exp(least(logarithms)),
            "largest": math.exp(largest(logarithms)),
            "other": (_fell(table, name) != fell).sum(),
            "overturned": _fell(table, name).sum(),
        }
    rows[RECESS] = {"cells": len(table), "overturned": fell.sum()}
    return pd.DataFrame.from_dict(rows, orient="index")


def traces(tables: Tables) -> pd.DataFrame:
    """Agreement of single traces of the engine with each model.

    Returns
    -------
    DataFrame
        A row for each support and reference_support: low and high, least and largest agreement time [s];
        runs; whole, those that agree to their end; alike, those whose peak is that of the model within 1 %,
        and worst, the largest relative difference of the peak.
    """
    table = tables["following"]
    off = (table["peak_tilt"] / table["reference_peak_tilt"] - 1.0).abs()
    table = table.assign(whole=~table["diverged"].astype(bool), off=off, alike=off <= ALIKE)
    return table.groupby(["support", "reference_support"], as_index=False).agg(
        low=("agreement_time", "min"),
        high=("agreement_time", "max"),
        runs=("whole", "size"),
        whole=("whole", "sum"),
        alike=("alike", "sum"),
        worst=("off", "max"),
    )


def early(tables: Tables) -> int:
    """Number of traces that diverge earlier than predicted."""
    table = tables["following"]
    before = table["agreement_time"] * IN_TIME < table["predicted_agreement_time"]
    return int((table["diverged"].astype(bool) & before).sum())


def model_difference(table: pd.DataFrame) -> pd.Series[float]:
    """Difference in angle of turn between the recess and flat-ground models for the release of each row.

    NaN where there is one of them alone.
    """
    turns = table.groupby(list(RELEASE))["turn"]
    apart = turns.transform("max") - turns.transform("min")
    return apart.where(turns.transform("size") > 1)


def _confirmations(table: pd.DataFrame) -> dict[str, int]:
    """Runs with a resolved pass: releases, and numbers that confirm and contradict their model.

    One that failed decides nothing: it has said so itself. Where there is one model it is confirmed by what
    does not contradict it.
    """
    known = table.assign(apart=model_difference(table))
    known = known[table["resolved"].astype(bool) & ~table["outcome"].isin(NO_PEAK)]
    error = (known["engine_turn"] - known["turn"]).abs()
    period_off = (known["engine_half_period"] / known["half_period"] - 1.0).abs()
    agrees = (error / known["turn"].abs() <= _CONTRADICTS) & (period_off <= _CONTRADICTS)
    nearer = known["apart"].isna() | (error < CONFIRMS * known["apart"])
    return {
        "runs": int((agrees & nearer).sum()),
        "runs_all": len(known),
        "count": len(known[list(RELEASE)].drop_duplicates()),
        "runs_contradicted": int((~agrees).sum()),
    }


def soft_contacts(tables: Tables) -> pd.DataFrame:
    """Runs with other contact settings: failures, peak ratio, loss; NaN after a failure."""
    table = tables["contact"]
    failed = table[["free_outcome", "outcome"]].isin(NO_PEAK).any(axis="columns")
    known = table.assign(ratio=table["peak"] / table["recess_peak"])[["ratio", "loss"]].mask(failed)
    return table.assign(failed=failed, **known)


def damping(tables: Tables) -> pd.DataFrame:
    """Least and largest peak ratio, and largest loss, by contact damping."""
    by_damping = soft_contacts(tables).groupby("damping", as_index=False)
    return by_damping.agg(
        points=("failed", "size"),
        failed=("failed", "sum"),
        least=("ratio", "min"),
        largest=("ratio", "max"),
        loss=("loss", "max"),
    )


def limits_of(tables: Tables, structure: Structure) -> pd.DataFrame:
    """All numbers of the findings, of `vertical` and of `traces`: limit, number, value."""
    models = traces(tables)
    models.index = models.pop("support") + "_" + models.pop("reference_support")
    numbers: dict[str, Mapping[Any, Any]] = {
        **{each.key: each.values for each in findings_of(tables, structure)},  # noqa: PD011
        **{f"vertical.{name}": row for name, row in vertical(tables).to_dict("index").items()},
        **{f"traces.{name}": row for name, row in models.to_dict("index").items()},
    }
    rows = [(limit, name, value) for limit, values in numbers.items() for name, value in values.items()]
    return pd.DataFrame(rows, columns=["limit", "number", "value"]).astype({"value": float})


def findings_of(tables: Tables, structure: Structure) -> Findings:
    """Findings by group: limit_scope, limit_model, limit_requirement and so on.

    Parameters
    ----------
    tables : mapping of DataFrame
        Of each part by its name, as `measure_all` returns them: without rings there is no finding of them,
        nor of a tendon without one.
    structure : Structure
    """
    table = contrasts(tables)
    groups = [_scope(structure), _model(tables, table), _requirements(tables), _records(tables, table)]
    groups += [_releases(tables), _forces(tables, structure), _rings(tables)]
    return Findings(each for group in groups for each in group)


def _finding(key: str, level: Level = "note", /, **values: Value) -> Finding:
    return Finding(key=f"limit_{key}", level=level, values=values)


def _scope(structure: Structure) -> Iterator[Finding]:
    if structure.slab_mass_ratio:
        yield _finding("scope.slab", ratio=structure.slab_mass_ratio)
    if tendon := structure.tendon:
        given = {"given": tendon.prestress, "given_stiffness": tendon.stiffness}
        yield _finding("scope.tendon", **given, factor=structure.uplift)


def _model(tables: Tables, table: pd.DataFrame) -> Iterator[Finding]:
    """Verdict on the reduced model by an engine in an ideal recess.

    It is contradicted where one release is that of another motion, or where the median ratio of the peaks at
    one point is known to be beyond the margin; established where the median is known to be within the margin
    at some point, and beyond it at none.
    """
    members, points = int(table["count"].max()), len(table[POINT].drop_duplicates())
    decided = _confirmations(tables["verification"])
    verdicts = table.loc[table["method"] == RECESS, "verdict"]
    within, beyond = (int((verdicts == each).sum()) for each in ("within", "beyond"))
    if contradicted := decided["runs_contradicted"] or beyond:
        runs = {"runs": decided["runs_contradicted"] or math.nan, "runs_all": decided["runs_all"]}
        counts = {"count": beyond or math.nan, "count_all": points}
        yield _finding("model.contradicted", "not satisfied", **runs, **counts)
    else:
        key = "established" if within else "undecided"
        level: Level = "satisfied" if within else "not tested"
        counts = {"count": within, "count_all": points, "share": MARGIN}
        yield _finding(f"model.{key}", level, runs=members, **_ends(table, RECESS), **counts)
    bands: dict[str, str] = {**dict(zip(RECESSES_FIRST, RECESSES_FIRST, strict=True)), "copy": PERTURBED}
    strays: dict[str, float] = {}
    for name, method in bands.items():
        strays |= _ends(table, method, "ratio_95", f"ratio_{name}")
    if not contradicted and not all(map(math.isnan, strays.values())):
        yield _finding("model.strays", "caution", **strays, runs=members)
        if not np.isfinite(table.loc[table["against"] == RECESS.model, "ratio_95_high"]).any():
            yield _finding("model.unbounded", "caution")
    # False without such recesses, and of too few records to know
    if strays[f"ratio_{RING}_largest"] > 1.0:
        yield _finding("clearance.unconservative", "caution")


def _requirements(tables: Tables) -> Iterator[Finding]:
    peaks = tables["peaks"]
    yield _finding("requirement.friction", ratio=largest(peaks["friction"] / peaks["tan_alpha"]))
    moving = peaks.dropna(subset="least_normal")
    normal, tan_alpha = moving["least_normal"], moving["tan_alpha"]
    kept, lost_from = limit_of(tan_alpha, normal > 0.0)
    values = {"runs": len(moving), "bound": float(normal[tan_alpha <= kept].min())}
    if lost := int((normal <= 0.0).sum()):
        weakest = float(moving.loc[normal <= 0.0, "intensity"].min())
        values |= {"runs_lost": lost, "ratio": lost_from, "factor": weakest}
    yield _finding("requirement.contact_lost" if lost else "requirement.contact", **values)
    yield _finding("requirement.recess", ratio=largest(peaks["moment"]))
    if "tension" in peaks:
        yield _finding("requirement.tendon", ratio=largest(peaks["tension"]))
    yield _stiffness(soft_contacts(tables))
    yield _finding("requirement.question")


def _stiffness(table: pd.DataFrame) -> Finding:
    """Finding on the largest contact softness (time constant times p) that leaves the peak unchanged."""
    known = table[~table["failed"]]
    off = (known["ratio"] - 1.0).abs()
    # one contact is one point, although its rounded softness differs by slenderness
    held, _ = limit_of(known["time_constant"], off <= SMALL)
    stiff = table[table["time_constant"] <= held]  # none where it is NaN
    failed = stiff[stiff["failed"]]
    return _finding(
        "requirement.stiffness",
        bound=least(known.loc[known["time_constant"] == held, "softness"]),
        share=largest(off[known["time_constant"] <= held]),
        runs=len(stiff),
        runs_ended=len(stiff) - len(failed),
        ratio=largest(failed["softness"]),
        given_least=least(failed["damping"]),
        given_largest=largest(failed["damping"]),
    )


def _records(tables: Tables, table: pd.DataFrame) -> Iterator[Finding]:
    runs = tables["records"]
    low, high = _ends(table, HALVED, "ratio_05"), _ends(table, HALVED, "ratio_95", "ratio_95")
    if math.isfinite(high["ratio_95_least"]):
        # 90 % of the motions have equal peaks at half the step
        converged = low["ratio_least"] >= 1.0 / (1.0 + MARGIN) and high["ratio_95_largest"] <= 1.0 + MARGIN
        key = "converged" if converged else "not_converged"
        yield _finding(f"records.{key}", "note" if converged else "caution", **_ends(table, HALVED), **high)
    ring = runs["method"] == RING
    if ring.any():
        standing = runs.loc[ring & (runs["outcome"] == "stands"), "peak"]
        if passed := int((standing >= 1.0).sum()):
            most = largest(standing)
            yield _finding("records.beyond_alpha", "caution", runs=passed, runs_all=len(standing), peak=most)
        touched = runs[(runs["method"] != HALVED) & (runs["contact_time"] > 0.0)]
        yield _finding("records.touched", runs=len(touched), share=largest(touched["loss"]))
    if failed := int(runs["outcome"].isin(NO_PEAK).sum()):
        open_ended = int((runs["outcome"] == "undecided").sum())
        counts = {"count": failed - open_ended, "count_undecided": open_ended}
        yield _finding("records.left_out", runs=len(runs), **counts)


def _releases(tables: Tables) -> Iterator[Finding]:
    table, engine = tables["free_response"], _confirmations(tables["verification"])
    values = {**engine, "runs_contradicted": engine["runs_contradicted"] or math.nan}
    if table["flat_turn"].isna().all():
        yield _finding("release.confirmed", **values)
        return
    off = (table["flat_turn"] - table["turn"]).abs()
    turns = (table["flat_turn"] / table["turn"] - 1.0).abs()
    periods = (table["flat_period"] / table["period"] - 1.0).abs()
    alike, _ = limit_of(table["tan_alpha"], (turns <= ALIKE) & (periods <= ALIKE))
    yield _finding("release.alike", ratio=alike)
    worst = table.iloc[int(np.nanargmax(off))]
    yield _finding(
        "release.off",
        share_period=largest(periods),
        share_peak=max(largest(table["flat_peak"]) - 1.0, 0.0),
        share_turn=largest(turns),
        bound=math.degrees(largest(off)),
        ratio=float(worst["tan_alpha"]),
        peak=float(worst["release"]),
        factor=float(worst["spin"]),
    )
    unsure = engine["runs_all"] - engine["runs"] - engine["runs_contradicted"]
    yield _finding("release.decided", **values, runs_open=unsure or math.nan)


def _forces(tables: Tables, structure: Structure) -> Iterator[Finding]:
    free, peaks, slip = (tables[name] for name in ("free_response", "peaks", "slip"))
    yield _finding("force.friction", ratio=largest(free["friction"] / free["tan_alpha"]))
    # slip is counted at the base; under a slab it shows as a tilt error, or as energy that ends the run
    slipped = (slip[["slip", "tilt_rms"]] > SLIPPED).any(axis="columns") | slip["outcome"].isin(NO_PEAK)
    slips_at, sticks = largest(slip.loc[slipped, "share"]), slip.loc[~slipped, "share"]
    # a friction at which any release slips does not count as sticking
    values = {"share": slips_at, "bound": least(sticks[~(sticks <= slips_at)])}
    if not structure.slab_mass_ratio:  # only without a slab, as slip at its base is then all slip
        nearest = slip[slip["share"] == slips_at]
        values |= {"ratio": largest(nearest["slip"]), "share_tilt": largest(nearest["tilt_rms"])}
    yield _finding("force.slip", **values)
    normal = free["least_normal"]
    yield _finding(
        "force.normal",
        bound=least(peaks["least_normal"]),
        bound_free=float(normal.min()),
        ratio=float(free["tan_alpha"].iloc[int(np.nanargmin(normal))]),
        ratio_lost=limit_of(free["tan_alpha"], normal > 0.0)[1],
    )
    moving = peaks.dropna(subset="moment")
    yield _finding("force.moment", ratio=limit_of(moving["tan_alpha"], moving["moment"] <= SLIGHT)[0])


def _rings(tables: Tables) -> Iterator[Finding]:
    if "rings" not in tables:
        return
    table = tables["rings"]
    ring = table[has_walls(table)]
    free, touched = ring["motion"] == FREE, ring[ring["contact_time"] > 0.0]
    shaken = ring[~free]
    at_end = shaken.groupby("clearance")["at_end"].max()
    yield _finding(
        "ring.place",
        ratio=float(str(at_end.idxmin())) if len(at_end) else math.nan,
        ratio_end=float(at_end.min()),
        bound=largest(shaken["twist"].abs()),
        bound_free=largest(ring.loc[free, "twist"].abs()),
    )
    yield _finding("ring.touched", runs=len(touched), runs_all=len(ring), share=largest(touched["loss"]))
    # member farthest from the peak of the recess model
    known = shaken[shaken["outcome"] != "failed"]
    ratio = known["peak"] / known["recess_peak"]
    with np.errstate(divide="ignore"):
        far = int(np.nanargmax(np.abs(np.log(ratio))))
    names = ("tan_alpha", "turn", "clearance", "inclination", "friction")
    given = {f"given_{name}": float(known[name].iloc[far]) for name in names}
    given["given_inclination"] = given["given_inclination"] or math.nan  # 0: they lean by alpha
    yield _finding("ring.worst", ratio=float(ratio.iloc[far]), **given)
    halved = (shaken["halved_peak"] / shaken["peak"] - 1.0).abs()
    yield _finding(
        "ring.halved",
        runs=int((halved <= SMALL).sum()),
        runs_all=int(np.isfinite(halved).sum()),
        share=largest(halved),
        count=int(table["outcome"].isin(NO_PEAK).sum()) or math.nan,
    )


def has_walls(table: pd.DataFrame) -> pd.Series[bool]:
    """Mask of the runs whose support has walls."""
    return table["support"].map({name: support.walls for name, support in SUPPORTS.items()})
