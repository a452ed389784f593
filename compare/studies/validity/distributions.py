"""Peak tilts over records: paired ratios of the methods, and maps of the reduced models."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from ...metrics.statistics import MARGIN, log_ratios, quantile_interval
from ..ensemble import contrast_row, pairs
from .plan import EL_CENTRO
from .records import FLAT, HALVED, PERTURBED, RECESS

Tables = Mapping[str, "pd.DataFrame"]
Array = NDArray[np.float64]
Numbers = dict[str, float]


def column(table: pd.DataFrame, name: str) -> Array:
    """Return a column as numbers."""
    return table[name].to_numpy(dtype=np.float64)


def largest(values: Array) -> float:
    """Return the largest finite value; NaN where there is none."""
    finite = values[np.isfinite(values)]
    return float(finite.max()) if len(finite) else math.nan


def reached(values: Array, share: float) -> float:
    """Return a value that a share of all does not exceed, infinite ones included; NaN of nothing."""
    known = values[~np.isnan(values)]
    return float(np.quantile(known, share, method="inverted_cdf")) if len(known) else math.nan


def up_to(points: Array, holds: NDArray[np.bool_]) -> float:
    """Return the largest point up to which every point holds; NaN where already the first does not.

    Several rows may share a point; a point holds where all of its rows do.
    """
    found = math.nan
    for point in np.unique(points):
        if not holds[points == point].all():
            break
        found = float(point)
    return found


def first_failing(points: Array, holds: NDArray[np.bool_]) -> float:
    """Return the smallest point with a row that does not hold; NaN where all do."""
    failing = points[~holds]
    return float(failing.min()) if len(failing) else math.nan


POINT = ["tan_alpha", "semidiagonal", "intensity"]
# what is held against what, and its name in the numbers; the last says how far a ring has converged
_NAMES = {
    ("recess", RECESS): "recess",
    ("ring", RECESS): "ring",
    ("flat", RECESS): "flat",
    (FLAT, RECESS): "model",
    (PERTURBED, RECESS): "copy",
    (HALVED, "ring"): "halved",
}
CONTRASTS = tuple(_NAMES)
_SHARE = 0.9
FEWEST = 10  # of fewer motions nine in ten is none short of all


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
            found = pairs(runs, method, against, member="motion", peak="peak").contrast()
            if found is not None:
                at = dict(zip(POINT, point, strict=True)) | {"method": method, "against": against}
                rows.append(at | contrast_row(found))
    return pd.DataFrame(rows)


def ratios(runs: pd.DataFrame, method: str, against: str) -> Array:
    """Return the ratios of the peaks of two methods, a record each; 0 and infinite where one overturns."""
    return np.exp(pairs(runs, method, against, member="motion", peak="peak").log_ratios())


def peak_ratios(tables: Tables) -> Numbers:
    """Return the range over the points of the contrasts of each method.

    NAME_least and NAME_largest, of the median ratio to the recess model; NAME_05_least to NAME_95_largest, of
    what 5 % and 95 % of the records of a point do not exceed; NAME_within and NAME_beyond, the number of
    points where the median is known to be within the margin, and beyond it. NAME "halved" is the ring at half
    the step against itself.
    """
    table, runs = contrasts(tables), tables["records"]
    numbers: Numbers = {
        "members": float(table["count"].max()),
        "points": float(len(table[POINT].drop_duplicates())),
    }
    for (method, against), name in _NAMES.items():
        own = table[(table["method"] == method) & (table["against"] == against)]
        numbers |= {
            **{
                f"{name}{share}_{end}": float(getattr(own[f"ratio{share}"], call)())
                for share in ("", "_05", "_95")
                for end, call in (("least", "min"), ("largest", "max"))
            },
            f"{name}_within": float((own["verdict"] == "within").sum()),
            f"{name}_beyond": float((own["verdict"] == "beyond").sum()),
        }
    touched = runs[(runs["method"] == "ring") & (runs["contact_time"] > 0.0)]
    return numbers | {
        "touched": float(len(touched)),
        "ring_loss_worst": largest(column(touched, "loss")),
        "failed": float((runs["outcome"] == "failed").sum()),
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
        in ten do not exceed, or keep (NaN of fewer than `FEWEST`), and lost, the share that loses contact.
    """
    rows = []
    table = tables["peaks"]
    for point, members in table[table["motion"] != EL_CENTRO].groupby(POINT, sort=False):
        tan_alpha = float(str(point[0]))
        recess = column(members, "recess")
        fell = _fell(recess, tan_alpha)
        row = dict(zip(POINT, point, strict=True)) | {
            "members": len(members),
            "rocked": int((recess > 0.0).sum()),
            "overturned": float(fell.mean()),
        }
        for name in ("flat", "copy"):
            other = column(members, name)
            logarithms = log_ratios(other, recess, _fell(other, tan_alpha), fell)
            logarithms = logarithms[~np.isnan(logarithms)]
            median = quantile_interval(logarithms, 0.5)
            row |= {
                f"{name}_ratio": math.exp(median.value),
                f"{name}_low": math.exp(median.low),
                f"{name}_high": math.exp(median.high),
                f"{name}_90": math.exp(reached(np.abs(logarithms), _SHARE)),
                f"{name}_overturned": float(_fell(other, tan_alpha).mean()),
            }
        normal = column(members, "least_normal")
        known = normal[~np.isnan(normal)]
        row |= {
            "standing": len(known),
            "friction_90": _nine_in_ten(column(members, "friction")) / tan_alpha,
            "normal_10": -_nine_in_ten(-normal),
            "moment_90": _nine_in_ten(column(members, "moment")),
            "lost": float((known <= 0.0).mean()) if len(known) else math.nan,
        }
        rows.append(row)
    return pd.DataFrame(rows)


def single_peaks(tables: Tables) -> Numbers:
    """Return the least and the largest median change of the peak by flat ground, over all cells."""
    table = cells(tables)
    return {
        "cells": float(len(table)),
        "members": float(table["members"].max()),
        "flat_least": float(table["flat_ratio"].min()),
        "flat_largest": float(table["flat_ratio"].max()),
    }


def vertical(tables: Tables) -> Numbers:
    """Return the change of the peak by the vertical component of El Centro, beside a record 1 % stronger.

    NAME_apart counts the cells whose peak changes by more than the margin, those that overturn by one alone
    included; NAME_least and NAME_largest are of the others.
    """
    table = tables["peaks"]
    table = table[table["vertical"].notna()]
    tan_alpha, recess = column(table, "tan_alpha"), column(table, "recess")
    fell = _fell(recess, tan_alpha)
    numbers: Numbers = {"cells": float(len(table)), "fell": float(fell.sum())}
    for name in ("vertical", "copy"):
        other = column(table, name)
        theirs = _fell(other, tan_alpha)
        logarithms = log_ratios(other, recess, theirs, fell)
        # of those that overturn by one alone the ratio is infinite or zero, by both there is none
        numbers |= {
            f"{name}_compared": float((~np.isnan(logarithms)).sum()),
            f"{name}_apart": float((np.abs(logarithms) > math.log1p(MARGIN)).sum()),
            f"{name}_least": math.exp(-largest(-logarithms)),
            f"{name}_largest": math.exp(largest(logarithms)),
            f"{name}_fell": float(theirs.sum()),
            f"{name}_other": float((theirs != fell).sum()),
        }
    return numbers


def _nine_in_ten(values: Array) -> float:
    """Return what nine in ten of the known values do not exceed; NaN of too few."""
    enough = np.count_nonzero(~np.isnan(values)) >= FEWEST
    return reached(values, _SHARE) if enough else math.nan


def _fell(peaks: Array, tan_alpha: Array | float) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
    """Whether peaks over alpha are those of overturned runs, which end at pi/2."""
    return np.asarray(peaks * np.arctan(tan_alpha) >= 0.5 * math.pi * (1.0 - 1e-9))
