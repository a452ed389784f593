"""Coverage of 95 % intervals of annual frequencies and of their ratios.

`python tests/benchmarks risk_coverage` draws the intensities at which motions overturn two bodies, lognormal
and cut off at uplift, many times anew, and counts how often the interval of the frequency under a power-law
hazard and that of the ratio hold what all motions give, and how often the frequency is above its interval.
Few motions have most of such a mean: the more they scatter, and the further uplift lies below the median, the
less any interval knows. Stripes are motions of their own at each level, as many as stated.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np

from rockwobble.compare.metrics.statistics import Interval
from rockwobble.models import HazardCurve
from rockwobble.studies.fragility.fit import resamples
from rockwobble.studies.fragility.integral import frequencies_of
from rockwobble.studies.fragility.risk import Exposure, Resampled, frequency_interval, resampled

from .console import options_of, show

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

Problem = tuple[int, bool, float, float, float, float]
# motions, levels with motions of their own, dispersion, that of the ratio of both bodies, exponent of the
# hazard, uplift over the median
PROBLEMS: tuple[Problem, ...] = (
    (22, False, 0.66, 0.3, 3.0, 0.24),
    (22, False, 0.7, 0.6, 3.0, 0.24),
    (22, False, 0.4, 0.1, 2.5, 0.24),
    (22, False, 0.66, 0.3, 3.0, 0.1),
    (22, False, 0.4, 0.1, 2.5, 0.1),
    (40, False, 0.66, 0.3, 2.5, 0.24),
    (40, False, 0.66, 0.3, 2.5, 0.1),
    (22, True, 0.6, 0.3, 3.0, 0.24),
    (22, True, 0.6, 0.3, 3.0, 0.1),
    (10, True, 0.4, 0.1, 2.5, 0.24),
    (10, True, 0.4, 0.1, 2.5, 0.1),
)
MEDIAN, HIGHEST, LEVELS = 0.9, 6.0, 16
_POPULATION = 100_000


def coverage(trials: int, seed: int, problems: Sequence[Problem] = PROBLEMS) -> Iterator[dict[str, float]]:
    """Yield for each problem the coverage of its intervals in the trials."""
    at = np.geomspace(0.01, 200.0, 60)
    for motions, stripes, dispersion, apart, exponent, uplift in problems:
        lift = math.log(uplift * MEDIAN)
        levels = np.log(np.geomspace(1.05 * uplift * MEDIAN, HIGHEST, LEVELS))
        rng, hazard = np.random.default_rng(seed), HazardCurve(at, 1e-2 * at**-exponent, measure="pga")
        first = np.maximum(rng.normal(math.log(MEDIAN), dispersion, _POPULATION), lift)
        moved = first + 0.3 + rng.normal(0.0, apart, _POPULATION)
        bodies = first, np.maximum(moved, lift)
        shares = [np.array([[(body <= level).mean() for level in levels]]) for body in bodies]
        ends = np.array([lift]), np.array([math.inf])
        truths = [float(frequencies_of(hazard, levels[None], each, *ends).total[0]) for each in shares]
        strata = np.repeat(np.arange(LEVELS), motions) if stripes else np.zeros(motions, dtype=np.int64)
        made = (strata[:, None] == np.arange(LEVELS)) | (not stripes)
        weights, rows = resamples(len(strata), 400, 1, strata=strata), []
        for _ in range(trials):
            drawn = rng.integers(0, _POPULATION, len(strata))
            (one, interval), (other, _) = (
                _frequency(hazard, levels, body[drawn], made, lift, weights, motions) for body in bodies
            )
            ratio = other.over(one).interval(motions)
            rows.append(
                (
                    interval.low <= truths[0] <= interval.high,
                    truths[0] > interval.high,
                    ratio.low <= truths[1] / truths[0] <= ratio.high,
                )
            )
        about = {"motions": motions, "stripes": stripes, "dispersion": dispersion, "apart": apart}
        about |= {"exponent": exponent, "uplift": uplift}
        yield {**about, **dict(zip(("frequency", "above", "ratio"), np.mean(rows, axis=0), strict=True))}


def _frequency(
    hazard: HazardCurve,
    levels: Array,
    capacity: Array,
    made: NDArray[np.bool_],
    uplift: float,
    weights: Array,
    motions: int,
) -> tuple[Resampled, Interval]:
    overturns = np.where(made, levels >= capacity[:, None], np.nan)
    x, ones = np.tile(levels, (len(capacity), 1)), np.ones(len(capacity))
    exposure = Exposure(x=x, y=overturns, made=made, uplift=uplift * ones, far=math.inf * ones)
    single = exposure.frequencies(hazard)
    drawn = resampled(exposure.terms(hazard, single), weights)
    return drawn, frequency_interval(hazard, exposure, single, drawn, motions)


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
