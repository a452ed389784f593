"""Islands: levels at which a motion overturns a cylinder that stands under the same motion made stronger.

An incremental analysis raises each motion until the cylinder overturns and stops. What it takes for
overturned above that level may stand, so its curve lies to the left of the one of all levels.
"""

from __future__ import annotations

import itertools

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from .limits import OVERTURNED
from .resampling import Array, Sample, interval
from .samples import Blocks


def island_table(blocks: Blocks, weights: Array) -> pd.DataFrame:
    """Return, for each cylinder and method, how many motions have islands and what stopping early does.

    The columns: motions, with_islands (of these), runs, islands (runs that overturn while a stronger one
    stands), median of all levels and median_incremental, and bias, the second over the first, with the
    interval of the same resamples.
    """
    rows = []
    motions = len(blocks.motions)
    for cylinder, method in itertools.product(blocks.cylinders, blocks.methods):
        sample = blocks.sample(cylinder, method, OVERTURNED)
        if np.isnan(sample.y).all():
            continue
        stopped = Sample(x=sample.x, y=incremental(sample.y))
        whole, early = sample.curves(), stopped.curves()
        with np.errstate(invalid="ignore"):
            value = float(early.centre[0] - whole.centre[0])
            many_early, many = stopped.curves(weights), sample.curves(weights)
            low, high = many_early.low - many.high, many_early.high - many.low
            # of the same counts the same curve, wherever it lies
            same = (stopped.counts(weights)[2] == sample.counts(weights)[2]).all(axis=1)
            low, high = (np.where(same, 0.0, end) for end in (low, high))
        found = islands(sample.y)
        rows.append(
            {
                "cylinder": cylinder,
                "method": method,
                "motions": motions,
                "with_islands": int(found.any(axis=1).sum()),
                "runs": int((~np.isnan(sample.y)).sum()),
                "islands": int(found.sum()),
                "median": float(np.exp(whole.centre[0])),
                "median_incremental": float(np.exp(early.centre[0])),
                **interval(value, low, motions, above=high).exponential().columns("bias"),
            }
        )
    return pd.DataFrame(rows)


def islands(y: Array) -> NDArray[np.bool_]:
    """Return where a run (R, S) overturns while the same motion, stronger, leaves the cylinder standing.

    Parameters
    ----------
    y : ndarray, shape (R, S)
        1, 0, or NaN where a run failed, from the weakest level to the strongest.
    """
    stands = np.nan_to_num(y, nan=1.0) == 0.0
    later = np.zeros_like(stands)
    later[:, :-1] = np.logical_or.accumulate(stands[:, :0:-1], axis=1)[:, ::-1]
    return np.asarray((y == 1.0) & later, dtype=np.bool_)


def incremental(y: Array) -> Array:
    """Return the outcome (R, S) of each level as an analysis has it that stops at the first overturning."""
    fell = np.maximum.accumulate(np.nan_to_num(y, nan=0.0), axis=1)
    return np.where(np.isnan(y) & (fell == 0.0), np.nan, fell)
