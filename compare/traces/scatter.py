"""Noise of an external trajectory: the scatter of its own samples about a smooth motion."""

from __future__ import annotations

import numpy as np

from .file import Array

# of a normal distribution: median of the absolute value over the standard deviation
_MEDIAN_OF_NORMAL = 0.6745
_FEWEST = 12  # samples without which nothing is told of their scatter


def scatter(time: Array, values: Array) -> float:
    """Standard deviation of the noise of the roughest column of values (n, k); 0 where too few tell it.

    Each sample is held against the cubic through its four neighbours, at their own times (n,), so that uneven
    samples do no harm. The median keeps the few samples out at which a pass by the upright position makes a
    real corner.
    """
    if len(time) < 5:
        return 0.0
    middle, places = time[2:-2], {at: time[at : len(time) - 4 + at] for at in (0, 1, 3, 4)}
    guess, gain = np.zeros_like(values[2:-2]), np.ones(len(middle))
    for at, one in places.items():
        others = [other for there, other in places.items() if there != at]
        weight = np.prod([(middle - other) / (one - other) for other in others], axis=0)
        guess += weight[:, None] * values[at : len(time) - 4 + at]
        gain += weight * weight
    apart = np.abs(values[2:-2] - guess) / np.sqrt(gain)[:, None]
    # samples that are exactly those of their neighbours stand, and say nothing of the noise in motion
    told = apart[np.isfinite(apart).all(axis=1) & (apart > 0.0).any(axis=1)]
    return float(np.median(told, axis=0).max()) / _MEDIAN_OF_NORMAL if len(told) >= _FEWEST else 0.0
