"""Overturning spectra: peak tilts over size and intensity, in three dimensions and in two planes."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from functools import partial

import numpy as np
from numpy.typing import ArrayLike

from rockwobble import reduced
from rockwobble.models import GroundMotion

from .result import Array, OverturningSpectrum
from .search import STEP, Search, probe_below, run_searches, search_lowest
from .series import SERIES, intensity_unit, series_options, uplift_of_series

ProgressCallback = Callable[[str, float], None]

# Steps end at each sample of the record, so a tenth of the tolerance of `reduced.peak_tilts` costs only
# 4 % of the time, and the cells that it moves by 2 % of their tilt fall from 2 in 1000 to none.
RTOL = 1e-8
SUPPORTS = ("recess", "flat")
_GRID = 0.3  # share of the time of a series with 100 intensities, of which a search runs some 200


def overturning_spectrum(
    tan_alpha: float,
    motion: GroundMotion,
    *,
    semidiagonals: ArrayLike,
    intensities: ArrayLike,
    support: str = "recess",
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
    support : {"recess", "flat"}, optional
        Of the model in three dimensions.
    rtol, rest_tilt, gravity
        As in `reduced.simulate`.
    search_step : float, optional
        Finest step of the search for the lowest overturning intensity [-]; see `search_lowest`.
    workers : int, optional
        Number of threads. It does not influence the result.
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
    if support not in SUPPORTS:
        raise ValueError(f"support must be one of {', '.join(SUPPORTS)}, got {support!r}")
    if not 0.0 < search_step < math.inf:
        raise ValueError(f"search_step must be positive and finite, got {search_step!r}")
    unit = intensity_unit(tan_alpha, motion, gravity)
    peaks, lowest, below, start = {}, {}, {}, {}
    for index, name in enumerate(SERIES):
        start[name] = uplift_of_series(name, motion, tan_alpha, gravity) / unit
        peaks[name], lowest[name], below[name] = _series(
            partial(
                reduced.peak_tilts,
                tan_alpha=tan_alpha,
                motion=motion.scaled(unit),
                rtol=rtol,
                rest_tilt=rest_tilt,
                gravity=gravity,
                **series_options(name, support),
            ),
            sizes,
            levels,
            partial(search_lowest, levels, start=start[name], step=search_step, alpha=math.atan(tan_alpha)),
            partial(probe_below, start[name], float(levels[-1])),
            index,
            workers,
            partial(progress, name) if progress is not None else _silent,
        )
    return OverturningSpectrum(
        tan_alpha=tan_alpha,
        motion=motion,
        gravity=gravity,
        support=support,
        rest_tilt=rest_tilt,
        semidiagonals=sizes,
        intensities=levels,
        peak_tilt=peaks,
        lowest=lowest,
        below=below,
        searched_from=start,
        search_step=search_step,
    )


def _series(
    run: Callable[..., Array],
    sizes: Array,
    levels: Array,
    search: Callable[[Array], Search[float]],
    probe: Callable[[float, Sequence[int]], Search[tuple[float, int]]],
    seed: int,
    workers: int | None,
    tell: Callable[[float], None],
) -> tuple[Array, Array, Array]:
    """Return the peak tilts on the grid, the lowest that overturns each size, and how many probes did."""

    def at(group: list[int], level: float) -> Array:
        return run(sizes[group], scales=[level], workers=1)[:, 0]

    def searched(times: float) -> None:
        tell(1.0 - (1.0 - _GRID) * 0.5**times)  # each time there is less to run

    peaks = run(sizes, scales=levels, workers=workers, progress=lambda done: tell(_GRID * done))
    found = run_searches([search(known) for known in peaks], at, workers=workers, progress=searched)
    probes = [probe(lowest, (seed, i)) for i, lowest in enumerate(found)]
    probed = np.array(run_searches(probes, at, workers=workers))
    tell(1.0)
    return peaks, np.fmin(found, probed[:, 0]), probed[:, 1]


def _silent(fraction: float) -> None:
    """Tell nobody."""


def _axis(name: str, values: ArrayLike) -> Array:
    axis = np.array(values, dtype=np.float64)
    if axis.ndim != 1 or not axis.size or not np.isfinite(axis).all():
        raise ValueError(f"{name} must be a sequence of finite numbers, got {values!r}")
    if axis[0] <= 0.0 or (np.diff(axis) <= 0.0).any():
        raise ValueError(f"{name} must be positive and increasing, got {values!r}")
    axis.flags.writeable = False
    return axis
