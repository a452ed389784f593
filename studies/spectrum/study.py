"""Overturning spectrum: which shaking overturns which size, in three dimensions and by planar analysis.

Its tables: 3D beside planar analysis, and cells run again singly and to a tighter tolerance.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from rockwobble import reduced
from rockwobble.compare.metrics.pair import beyond_yield, overturned
from rockwobble.compare.runs.progress import ProgressCallback
from rockwobble.compare.storage.manifest import Number
from rockwobble.compare.storage.provenance import reduced_makers, result_fingerprint
from rockwobble.compare.storage.results import Results
from rockwobble.models import Case, Cylinder, GroundMotion, WobblingFrame
from rockwobble.models.argument_kinds import with_argument_kinds
from rockwobble.models.doubts import doubts_about
from rockwobble.models.plain_json import plain
from rockwobble.models.records.units import sources_of
from rockwobble.models.support import RECESS

from ..plans import PROBES, STEP, SpectrumPlan, tendon_of
from .maps import KIND, TiltMaps, maps_of, record_frame, safe_gaps, tilt_maps
from .parts import PLANAR_X, PLANAR_Y, SERIES, SPATIAL, series_options

Array = NDArray[np.float64]

# a table of five to ten bands is read at a glance
_BANDS = 6
_ROUND = (1.0, 2.0, 5.0, 10.0)


def planar_contrast(spectrum: TiltMaps) -> pd.DataFrame:
    """Return the differences of 3D and planar runs, one row for each band of sizes and a last one for all.

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
    band = np.searchsorted(edges, sizes, side="right") - 1
    band[sizes == edges[-1]] = len(edges) - 2
    groups = [np.flatnonzero(band == i) for i in range(len(edges) - 1)]
    rows = [_row(spectrum, group) for group in groups if len(group)]
    return pd.DataFrame([*rows, _row(spectrum, np.arange(len(sizes)))])


def edge_difference(spectrum: TiltMaps) -> Array:
    """Return the lowest overturning intensity in 3D less that in the worse plane, (n_R,) [-].

    Negative where the planar analysis is unconservative; infinite where only one of them was found to
    overturn, 0 where none was or the two are no further apart than `search_step`.
    """
    space, x, y = (_or_infinite(spectrum.lowest[name]) for name in (SPATIAL, PLANAR_X, PLANAR_Y))
    plane = np.minimum(x, y)
    both = np.isinf(space) & np.isinf(plane)
    difference = np.where(both, 0.0, space) - np.where(both, 0.0, plane)
    return np.where(np.abs(difference) > spectrum.search_step, difference, 0.0)


def unconservative_from(spectrum: TiltMaps) -> float:
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
    # of an even number the upper middle one: a mean with infinity would hide a finite one
    ordered = np.sort(_or_infinite(lowest))
    return float(ordered[len(ordered) // 2])


def _or_infinite(lowest: Array) -> Array:
    return np.where(np.isnan(lowest), math.inf, lowest)


CHECK_RTOL = 1e-9
# Relative change of the record. A cell that it changes as much as the tolerance of the grid does is a
# matter of chance and says nothing of accuracy.
NUDGE = 1e-9
# a cell overturns for sure where it does so at all three of these factors on its record
CONFIRMING = (1.0, 1.0 - NUDGE, 1.0 + NUDGE)
SAME_PEAK = 0.02  # of the peak tilt, by which two runs of a cell may differ
CELLS = 60  # enough to find one wrong cell in twenty almost surely, in half a second


def check_cells(spectrum: TiltMaps) -> pd.DataFrame:
    """Run randomly chosen cells again as single runs, each beside a copy with a record stronger by a hair.

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
        name = SERIES[which]
        peak = float(spectrum.peak_tilt[name][i, j])
        single, copy = (
            _single(spectrum, name, i, float(spectrum.scales[j]) * factor) for factor in (1.0, 1.0 + NUDGE)
        )
        rows.append(
            {
                "series": name,
                "semidiagonal": float(spectrum.semidiagonals[i]),
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
    """Run each lowest intensity again, to a tighter tolerance and under a record that differs by a hair.

    Returns
    -------
    DataFrame
        That of `lowest_frame` with a column more. confirmed: it overturns again, in all of three runs under
        the record and under those larger and smaller by `NUDGE`. What does not is a matter of chance: many
        passes have multiplied the rounding of the solution to the size of the tilt.
    """
    table = spectrum.lowest_frame()
    unit = float(spectrum.scales[0] / spectrum.intensities[0])
    table["confirmed"] = [
        _overturns_again(spectrum, name, i, unit * float(lowest))
        for name in SERIES
        for i, lowest in enumerate(spectrum.lowest[name])
    ]
    return table


def _overturns_again(spectrum: TiltMaps, series: str, i: int, scale: float) -> bool:
    if math.isnan(scale):
        return False
    return all(overturned(_single(spectrum, series, i, scale * factor)) for factor in CONFIRMING)


def _single(spectrum: TiltMaps, series: str, i: int, scale: float) -> float:
    run = reduced.simulate(
        Case(
            WobblingFrame(
                Cylinder(semidiagonal=float(spectrum.semidiagonals[i]), tan_alpha=spectrum.tan_alpha),
                spectrum.slab_mass_ratio,
            ),
            spectrum.motion.scaled(scale),
            gravity=spectrum.gravity,
            rolling_resistance=spectrum.rolling_resistance,
            tendon=tendon_of(spectrum.tendon_prestress, spectrum.tendon_stiffness, spectrum.tendon_yield),
        ),
        rtol=CHECK_RTOL,
        sample_step=spectrum.motion.duration,
        **series_options(series, spectrum.support),
    )
    return math.nan if beyond_yield(run.peak_tilt, run.case) else run.peak_tilt


def _agree(peak: float, other: float) -> bool:
    return math.isnan(peak) == math.isnan(other) and not abs(peak - other) > SAME_PEAK * other


def tables_of(spectrum: TiltMaps) -> dict[str, pd.DataFrame]:
    """Return the tables of `OverturningSpectrum`; cells and lowest intensities are verified for them."""
    return {
        "spectrum": spectrum.to_frame(),
        "record": record_frame(spectrum.motion),
        "lowest": confirm_lowest(spectrum),
        "gaps": safe_gaps(spectrum),
        "contrast": planar_contrast(spectrum),
        "checked": check_cells(spectrum),
    }


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class OverturningSpectrum(Results, kind=KIND):
    """Peak tilts over size and intensity in three dimensions and in two planes, and what overturns.

    Attributes
    ----------
    spectrum, lowest : DataFrame
        Cells, and the lowest intensities found to overturn: see `TiltMaps.to_frame` and `confirm_lowest`.
    gaps : DataFrame
        Gaps in the overturning region, see `safe_gaps`.
    contrast : DataFrame
        Planar analysis beside three dimensions by bands of sizes, see `planar_contrast`.
    checked : DataFrame
        Cells that were run again, see `check_cells`.
    record : DataFrame
        The ground motion.

    Examples
    --------
    >>> import rockwobble as rw
    >>> coarse = {"semidiagonals": [1, 20], "intensities": [0.9, 4], "search_step": 0.2, "probes": 9}
    >>> found = rw.spectrum(0.1, rw.el_centro_1940(), **coarse)
    >>> found.headline()["share that overturns in 3D"]
    0.25
    """

    @cached_property
    def maps(self) -> TiltMaps:
        """The tables as arrays."""
        return maps_of(self.tables, self.facts)

    def headline(self) -> dict[str, Number]:
        """Return the shares of cells that overturn, and those where planar analysis says something else."""
        every = self.contrast.iloc[-1]
        return {
            "cells": int(every["cells"]),
            "share that overturns in 3D": float(every["overturned"]),
            "share that overturns in 3D and in neither plane": float(every["unconservative"]),
            "share that overturns in a plane and not in 3D": float(every["conservative"]),
        }


@with_argument_kinds
def spectrum(
    tan_alpha: float,
    motion: GroundMotion,
    *,
    semidiagonals: Sequence[float] | None = None,
    intensities: Sequence[float] | None = None,
    slab_mass_ratio: float = 0.0,
    gravity: float = 9.81,
    rolling_resistance: float = 0.0,
    tendon_prestress: float = 0.0,
    tendon_stiffness: float = 0.0,
    tendon_yield: float | None = None,
    support: str = RECESS,
    search_step: float = STEP,
    probes: int = PROBES,
    workers: int | None = None,
    progress: ProgressCallback | None = None,
    resume: str | Path | None = None,
) -> OverturningSpectrum:
    """Run every size at every intensity, in three dimensions and in the planes of both components.

    Parameters
    ----------
    tan_alpha : float
        Slenderness b/h [-].
    motion : GroundMotion
    semidiagonals : sequence of float, optional
        R [m]. Default: 100 from 0.5 to 30.
    intensities : sequence of float, optional
        Peaks of the horizontal resultant [g tan alpha]. Default: 100 from 1 to 12.
    slab_mass_ratio : float, optional
        Mass of a rigid slab over that of its columns.
    gravity : float, optional
        g [m/s^2].
    rolling_resistance : float, optional
        Length of the couple against rolling [m].
    tendon_prestress, tendon_stiffness : float, optional
        Tendon prestress and tendon stiffness of a tendon [weights of one column, and these per base radius].
    tendon_yield : float, optional
        Its yield force [weights of one column]: a run that passes it is no answer, NaN.
    support : {"recess", "flat"}, optional
        Support of the model in three dimensions.
    search_step : float, optional
        Finest step of the search for the lowest intensity that overturns [g tan alpha].
    probes : int, optional
        Random intensities below each lowest, until none of them overturns.
    workers, progress, resume : optional
        As in `tilt_maps`.

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
    >>> coarse = {"semidiagonals": [1, 20], "intensities": [0.9, 4], "search_step": 0.2, "probes": 9}
    >>> spectrum(0.1, el_centro_1940(), **coarse).maps.overturned("3d").tolist()
    [[False, True], [False, False]]
    """
    plan = SpectrumPlan(
        semidiagonals=semidiagonals,
        intensities=intensities,
        slab_mass_ratio=slab_mass_ratio,
        gravity=gravity,
        rolling_resistance=rolling_resistance,
        tendon_prestress=tendon_prestress,
        tendon_stiffness=tendon_stiffness,
        tendon_yield=tendon_yield,
        support=support,
        search_step=search_step,
        probes=probes,
    )
    return spectrum_of(tilt_maps(tan_alpha, motion, plan, workers=workers, progress=progress, resume=resume))


def spectrum_of(maps: TiltMaps) -> OverturningSpectrum:
    """Return the results of maps that were run: their tables, with cells and lowest intensities verified."""
    sizes = [Cylinder(semidiagonal=size, tan_alpha=maps.tan_alpha) for size in maps.semidiagonals.tolist()]
    doubts = doubts_about(motions=[maps.motion], cylinders=sizes, gravities=[maps.gravity])
    facts = maps.facts() | {"doubts": doubts, "record_sources": sources_of([maps.motion])}
    grid = maps.semidiagonals, maps.intensities
    facts["inputs"] = result_fingerprint([maps.facts(), *grid, maps.motion.acceleration], reduced_makers())
    return OverturningSpectrum(tables=tables_of(maps), facts=plain(facts))
