"""Contrast of two methods: the same members by both, compared member by member.

Beyond the agreement of traces single runs say nothing, many do. The members of an ensemble are the same for
all methods: the same record moves both, so what differs is their ratio, and every test and interval is of
the members as pairs. The medians of two fragility curves have a contrast of their own, see
`studies.fragility.tables`: their motions are the same, too, but it is of curves.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, fields

import numpy as np
from numpy.typing import NDArray

from rockwobble.models import Trace
from rockwobble.models.frames import pd
from rockwobble.models.trace import NO_PEAK

from .statistics import (
    MARGIN,
    Array,
    Flags,
    Interval,
    mcnemar_p,
    paired_difference,
    quantile_interval,
    ratio_within_reach,
    signed_rank_p,
)


@dataclass(frozen=True, slots=True, kw_only=True)
class Contrast:
    """Contrast of two methods.

    The ratio of a member is that of its two peak tilts, an overturned run larger than everything: infinite
    where it overturns by the first method alone, zero where by the second alone. A member that overturns by
    both, or stays at rest by both, has none.

    Attributes
    ----------
    count : int
        Members that count: those that failed in neither method.
    compared : int
        Members with a ratio.
    higher, lower : int
        Members with a ratio above and below 1.
    ratio : Interval
        Median of the ratios. An end of zero or infinity is not bounded.
    ratio_05, ratio_95 : Interval
        Ratios that 5 % and 95 % of the members do not exceed.
    ratio_p : float
        P value of Wilcoxon's signed ranks of the logarithms: probability of a difference as large if both
        methods could be exchanged in every member. Infinite ratios have the largest ranks; ratios of 1 have
        none.
    within_reach : float
        The least ratio above 1 for which, and for its inverse, the interval of the median of as many members,
        scattered as these are, leaves 1 out with a probability of `POWER`; infinite where there is none.
    overturned, against_overturned : int
        Runs that overturn.
    both_overturned : int
        Members that overturn by both methods.
    overturned_p : float
        P value of McNemar's exact test: of the members that overturn by one method alone.
    overturned_difference : Interval
        Share of the members that overturn, less that of the second method [-].
    """

    count: int
    compared: int
    higher: int
    lower: int
    ratio: Interval
    ratio_05: Interval
    ratio_95: Interval
    ratio_p: float
    within_reach: float
    overturned: int
    against_overturned: int
    both_overturned: int
    overturned_p: float
    overturned_difference: Interval

    @property
    def verdict(self) -> str:
        """Whether the median ratio is known to be within the margin of 1: "within", "beyond", "undecided"."""
        return self.ratio.about_one(MARGIN)

    def columns(self) -> dict[str, float | int | str]:
        """Return the attributes and the verdict as columns, ends of an interval as NAME_low and NAME_high."""
        row: dict[str, float | int | str] = {}
        for name in (each.name for each in fields(self)):
            value = getattr(self, name)
            row |= value.columns(name) if isinstance(value, Interval) else {name: value}
        return row | {"verdict": self.verdict}


@dataclass(frozen=True, slots=True, eq=False)
class Pairs:
    """The members of an ensemble by two methods.

    Attributes
    ----------
    peaks, against : ndarray, shape (n,)
        Peak tilts [alpha], NaN where a run failed: such a member does not count.
    overturned, against_overturned : ndarray of bool, shape (n,)
    members : ndarray of str, shape (n,), optional
    """

    peaks: Array
    against: Array
    overturned: Flags
    against_overturned: Flags
    members: NDArray[np.str_] = field(default_factory=lambda: np.array([], dtype=str))

    @property
    def failed(self) -> Flags:
        """Whether a member failed by one method or both."""
        return np.isnan(self.peaks) | np.isnan(self.against)

    def log_ratios(self) -> Array:
        """Logarithm of the ratio of each member, NaN without one."""
        first, second = (
            np.where(fell, math.inf, peaks)
            for fell, peaks in ((self.overturned, self.peaks), (self.against_overturned, self.against))
        )
        first[self.failed] = math.nan
        # the logarithm of a run at rest is infinite; two at rest, or two overturned, have no ratio
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.asarray(np.log(first) - np.log(second), dtype=np.float64)

    def ratio_bounds(self) -> tuple[float, ...]:
        """Least and largest median ratio, for any outcome of the members that failed."""
        known = self.log_ratios()
        fates = (np.where(self.failed, fate, known) for fate in (-math.inf, math.inf))
        return tuple(quantile_interval(each[~np.isnan(each)], 0.5).exponential().value for each in fates)

    def contrast(self) -> Contrast | None:
        """Contrast of the methods; None where fewer than two members ran by both."""
        counts, logarithms = ~self.failed, self.log_ratios()
        if np.count_nonzero(counts) < 2:
            return None
        fell, fell_there = self.overturned[counts], self.against_overturned[counts]
        logarithms = logarithms[~np.isnan(logarithms)]
        only, only_there = int((fell & ~fell_there).sum()), int((fell_there & ~fell).sum())
        ratio, ratio_05, ratio_95 = (
            quantile_interval(logarithms, share).exponential() for share in (0.5, 0.05, 0.95)
        )
        return Contrast(
            count=len(fell),
            compared=len(logarithms),
            higher=int((logarithms > 0.0).sum()),
            lower=int((logarithms < 0.0).sum()),
            ratio=ratio,
            ratio_05=ratio_05,
            ratio_95=ratio_95,
            ratio_p=signed_rank_p(logarithms),
            within_reach=ratio_within_reach(logarithms),
            overturned=int(fell.sum()),
            against_overturned=int(fell_there.sum()),
            both_overturned=int((fell & fell_there).sum()),
            overturned_p=mcnemar_p(only, only_there),
            overturned_difference=paired_difference(only, only_there, len(fell)),
        )


def pairs_in(
    runs: pd.DataFrame, method: str, against: str, *, member: str = "member", peak: str = "peak_tilt"
) -> Pairs:
    """Members of a table by two methods, paired.

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
        raise ValueError("each member must have one run by each method, got more")
    names = runs[member].unique()
    rows = [runs[runs["method"] == name].set_index(member).reindex(names) for name in (method, against)]
    peaks, against_peaks = (each[peak].where(~each["outcome"].isin(NO_PEAK)).to_numpy(float) for each in rows)
    fell, fell_there = ((each["outcome"] == "overturned").to_numpy(bool) for each in rows)
    return Pairs(peaks, against_peaks, fell, fell_there, np.array(names, dtype=str))


def pairs_of(traces: Sequence[Trace], against: Sequence[Trace]) -> Pairs:
    """Members of two sequences of traces (n,), in the same order; peak tilts in rad."""
    parts = (traces, against)
    peaks = (np.array([trace.peak_tilt for trace in part]) for part in parts)
    fell = (np.array([trace.outcome == "overturned" for trace in part]) for part in parts)
    return Pairs(*peaks, *fell)
