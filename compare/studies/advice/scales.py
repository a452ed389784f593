"""One case over scales of its ground motion: in 3D, and by planar analysis of each component."""

from __future__ import annotations

import dataclasses
import os
from collections.abc import Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rockwobble import reduced
from rockwobble.models import Case, GroundMotion

from ...metrics.tilt import overturned
from ..spectrum.lowest_overturning import STEP, lowest_on_grid, search_lowest
from ..spectrum.series import SERIES, SPATIAL, intensity_unit, series_options, uplift_of_series
from ..spectrum.study import RTOL
from ..spectrum.verification import CHECK_RTOL, NUDGE

Array = NDArray[np.float64]

# twelve scales for each factor of two, from a quarter to sixteen times the record as it is given
_PER_OCTAVE, _FIRST, _LAST = 12, -2, 4


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
        Lowest factor found to overturn, of each series; NaN where none is.
    confirmed : mapping
        Whether it overturns to a tighter tolerance and under a record that differs by a hair, too.
    searched_from : mapping
        Factor at which each series uplifts, from which `lowest` was searched: up to where something
        overturns, or to the last factor. 0 for a release, inf where it uplifts at none.
    search_step : float
        Largest step of that search: see `search_lowest`. A narrower window of overturning may lie below
        `lowest`.
    """

    factors: Array
    peaks: Mapping[str, Array]
    lowest: Mapping[str, float]
    confirmed: Mapping[str, bool]
    searched_from: Mapping[str, float]
    search_step: float

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
    motion = case.motion
    if motion is None or motion.peak == 0.0:
        return None
    tan_alpha, gravity = case.cylinder.tan_alpha, case.gravity
    factors = 2.0 ** (np.arange(_FIRST * _PER_OCTAVE, _LAST * _PER_OCTAVE + 1) / _PER_OCTAVE)
    released = case.initial is not None and case.initial.tilt > 0.0
    series = (SPATIAL,) if released else SERIES
    step = STEP * intensity_unit(tan_alpha, motion, gravity)
    peaks, lowest, confirmed, start = {}, {}, {}, {}
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        for name in series:

            def run(scales: Array, name: str = name, rtol: float = RTOL) -> Array:
                return np.array(list(pool.map(lambda scale: _peak(case, scale, name, model, rtol), scales)))

            run(factors[:1])  # compiles, where that is due, once and not in each thread
            peaks[name] = run(factors)
            start[name] = (
                0.0 if released else uplift_of_series(name, motion, tan_alpha, gravity, until=case.length)
            )
            known = float(lowest_on_grid(factors, peaks[name][None])[0])
            stop = float(np.fmin(known, factors[-1]))
            found = search_lowest(run, start[name], stop, step, case.cylinder.alpha)
            lowest[name] = float(np.fmin(found, known))
            again = lowest[name] * np.array([1.0, 1.0 - NUDGE, 1.0 + NUDGE])
            confirmed[name] = bool(
                np.isfinite(lowest[name]) and overturned(run(again, rtol=CHECK_RTOL)).all()
            )
    return ScaleScan(
        factors=factors,
        peaks=peaks,
        lowest=lowest,
        confirmed=confirmed,
        searched_from=start,
        search_step=step,
    )


def _peak(case: Case, factor: float, series: str, model: str, rtol: float) -> float:
    motion: GroundMotion | None = case.motion
    scaled = dataclasses.replace(case, motion=motion.scaled(factor) if motion is not None else None)
    return reduced.simulate(
        Case(
            scaled.cylinder,
            scaled.motion,
            initial=scaled.initial,
            duration=scaled.duration,
            gravity=scaled.gravity,
        ),
        rtol=rtol,
        sample_step=scaled.length,
        **series_options(series, model),
    ).peak_tilt
