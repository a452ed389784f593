"""Efficiency: by which intensity motions that overturn differ least from motions that do not."""

from __future__ import annotations

import math

import numpy as np
import pandas as pd

from .fit import FITTED, KINDS
from .intensity import MEASURES
from .limits import OVERTURNED
from .resampling import Array, interval, spread_interval
from .samples import Blocks

# Every run has an intensity of its own in each measure but that of the levels, and so many numbers in each
# resample: as many resamples as keep this many numbers, and no fewer than give an end of an interval.
_MOST_NUMBERS, _FEWEST = 150_000, 100


def efficiency_table(blocks: Blocks, method: str, weights: Array) -> pd.DataFrame:
    """Return the dispersion of one method by each measure, and over that of the best, of the same resamples.

    The runs are the same for every measure: from where no motion overturns to where nearly all do, so that
    it matters little by which measure their levels were chosen.
    """
    rows = []
    motions = len(blocks.motions)
    for cylinder in blocks.cylinders:
        if (cylinder, method) not in blocks.runs:
            continue
        if np.isnan(blocks.exceeded(cylinder, method, OVERTURNED)).all():  # every run failed
            continue
        measures = [measure for measure in MEASURES if blocks.known(cylinder, measure)]
        samples = {m: blocks.sample(cylinder, method, OVERTURNED, m) for m in measures}
        found = {m: sample.curves() for m, sample in samples.items()}
        fitted = [m for m in measures if KINDS[found[m].kinds[0]] == FITTED]
        if not fitted:
            continue
        size = samples[fitted[0]].y.size
        some = weights[: max(_FEWEST, _MOST_NUMBERS // size)]
        drawn = {m: samples[m].curves(some).dispersion for m in fitted}
        best = min(fitted, key=lambda m: float(found[m].dispersion[0]))
        for measure in fitted:
            spread = float(found[measure].dispersion[0])
            with np.errstate(divide="ignore", invalid="ignore"):  # separated resamples have no dispersion
                ratios = np.log(drawn[measure] / drawn[best]) if measure != best else np.zeros(len(some))
            value = math.log(spread / float(found[best].dispersion[0]))
            rows.append(
                {
                    "cylinder": cylinder,
                    "method": method,
                    "measure": measure,
                    "median": float(np.exp(found[measure].centre[0])),
                    **spread_interval(spread, drawn[measure], motions).columns("dispersion"),
                    **interval(value, ratios, motions).exponential().columns("over_best"),
                    "best": measure == best,
                }
            )
    return pd.DataFrame(rows)
