"""The tables of an ensemble, from the runs of its members."""

from __future__ import annotations

import dataclasses
import itertools
import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from ...metrics.distributions import Array, Contrast, Flags, adjusted, contrast, log_ratios
from ...metrics.order_statistics import Interval, quantile_interval


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Pairs:
    """The members of an ensemble by two methods.

    Attributes
    ----------
    members : ndarray of str, shape (n,)
    peaks, against : ndarray, shape (n,)
        Peak tilts [alpha], NaN where a run failed.
    overturned, against_overturned : ndarray of bool, shape (n,)
    """

    members: NDArray[np.str_]
    peaks: Array
    against: Array
    overturned: Flags
    against_overturned: Flags

    @property
    def failed(self) -> Flags:
        """Whether a member failed by one method or both."""
        return np.isnan(self.peaks) | np.isnan(self.against)

    def log_ratios(self) -> Array:
        """Return the logarithms of the ratios of the members, see `distributions.log_ratios`."""
        return log_ratios(self.peaks, self.against, self.overturned, self.against_overturned)

    def contrast(self) -> Contrast | None:
        """Return the contrast of the methods; None where fewer than two members ran by both."""
        if np.count_nonzero(~self.failed) < 2:
            return None
        return contrast(self.peaks, self.against, self.overturned, self.against_overturned)


def pairs(
    runs: pd.DataFrame, method: str, against: str, *, member: str = "member", peak: str = "peak_tilt"
) -> Pairs:
    """Return the members by two methods, each beside itself.

    Parameters
    ----------
    runs : DataFrame
        One row for each member and method: columns method, outcome, and those of the names below.
    method, against : str
    member, peak : str, optional
        Columns of the member's name and of its peak tilt [alpha].

    Raises
    ------
    ValueError
        If a member has two runs of one method.
    """
    if runs.duplicated([member, "method"]).any():
        raise ValueError("a member has one run by each method, got more")
    names = list(runs[member].unique())
    ours, theirs = (
        runs[runs["method"] == name].set_index(member).reindex(names) for name in (method, against)
    )
    return Pairs(
        members=np.array(names, dtype=str),
        peaks=ours[peak].where(ours["outcome"] != "failed").to_numpy(float),
        against=theirs[peak].where(theirs["outcome"] != "failed").to_numpy(float),
        overturned=(ours["outcome"] == "overturned").to_numpy(bool),
        against_overturned=(theirs["outcome"] == "overturned").to_numpy(bool),
    )


def method_table(members: pd.DataFrame, methods: Mapping[str, str]) -> pd.DataFrame:
    """Return one row for each method, see `Ensemble.methods`; `methods` names the own model of each."""
    rows = []
    for method, own in methods.items():
        runs = members[members["method"] == method]
        failed = runs[runs["outcome"] == "failed"]
        known = runs[runs["outcome"] != "failed"]
        fallen = known["outcome"] == "overturned"
        peaks = np.where(fallen, math.inf, known["peak_tilt"].to_numpy(float))
        median = quantile_interval(peaks, 0.5)
        rows.append(
            {
                "method": method,
                "own_model": own,
                "runs": len(runs),
                "rocked": int((known["peak_tilt"] > 0.0).sum()),
                "overturned": int(fallen.sum()),
                "failed": len(failed),
                "failed_members": ", ".join(failed["member"]),
                "peak_16": quantile_interval(peaks, 0.16).value,
                "peak_median": median.value,
                "peak_median_low": max(median.low, 0.0),
                "peak_median_high": median.high,
                "peak_84": quantile_interval(peaks, 0.84).value,
            }
        )
    return pd.DataFrame(rows)


def contrast_table(members: pd.DataFrame, methods: Mapping[str, str]) -> pd.DataFrame:
    """Return one row for each two methods, see `Ensemble.contrasts`."""
    rows = []
    for against, method in itertools.combinations(methods, 2):
        both = pairs(members, method, against)
        found = both.contrast()
        if found is not None:
            masked = ", ".join(both.members[both.failed])
            rows.append({"method": method, "against": against, **contrast_row(found), "masked": masked})
    table = pd.DataFrame(rows)
    for name in ("ratio_p", "overturned_p") if len(table) else ():
        table[f"{name}_adjusted"] = adjusted(table[name].to_numpy(float))
    return table


def contrast_row(found: Contrast) -> dict[str, float | int | str]:
    """Return a contrast by the names of its attributes, the ends of an interval as NAME_low and NAME_high."""
    row: dict[str, float | int | str] = {}
    for field in dataclasses.fields(found):
        value = getattr(found, field.name)
        row |= value.columns(field.name) if isinstance(value, Interval) else {field.name: value}
    return row | {"verdict": found.verdict}
