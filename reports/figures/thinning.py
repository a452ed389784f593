"""Thinning of curves to fewer points without visible change."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
POINTS = 2000
_WINDOW = 1.0  # window of an envelope, about one swing [s]


def kept_samples(*columns: NDArray[np.float64], points: int = POINTS) -> NDArray[np.intp]:
    """Indices of samples to draw: both ends, and the extremes of each column in each stretch.

    Parameters
    ----------
    *columns : ndarray, shape (n,)
        What is drawn over the sample number; NaN is a gap, whose edges are kept.
    points : int, optional
        How many samples to keep at most, edges of gaps not counted.

    Returns
    -------
    ndarray, shape (k,)
        Increasing indices.
    """
    count = len(columns[0])
    if count <= points:
        return np.arange(count)
    stretches = max(1, (points - 2) // (2 * len(columns)))
    edges = np.linspace(0, count, stretches + 1).astype(np.intp)
    chosen = [np.array([0, count - 1], dtype=np.intp)]
    for column in columns:
        gap = np.isnan(column)
        turns = np.flatnonzero(gap[1:] != gap[:-1])
        chosen += [turns, turns + 1]
        for filled, pick in ((np.inf, np.argmin), (-np.inf, np.argmax)):
            values = np.where(gap, filled, column)
            chosen.append(np.array([a + pick(values[a:b]) for a, b in pairwise(edges)], dtype=np.intp))
    return np.unique(np.concatenate(chosen))


def kept_points(x: Array, y: Array, *, points: int = POINTS) -> NDArray[np.intp]:
    """Points of a line (n,), (n,) to draw: as `kept_samples`, for a path in both directions."""
    rising = bool(np.all(np.diff(x) >= 0.0))
    return kept_samples(y, points=points) if rising else kept_samples(x, y, points=2 * points)


def envelope(time: NDArray[np.float64], values: NDArray[np.float64]) -> NDArray[np.float64]:
    """Largest value within the last second, shape (n,).

    A difference of two oscillations passes zero all the time; its envelope shows its size. It first
    exceeds a bound exactly where the values do.

    Parameters
    ----------
    time : ndarray, shape (n,)
        Even steps but for the last [s].
    values : ndarray, shape (n,)
    """
    if len(time) < 2:
        return values
    count = max(1, round(_WINDOW / float(time[1] - time[0])))
    padded = np.concatenate([np.full(count - 1, -np.inf), values])
    upper: NDArray[np.float64] = np.lib.stride_tricks.sliding_window_view(padded, count).max(axis=1)
    return upper
