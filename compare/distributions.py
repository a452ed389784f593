"""Two distributions of peak tilt held against each other.

Beyond the horizon single traces say nothing, but what is drawn from the same distribution can be told from
what is not. The members of an ensemble are common to all methods, so the bootstrap draws members, and each
draw brings the runs of both methods.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

# share of the bootstrap's draws inside an interval
CONFIDENCE = 0.95


@dataclass(frozen=True, slots=True, kw_only=True)
class Interval:
    """A value and its bootstrap interval."""

    value: float
    low: float
    high: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Contrast:
    """What tells two distributions apart.

    Attributes
    ----------
    count : int
        Members that count: those that failed in neither method.
    ks : Interval
        Kolmogorov-Smirnov distance of the peak tilts, overturned runs counted as the largest.
    ks_p : float
        Probability of a distance at least as large if both were the same distribution.
    wasserstein : Interval
        Distance of the peak tilts of the runs that do not overturn [alpha].
    median_ratio : Interval
        Ratio of the medians, overturned runs counted as the largest; NaN where a median overturns or
        does not uplift.
    member_factor : float
        Factor by which the two peaks of a member differ: the median over those that uplift and stand.
    overturned, against_overturned : int
        Runs that overturn.
    both_overturned : int
        Members that overturn in both methods.
    overturned_p : float
        Of Fisher's exact test on these counts.
    """

    count: int
    ks: Interval
    ks_p: float
    wasserstein: Interval
    median_ratio: Interval
    member_factor: float
    overturned: int
    against_overturned: int
    both_overturned: int
    overturned_p: float


def contrast(
    peaks: Array,
    against: Array,
    overturned: NDArray[np.bool_],
    against_overturned: NDArray[np.bool_],
    *,
    draws: int = 1000,
    seed: int = 0,
) -> Contrast:
    """Hold the peak tilts of one method against those of another, member by member.

    Parameters
    ----------
    peaks, against : ndarray, shape (n,)
        Peak tilts of the same members [alpha]; NaN where a run failed: such a member does not count.
    overturned, against_overturned : ndarray of bool, shape (n,)
    draws : int, optional
        Of the bootstrap.
    seed : int, optional
        Of its random numbers.

    Raises
    ------
    ValueError
        If fewer than two members count.
    """
    from scipy.stats import fisher_exact, ks_2samp

    counts = np.isfinite(peaks) & np.isfinite(against)
    if np.count_nonzero(counts) < 2:
        raise ValueError(f"two members that do not fail are needed, got {np.count_nonzero(counts)}")
    ours = np.where(overturned, math.inf, peaks)[counts]
    theirs = np.where(against_overturned, math.inf, against)[counts]
    fell, fell_there = overturned[counts], against_overturned[counts]
    count = len(ours)
    chosen = np.random.default_rng(seed).integers(count, size=(draws, count))
    table = [
        [int(fell.sum()), int((~fell).sum())],
        [int(fell_there.sum()), int((~fell_there).sum())],
    ]
    ranks = _ranks(ours, theirs)
    return Contrast(
        count=count,
        ks=_interval(ks_distance, ours, theirs, chosen),
        ks_p=float(ks_2samp(*ranks).pvalue),
        wasserstein=_interval(standing_wasserstein, ours, theirs, chosen),
        median_ratio=_interval(median_ratio, ours, theirs, chosen),
        member_factor=member_factor(ours, theirs),
        overturned=table[0][0],
        against_overturned=table[1][0],
        both_overturned=int((fell & fell_there).sum()),
        overturned_p=float(fisher_exact(np.array(table))[1]),
    )


def ks_distance(ours: Array, theirs: Array) -> float:
    """Return the largest difference of the two empirical distributions; inf is the largest value."""
    points = np.sort(np.concatenate([ours, theirs]))
    below = [
        np.searchsorted(np.sort(values), points, side="right") / len(values) for values in (ours, theirs)
    ]
    return float(np.abs(below[0] - below[1]).max())


def standing_wasserstein(ours: Array, theirs: Array) -> float:
    """Return the Wasserstein distance of the finite values; NaN where one side has none."""
    from scipy.stats import wasserstein_distance

    standing = [values[np.isfinite(values)] for values in (ours, theirs)]
    if not all(map(len, standing)):
        return math.nan
    return float(wasserstein_distance(*standing))


def median_ratio(ours: Array, theirs: Array) -> float:
    """Return the ratio of the medians; NaN where one is not finite or the second is zero."""
    # the lower of the two middle values, because a mean with infinity is no value of the sample
    first, second = (float(np.sort(values)[(len(values) - 1) // 2]) for values in (ours, theirs))
    return first / second if math.isfinite(first) and math.isfinite(second) and second > 0.0 else math.nan


def member_factor(ours: Array, theirs: Array) -> float:
    """Return the median factor, at least 1, between finite values above zero in pairs; NaN without any."""
    counts = np.isfinite(ours) & np.isfinite(theirs) & (ours > 0.0) & (theirs > 0.0)
    if not counts.any():
        return math.nan
    return float(np.exp(np.median(np.abs(np.log(ours[counts] / theirs[counts])))))


def smallest_distance(count: int) -> float:
    """Return the KS distance that two samples of one distribution exceed once in twenty times.

    The limit of Kolmogorov and Smirnov for two large samples of `count` values each.
    """
    return math.sqrt(math.log(2.0 / (1.0 - CONFIDENCE)) / count)


def _ranks(ours: Array, theirs: Array) -> tuple[Array, Array]:
    """Ranks of the values in both together: infinite ones are values like others there."""
    _, ranks = np.unique(np.concatenate([ours, theirs]), return_inverse=True)
    return ranks[: len(ours)].astype(np.float64), ranks[len(ours) :].astype(np.float64)


def _interval(
    statistic: Callable[[Array, Array], float], ours: Array, theirs: Array, chosen: NDArray[np.int64]
) -> Interval:
    drawn = np.array([statistic(ours[members], theirs[members]) for members in chosen])
    drawn = drawn[np.isfinite(drawn)]
    tail = 0.5 * (1.0 - CONFIDENCE)
    low, high = np.quantile(drawn, [tail, 1.0 - tail]) if len(drawn) else (math.nan, math.nan)
    return Interval(value=float(statistic(ours, theirs)), low=float(low), high=float(high))
