"""Modes of motion, and the mode expected by friction, slenderness, support and shaking."""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from .case import Case
from .ground_motion import GroundMotion
from .support import support_named

REST, SLIDES, ROCKS = "rest", "slides", "rocks"
ROCKS_IN_PLANE, ROCKS_AND_SLIDES = "rocks in one plane", "rocks and slides"
MODES = (REST, SLIDES, ROCKS, ROCKS_IN_PLANE, ROCKS_AND_SLIDES)
# ratio to `Case.friction_of_uplift` below which an uplifting body slides as well, as friction is never known
# exactly
BORDER = 1.1

# A motion is in one plane if it leaves it by no more than a few roundings of its peak.
PLANE_TOLERANCE = 32.0 * float(np.finfo(float).eps)


def expected_mode(case: Case, support: str) -> str:
    """Mode of motion expected by mechanics, before any run.

    From rest on flat ground the smaller of friction and b/h decides: below b/h friction can never lift the
    base and never turns it, so it slides; from there to 1.1 b/h it rocks and may slide.
    Recesses take what friction does not.

    Parameters
    ----------
    case : Case
    support : str
        Name of a support.

    Returns
    -------
    str
        One of `MODES`.

    Examples
    --------
    >>> from rockwobble.models import Cylinder, el_centro_1940
    >>> cask = Cylinder(semidiagonal=3.0, tan_alpha=0.5)
    >>> shaken = el_centro_1940().scaled(2.5)
    >>> expected_mode(Case(cask, shaken, friction=0.3), "flat")
    'slides'
    >>> expected_mode(Case(cask, shaken, friction=0.3), "recess")
    'rocks'
    >>> expected_mode(Case(cask, shaken, friction=0.52), "flat")
    'rocks and slides'
    """
    rocks = ROCKS if plane_of(case) is None else ROCKS_IN_PLANE
    if case.is_release:
        return rocks
    free = support_named(support).lets_slide
    if free and case.friction < case.friction_of_uplift:
        return SLIDES if case.friction_at_rest > case.friction else REST
    if not case.uplifts:
        return REST
    if free and case.friction < BORDER * case.friction_of_uplift:
        return ROCKS_AND_SLIDES
    return rocks


def plane_of(case: Case) -> float | None:
    """Azimuth of the vertical plane that holds the motion of a case [rad]; None if there is none."""
    motion, initial = case.motion, case.initial
    if initial is None or initial.tilt == 0.0:
        return plane_of_shaking(motion)
    azimuth = initial.rolling_angle
    stays = motion is None or stays_in_plane(motion.acceleration, azimuth)
    return azimuth if stays and initial.rolling_rate == 0.0 else None


def wall_force(case: Case) -> float:
    """Largest horizontal force of a closed base on walls, beyond friction, over the weight [-]."""
    if case.motion is None or case.is_release:
        return 0.0
    acceleration, border = case.motion.until(case.length), case.friction_of_uplift
    load = case.gravity * border / case.cylinder.tan_alpha * np.ones(len(acceleration))
    load += acceleration[:, 2] if case.motion.has_vertical else 0.0
    pushed = np.minimum(np.hypot(acceleration[:, 0], acceleration[:, 1]), border * load)
    return float(max((pushed - case.friction * load).max(), 0.0) / case.gravity)


@lru_cache(maxsize=4)
def plane_of_shaking(motion: GroundMotion | None) -> float | None:
    """Azimuth of the vertical plane that holds the whole motion [rad]; None if there is none."""
    if motion is None or motion.peak == 0.0:
        return 0.0
    record = motion.acceleration
    largest = record[int(np.square(record[:, :2]).sum(axis=1).argmax())]
    azimuth = math.atan2(largest[1], largest[0])
    return azimuth if stays_in_plane(record, azimuth) else None


def stays_in_plane(record: NDArray[np.float64], azimuth: float, tolerance: float = PLANE_TOLERANCE) -> bool:
    """Whether a record (n, 2) or (n, 3) leaves the plane at `azimuth` by at most a share of its peak."""
    x, y = record[:, 0], record[:, 1]
    across = y * math.cos(azimuth) - x * math.sin(azimuth)
    peak = math.sqrt(float((x * x + y * y).max(initial=0.0)))
    return float(np.abs(across).max(initial=0.0)) <= tolerance * peak
