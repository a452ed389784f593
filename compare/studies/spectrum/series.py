"""The three runs of a cell of a spectrum: in space, and in the planes of both components.

They share one factor on the record: the planar runs take the east-west or the north-south component of the
same shaking and leave the other out, as a planar analysis does.
"""

from __future__ import annotations

import math
from typing import TypedDict

import numpy as np

from rockwobble.models import GroundMotion

SPATIAL, PLANAR_X, PLANAR_Y = "3d", "planar_x", "planar_y"
SERIES = (SPATIAL, PLANAR_X, PLANAR_Y)
TITLES = {
    SPATIAL: "3D, both components",
    PLANAR_X: "planar, east-west alone",
    PLANAR_Y: "planar, north-south alone",
}
_AZIMUTH = {PLANAR_X: 0.0, PLANAR_Y: 0.5 * math.pi}  # of the plane [rad]


class Options(TypedDict, total=False):
    """Options of a reduced run."""

    support: str
    plane: float


def series_options(series: str, support: str) -> Options:
    """Return the options of a reduced run that make it one of a series; `support` is that in 3D."""
    return {"support": support} if series == SPATIAL else {"plane": _AZIMUTH[series]}


def uplift_of_series(
    series: str, motion: GroundMotion, tan_alpha: float, gravity: float, *, until: float = math.inf
) -> float:
    """Return the factor on a ground motion at which a series uplifts from rest; see `uplift_factor`."""
    return uplift_factor(motion, tan_alpha, gravity, plane=_AZIMUTH.get(series), until=until)


def intensity_unit(tan_alpha: float, motion: GroundMotion, gravity: float) -> float:
    """Return the factor that brings the peak horizontal resultant of `motion` to g tan(alpha).

    Raises
    ------
    ValueError
        If the motion has no horizontal component to scale.
    """
    if motion.peak == 0.0:
        raise ValueError("motion must have a horizontal acceleration to scale, got none")
    return gravity * tan_alpha / motion.peak


def uplift_factor(
    motion: GroundMotion,
    tan_alpha: float,
    gravity: float,
    *,
    plane: float | None = None,
    until: float = math.inf,
) -> float:
    """Return the factor on a ground motion at which a cylinder at rest uplifts [-]; inf if none does.

    Exact: f of equation (25) is convex between samples, and so is largest at one of them.

    Parameters
    ----------
    motion : GroundMotion
    tan_alpha : float
    gravity : float
        [m/s^2]
    plane : float, optional
        Azimuth of the plane of planar motion [rad]. Default: motion in space.
    until : float, optional
        End of the run [s].
    """
    samples, times = motion.acceleration, np.arange(len(motion.acceleration)) * motion.time_step
    if until < motion.duration:
        last = [np.interp(until, times, column) for column in samples.T]
        samples = np.vstack([samples[times <= until], last])
    x, y = samples[:, 0], samples[:, 1]
    drive = np.hypot(x, y) if plane is None else np.abs(x * math.cos(plane) + y * math.sin(plane))
    if motion.has_vertical:
        drive = drive - samples[:, 2] * tan_alpha
    largest = float(drive.max())
    return gravity * tan_alpha / largest if largest > 0.0 else math.inf
