"""How far the samples of an external trajectory scatter about a smooth motion: its noise, from itself."""

from __future__ import annotations

import numpy as np

from .file import Array

# of a normal distribution: median of the absolute value over the standard deviation
_MEDIAN_OF_NORMAL = 0.6745
# samples without which nothing is told of their scatter
_FEWEST = 12


def scatter(time: Array, values: Array) -> float:
    """Standard deviation of the noise of the roughest component, in the unit of the values.

    Each sample is held against the cubic through its four neighbours, at their own times, so that uneven
    samples do no harm. The median keeps the few samples out at which a pass by the upright position makes a
    real corner.

    Parameters
    ----------
    time : ndarray, shape (n,)
        [s]
    values : ndarray, shape (n, k)
        NaN where nothing is known.

    Returns
    -------
    float
        0 where there are too few samples to tell.
    """
    if len(time) < 5:
        return 0.0
    middle, around = time[2:-2], [time[at : len(time) - 4 + at] for at in (0, 1, 3, 4)]
    guess = np.zeros_like(values[2:-2])
    gain = np.ones(len(middle))
    for one, at in zip(around, (0, 1, 3, 4), strict=True):
        weight = np.ones(len(middle))
        for other in around:
            if other is not one:
                weight *= (middle - other) / (one - other)
        guess += weight[:, None] * values[at : len(time) - 4 + at]
        gain += weight * weight
    apart = np.abs(values[2:-2] - guess) / np.sqrt(gain)[:, None]
    # samples that are exactly those of their neighbours stand, and say nothing of the noise in motion
    told = apart[np.isfinite(apart).all(axis=1) & (apart > 0.0).any(axis=1)]
    return float(np.median(told, axis=0).max()) / _MEDIAN_OF_NORMAL if len(told) >= _FEWEST else 0.0
