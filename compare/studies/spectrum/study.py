"""Overturning spectra: peak tilts over size and intensity, in three dimensions and in two planes."""

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

from ...metrics.tilt import overturned
from .lowest_overturning import STEP, lowest_intensities, lowest_on_grid
from .series import SERIES, SPATIAL, SPATIAL_MODELS, intensity_unit, series_options, uplift_of_series

if TYPE_CHECKING:
    import pandas as pd

Array = NDArray[np.float64]
Progress = Callable[[float], None]
ProgressCallback = Callable[[str, float], None]

# Steps end at each sample of the record, so a tenth of the tolerance of `reduced.peak_tilts` costs only
# 4 % of the time, and the cells that it moves by 2 % of their tilt fall from 2 in 1000 to none.
RTOL = 1e-8
_GRID_SHARE = 0.06  # of the time of a series with 100 intensities, of which a search runs a thousand and more


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
        The model in three dimensions, "recess" or "flat".
    rest_tilt : float
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
        For each of `SERIES` an ndarray, shape (n_R,): the lowest intensity found to overturn [-]; NaN
        where none was found.
    searched_from : mapping
        For each of `SERIES` the intensity at which it uplifts [-], from which `lowest` was searched: up to
        where something overturns, or to the last of the grid. inf where it uplifts at none.
    search_step : float
        Largest step of that search [-]: see `search_lowest`. A window of overturning that is narrower may
        lie below `lowest`.
    """

    tan_alpha: float
    motion: GroundMotion
    gravity: float
    model: str
    rest_tilt: float
    semidiagonals: Array
    intensities: Array
    peak_tilt: Mapping[str, Array]
    lowest: Mapping[str, Array]
    searched_from: Mapping[str, float]
    search_step: float

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
        return overturned(self.peak_tilt[series])

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
        """Return the lowest intensities found to overturn, one row for each size and series.

        Columns: series, semidiagonal [m], intensity [-], peak_acceleration [m/s^2] (of what drives the
        series), on_grid [-], the lowest intensity of the grid that overturns, each NaN where nothing does;
        searched_from and search_step [-].
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
                        "on_grid": lowest_on_grid(self.intensities, self.peak_tilt[series]),
                        "searched_from": self.searched_from[series],
                        "search_step": self.search_step,
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
    rest_tilt: float = reduced.REST_TILT,
    gravity: float = 9.81,
    search_step: float = STEP,
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
    model : {"recess", "flat"}, optional
        The model in three dimensions.
    rtol, rest_tilt, gravity
        As in `reduced.simulate`.
    search_step : float, optional
        Largest step of the search for the lowest overturning intensity [-].
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
    ...     0.1, el_centro_1940(), semidiagonals=[1.0, 20.0], intensities=[0.9, 4.0]
    ... )
    >>> spectrum.overturned("3d").tolist()
    [[False, True], [False, False]]
    """
    sizes, levels = _axis("semidiagonals", semidiagonals), _axis("intensities", intensities)
    if model not in SPATIAL_MODELS:
        raise ValueError(f"model must be one of {', '.join(SPATIAL_MODELS)}, got {model!r}")
    if not 0.0 < search_step < math.inf:
        raise ValueError(f"search_step must be positive and finite, got {search_step!r}")
    unit = intensity_unit(tan_alpha, motion, gravity)
    peaks: dict[str, Array] = {}
    lowest: dict[str, Array] = {}
    searched_from: dict[str, float] = {}
    for series in SERIES:
        run: Callable[..., Array] = partial(
            _run,
            tan_alpha=tan_alpha,
            motion=motion,
            rtol=rtol,
            rest_tilt=rest_tilt,
            gravity=gravity,
            **series_options(series, model),
        )
        grid_done, search_done = _parts(series, progress)
        peaks[series] = run(sizes, unit * levels, workers=workers, progress=grid_done)
        uplift = uplift_of_series(series, motion, tan_alpha, gravity)
        searched_from[series] = uplift / unit
        lowest[series] = lowest_intensities(
            sizes,
            unit * levels,
            peaks[series],
            partial(run, workers=1),
            start=uplift,
            step=unit * search_step,
            alpha=math.atan(tan_alpha),
            workers=workers,
            progress=search_done,
        )
        lowest[series] /= unit
    return OverturningSpectrum(
        tan_alpha=tan_alpha,
        motion=motion,
        gravity=gravity,
        model=model,
        rest_tilt=rest_tilt,
        semidiagonals=sizes,
        intensities=levels,
        peak_tilt=peaks,
        lowest=lowest,
        searched_from=searched_from,
        search_step=search_step,
    )


def _run(
    semidiagonals: Array, scales: Array, *, tan_alpha: float, motion: GroundMotion, **options: Any
) -> Array:
    return reduced.peak_tilts(semidiagonals, tan_alpha, motion, scales, **options)


def _parts(series: str, progress: ProgressCallback | None) -> tuple[Progress | None, Progress | None]:
    """Return what tells of the grid, and of the search after it, as parts of one series."""
    if progress is None:
        return None, None
    return (
        lambda done: progress(series, _GRID_SHARE * done),
        lambda done: progress(series, _GRID_SHARE + (1.0 - _GRID_SHARE) * done),
    )


def _axis(name: str, values: ArrayLike) -> Array:
    axis = np.array(values, dtype=np.float64)
    if axis.ndim != 1 or not axis.size or not np.isfinite(axis).all():
        raise ValueError(f"{name} must be a sequence of finite numbers, got {values!r}")
    if axis[0] <= 0.0 or (np.diff(axis) <= 0.0).any():
        raise ValueError(f"{name} must be positive and increasing, got {values!r}")
    axis.flags.writeable = False
    return axis
