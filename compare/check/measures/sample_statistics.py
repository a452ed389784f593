"""Layer metrics, fourth part: intervals, tests and the power of a sample, from the sums that define them."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
from scipy.integrate import quad

from ...metrics.distributions import (
    adjusted,
    largest_share_unseen,
    least_significant_count,
    log_ratios,
    mcnemar_p,
    paired_difference,
    ratio_within_reach,
)
from ...metrics.order_statistics import Interval, quantile_interval, share_interval
from ..bench import Array, Bench
from ..finding import Bound, Finding, none_wrong, worst_of

DEFINED = Bound(1e-9, "sums of binomial coefficients and an integral, by quadrature")
NORMAL = 1.959963984540054  # exceeded with a probability of 2.5 %
COUNT = 22  # members of an ensemble of far-field records


def check(bench: Bench) -> Iterator[Finding]:
    """Yield the findings of this part."""
    del bench
    part = "intervals of quantiles and shares (compare/metrics/order_statistics.py)"
    yield worst_of("ends of intervals, against the probability that they leave out", _ends(), DEFINED, part)
    part = "distributions (compare/metrics/distributions.py)"
    yield worst_of("tests and reach of paired members", _tests(), DEFINED, part)
    yield none_wrong("wrong words on an interval", _words(), "by its definition", part)


def _at_most(count: int, total: int, share: float) -> float:
    """Probability that no more than `count` of `total` have what a share has."""
    return math.fsum(math.comb(total, i) * share**i * (1.0 - share) ** (total - i) for i in range(count + 1))


def _beta(a: float, b: float, share: float) -> float:
    """Probability of less than a share in a beta distribution."""
    scale = math.lgamma(a + b) - math.lgamma(a) - math.lgamma(b)

    def density(x: float) -> float:
        return math.exp(scale + (a - 1.0) * math.log(x) + (b - 1.0) * math.log1p(-x))

    return float(quad(density, 0.0, share, epsabs=1e-12, epsrel=1e-12)[0])


def _below(index: float, share: float) -> float:
    """Probability that the order statistic of an index, whole or not, is below the quantile of a share."""
    return _beta(index, COUNT + 1.0 - index, share)


def _ends() -> dict[str, float]:
    ordered = np.arange(1.0, COUNT + 1.0)  # so that an end is its own index
    median, low, high = (quantile_interval(ordered[::-1], share) for share in (0.5, 0.05, 0.95))
    some, none, every = (share_interval(count, COUNT) for count in (3, 0, COUNT))
    return {
        "median": median.value - 11.5,
        "median, low": _below(median.low, 0.5) - 0.975,
        "median, high": _below(median.high, 0.5) - 0.025,
        "5 %, no low end": 0.0 if low.low == -math.inf else math.inf,
        "5 %, high": _below(low.high, 0.05) - 0.05,
        "5 %": low.value - 0.05 * (COUNT + 1.0),
        "95 %, low": _below(high.low, 0.95) - 0.95,
        "95 %, no high end": 0.0 if high.high == math.inf else math.inf,
        "3 of 22": some.value - 3.0 / COUNT,
        "3 of 22, low": _at_most(2, COUNT, some.low) - 0.975,
        "3 of 22, high": _at_most(3, COUNT, some.high) - 0.025,
        "none of 22": none.low + none.value,
        "none of 22, high": _at_most(0, COUNT, none.high) - 0.025,
        "all of 22": every.high + every.value - 2.0,
        "all of 22, low": _at_most(COUNT - 1, COUNT, every.low) - 0.975,
    }


def _tests() -> dict[str, float]:
    first, second = 5.0 / 22.0, 2.0 / 22.0  # of 4 and 1 of 20, with one more in either and two in all
    width = NORMAL * math.sqrt((first + second - (first - second) ** 2) / 22.0)
    difference = paired_difference(4, 1, 20)
    least = next(count for count in range(1, 99) if 2.0 * _at_most(0, count, 0.5) < 0.05)
    scatter = np.log([0.5, 0.8, 0.9, 1.0, 1.0, 1.05, 1.1, 1.3, 1.5, 2.0, 2.5])
    reach = ratio_within_reach(scatter)
    # Holm: the least of four times 4, the next times 3, and none below the one before
    holm = adjusted(np.array([0.01, 0.04, 0.03, 0.005])) - [0.03, 0.06, 0.06, 0.02]
    fell, stood = np.array([True, False, True, False]), np.array([False, True, True, False])
    ratios = log_ratios(np.array([1.0, 0.5, 1.0, 0.4]), np.array([0.5, 1.0, 1.0, 0.1]), fell, stood)
    known = ratios[0] == math.inf and ratios[1] == -math.inf and math.isnan(ratios[2])
    return {
        "McNemar, 2 against 7": mcnemar_p(2, 7) - 2.0 * _at_most(2, 9, 0.5),
        "McNemar, none": mcnemar_p(0, 0) - 1.0,
        "difference of shares": difference.value - 3.0 / 20.0,
        "difference of shares, low": difference.low - (first - second - width),
        "difference of shares, high": difference.high - (first - second + width),
        "least significant count": float(least_significant_count() - least),
        "share unseen": (1.0 - largest_share_unseen(COUNT)) ** COUNT - 0.05,
        "ratio within reach": 0.0 if _is_smallest_detected(scatter, reach) else math.inf,
        "Holm": float(np.abs(holm).max()),
        "ratios": ratios[3] - math.log(4.0) if known else math.inf,
    }


def _is_smallest_detected(scatter: Array, reach: float) -> bool:
    """Whether a median of `reach` is found to differ from 1 with a power of 80 %, and a smaller one is not.

    The interval of their median begins at an order statistic: a beta distribution of its index says how often
    it is above 1 where a member is so with a given share.
    """
    count, middle = len(scatter), float(np.median(scatter))
    index = quantile_interval(np.arange(1.0, count + 1.0), 0.5).low

    def power(logarithm: float, sign: float) -> float:
        above = float(np.mean(sign * (scatter - middle) + logarithm >= 0.0))
        return _beta(count + 1.0 - index, index, above) if above < 1.0 else 1.0

    def detected(logarithm: float) -> bool:
        return min(power(logarithm, 1.0), power(logarithm, -1.0)) >= 0.8

    return detected(math.log(reach) + 1e-9) and not detected(math.log(reach) - 1e-9)


def _words() -> list[str]:
    words = {
        (0.99, 1.02): "within",
        (1.06, 1.2): "beyond",
        (0.5, 0.9): "beyond",
        (0.9, 1.02): "undecided",
        (1.0, 1.2): "undecided",
    }
    return [
        f"{low} to {high}"
        for (low, high), word in words.items()
        if Interval(value=1.0, low=low, high=high).about_one(0.05) != word
    ]
