"""The three runs of a cell of a spectrum: in space, and in the planes of both components.

They share one factor on the record: the planar runs take the east-west or the north-south component of the
same shaking and leave the other out, as a planar analysis does.
"""

from __future__ import annotations

import math
from typing import Any

from rockwobble.models import GroundMotion

from .lowest_overturning import uplift_factor

SPATIAL, PLANAR_X, PLANAR_Y = "3d", "planar_x", "planar_y"
SERIES = (SPATIAL, PLANAR_X, PLANAR_Y)
SPATIAL_MODELS = ("recess", "flat")
_AZIMUTH = {PLANAR_X: 0.0, PLANAR_Y: 0.5 * math.pi}  # of the plane [rad]


def series_options(series: str, model: str) -> dict[str, Any]:
    """Return the options of a reduced run that make it one of a series; `model` is that in 3D."""
    if series == SPATIAL:
        return {"support": model}
    return {"plane": _AZIMUTH[series]}


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
