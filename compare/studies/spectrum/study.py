"""Overturning spectra: peak tilts over size and intensity, in three dimensions and in two planes."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial

import numpy as np
from numpy.typing import ArrayLike

from rockwobble import reduced
from rockwobble.models import GroundMotion
from rockwobble.models.number_checks import require_increasing, require_one_of, require_positive

from ...runs.progress import ProgressCallback, Stages
from .result import Array, OverturningSpectrum
from .search import PROBES, STEP, probe_below, run_searches, search_lowest
from .series import SERIES, TITLES, intensity_unit, series_options, uplift_of_series

# Steps end at each sample of the record, so a tenth of the tolerance of `reduced.peak_tilts` costs only
# 4 % of the time, and the cells that it moves by 2 % of their tilt fall from 2 in 1000 to none.
RTOL = 1e-8
SUPPORTS = ("recess", "flat")


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
    probes: int = PROBES,
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
    probes : int, optional
        Intensities drawn at random below each lowest, none of which overturns; 0 draws none. See
        `probe_below`.
    workers : int, optional
        Number of threads. It does not influence the result.
    progress : callable, optional
        Told of the start and the end of each series.

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
    ...     0.1,
    ...     el_centro_1940(),
    ...     semidiagonals=[1.0, 20.0],
    ...     intensities=[0.9, 4.0],
    ...     search_step=0.2,
    ...     probes=9,
    ... )
    >>> spectrum.overturned("3d").tolist()
    [[False, True], [False, False]]
    """
    sizes = require_increasing("semidiagonals", semidiagonals)
    levels = require_increasing("intensities", intensities)
    require_one_of("support", support, SUPPORTS)
    require_positive("search_step", search_step)
    if probes < 0:
        raise ValueError(f"probes must be 0 or more, got {probes!r}")
    unit = intensity_unit(tan_alpha, motion, gravity)
    peaks, lowest, below, start = {}, {}, {}, {}
    stages = Stages(progress, [1.0] * len(SERIES))
    for index, name in enumerate(SERIES):
        start[name] = uplift_of_series(name, motion, tan_alpha, gravity) / unit
        run = partial(
            reduced.peak_tilts,
            tan_alpha=tan_alpha,
            motion=motion,
            rtol=rtol,
            rest_tilt=rest_tilt,
            gravity=gravity,
            **series_options(name, support),
        )
        search = partial(
            search_lowest, levels, start=start[name], step=search_step, alpha=math.atan(tan_alpha)
        )
        with stages.stage(TITLES[name]):
            peaks[name] = run(sizes, scales=unit * levels, workers=workers)
            at = partial(_at_level, run, sizes, unit)
            found = run_searches([search(known) for known in peaks[name]], at, workers=workers)
            probing = [
                probe_below(start[name], levels[-1], each, probes=probes, seed=(index, i))
                for i, each in enumerate(found)
            ]
            lowest[name], below[name] = np.array(run_searches(probing, at, workers=workers)).T
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
        probes=probes,
    )


def _at_level(run: Callable[..., Array], sizes: Array, unit: float, group: list[int], level: float) -> Array:
    return run(sizes[group], scales=[unit * level], workers=1)[:, 0]
