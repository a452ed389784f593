"""Statistics of small samples: quantiles and shares with intervals, and tests of pairs.

A quantile lies between two order statistics with a probability that is known exactly, whatever is sampled:
that the k-th of n values is below the quantile of share q is I_q(k, n + 1 - k), the regularised incomplete
beta function. An interval ends where this is half of what it leaves out; between two values it is taken at
the fraction (A. D. Hutson, J. Appl. Stat. 26, 343-353, 1999). Infinite values are values like others.

A bootstrap over the members draws from the same order statistics but does not know what lies beyond them:
of 22 members its interval of the median has a coverage of 94 %, that of the 5th percentile of at most 68 %,
the probability that any member is below it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

# coverage probability of an interval
CONFIDENCE = 0.95
# least count for an interval of the median: fewer values have less than 95 %, 1 - 2/2^5 is 94 %
FEWEST = 6
_HALVINGS = 60  # halvings of an interval of indices, to rounding


@dataclass(frozen=True, slots=True, kw_only=True)
class Interval:
    """Value and its interval; an end that the members do not bound is infinite."""

    value: float
    low: float
    high: float

    def about_one(self, margin: float) -> str:
        """Return whether a ratio is known to be within a margin of 1: "within", "beyond" or "undecided"."""
        low, high = 1.0 / (1.0 + margin), 1.0 + margin
        if low <= self.low and self.high <= high:
            return "within"
        return "beyond" if self.high < low or self.low > high else "undecided"

    def exponential(self) -> Interval:
        """Interval of a number from this one of its logarithm."""
        return Interval(value=math.exp(self.value), low=math.exp(self.low), high=math.exp(self.high))

    def columns(self, name: str) -> dict[str, float]:
        """Numbers as columns NAME, NAME_low and NAME_high; ends are NaN where no member differs."""
        known = self.low != self.high or math.isinf(self.low)
        low, high = (self.low, self.high) if known else (math.nan, math.nan)
        return {name: self.value, f"{name}_low": low, f"{name}_high": high}


def value_if_enough(value: float, count: int, *, ratio: bool = False) -> float:
    """Quantile, median or ratio of `count` members where it may be stated, else NaN.

    It is not of fewer than `FEWEST` members. Nor is a `ratio` of zero or infinity: it says only that most
    members overturn by one of two methods alone. Counts say either.

    Examples
    --------
    >>> [value_if_enough(1.2, count) for count in (6, 5)]
    [1.2, nan]
    >>> [value_if_enough(math.inf, 9, ratio=ratio) for ratio in (False, True)]
    [inf, nan]
    """
    return math.nan if count < FEWEST or (ratio and not 0.0 < value < math.inf) else value


def quantile_interval(values: Array, share: float) -> Interval:
    """Quantile of the distribution of the values, and its interval.

    Parameters
    ----------
    values : ndarray, shape (n,)
        In any order, infinite ones included; in the unit of the result.
    share : float
        Share of what is drawn, at most the quantile; between 0 and 1.

    Returns
    -------
    Interval
        The value is the order statistic of index share (n + 1): NaN where it lies between minus and plus
        infinity. Where one end is not bounded, the other leaves out all that an interval may, so that it has
        its probability. All NaN of fewer than `FEWEST` values.

    Examples
    --------
    >>> found = quantile_interval(np.arange(1.0, 23.0), 0.5)
    >>> found.value, round(found.low, 2), round(found.high, 2)
    (11.5, 6.95, 16.05)
    >>> quantile_interval(np.arange(1.0, 23.0), 0.05).low
    -inf
    """
    ordered = np.sort(np.asarray(values, dtype=np.float64))
    count = len(ordered)
    if count < FEWEST:
        return Interval(value=math.nan, low=math.nan, high=math.nan)
    left_out = 1.0 - CONFIDENCE
    lower, upper = (end_index(count, part, 0.5 * left_out) for part in (share, 1.0 - share))
    if upper is None and lower is not None:
        lower = end_index(count, share, left_out)
    elif lower is None and upper is not None:
        upper = end_index(count, 1.0 - share, left_out)
    return Interval(
        value=_between(ordered, min(max(share * (count + 1), 1.0), count)),
        low=-math.inf if lower is None else _between(ordered, lower),
        high=math.inf if upper is None else _between(ordered, count + 1 - upper),
    )


def covering(values: Array, share: float) -> tuple[float, int]:
    """Least value that at least a share of the values do not exceed, and the number that do not.

    It is an order statistic, so that it is infinite only where more than 1 - share of the values are: what is
    said of it and of the share of runs that overturn is one statement.

    Examples
    --------
    >>> covering(np.array([1.0, 4.0, 2.0, 3.0]), 0.5), covering(np.array([*range(1, 22), np.inf]), 0.95)
    ((2.0, 2), (21.0, 21))
    """
    ordered = np.sort(np.asarray(values, dtype=np.float64))
    rank = max(math.ceil(share * len(ordered) * (1.0 - 1e-12)), 1)
    return float(ordered[rank - 1]), rank


def share_interval(count: int, total: int) -> Interval:
    """Share `count` / `total` of a sample, and its interval.

    Exact, of C. J. Clopper and E. S. Pearson, Biometrika 26, 404-413, 1934: it contains the share with 95 %
    or more. Without a sample nothing is known, and the value is NaN.

    Examples
    --------
    >>> found = share_interval(0, 22)
    >>> found.value, found.low, round(found.high, 3)
    (0.0, 0.0, 0.154)
    """
    from scipy.special import betaincinv

    left_out = 0.5 * (1.0 - CONFIDENCE)
    return Interval(
        value=count / total if total else math.nan,
        low=float(betaincinv(count, total - count + 1, left_out)) if count else 0.0,
        high=float(betaincinv(count + 1, total - count, 1.0 - left_out)) if count < total else 1.0,
    )


@cache
def end_index(count: int, share: float, left_out: float) -> float | None:
    """Index, from 1, of the order statistic that is above the quantile with a given probability.

    None where even the smallest value is so with more than the probability `left_out`.
    """
    from scipy.special import betainc

    def is_enough(index: float) -> bool:
        return bool(betainc(index, count + 1 - index, share) >= 1.0 - left_out)

    if not is_enough(1.0):
        return None
    low, high = 1.0, float(count)
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if is_enough(middle) else (low, middle)
    return low


def _between(ordered: Array, index: float) -> float:
    """Order statistic of an index from 1, linear between its neighbours."""
    below = math.floor(index)
    fraction = index - below
    low, high = float(ordered[below - 1]), float(ordered[min(below, len(ordered) - 1)])
    if fraction == 0.0 or low == high:
        return low
    # any fraction of an infinite neighbour is infinite; between both infinities there is no value
    between = (1.0 - fraction) * low + fraction * high
    return between if math.isnan(between) else min(max(between, low), high)  # rounding may step over one


Flags = NDArray[np.bool_]

# margin of equality of two methods for the median member: no engineer knows a peak tilt to 5 %, and an
# ensemble of some twenty members can show it
MARGIN = 0.05
# probability of detecting a detectable difference
POWER = 0.8
# significance level of a difference of two methods
SIGNIFICANCE = 0.05


def signed_rank_p(logarithms: Array) -> float:
    """p-value of Wilcoxon's signed ranks, infinite values the largest and zeros left out.

    Exact for every number of members, and for ties as those of infinite ratios, which share a mean rank:
    scipy takes a normal distribution there, or tries all signs one by one.
    """
    differs = logarithms[logarithms != 0.0]
    _, place, ties = np.unique(np.abs(differs), return_inverse=True, return_counts=True)
    ranks = (2 * np.cumsum(ties) - ties + 1)[place]  # twice the mean ranks, which are whole or a half
    # probability of each sum of ranks, under random signs
    sums = np.zeros(ranks.sum() + 1)
    sums[0] = 1.0
    for rank in ranks:
        sums = 0.5 * (sums + np.concatenate([np.zeros(rank), sums[:-rank]]))
    statistic = ranks[differs > 0.0].sum()
    return min(2.0 * float(min(sums[: statistic + 1].sum(), sums[statistic:].sum())), 1.0)


def mcnemar_p(only: int, only_there: int) -> float:
    """p-value of McNemar's exact test on members that overturn by one method alone."""
    from scipy.special import bdtr

    return min(2.0 * float(bdtr(min(only, only_there), only + only_there, 0.5)), 1.0)


def paired_difference(only: int, only_there: int, count: int) -> Interval:
    """Difference of two shares of the same members.

    Interval of D. G. Bonett and R. M. Price, J. Educ. Behav. Stat. 37, 479-488, 2012: that of Wald with one
    more member in both discordant counts, without which none at all would have no width.

    Parameters
    ----------
    only, only_there : int
        Members that have it by the first and by the second method alone.
    count : int
        Members in all.
    """
    from scipy.special import ndtri

    first, second = (only + 1.0) / (count + 2.0), (only_there + 1.0) / (count + 2.0)
    middle = first - second
    normal = float(ndtri(0.5 * (1.0 + CONFIDENCE)))
    width = normal * math.sqrt((first + second - middle**2) / (count + 2.0))
    return Interval(
        value=(only - only_there) / count, low=max(middle - width, -1.0), high=min(middle + width, 1.0)
    )


def least_significant_count() -> int:
    """Least count by one method alone, none by the other, that is significant by `mcnemar_p`."""
    return math.floor(math.log2(2.0 / SIGNIFICANCE)) + 1


def largest_share_unseen(count: int) -> float:
    """Share that a sample of `count` misses altogether with a probability of 5 % [-]."""
    return float(1.0 - (1.0 - CONFIDENCE) ** (1.0 / count))


def ratio_within_reach(logarithms: Array) -> float:
    """Smallest detectable ratio above 1, for as many members with this scatter; infinite if none.

    Told is a ratio that the interval of the median leaves 1 out for. Its lower end, the order statistic of
    index k, is above 1 with the wanted power where a member is with the share q: I_q(n + 1 - k, k) is the
    power. The members scatter about the ratio as these do about their median; where they scatter more to one
    side, the side counts on which the ratio has to be farther from 1.

    Parameters
    ----------
    logarithms : ndarray, shape (n,)
        Logarithms of the ratios, see `Pairs.log_ratios`, without those that have none.
    """
    from scipy.special import betaincinv

    count = len(logarithms)
    index = end_index(count, 0.5, 0.5 * (1.0 - CONFIDENCE)) if count else None
    middle = quantile_interval(logarithms, 0.5).value
    if index is None or not math.isfinite(middle):
        return math.inf
    share = float(betaincinv(count + 1 - index, index, POWER))
    scatter = logarithms - middle
    needed = (float(np.quantile(side, share, method="inverted_cdf")) for side in (scatter, -scatter))
    return math.exp(max(*needed, 0.0))


def adjusted(probabilities: Array) -> Array:
    """p-values of several tests, adjusted for their number.

    S. Holm, Scand. J. Stat. 6, 65-70, 1979.
    """
    order = np.argsort(probabilities, kind="stable")
    steps = np.maximum.accumulate(probabilities[order] * np.arange(len(order), 0, -1))
    p_values = np.empty(len(order))
    p_values[order] = np.minimum(steps, 1.0)
    return p_values
