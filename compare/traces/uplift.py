"""Time and direction of the uplift of a sampled trajectory.

Where the ground acceleration rises through the threshold the tilt begins as theta = K t^3/6, so a lean is
seen only some time after the uplift: after the cube root of 6 theta/K, and at a sample. The cube root of the
first two leans is continued back to zero. How well samples and noise tell that is measured on the model that
it is held against, see `rockwobble.compare.comparison.external.uplift_difference`.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from .file import Array


class Uplift(NamedTuple):
    """The uplift, as samples tell it; NaN without one."""

    time: float = math.nan  # [s]; 0 where the first sample leans already: a release
    direction: float = math.nan  # azimuth at the first sample that leans [rad]
    first: int | None = None  # that sample


def uplift(time: Array, tilt: Array, angle: Array, *, stands: float) -> Uplift:
    """Return the uplift of samples (n,): times [s], tilts and azimuths of the lean, NaN if not known [rad].

    Up to the tilt `stands` [rad] the cylinder counts as standing.
    """
    leaning = np.flatnonzero(tilt > stands)
    if not len(leaning):
        return Uplift()
    first = int(leaning[0])
    direction = float(angle[first])
    if first == 0 or first + 1 == len(time):
        return Uplift(float(time[first]) if first else 0.0, direction, first)
    t0, t1 = (float(value) for value in time[first : first + 2])
    s0, s1 = (float(value) ** (1.0 / 3.0) for value in tilt[first : first + 2])
    # not before the start
    begin = max(t0 - s0 * (t1 - t0) / (s1 - s0), 0.0) if s1 > s0 else t0
    return Uplift(begin, direction, first)
