"""Overturning spectra: peak tilts over size and intensity, in three dimensions and in two planes.

The three runs of a cell share one factor on the record: the planar runs take the east-west or the
north-south component of the same shaking and leave the other out, as a planar analysis does.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rockwobble import reduced
from rockwobble.models import GroundMotion

from .lowest_overturning import lowest_overturning, refined

if TYPE_CHECKING:
    import pandas as pd

Array = NDArray[np.float64]
ProgressCallback = Callable[[str, float], None]

SPATIAL, PLANAR_X, PLANAR_Y = "3d", "planar_x", "planar_y"
SERIES = (SPATIAL, PLANAR_X, PLANAR_Y)
_AZIMUTH = {PLANAR_X: 0.0, PLANAR_Y: 0.5 * math.pi}  # of the plane [rad]
# Steps end at each sample of the record, so a tenth of the tolerance of `reduced.peak_tilts` costs only
# 4 % of the time, and the cells that it moves by 2 % of their tilt fall from 2 in 1000 to none.
RTOL = 1e-8
SPATIAL_MODELS = ("recess", "rolling")
# Halvings of the grid interval that holds the lowest overturning intensity: a 32nd of its width,
# less than the width of the line that draws it, for 5 % of the runs of a grid of 100 intensities.
REFINEMENTS = 5


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class OverturningSpectrum:
    """Peak tilts of cylinders of one slenderness under one record, over size and intensity.

    Attributes
    ----------
    tan_alpha : float
        Slenderness b/h [-].
    motion : GroundMotion
        The record at its own scale.
    gravity : float
        [m/s^2]
    model : str
        The model in three dimensions, "recess" or "rolling".
    seating : float
        As in `reduced.simulate`.
    semidiagonals : ndarray, shape (n_R,)
        Sizes R [m].
    intensities : ndarray, shape (n_I,)
        Peak of the horizontal resultant over g tan(alpha) [-]; 1 is the threshold of uplift in three
        dimensions without vertical motion.
    peak_tilt : mapping
        For each of `SERIES` an ndarray, shape (n_R, n_I) [rad]: 0 without uplift, pi/2 if overturned,
        NaN if the run failed.
    lowest : mapping
        For each of `SERIES` an ndarray, shape (n_R,): the minimum overturning acceleration, over
        g tan(alpha) [-]; NaN where no intensity of the grid overturns.
    lowest_width : float
        Bound of what `lowest` may lie above the edge of overturning that it approaches [-].
    """

    tan_alpha: float
    motion: GroundMotion
    gravity: float
    model: str
    seating: float
    semidiagonals: Array
    intensities: Array
    peak_tilt: Mapping[str, Array]
    lowest: Mapping[str, Array]
    lowest_width: float

    @property
    def alpha(self) -> float:
        """Slenderness [rad]."""
        return math.atan(self.tan_alpha)

    @property
    def scales(self) -> Array:
        """Factor on the record for each intensity (n_I,) [-]."""
        return self.intensities * intensity_unit(self.tan_alpha, self.motion, self.gravity)

    def component_share(self, series: str) -> float:
        """Peak of what drives a series over the peak of the horizontal resultant [-]."""
        if series == SPATIAL:
            return 1.0
        column = self.motion.acceleration[:, SERIES.index(series) - 1]
        return float(np.abs(column).max()) / self.motion.peak

    def overturned(self, series: str) -> NDArray[np.bool_]:
        """Whether each cell overturns (n_R, n_I); False where the run failed."""
        return np.asarray(self.peak_tilt[series] >= 0.5 * math.pi, dtype=np.bool_)

    def failed(self) -> NDArray[np.bool_]:
        """Whether any run of a cell failed (n_R, n_I): such cells are left out of every share."""
        tilts = np.stack([self.peak_tilt[series] for series in SERIES])
        return np.asarray(np.isnan(tilts).any(axis=0), dtype=np.bool_)

    def to_frame(self) -> pd.DataFrame:
        """Return one row for each cell and series.

        Columns: series, semidiagonal [m], intensity [-], scale [-], peak_acceleration [m/s^2] (of what
        drives the series), peak_tilt [rad], peak_tilt_over_alpha [-], overturned.
        """
        import pandas as pd

        sizes, intensities = np.meshgrid(self.semidiagonals, self.intensities, indexing="ij")
        _, scales = np.meshgrid(self.semidiagonals, self.scales, indexing="ij")
        tables = [
            pd.DataFrame(
                {
                    "series": series,
                    "semidiagonal": sizes.ravel(),
                    "intensity": intensities.ravel(),
                    "scale": scales.ravel(),
                    "peak_acceleration": self.component_share(series) * self.motion.peak * scales.ravel(),
                    "peak_tilt": self.peak_tilt[series].ravel(),
                    "peak_tilt_over_alpha": self.peak_tilt[series].ravel() / self.alpha,
                    "overturned": self.overturned(series).ravel(),
                }
            )
            for series in SERIES
        ]
        return pd.concat(tables, ignore_index=True)

    def lowest_frame(self) -> pd.DataFrame:
        """Return the minimum overturning accelerations, one row for each size and series.

        Columns: series, semidiagonal [m], intensity [-], peak_acceleration [m/s^2] (of what drives the
        series), both NaN where nothing overturns, and on_edge: the grid begins above the minimum.
        """
        import pandas as pd

        tables = []
        for series in SERIES:
            lowest = self.lowest[series]
            acceleration = lowest * self.gravity * self.tan_alpha * self.component_share(series)
            tables.append(
                pd.DataFrame(
                    {
                        "series": series,
                        "semidiagonal": self.semidiagonals,
                        "intensity": lowest,
                        "peak_acceleration": acceleration,
                        "on_edge": self.overturned(series)[:, 0],
                    }
                )
            )
        return pd.concat(tables, ignore_index=True)


def overturning_spectrum(
    tan_alpha: float,
    motion: GroundMotion,
    *,
    semidiagonals: ArrayLike,
    intensities: ArrayLike,
    model: str = "recess",
    rtol: float = RTOL,
    seating: float = reduced.SEATING,
    gravity: float = 9.81,
    refinements: int = REFINEMENTS,
    workers: int | None = None,
    progress: ProgressCallback | None = None,
) -> OverturningSpectrum:
    """Run every size at every intensity, in three dimensions and in the planes of both components.

    Parameters
    ----------
    tan_alpha : float
        Slenderness b/h [-].
    motion : GroundMotion
    semidiagonals : array_like, shape (n_R,)
        Sizes R, increasing [m].
    intensities : array_like, shape (n_I,)
        Peak of the horizontal resultant over g tan(alpha), increasing [-].
    model : {"recess", "rolling"}, optional
        The model in three dimensions.
    rtol, seating, gravity
        As in `reduced.simulate`.
    refinements : int, optional
        Halvings of the interval that holds the lowest overturning intensity.
    workers : int, optional
        Number of threads; default: that of the cores. It does not influence the result.
    progress : callable, optional
        Called with the series at work and the fraction of it that is done.

    Returns
    -------
    OverturningSpectrum

    Raises
    ------
    ValueError
        If an axis is not increasing and positive, the motion is still, or an option is out of range.

    Examples
    --------
    >>> from rockwobble.models import el_centro_1940
    >>> spectrum = overturning_spectrum(
    ...     0.1, el_centro_1940(), semidiagonals=[1.0, 20.0], intensities=[0.9, 4.0], refinements=0
    ... )
    >>> spectrum.overturned("3d").tolist()
    [[False, True], [False, False]]
    """
    sizes, levels = _axis("semidiagonals", semidiagonals), _axis("intensities", intensities)
    if model not in SPATIAL_MODELS:
        raise ValueError(f"model must be one of {', '.join(SPATIAL_MODELS)}, got {model!r}")
    if refinements < 0:
        raise ValueError(f"refinements must not be negative, got {refinements!r}")
    unit = intensity_unit(tan_alpha, motion, gravity)
    peaks: dict[str, Array] = {}
    lowest: dict[str, Array] = {}
    for series in SERIES:
        run: Callable[..., Array] = partial(
            _run,
            tan_alpha=tan_alpha,
            motion=motion,
            rtol=rtol,
            seating=seating,
            gravity=gravity,
            **series_options(series, model),
        )
        tell = None if progress is None else partial(progress, series)
        peaks[series] = run(sizes, unit * levels, workers=workers, progress=tell)
        on_grid = lowest_overturning(peaks[series] >= 0.5 * math.pi)
        lowest[series] = refined(
            sizes, unit * levels, on_grid, partial(run, workers=1), refinements=refinements, workers=workers
        )
        lowest[series] /= unit
    width = float(np.diff(levels).max(initial=0.0)) / 2**refinements
    return OverturningSpectrum(
        tan_alpha=tan_alpha,
        motion=motion,
        gravity=gravity,
        model=model,
        seating=seating,
        semidiagonals=sizes,
        intensities=levels,
        peak_tilt=peaks,
        lowest=lowest,
        lowest_width=width,
    )


def _run(
    semidiagonals: Array, scales: Array, *, tan_alpha: float, motion: GroundMotion, **options: Any
) -> Array:
    return reduced.peak_tilts(semidiagonals, tan_alpha, motion, scales, **options)


def series_options(series: str, model: str) -> dict[str, Any]:
    """Return the options of a reduced run that make it one of a series; `model` is that in 3D."""
    if series == SPATIAL:
        return {"model": model}
    return {"model": "planar", "plane": _AZIMUTH[series]}


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


def _axis(name: str, values: ArrayLike) -> Array:
    axis = np.array(values, dtype=np.float64)
    if axis.ndim != 1 or not axis.size or not np.isfinite(axis).all():
        raise ValueError(f"{name} must be a sequence of finite numbers, got {values!r}")
    if axis[0] <= 0.0 or (np.diff(axis) <= 0.0).any():
        raise ValueError(f"{name} must be positive and increasing, got {values!r}")
    axis.flags.writeable = False
    return axis
