"""A ground motion as the three columns that the kernels take, and the plane that holds it."""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from rockwobble.models import Case, GroundMotion
from rockwobble.models.mode import PLANE_TOLERANCE, stays_in_plane


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
    return not stays_in_plane(record, math.atan2(largest[1], largest[0]), 1e4 * PLANE_TOLERANCE)


def in_plane(record: NDArray[np.float64], azimuth: float) -> NDArray[np.float64]:
    """Return a record (n, 3) without its component across the vertical plane at `azimuth` [rad]."""
    cosine, sine = math.cos(azimuth), math.sin(azimuth)
    along = record[:, 0] * cosine + record[:, 1] * sine
    return np.column_stack([along * cosine, along * sine, record[:, 2]])


def sample_times(duration: float, sample_step: float) -> NDArray[np.float64]:
    """Multiples of `sample_step` before `duration`, and `duration` itself (n,) [s]."""
    # a multiple within rounding of the end is the end
    count = math.ceil(duration / sample_step * (1.0 - 1e-12))
    times = np.arange(count + 1, dtype=float)
    times *= sample_step
    times[-1] = duration
    return times


# kept for the runs that follow with the same motion: it takes a tenth of the time of a short one
@lru_cache(maxsize=4)
def three_columns(motion: GroundMotion | None) -> NDArray[np.float64]:
    """Return the samples of a motion (n, 3) [m/s^2], zeros where it has no vertical component."""
    if motion is None:
        return np.empty((0, 3))
    record = np.zeros((len(motion.acceleration), 3))
    record[:, : motion.acceleration.shape[1]] = motion.acceleration
    return record
