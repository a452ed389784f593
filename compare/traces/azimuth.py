"""The azimuth of an external trajectory from sample to sample, without jumps."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .file import Array


def unwrapped(axis: Array, leans: NDArray[np.bool_]) -> tuple[Array, NDArray[np.bool_]]:
    """Return the azimuth (n,) of the axis (n, 3) without jumps, and whether each change is no guess.

    It means something where the axis `leans` (n,); elsewhere the angle waits. Between two samples it takes
    the shorter way round, unless that is more than a quarter turn: then upright was passed between them, and
    which way is told by the sense in which the axis went round before and after (the area that its projection
    sweeps, which the passage of upright conserves).
    """
    count = len(axis)
    followed = np.ones(count, dtype=bool)
    tilted = np.flatnonzero(leans)
    if not len(tilted):
        return np.zeros(count), followed
    x, y = axis[tilted, 0], axis[tilted, 1]
    azimuth = np.arctan2(y, x)
    change = np.diff(azimuth)
    change -= 2.0 * np.pi * np.round(change / (2.0 * np.pi))
    swept = x[:-1] * y[1:] - x[1:] * y[:-1]
    guessed = np.abs(change) > 0.5 * np.pi
    for at in np.flatnonzero(guessed):
        around = [i for i in (at - 2, at - 1, at + 1, at + 2) if 0 <= i < len(change) and not guessed[i]]
        way = np.sign(swept[around].sum())
        if way and way != np.sign(change[at]):
            change[at] += 2.0 * np.pi * way
    followed[tilted[1:][guessed]] = False
    angles = azimuth[0] + np.concatenate([[0.0], np.cumsum(change)])
    # standing, the angle is that of the last lean; before the first, of the first
    last = np.searchsorted(tilted, np.arange(count), side="right") - 1
    return angles[np.maximum(last, 0)], followed
