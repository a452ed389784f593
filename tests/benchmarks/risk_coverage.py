"""How often the 95 % intervals of annual frequencies, and of ratios of two of them, hold the truth.

`python tests/benchmarks risk_coverage` draws the intensities at which motions overturn two bodies, lognormal
and cut off at uplift, many times anew, and counts how often the interval of the frequency under a power-law
hazard, that of the ratio, and the percentiles of the resamples in place of the first hold what all motions
give. Few motions have most of such a mean: the more they scatter, the less any interval knows.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np

from rockwobble.models import HazardCurve
from rockwobble.studies.fragility.fit import interval, resamples
from rockwobble.studies.fragility.risk import Exposure, Resampled, frequencies_of, resampled

from .console import options_of, show

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

# motions, dispersion, that of the ratio of both bodies, exponent of the hazard
PROBLEMS = ((22, 0.66, 0.3, 3.0), (22, 0.7, 0.6, 3.0), (22, 0.4, 0.1, 2.5), (40, 0.66, 0.3, 2.5))
UPLIFT = 0.215
_POPULATION = 100_000


def coverage(trials: int, seed: int) -> Iterator[dict[str, float]]:
    """Yield for each problem the shares of the trials in which the intervals hold the truth."""
    levels = np.log(np.geomspace(0.22, 6.0, 13))
    at = np.geomspace(0.01, 200.0, 60)
    for motions, dispersion, apart, exponent in PROBLEMS:
        rng, hazard = np.random.default_rng(seed), HazardCurve(at, 1e-2 * at**-exponent, measure="pga")
        first = np.maximum(rng.normal(math.log(0.9), dispersion, _POPULATION), math.log(UPLIFT))
        moved = first + 0.3 + rng.normal(0.0, apart, _POPULATION)
        bodies = (first, np.maximum(moved, math.log(UPLIFT)))
        ends = np.full(motions, math.log(UPLIFT)), np.full(motions, math.inf)
        shares = [np.array([[(body <= level).mean() for level in levels]]) for body in bodies]
        truths = [
            frequencies_of(hazard, levels[None], each, ends[0][:1], ends[1][:1]).total[0] for each in shares
        ]
        weights, held = resamples(motions, 500, 1), np.zeros((trials, 3), dtype=bool)
        for trial in range(trials):
            drawn = rng.integers(0, _POPULATION, motions)
            one, other = (_frequency(hazard, levels, body[drawn], ends, weights) for body in bodies)
            found = (
                (one.interval(motions), truths[0]),
                (interval(one.value, one.drawn, motions), truths[0]),
                (other.over(one, motions), truths[1] / truths[0]),
            )
            held[trial] = [each.low <= truth <= each.high for each, truth in found]
        yield {
            **{"motions": motions, "dispersion": dispersion, "apart": apart, "exponent": exponent},
            **dict(zip(("frequency", "percentiles", "ratio"), held.mean(axis=0), strict=True)),
        }


def _frequency(
    hazard: HazardCurve,
    levels: Array,
    capacity: Array,
    ends: tuple[Array, Array],
    weights: Array,
) -> Resampled:
    overturns = (levels >= capacity[:, None]).astype(float)
    x, made = np.tile(levels, (len(capacity), 1)), np.full(overturns.shape, True)
    exposure = Exposure(x=x, y=overturns, made=made, uplift=ends[0], far=ends[1])
    return resampled(exposure, hazard, exposure.frequencies(hazard).total, weights)


def main(arguments: Sequence[str]) -> int:
    """Print the table."""
    import pandas as pd

    parser = options_of("risk_coverage", "Coverage of the 95 % intervals of annual frequencies.")
    parser.add_argument("--trials", type=int, default=600, help="samples of motions of each problem")
    parser.add_argument("--seed", type=int, default=4, help="of the samples")
    options = parser.parse_args(arguments)
    table = pd.DataFrame(coverage(options.trials, options.seed))
    title = "Share of the trials in which 95 % intervals hold the truth"
    show(table, title, {str(name): ".3g" for name in table.columns})
    return 0
