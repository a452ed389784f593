"""Coverage of the intervals and level of the tests of an ensemble, by simulation.

`python tests/benchmarks ensemble_intervals` prints one line for each kind of ensemble: shares of many
simulated ensembles, so that 0.95 is known to 0.002 with the default of 10,000. Beside the interval of the
median from order statistics stands that of a percentile bootstrap over the members, which is not used.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rockwobble.compare.metrics.contrast import log_ratios
from rockwobble.compare.metrics.statistics import (
    mcnemar_p,
    paired_difference,
    quantile_interval,
    signed_rank_p,
)

from .console import options_of

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]

ENSEMBLES, DRAWS = 10_000, 400
BOOTSTRAPPED = 1000  # ensembles that are also bootstrapped: the shares are known to 0.007
TRUTH = 400_000  # members from which the true quantiles are taken


@dataclass(frozen=True, slots=True, kw_only=True)
class Kind:
    """A kind of ensemble: the peaks of the same records by two methods, with a scatter of each method.

    Attributes
    ----------
    name : str
    count : int
        Members.
    shift, scatter : float
        Median and standard deviation of the log ratios of what stands.
    limit : float
        Peak from which on a member overturns [alpha].
    tied : float
        Share of the members with the same peak by both.
    skewed : bool
        Scatter of an exponential in place of a normal distribution, in the first method alone.
    """

    name: str
    count: int = 22
    shift: float = 0.0
    scatter: float = 0.3
    limit: float = math.inf
    tied: float = 0.0
    skewed: bool = False

    def draw(self, shape: tuple[int, ...], random: np.random.Generator) -> tuple[Array, Array, Flags, Flags]:
        """Return peaks by both methods and who overturns, each of this shape."""
        record = random.lognormal(-1.2, 0.8, shape)
        if self.skewed:
            first = self.scatter * (random.exponential(size=shape) - math.log(2.0))
            second = np.zeros(shape)
        else:
            first, second = (self.scatter / math.sqrt(2.0) * random.standard_normal(shape) for _ in range(2))
        same = random.random(shape) < self.tied
        ours = record * np.exp(np.where(same, 0.0, first + self.shift))
        theirs = record * np.exp(np.where(same, 0.0, second))
        return ours, theirs, ours > self.limit, theirs > self.limit


KINDS = (
    *(Kind(name="no difference", count=count) for count in (8, 12, 22, 40)),
    Kind(name="a tenth larger", shift=math.log(1.1)),
    Kind(name="a tenth larger, skewed", shift=math.log(1.1), skewed=True),
    Kind(name="no difference, a fifth tied at the median", tied=0.2),
    Kind(name="a third larger, a fifth tied", shift=0.3, tied=0.2),
    *(Kind(name=f"no difference, overturned above {x:g}", limit=x) for x in (0.6, 0.4, 0.25)),
    Kind(name="a tenth larger, overturned above 0.6", shift=math.log(1.1), limit=0.6),
    Kind(name="a tenth larger, overturned above 0.4", shift=math.log(1.1), limit=0.4),
)
HEADINGS = ("ensemble", "n", "median", "bootstrap", "5th", "95th", "difference", "Wilcoxon", "McNemar")


def bootstrap(values: Array, random: np.random.Generator) -> tuple[float, float]:
    """Return the percentile interval of the median over drawn members."""
    drawn = np.sort(values[random.integers(len(values), size=(DRAWS, len(values)))], axis=1)
    with np.errstate(invalid="ignore"):  # between both infinities
        medians = 0.5 * (drawn[:, (len(values) - 1) // 2] + drawn[:, len(values) // 2])
    low, high = np.quantile(medians[~np.isnan(medians)], [0.025, 0.975], method="inverted_cdf")
    return float(low), float(high)


def measure(kind: Kind, ensembles: int) -> tuple[str, ...]:
    """Return a line: coverage of each interval, and how often each test says p < 0.05."""
    random = np.random.default_rng(1)
    many = kind.draw((TRUTH,), random)
    every = log_ratios(*many)
    shares = (0.5, 0.05, 0.95)
    truths = np.quantile(every[~np.isnan(every)], shares, method="inverted_cdf")
    difference = float(many[2].mean() - many[3].mean())
    inside: dict[str, list[bool]] = {name: [] for name in HEADINGS[2:]}
    for index in range(ensembles):
        ours, theirs, fell, there = kind.draw((kind.count,), random)
        ratios = log_ratios(ours, theirs, fell, there)
        ratios = ratios[~np.isnan(ratios)]
        for name, share, truth in zip(("median", "5th", "95th"), shares, truths, strict=True):
            found = quantile_interval(ratios, share)
            if not math.isnan(found.value) and not found.low <= found.value <= found.high:
                raise AssertionError(f"{found} does not contain its value")
            inside[name].append(found.low <= truth <= found.high)
        if index < BOOTSTRAPPED and len(ratios):
            low, high = bootstrap(ratios, random)
            inside["bootstrap"].append(low <= truths[0] <= high)
        only, only_there = int((fell & ~there).sum()), int((there & ~fell).sum())
        shares_differ = paired_difference(only, only_there, kind.count)
        inside["difference"].append(shares_differ.low <= difference <= shares_differ.high)
        inside["Wilcoxon"].append(signed_rank_p(ratios) < 0.05)
        inside["McNemar"].append(mcnemar_p(only, only_there) < 0.05)
    return (kind.name, str(kind.count), *(f"{np.mean(values):.3f}" for values in inside.values()))


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the table."""
    parser = options_of(
        "ensemble_intervals", "Coverage of the intervals and level of the tests of an ensemble."
    )
    parser.add_argument(
        "--ensembles", type=int, default=ENSEMBLES, help="simulated of each kind (%(default)s)"
    )
    ensembles = parser.parse_args(arguments).ensembles
    print("Coverage of 95 % intervals, and share of p < 0.05 (no difference: at most 0.05)")
    print(f"{HEADINGS[0]:45}" + "".join(f"{name:>11}" for name in HEADINGS[1:]))
    for kind in KINDS:
        name, *cells = measure(kind, ensembles)
        print(f"{name:45}" + "".join(f"{cell:>11}" for cell in cells), flush=True)
    return 0
