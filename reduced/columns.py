"""A ground motion as the three columns that the kernels take, and the plane that holds it."""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from rockwobble.models import Case, GroundMotion

# A motion is in one plane if it leaves it by no more than a few roundings of its peak.
_PLANE_TOLERANCE = 32.0 * float(np.finfo(float).eps)


def ground_at(case: Case, times: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the ground acceleration (n, 3) [m/s^2] at `times` (n,) [s]; zero outside record and run."""
    motion = case.motion
    record = three_columns(motion)
    if motion is None:
        return np.zeros((len(times), 3))
    at = np.arange(len(record)) * motion.time_step
    # the last instant of a run may round beyond the last sample
    inside = times <= min(motion.duration, case.length) * (1.0 + 1e-12)
    return np.column_stack([np.where(inside, np.interp(times, at, column), 0.0) for column in record.T])


@lru_cache(maxsize=4)
def is_spatial(motion: GroundMotion) -> bool:
    """Whether the motion is in no vertical plane by more than any rounding."""
    record = three_columns(motion)
    largest = record[int(np.square(record[:, :2]).sum(axis=1).argmax())]
    return not stays_in_plane(record, math.atan2(largest[1], largest[0]), 1e4 * _PLANE_TOLERANCE)


@lru_cache(maxsize=4)
def plane_of_shaking(motion: GroundMotion | None) -> float | None:
    """The azimuth [rad] of the vertical plane that holds the whole motion, if there is one."""
    if motion is None or motion.peak == 0.0:
        return 0.0
    record = three_columns(motion)
    largest = record[int(np.square(record[:, :2]).sum(axis=1).argmax())]
    azimuth = math.atan2(largest[1], largest[0])
    return azimuth if stays_in_plane(record, azimuth) else None


def stays_in_plane(record: NDArray[np.float64], azimuth: float, tolerance: float = _PLANE_TOLERANCE) -> bool:
    """Return whether a record (n, 3) leaves the plane at `azimuth` by at most a share of its peak."""
    x, y = record[:, 0], record[:, 1]
    across = y * math.cos(azimuth) - x * math.sin(azimuth)
    peak = math.sqrt(float((x * x + y * y).max(initial=0.0)))
    return float(np.abs(across).max(initial=0.0)) <= tolerance * peak


def in_plane(record: NDArray[np.float64], azimuth: float) -> NDArray[np.float64]:
    """Return a record (n, 3) without its component across the vertical plane at `azimuth` [rad]."""
    cosine, sine = math.cos(azimuth), math.sin(azimuth)
    along = record[:, 0] * cosine + record[:, 1] * sine
    return np.column_stack([along * cosine, along * sine, record[:, 2]])


# kept for the runs that follow with the same motion: it takes a tenth of the time of a short one
@lru_cache(maxsize=4)
def three_columns(motion: GroundMotion | None) -> NDArray[np.float64]:
    """Return the samples of a motion (n, 3) [m/s^2], zeros where it has no vertical component."""
    if motion is None:
        return np.empty((0, 3))
    record = np.zeros((len(motion.acceleration), 3))
    record[:, : motion.acceleration.shape[1]] = motion.acceleration
    return record
