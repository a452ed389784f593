"""Quantiles of small samples, with intervals that hold for any distribution.

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
from scipy.optimize import brentq
from scipy.special import betainc, betaincinv

Array = NDArray[np.float64]

# probability with which an interval contains what it is for
CONFIDENCE = 0.95
# of fewer no two values have the median between them with that probability: 1 - 2/2^5 is 94 %
FEWEST = 6


@dataclass(frozen=True, slots=True, kw_only=True)
class Interval:
    """A value and its interval; an end that the members do not bound is infinite."""

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
        """Return the interval of a number from this one of its logarithm."""
        return Interval(value=math.exp(self.value), low=math.exp(self.low), high=math.exp(self.high))

    def columns(self, name: str) -> dict[str, float]:
        """Return the numbers as columns NAME, NAME_low and NAME_high."""
        return {name: self.value, f"{name}_low": self.low, f"{name}_high": self.high}


def stated(value: float, count: int, *, ratio: bool = False) -> float:
    """Return a quantile, median or ratio of `count` members where it may be stated, else NaN.

    It is not of fewer than `FEWEST` members. Nor is a `ratio` of zero or infinity: it says only that most
    members overturn by one of two methods alone. Counts say either.

    Examples
    --------
    >>> stated(1.2, 6), stated(1.2, 5), stated(math.inf, 9), stated(math.inf, 9, ratio=True)
    (1.2, nan, inf, nan)
    """
    return math.nan if count < FEWEST or (ratio and not 0.0 < value < math.inf) else value


def quantile_interval(values: Array, share: float) -> Interval:
    """Return a quantile of what the values are drawn from, and its interval.

    Parameters
    ----------
    values : ndarray, shape (n,)
        In any order, infinite ones included; in the unit of the result.
    share : float
        Of what is drawn, at most the quantile; between 0 and 1.

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


def share_interval(count: int, total: int) -> Interval:
    """Return the share of what is drawn that a sample has `count` of `total` of, and its interval.

    Exact, of C. J. Clopper and E. S. Pearson, Biometrika 26, 404-413, 1934: it contains the share with 95 %
    or more. Without a sample nothing is known, and the value is NaN.

    Examples
    --------
    >>> found = share_interval(0, 22)
    >>> found.value, found.low, round(found.high, 3)
    (0.0, 0.0, 0.154)
    """
    left_out = 0.5 * (1.0 - CONFIDENCE)
    return Interval(
        value=count / total if total else math.nan,
        low=float(betaincinv(count, total - count + 1, left_out)) if count else 0.0,
        high=float(betaincinv(count + 1, total - count, 1.0 - left_out)) if count < total else 1.0,
    )


@cache
def end_index(count: int, share: float, left_out: float) -> float | None:
    """Return the index, from 1, of the order statistic that is above the quantile with a given probability.

    None where even the smallest value is so with more than the probability `left_out`.
    """

    def excess(index: float) -> float:
        return float(betainc(index, count + 1 - index, share)) - (1.0 - left_out)

    return float(brentq(excess, 1.0, count)) if excess(1.0) >= 0.0 else None


def _between(ordered: Array, index: float) -> float:
    """Return the order statistic of an index from 1, on the line between its neighbours."""
    below = math.floor(index)
    fraction = index - below
    low, high = float(ordered[below - 1]), float(ordered[min(below, len(ordered) - 1)])
    if fraction == 0.0 or low == high:
        return low
    # of an infinite neighbour any fraction is infinite; between both infinities there is no value
    between = (1.0 - fraction) * low + fraction * high
    return between if math.isnan(between) else min(max(between, low), high)  # rounding may step over one
