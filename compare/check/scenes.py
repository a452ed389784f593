"""Problems of many checks: one pier, releases, and ground motions that are known at every time."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from rockwobble.models import Case, Cylinder, GroundMotion, InitialState, WobblingFrame

GRAVITY = 9.81  # [m/s^2], the default of a case
PIER = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
SQUAT = Cylinder(semidiagonal=6.0, tan_alpha=1.0)
FRAME = WobblingFrame(Cylinder(semidiagonal=3.0, tan_alpha=0.2), 1.0, columns=1)
THRESHOLD = GRAVITY * PIER.tan_alpha  # ground acceleration of its uplift [m/s^2]


def released(share: float, spin: float, duration: float, cylinder: Cylinder = PIER, name: str = "") -> Case:
    """Return a release from rest at a share of alpha, with a rolling rate [rad/s]."""
    initial = InitialState(tilt=share * cylinder.alpha, rolling_angle=0.3, rolling_rate=spin)
    return Case(cylinder, initial=initial, duration=duration, name=name)


def polyline(times: ArrayLike, values: ArrayLike, step: float) -> GroundMotion:
    """Return the motion that goes straight from knot to knot.

    Parameters
    ----------
    times : array_like, shape (k,)
        Times of the knots, multiples of `step`, from 0 on [s].
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
    knots = motion.time_step * np.arange(len(motion.acceleration))
    return polyline(knots, motion.acceleration, motion.time_step / times)


def steady(acceleration: ArrayLike, duration: float) -> GroundMotion:
    """Return ground that accelerates evenly by `acceleration` (2,) or (3,) [m/s^2] for `duration` [s]."""
    return GroundMotion(np.tile(np.asarray(acceleration, dtype=float), (2, 1)), duration)


# one pass of the upright position, at 0.1 alpha
RELEASE = released(0.5, 0.5, 3.0, name="release")
FRAME_RELEASE = released(0.5, 0.5, 2.4, FRAME, "release of a frame")
# rocks in three dimensions from rest, through several passes that are not near; one for each component
SHOCK_TIMES = (0.0, 0.5, 1.0, 1.5, 2.0)
SHOCK = THRESHOLD * np.array(
    [[0.0, 0.0, 0.0], [1.6, 1.2, 0.0], [-0.5, 1.5, 0.5], [-0.6, -0.9, -0.5], [0.0, 0.0, 0.0]]
)
