"""When and where a sampled trajectory uplifts, and how well its samples tell that.

Where the ground acceleration rises through the threshold the tilt begins as theta = K t^3/6, so a lean is
seen only some time after the uplift: after the cube root of 6 theta/K, and at a sample. The cube root of the
first two leans is continued back to zero. Where the ground jumps over the threshold the tilt begins as t^2,
where its direction turns it has a term t^4: how much the answer depends on that is part of its uncertainty.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from .file import Array

# power of time with which the tilt begins: expected, and those it may have
_POWER, _OTHERS = 3.0, (2.0, 4.0)
# standard deviations of the noise: the first of some hundred samples that is above a tilt is sought
CONFIDENCE = 4.0


@dataclass(frozen=True, slots=True)
class Uplift:
    """The uplift, as samples tell it; NaN without one.

    Attributes
    ----------
    time, time_uncertainty : float
        [s]; 0 and 0 where the first sample leans already: a release.
    direction, direction_uncertainty : float
        Azimuth at the first sample that leans [rad], and how far it may be from that at uplift.
    first : int or None
        The first sample that leans.
    """

    time: float = math.nan
    time_uncertainty: float = math.nan
    direction: float = math.nan
    direction_uncertainty: float = math.nan
    first: int | None = None


def uplift(time: Array, tilt: Array, angle: Array, *, stands: float, noise: float = 0.0) -> Uplift:
    """Return the uplift of a trajectory.

    Parameters
    ----------
    time, tilt, angle : ndarray, shape (n,)
        [s], [rad], and the azimuth of the lean, NaN where it is not known [rad].
    stands, noise : float
        Tilt up to which the cylinder counts as standing, and standard deviation of its noise [rad].
    """
    leaning = np.flatnonzero(tilt > stands)
    if not len(leaning):
        return Uplift()
    first = int(leaning[0])
    at, direction, blurred = float(time[first]), float(angle[first]), CONFIDENCE * noise / float(tilt[first])
    step = at - float(time[first - 1]) if first else 0.0
    if first == 0 or first + 1 == len(time):
        known = blurred if math.isfinite(direction) else math.nan
        return Uplift(at if first else 0.0, step, direction, known, first)
    begin = _begin(time, tilt, first, _POWER)
    apart = max(abs(_begin(time, tilt, first, power) - begin) for power in _OTHERS)
    # noise moves the sample at which the tilt is seen along its growth, theta' = 3 theta/t
    since = at - begin
    uncertainty = 0.5 * step + apart + since * blurred / _POWER
    turned = abs(math.remainder(float(angle[first + 1]) - direction, 2.0 * math.pi))
    turning = turned / (float(time[first + 1]) - at)
    return Uplift(begin, uncertainty, direction, turning * (since + uncertainty) + blurred, first)


def _begin(time: Array, tilt: Array, first: int, power: float) -> float:
    """Time at which a tilt that begins as this power of time was zero, not before the start [s]."""
    t0, t1 = (float(value) for value in time[first : first + 2])
    s0, s1 = (float(value) ** (1.0 / power) for value in tilt[first : first + 2])
    return max(t0 - s0 * (t1 - t0) / (s1 - s0), 0.0) if s1 > s0 else t0
