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


@dataclass(frozen=True, slots=True, kw_only=True)
class Uplift:
    """The uplift, as samples tell it.

    Parameters
    ----------
    time, time_uncertainty : float
        [s]; 0 and 0 where the first sample leans already: a release; NaN without uplift.
    direction, direction_uncertainty : float
        Azimuth at the first sample that leans [rad], and how far it may be from that at uplift.
    first : int or None
        The first sample that leans.
    """

    time: float
    time_uncertainty: float
    direction: float
    direction_uncertainty: float
    first: int | None


def uplift(time: Array, tilt: Array, angle: Array, *, stands: float, noise: float = 0.0) -> Uplift:
    """Return the uplift of a trajectory.

    Parameters
    ----------
    time, tilt : ndarray, shape (n,)
        [s], [rad]
    angle : ndarray, shape (n,)
        Azimuth of the lean; NaN where it is not known [rad].
    stands : float
        Tilt up to which the cylinder counts as standing [rad].
    noise : float, optional
        Standard deviation of the noise of the tilt [rad].
    """
    leaning = np.flatnonzero(tilt > stands)
    if not len(leaning):
        return Uplift(
            time=math.nan,
            time_uncertainty=math.nan,
            direction=math.nan,
            direction_uncertainty=math.nan,
            first=None,
        )
    first = int(leaning[0])
    blurred = CONFIDENCE * noise / float(tilt[first])
    if first == 0 or first + 1 == len(time):
        step = 0.0 if first == 0 else float(time[first] - time[first - 1])
        return Uplift(
            time=float(time[first]) if first else 0.0,
            time_uncertainty=step,
            direction=float(angle[first]),
            direction_uncertainty=blurred if math.isfinite(angle[first]) else math.nan,
            first=first,
        )
    begin = _begin(time, tilt, first, _POWER)
    apart = max(abs(_begin(time, tilt, first, power) - begin) for power in _OTHERS)
    half = 0.5 * float(time[first] - time[first - 1])
    # noise moves the sample at which the tilt is seen along its growth, theta' = 3 theta/t
    since = float(time[first]) - begin
    uncertainty = half + apart + since * blurred / _POWER
    turning = abs(math.remainder(float(angle[first + 1] - angle[first]), 2.0 * math.pi)) / float(
        time[first + 1] - time[first]
    )
    return Uplift(
        time=begin,
        time_uncertainty=uncertainty,
        direction=float(angle[first]),
        direction_uncertainty=turning * (since + uncertainty) + blurred,
        first=first,
    )


def _begin(time: Array, tilt: Array, first: int, power: float) -> float:
    """Time at which a tilt that begins as this power of time was zero, not before the start [s]."""
    t0, t1 = (float(value) for value in time[first : first + 2])
    s0, s1 = (float(value) ** (1.0 / power) for value in tilt[first : first + 2])
    return max(t0 - s0 * (t1 - t0) / (s1 - s0), 0.0) if s1 > s0 else t0
