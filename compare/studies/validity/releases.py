"""Releases of free response in numbers that do not depend on size."""

from __future__ import annotations

from rockwobble import reduced
from rockwobble.models import Cylinder, InitialState

from .motions import REFERENCE_SIZE


def released(tan_alpha: float, release: float, spin: float) -> tuple[Cylinder, InitialState]:
    """Return a cylinder and its release.

    Parameters
    ----------
    tan_alpha : float
    release : float
        Tilt over alpha.
    spin : float
        Rolling rate over that of steady wobble at the tilt; below 1 the release is a tilt maximum.
    """
    cylinder = Cylinder(semidiagonal=REFERENCE_SIZE, tan_alpha=tan_alpha)
    tilt = release * cylinder.alpha
    rate = spin * reduced.steady_wobble_rate(cylinder, tilt)
    return cylinder, InitialState(tilt=tilt, rolling_rate=rate)
