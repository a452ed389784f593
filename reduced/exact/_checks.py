"""Checks of the arguments that the exact solutions share."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rockwobble.models import Cylinder
from rockwobble.models.number_checks import require_positive

from ..body import Body, body_of


def body_under(cylinder: Cylinder, gravity: float) -> Body:
    """Return the constants of `cylinder`, or raise ValueError unless gravity is positive and finite."""
    return body_of(cylinder, require_positive("gravity", gravity, "m/s^2"))


def require_tilts(tilt: ArrayLike, alpha: float) -> NDArray[np.float64]:
    """Return `tilt` as an array, or raise ValueError unless every value is between 0 and alpha."""
    theta = np.asarray(tilt, dtype=float)
    outside = ~((theta > 0.0) & (theta < alpha))  # also where it is not a number
    if np.any(outside):
        first = float(np.extract(outside, theta)[0])
        raise ValueError(f"tilt must be above 0 and below alpha = {alpha!r} [rad], got {first!r}")
    return theta
