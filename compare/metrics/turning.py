"""Differences of direction: the contact point's azimuth at uplift and after many turns."""

from __future__ import annotations

import math

import numpy as np

from rockwobble.models import Trace

from .pair import FloatArray, Pair

_HALF_A_TURN = 1e-9  # [rad] rounding of half a turn: motion with spin takes longer than a sample for it


def direction_difference(reference: Trace, trial: Trace) -> float:
    """Return the difference of the directions of uplift or release, in (-pi, pi] [rad]."""
    return -math.remainder(reference.uplift_direction - trial.uplift_direction, 2.0 * math.pi)


def turn_difference(pair: Pair, *, until: float, direction_difference: float = 0.0) -> float:
    """Return the difference of the angles rolled by the contact points until `until`, whole turns counted.

    Rolling angles are unwrapped from uplift on, so their difference counts the turns that one
    motion made more than the other since then. Only the whole turn by which the two started apart
    is taken off: an azimuth is known up to that.

    Parameters
    ----------
    pair : Pair
    until : float
        Time of the run [s]; the last sample at which both are tilted counts.
    direction_difference : float, optional
        Difference of the directions at uplift, in (-pi, pi] [rad].

    Returns
    -------
    float
        Trial minus reference [rad]; NaN where they are never tilted at the same time.
    """
    difference = pair.rolling_angle - pair.reference_rolling_angle
    both = np.flatnonzero(np.isfinite(difference) & (pair.time <= until))
    if not len(both):
        return math.nan
    offset = float(difference[both[0]]) - (
        direction_difference if math.isfinite(direction_difference) else 0.0
    )
    return float(difference[both[-1]]) - 2.0 * math.pi * round(offset / (2.0 * math.pi))


def first_unresolved_pass(trial: Trace, *, start: float = 0.0) -> float:
    """Return the time of the engine's first pass below its contact resolution [s]; inf if none.

    Passes before `start`, the uplift of the reference, are those of a base that settles in its contact.
    """
    passes = trial.passes
    if "resolved" not in passes:
        return math.inf
    times = np.asarray(passes["time"], dtype=np.float64)
    counts = ~np.asarray(passes["resolved"], dtype=bool) & (times > start)
    return float(times[counts][0]) if counts.any() else math.inf


def landings(response: Trace) -> FloatArray:
    """Return the times at which a reduced model goes through upright itself (n,) [s], to a sample.

    Its contact then jumps to the other end of the diameter. A fall that follows makes no pass of it.
    """
    turned = np.abs(np.diff(response.rolling_angle))
    return np.asarray(response.time)[1:][np.abs(turned - np.pi) < _HALF_A_TURN]
