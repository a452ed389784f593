"""Verification of a spectrum: 3D compared with planar analysis, and cells rerun at a tighter tolerance."""

from __future__ import annotations

import math

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from rockwobble import reduced
from rockwobble.compare.metrics.pair import beyond_yield, overturned

from .maps import TiltMaps
from .parts import PLANAR_X, PLANAR_Y, SERIES, SPATIAL, series_options

Array = NDArray[np.float64]

# a table of five to ten bands is read at a glance
_BANDS = 6
_ROUND = (1.0, 2.0, 5.0, 10.0)


def planar_contrast(spectrum: TiltMaps) -> pd.DataFrame:
    """Differences of 3D and planar runs, one row per band of sizes and one for all.

    Parameters
    ----------
    spectrum : TiltMaps

    Returns
    -------
    DataFrame
        smallest, largest: sizes of the band [m]; cells, those with a failed run left out, and the shares of
        them in which 3D overturns (overturned), a planar run does (planar_overturned), 3D and no planar run
        (unconservative), a planar run and not 3D (conservative), and 3D tilts more than both planar runs
        (larger_tilt); lower_edge and higher_edge, the shares of sizes whose lowest found to overturn is lower
        in 3D than in both planes, or higher than in one; lowest, planar_x_lowest and planar_y_lowest, the
        medians of these lowest intensities [g tan alpha], infinite where most stand.
        Bands without a size have no row. A size on an edge belongs to the band above, the last edge to the
        last band.
    """
    sizes = spectrum.semidiagonals
    edges = size_bands(sizes)
    band = np.minimum(np.searchsorted(edges, sizes, side="right") - 1, len(edges) - 2)
    rows = [_row(spectrum, np.flatnonzero(band == each)) for each in np.unique(band)]
    return pd.DataFrame([*rows, _row(spectrum, np.arange(len(sizes)))])


def edge_difference(spectrum: TiltMaps) -> Array:
    """Lowest overturning intensity in 3D less that in the worse plane, (n_R,) [-].

    Negative where the planar analysis is unconservative; infinite where only one of them was found to
    overturn, 0 where none was or the two are no further apart than `search_step`.
    """
    space, x, y = (_or_infinite(spectrum.lowest[name]) for name in (SPATIAL, PLANAR_X, PLANAR_Y))
    plane = np.minimum(x, y)
    both = np.isinf(space) & np.isinf(plane)
    difference = np.where(both, 0.0, space) - np.where(both, 0.0, plane)
    return np.where(np.abs(difference) > spectrum.plan.search_step, difference, 0.0)


def unconservative_from(spectrum: TiltMaps) -> float:
    """Size [m] from which on 3D has the lower overturning intensity at every size; NaN if none."""
    lower = edge_difference(spectrum) < 0.0
    if not lower[-1]:
        return math.nan
    exceptions = np.flatnonzero(~lower)
    return float(spectrum.semidiagonals[exceptions[-1] + 1 if len(exceptions) else 0])


def size_bands(semidiagonals: Array) -> Array:
    """Edges of about six bands of a round width that hold all sizes [m]."""
    smallest, largest = float(semidiagonals[0]), float(semidiagonals[-1])
    rough = (largest - smallest) / _BANDS or largest
    power = 10.0 ** math.floor(math.log10(rough))
    # the nearest round number by ratio
    width = power * min(_ROUND, key=lambda digit: abs(math.log(rough / (digit * power))))
    first, last = math.floor(smallest / width), math.ceil(largest / width * (1.0 - 1e-12))
    return np.arange(first, max(last, first + 1) + 1, dtype=np.float64) * width


def _row(spectrum: TiltMaps, group: NDArray[np.intp]) -> dict[str, object]:
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
        "unconservative": _share(space & ~planar),
        "conservative": _share(planar & ~space),
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
    # upper middle value: a mean with infinity would hide a finite value
    return float(np.quantile(_or_infinite(lowest), 0.5, method="higher"))


def _or_infinite(lowest: Array) -> Array:
    return np.nan_to_num(lowest, nan=math.inf, posinf=math.inf)


CHECK_RTOL = 1e-9
# Relative change of the record. A cell that it changes as much as the tolerance of the grid does is a
# matter of chance and says nothing of accuracy.
NUDGE = 1e-9
# a cell counts as overturned only if it overturns at all three factors on its record
CONFIRMING = (1.0, 1.0 - NUDGE, 1.0 + NUDGE)
SAME_PEAK = 0.02  # relative difference of peak tilt allowed between two runs of a cell
CELLS = 60  # enough to find one wrong cell in twenty almost surely, in half a second


def check_cells(spectrum: TiltMaps) -> pd.DataFrame:
    """Rerun random cells as single runs, each with a copy under a minimally stronger record.

    Parameters
    ----------
    spectrum : TiltMaps
        `CELLS` cells are drawn from all its series without repetition, or every one where there are fewer.

    Returns
    -------
    DataFrame
        One row for each cell: series, semidiagonal [m], intensity [-], peak_tilt of the grid,
        single_peak_tilt and copy_peak_tilt [rad], agrees (to 2 % of the peak tilt), and sensitive (single
        run and copy do not agree either).
    """
    shape = len(SERIES), len(spectrum.semidiagonals), len(spectrum.intensities)
    cells = math.prod(shape)
    chosen = np.random.default_rng(0).choice(cells, size=min(CELLS, cells), replace=False)
    rows = []
    for which, i, j in zip(*np.unravel_index(np.sort(chosen), shape), strict=True):
        series, size = SERIES[which], float(spectrum.semidiagonals[i])
        peak, scale = float(spectrum.peak_tilt[series][i, j]), float(spectrum.scales[j])
        single, copy = (_single(spectrum, series, size, scale * factor) for factor in (1.0, 1.0 + NUDGE))
        rows.append(
            {
                "series": series,
                "semidiagonal": size,
                "intensity": float(spectrum.intensities[j]),
                "peak_tilt": peak,
                "single_peak_tilt": single,
                "copy_peak_tilt": copy,
                "agrees": _agree(peak, single),
                "sensitive": not _agree(copy, single),
            }
        )
    return pd.DataFrame(rows)


def confirm_lowest(spectrum: TiltMaps) -> pd.DataFrame:
    """Rerun each lowest intensity at a tighter tolerance and under a minimally different record.

    Returns
    -------
    DataFrame
        That of `lowest_frame` with a column more. confirmed: it overturns again, in all of three runs under
        the record and under those larger and smaller by `NUDGE`. What does not is a matter of chance: many
        passes have multiplied the rounding of the solution to the size of the tilt.
    """
    table = spectrum.lowest_frame()
    table["confirmed"] = [
        math.isfinite(lowest)
        and all(
            overturned(_single(spectrum, series, size, spectrum.unit * lowest * factor))
            for factor in CONFIRMING
        )
        for series, size, lowest in table[["series", "semidiagonal", "intensity"]].itertuples(index=False)
    ]
    return table


def _single(spectrum: TiltMaps, series: str, size: float, scale: float) -> float:
    run = reduced.simulate(
        spectrum.case(size, scale),
        rtol=CHECK_RTOL,
        sample_step=spectrum.motion.duration,
        **series_options(series, spectrum.plan.support),
    )
    return math.nan if beyond_yield(run.peak_tilt, run.case) else run.peak_tilt


def _agree(peak: float, other: float) -> bool:
    return math.isnan(peak) == math.isnan(other) and not abs(peak - other) > SAME_PEAK * other
