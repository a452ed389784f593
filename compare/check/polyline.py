"""Ground motions that are known at every time: straight lines between knots, sampled as often as wanted."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from rockwobble.models import GroundMotion


def polyline(times: ArrayLike, values: ArrayLike, step: float) -> GroundMotion:
    """Return the motion that goes straight from knot to knot.

    Parameters
    ----------
    times : array_like, shape (k,)
        Of the knots, multiples of `step`, from 0 on [s].
    values : array_like, shape (k, 2) or (k, 3)
        Acceleration there [m/s^2].
    step : float
        Spacing of the samples [s]; every knot is a sample, so the function of time is the same for each.
    """
    knots, columns = np.asarray(times, dtype=float), np.asarray(values, dtype=float).T
    at = step * np.arange(round(knots[-1] / step) + 1)
    return GroundMotion(np.column_stack([np.interp(at, knots, column) for column in columns]), step)


def refined(motion: GroundMotion, times: int) -> GroundMotion:
    """Return the same function of time with `times` as many samples."""
    a = motion.acceleration
    at = np.arange((len(a) - 1) * times + 1) / times
    columns = [np.interp(at, np.arange(len(a)), column) for column in a.T]
    return GroundMotion(np.column_stack(columns), motion.time_step / times)


def steady(acceleration: ArrayLike, duration: float) -> GroundMotion:
    """Return ground that accelerates evenly by `acceleration` (2,) or (3,) [m/s^2] for `duration` [s]."""
    return GroundMotion(np.tile(np.asarray(acceleration, dtype=float), (2, 1)), duration)
