"""Two methods on the same members: tests keep their level, intervals their coverage.

The simulations have fixed seeds and 2000 ensembles each: a share of 0.95 is known to 0.005 (one standard
deviation).
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.special import betainc, betaincinv
from scipy.stats import PermutationMethod, beta, binom, binomtest, norm, wilcoxon

from rockwobble.compare.metrics.contrast import Contrast, Pairs
from rockwobble.compare.metrics.statistics import (
    CONFIDENCE,
    MARGIN,
    POWER,
    Interval,
    adjusted,
    end_index,
    largest_share_unseen,
    least_significant_count,
    mcnemar_p,
    paired_difference,
    quantile_interval,
    ratio_within_reach,
    share_interval,
    signed_rank_p,
    value_if_enough,
)

ROUNDING = 1e-12
COUNT = 22  # far-field pairs of FEMA P-695
TRIALS = 2000
LEVEL = 0.06  # of a test at 5 %
UP = np.zeros(COUNT, dtype=bool)


def contrast_of(*pairs: np.ndarray) -> Contrast:
    contrast = Pairs(*pairs).contrast()
    assert contrast is not None
    return contrast


def sample(seed: int) -> np.ndarray:
    return np.random.default_rng(seed).lognormal(sigma=0.8, size=COUNT)


def ratios_of(*, shift: float, scatter: float, count: int = COUNT, seed: int = 0) -> np.ndarray:
    """Log ratios of ensembles (TRIALS, count): the same records, half of the scatter in each method."""
    random = np.random.default_rng(seed)
    first, second = scatter / math.sqrt(2.0) * random.standard_normal((2, TRIALS, count))
    return shift + first - second


def test_signed_ranks_are_those_of_scipy_where_it_is_exact():
    ours, theirs = sample(1), sample(2)
    expected = wilcoxon(np.log(ours), np.log(theirs), method="exact").pvalue
    assert contrast_of(ours, theirs, UP, UP).ratio_p == pytest.approx(expected, abs=ROUNDING)
    assert contrast_of(theirs, ours, UP, UP).ratio_p == pytest.approx(expected, abs=ROUNDING)
    # with ties, all choices of signs are counted; overturned members are the largest
    tied = np.array([0.1, -0.1, 0.2, 0.2, -0.3, 9.0, 9.0, 9.0])
    expected = wilcoxon(tied, method=PermutationMethod(n_resamples=np.inf)).pvalue
    assert signed_rank_p(tied) == pytest.approx(expected, abs=ROUNDING)
    assert signed_rank_p(np.where(tied == 9.0, math.inf, tied)) == pytest.approx(expected, abs=ROUNDING)
    assert signed_rank_p(np.zeros(4)) == signed_rank_p(np.array([])) == 1.0


@pytest.mark.parametrize("count", [6, 22, 301])
@pytest.mark.parametrize("share", [0.03, 0.5, 0.84])
def test_the_interval_of_a_quantile_excludes_it_at_its_level(count: int, share: float) -> None:
    # for the values 1, 2, ... an end is the index of its order statistic, whose share of the distribution has
    # the beta distribution
    ends = quantile_interval(np.arange(1.0, count + 1.0), share)
    outside = [
        beta.sf(share, ends.low, count + 1.0 - ends.low) if math.isfinite(ends.low) else 0.0,
        beta.cdf(share, ends.high, count + 1.0 - ends.high) if math.isfinite(ends.high) else 0.0,
    ]
    left_out = 1.0 - CONFIDENCE
    parts = [0.5 * left_out] * 2 if all(outside) else [left_out if part else 0.0 for part in outside]
    assert outside == pytest.approx(parts, rel=1e-9)  # of the root


@pytest.mark.parametrize("total", [1, 22, 301])
def test_the_interval_of_a_share_excludes_it_at_its_level(total: int) -> None:
    part = 0.5 * (1.0 - CONFIDENCE)
    for count in range(0, total + 1, max(1, total // 7)):
        ends = share_interval(count, total)
        # probability of the count, or of one farther out, where the end is the share
        if count:
            assert binom.sf(count - 1, total, ends.low) == pytest.approx(part, rel=1e-9)
        if count < total:
            assert binom.cdf(count, total, ends.high) == pytest.approx(part, rel=1e-9)
    assert binom.pmf(0, total, largest_share_unseen(total)) == pytest.approx(1.0 - CONFIDENCE, rel=1e-9)


@pytest.mark.parametrize(("only", "only_there"), [(0.1, 0.1), (0.0, 0.4)])
def test_interval_of_a_difference_of_shares_tends_to_the_normal_one(only: float, only_there: float) -> None:
    count = 100_000_000
    ends = paired_difference(round(only * count), round(only_there * count), count)
    deviation = math.sqrt((only + only_there - (only - only_there) ** 2) / count)
    outside = norm.cdf((np.array([ends.low, -ends.high]) - [ends.value, -ends.value]) / deviation)
    assert outside == pytest.approx([0.5 * (1.0 - CONFIDENCE)] * 2, rel=1e-3)


@pytest.mark.parametrize(
    ("values", "share", "expected"),
    [
        ([], 0.5, (math.nan, math.nan, math.nan)),
        ([1.0, 1.0, 1.0, 1.0, 1.0], 0.5, (math.nan, math.nan, math.nan)),  # five members bound nothing
        ([1.0, 1.0, 1.0, 1.0, 1.0, 1.0], 0.5, (1.0, 1.0, 1.0)),
        ([2.0] * COUNT, 0.5, (2.0, 2.0, 2.0)),
        ([-math.inf, math.inf] * 3, 0.5, (math.nan, -math.inf, math.inf)),
        ([1.0, math.inf] * 3, 0.5, (math.inf, 1.0, math.inf)),
        ([*[1.0] * 20, math.inf, math.inf], 0.5, (1.0, 1.0, 1.0)),
    ],
)
def test_quantiles_of_few_and_infinite_values(values, share, expected):
    interval = quantile_interval(np.array(values), share)
    np.testing.assert_equal((interval.value, interval.low, interval.high), expected)


def test_equality_is_claimed_by_the_interval_alone():
    # at the margin itself the claim would be wrong, and is made no more often than an interval is wrong
    edge = math.log(1.0 + MARGIN)
    claimed = []
    for values in ratios_of(shift=edge, scatter=0.03, seed=8):
        claim = quantile_interval(values, 0.5)
        claimed.append(-edge <= claim.low and claim.high <= edge)
    assert np.mean(claimed) <= LEVEL
    peaks = sample(1)
    scattered = peaks * np.exp(0.3 * np.random.default_rng(2).standard_normal(COUNT))
    # methods without a significant difference need not be equal, nor need a significant difference be large
    for trial, verdict, apart in ((scattered, "undecided", False), (1.001 * peaks, "within", True)):
        claim = contrast_of(trial, peaks, UP, UP)
        assert (claim.verdict, claim.ratio_p < 0.05) == (verdict, apart)
    claim = contrast_of(1.1 * peaks, peaks, UP, UP)
    assert (claim.verdict, claim.compared, claim.higher, claim.lower) == ("beyond", COUNT, COUNT, 0)
    assert (claim.ratio.low, claim.ratio.value, claim.ratio.high) == pytest.approx((1.1,) * 3, abs=ROUNDING)


@pytest.mark.parametrize("count", [COUNT, 201])
def test_a_ratio_within_reach_is_detected_with_its_power(count):
    # the reach is computed from as many members as each ensemble has, with the scatter of the distribution
    scatter = 0.3 * norm.ppf((np.arange(count) + 0.5) / count)
    reach = ratio_within_reach(scatter)
    ratios = ratios_of(shift=math.log(reach), scatter=0.3, count=count, seed=10)
    share = np.mean([quantile_interval(values, 0.5).low > 0.0 for values in ratios])
    index = end_index(count, 0.5, 0.5 * (1.0 - CONFIDENCE))
    assert index is not None
    needed = betaincinv(count + 1 - index, index, POWER)
    # the reach is at most one step of the members' shares beyond the need; three standard deviations of 2000
    # trials
    most = betainc(count + 1 - index, index, needed + 1.0 / count)
    assert POWER - 0.027 <= share <= most + 0.027
    for same in (-scatter, scatter + 0.5):
        assert ratio_within_reach(same) == pytest.approx(reach, abs=ROUNDING)


def test_no_ratio_is_within_reach_of_too_few():
    assert ratio_within_reach(np.array([0.1, 0.2, 0.3, 0.4, 0.5])) == math.inf
    assert ratio_within_reach(np.array([])) == math.inf
    # half of them overturn by one method alone: there is no median
    assert ratio_within_reach(np.array([0.1] * 11 + [math.inf] * 12)) == math.inf
    # more scatter on one side: the ratio on the other side has to compensate it
    assert ratio_within_reach(np.array([*np.zeros(14), *-np.ones(8)])) == pytest.approx(math.e, rel=1e-12)


def test_overturned_members_are_largest_and_failed_ones_are_ignored():
    peaks = np.array([8.0, 8.0, 0.2, 0.0, 0.3, math.nan])
    against = np.array([8.0, 0.2, 8.0, 0.0, 0.2, 0.4])
    fell, fell_there = peaks == 8.0, against == 8.0
    np.testing.assert_allclose(
        Pairs(peaks, against, fell, fell_there).log_ratios(),
        [math.nan, math.inf, -math.inf, math.nan, math.log(1.5), math.nan],
        atol=ROUNDING,
    )
    contrast = contrast_of(peaks, against, fell, fell_there)
    assert (contrast.count, contrast.compared, contrast.higher, contrast.lower) == (5, 3, 2, 1)
    assert (contrast.overturned, contrast.against_overturned, contrast.both_overturned) == (2, 2, 1)
    assert Pairs(peaks[4:], against[4:], fell[4:], fell_there[4:]).contrast() is None  # of one member


def test_bounds_of_a_ratio_allow_any_outcome_of_failed_members():
    ratios = np.array([0.8, 0.9, 1.0, 1.1, 1.2, 1.3, 1.4, math.nan])
    stands = np.zeros(8, dtype=bool)
    assert Pairs(ratios, np.ones(8), stands, stands).ratio_bounds() == pytest.approx(
        (math.sqrt(1.0 * 1.1), math.sqrt(1.1 * 1.2)), rel=ROUNDING
    )


def test_members_that_overturn_by_one_method_alone_decide():
    assert mcnemar_p(6, 0) == pytest.approx(2.0**-5, abs=ROUNDING)
    assert mcnemar_p(0, 0) == 1.0
    assert mcnemar_p(3, 8) == pytest.approx(binomtest(3, 11).pvalue, abs=ROUNDING)
    few = least_significant_count()
    assert mcnemar_p(few, 0) < 0.05 <= mcnemar_p(few - 1, 0)
    # as many fall by each method, but never the same: a test of two independent samples would miss it
    fell = np.arange(COUNT) < 8
    assert contrast_of(sample(1), sample(2), fell, np.roll(fell, 8)).overturned_p == 1.0
    assert contrast_of(sample(1), sample(2), fell, UP).overturned_p == pytest.approx(2.0**-7, abs=ROUNDING)


def test_the_interval_of_a_difference_of_shares_contains_it():
    for count in (2, 5, COUNT):
        for only in range(count + 1):
            for only_there in range(count + 1 - only):
                interval = paired_difference(only, only_there, count)
                assert -1.0 <= interval.low <= interval.value <= interval.high <= 1.0
    assert paired_difference(0, 0, COUNT) == Interval(
        value=0.0, low=pytest.approx(-0.1155, abs=1e-4), high=pytest.approx(0.1155, abs=1e-4)
    )
    assert largest_share_unseen(COUNT) == pytest.approx(0.1273, abs=1e-4)


def test_several_probabilities_are_corrected_for_their_number():
    np.testing.assert_allclose(adjusted(np.array([0.04, 0.01, 0.03])), [0.06, 0.03, 0.06], atol=ROUNDING)
    assert adjusted(np.array([0.6, 0.7])).tolist() == [1.0, 1.0]
    assert adjusted(np.array([0.03])).tolist() == [0.03]


def test_a_median_needs_enough_members_to_bound_it() -> None:
    # the median is outside of all n values where all lie on one side of it: 2 of 2^n
    for count in range(1, 12):
        enough = 1.0 - 2.0 * 0.5**count >= CONFIDENCE
        assert math.isnan(value_if_enough(1.2, count)) is not enough
        assert math.isnan(quantile_interval(np.arange(1.0, count + 1.0), 0.5).value) is not enough
