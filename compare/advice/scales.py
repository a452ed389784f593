"""One case over scales of its ground motion: in 3D, and by planar analysis of each component."""

from __future__ import annotations

import dataclasses
import math
import os
from collections.abc import Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rockwobble import reduced
from rockwobble.models import Case, GroundMotion

from ..spectrum import PLANAR_X, PLANAR_Y, SPATIAL, series_options

Array = NDArray[np.float64]

# twelve scales for each factor of two, from a quarter to sixteen times the record as it is given
_PER_OCTAVE, _FIRST, _LAST = 12, -2, 4
# halvings of the interval that holds the lowest overturning scale: to 0.2 %
_REFINEMENTS = 5
FELL = 0.5 * math.pi  # [rad]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ScaleScan:
    """Peak tilts over scales of the ground motion.

    Attributes
    ----------
    factors : ndarray, shape (n,)
        On the ground motion of the case, increasing; 1 is among them [-].
    peaks : mapping
        Peak tilt (n,) of each series [rad]: "3d", and "planar_x" and "planar_y" unless the case is a
        release. pi/2 if overturned, NaN if failed.
    lowest : mapping
        Lowest factor that overturns, of each series; NaN where none of these does.
    """

    factors: Array
    peaks: Mapping[str, Array]
    lowest: Mapping[str, float]

    @property
    def here(self) -> int:
        """Index of the case as it is given."""
        return int(np.abs(self.factors - 1.0).argmin())


def scan_scales(case: Case, model: str = "recess") -> ScaleScan | None:
    """Run a case over scales of its ground motion; None where there is none to scale.

    Parameters
    ----------
    case : Case
        From rest: three series. From a release, of which a planar analysis knows nothing: one.
    model : str, optional
        Model in three dimensions.
    """
    if case.motion is None or case.motion.peak == 0.0:
        return None
    factors = 2.0 ** (np.arange(_FIRST * _PER_OCTAVE, _LAST * _PER_OCTAVE + 1) / _PER_OCTAVE)
    released = case.initial is not None and case.initial.tilt > 0.0
    series = (SPATIAL,) if released else (SPATIAL, PLANAR_X, PLANAR_Y)
    peaks, lowest = {}, {}
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        for name in series:

            def peak(factor: float, name: str = name) -> float:
                return _peak(case, factor, name, model)

            peak(1.0)  # compiles, where that is due, once and not in each thread
            peaks[name] = np.array(list(pool.map(peak, factors)))
            lowest[name] = _lowest(case, factors, peaks[name], name, model)
    return ScaleScan(factors=factors, peaks=peaks, lowest=lowest)


def uplift_factor(case: Case) -> float:
    """Return the factor on the ground motion at which a cylinder at rest uplifts [-]; inf if none does.

    Exact: f of equation (25) is convex between samples.
    """
    motion = case.motion
    if motion is None:
        return math.inf
    horizontal = np.hypot(motion.acceleration[:, 0], motion.acceleration[:, 1])
    vertical = motion.acceleration[:, 2] if motion.has_vertical else np.zeros(len(horizontal))
    tan_alpha = case.cylinder.tan_alpha
    drive = float((horizontal - vertical * tan_alpha).max())
    return case.gravity * tan_alpha / drive if drive > 0.0 else math.inf


def _peak(case: Case, factor: float, series: str, model: str) -> float:
    motion: GroundMotion | None = case.motion
    scaled = dataclasses.replace(case, motion=motion.scaled(factor) if motion is not None else None)
    return reduced.simulate(
        scaled.cylinder,
        scaled.motion,
        initial=scaled.initial,
        duration=scaled.duration,
        sample_step=scaled.length,
        gravity=scaled.gravity,
        **series_options(series, model),
    ).peak_tilt


def _lowest(case: Case, factors: Array, peaks: Array, series: str, model: str) -> float:
    fell = np.flatnonzero(peaks >= FELL)
    if not len(fell):
        return math.nan
    high = float(factors[fell[0]])
    # the factor 1 is what the user asked about: it is not refined away
    low = float(factors[fell[0] - 1]) if fell[0] > 0 else high
    for _ in range(_REFINEMENTS if low < high else 0):
        middle = math.sqrt(low * high)
        if _peak(case, middle, series, model) >= FELL:
            high = middle
        else:
            low = middle
    return high
