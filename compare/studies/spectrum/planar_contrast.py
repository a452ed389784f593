"""Contrast of planar analysis and three dimensions: where one of them overturns and the other stands."""

from __future__ import annotations

import math

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from .result import OverturningSpectrum
from .series import PLANAR_X, PLANAR_Y, SPATIAL

Array = NDArray[np.float64]

# a table of five to ten bands is read at a glance
_BANDS = 6
_ROUND = (1.0, 2.0, 5.0, 10.0)

CONTRAST_COLUMNS: dict[str, str] = {
    "smallest": "smallest size of the band [m]",
    "largest": "largest size of the band [m]",
    "cells": "cells of the band, those with a failed run left out",
    "overturned": "share of cells in which the 3D model overturns",
    "planar_overturned": "share in which at least one planar run overturns",
    "missed": "share in which the 3D model overturns and neither planar run does",
    "overcalled": "share in which at least one planar run overturns and the 3D model does not",
    "larger_tilt": "share in which the 3D model tilts more than both planar runs",
    "lower_edge": "share of sizes whose lowest found to overturn is lower in 3D than in both planes",
    "higher_edge": "share of sizes whose lowest found to overturn is higher in 3D than in a plane",
    "lowest": "median of the lowest overturning intensity found in 3D [g tan alpha], inf: most stand",
    "planar_x_lowest": "the same of the planar east-west runs",
    "planar_y_lowest": "the same of the planar north-south runs",
}


def planar_contrast(spectrum: OverturningSpectrum) -> pd.DataFrame:
    """Return the differences of 3D and planar runs, one row for each band of sizes and a last one for all.

    Parameters
    ----------
    spectrum : OverturningSpectrum

    Returns
    -------
    DataFrame
        The columns of `CONTRAST_COLUMNS`; bands without a size have no row. A size on an edge belongs to the
        band above, the last edge to the last band.
    """
    sizes = spectrum.semidiagonals
    edges = size_bands(sizes)
    band = np.searchsorted(edges, sizes, side="right") - 1
    band[sizes == edges[-1]] = len(edges) - 2
    groups = [np.flatnonzero(band == i) for i in range(len(edges) - 1)]
    rows = [_row(spectrum, group) for group in groups if len(group)]
    return pd.DataFrame([*rows, _row(spectrum, np.arange(len(sizes)))], columns=list(CONTRAST_COLUMNS))


def edge_difference(spectrum: OverturningSpectrum) -> Array:
    """Return the lowest overturning intensity in 3D less that in the worse plane, (n_R,) [-].

    Negative where the planar analysis is unconservative; infinite where only one of them was found to
    overturn, 0 where none was or the two are no further apart than `search_step`.
    """
    space, x, y = (_or_infinite(spectrum.lowest[name]) for name in (SPATIAL, PLANAR_X, PLANAR_Y))
    plane = np.minimum(x, y)
    both = np.isinf(space) & np.isinf(plane)
    difference = np.where(both, 0.0, space) - np.where(both, 0.0, plane)
    return np.where(np.abs(difference) > spectrum.search_step, difference, 0.0)


def unconservative_from(spectrum: OverturningSpectrum) -> float:
    """Return the size [m] from which on 3D has the lower overturning intensity at every size; NaN if none."""
    lower = edge_difference(spectrum) < 0.0
    if not lower[-1]:
        return math.nan
    exceptions = np.flatnonzero(~lower)
    return float(spectrum.semidiagonals[exceptions[-1] + 1 if len(exceptions) else 0])


def size_bands(semidiagonals: Array) -> Array:
    """Return the edges of about six bands of a round width that hold all sizes [m]."""
    smallest, largest = float(semidiagonals[0]), float(semidiagonals[-1])
    rough = (largest - smallest) / _BANDS or largest
    power = 10.0 ** math.floor(math.log10(rough))
    # the nearest round number by ratio
    width = power * min(_ROUND, key=lambda digit: abs(math.log(rough / (digit * power))))
    first, last = math.floor(smallest / width), math.ceil(largest / width * (1.0 - 1e-12))
    return np.arange(first, max(last, first + 1) + 1, dtype=np.float64) * width


def _row(spectrum: OverturningSpectrum, group: NDArray[np.intp]) -> dict[str, object]:
    known = ~spectrum.failed()[group]
    space, x, y = (spectrum.overturned(name)[group][known] for name in (SPATIAL, PLANAR_X, PLANAR_Y))
    tilt, tilt_x, tilt_y = (spectrum.peak_tilt[name][group][known] for name in (SPATIAL, PLANAR_X, PLANAR_Y))
    planar = x | y
    difference = edge_difference(spectrum)[group]
    return {
        "smallest": float(spectrum.semidiagonals[group[0]]),
        "largest": float(spectrum.semidiagonals[group[-1]]),
        "cells": int(known.sum()),
        "overturned": _share(space),
        "planar_overturned": _share(planar),
        "missed": _share(space & ~planar),
        "overcalled": _share(planar & ~space),
        "larger_tilt": _share(tilt > np.maximum(tilt_x, tilt_y)),
        "lower_edge": _share(difference < 0.0),
        "higher_edge": _share(difference > 0.0),
        "lowest": _median(spectrum.lowest[SPATIAL][group]),
        "planar_x_lowest": _median(spectrum.lowest[PLANAR_X][group]),
        "planar_y_lowest": _median(spectrum.lowest[PLANAR_Y][group]),
    }


def _share(which: NDArray[np.bool_]) -> float:
    return float(which.mean()) if which.size else math.nan


def _median(lowest: Array) -> float:
    # of an even number the upper middle one: a mean with infinity would hide a finite one
    ordered = np.sort(_or_infinite(lowest))
    return float(ordered[len(ordered) // 2])


def _or_infinite(lowest: Array) -> Array:
    return np.where(np.isnan(lowest), math.inf, lowest)
