"""Problems of many checks: one pier, releases, and ground motions that are known at every time."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from rockwobble.models import Case, Cylinder, GroundMotion, InitialState

GRAVITY = 9.81  # [m/s^2], the default of a case
PIER = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
THRESHOLD = GRAVITY * PIER.tan_alpha  # of its uplift [m/s^2]
MODELS = ("recess", "flat", "planar")


def released(share: float, spin: float, duration: float, cylinder: Cylinder = PIER, name: str = "") -> Case:
    """Return a release from rest at a share of alpha, with a rolling rate [rad/s]."""
    initial = InitialState(tilt=share * cylinder.alpha, rolling_rate=spin)
    return Case(cylinder, initial=initial, duration=duration, name=name)


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
