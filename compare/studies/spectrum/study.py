"""Overturning spectrum: which shaking overturns which size, in three dimensions and by planar analysis."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

from rockwobble.models import GroundMotion
from rockwobble.models.records.units import doubts_of

from ...runs.progress import ProgressCallback
from ...storage.fingerprint import fingerprint
from ...storage.manifest import Number
from ...storage.provenance import reduced_makers
from ...storage.results import Results
from .maps import SPATIAL, TiltMaps, maps_of, tilt_maps
from .tables import tables_of

KIND = "overturning spectrum"


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class OverturningSpectrum(Results, kind=KIND):
    """Peak tilts over size and intensity in three dimensions and in two planes, and what overturns.

    Attributes
    ----------
    spectrum, lowest : DataFrame
        Cells, and the lowest intensities found to overturn: see `TiltMaps.to_frame` and `confirm_lowest`.
    islands : DataFrame
        Gaps in the overturning region, see `safe_islands`.
    contrast : DataFrame
        Planar analysis beside three dimensions by bands of sizes, the columns of `CONTRAST_COLUMNS`.
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
            "share that overturns in 3D and in neither plane": float(every["missed"]),
            "share that overturns in a plane and not in 3D": float(every["overcalled"]),
        }

    def _said(self) -> dict[str, str]:
        maps = self.maps
        sizes, levels = maps.semidiagonals, maps.intensities
        return {
            "record": maps.motion.name or "record",
            "overturned": f"{int(maps.overturned(SPATIAL).sum())} of {len(sizes) * len(levels)} cells",
            "sizes": f"{len(sizes)} from {sizes[0]:g} to {sizes[-1]:g} m",
            "intensities": f"{len(levels)} from {levels[0]:g} to {levels[-1]:g}",
            "tan alpha": f"{maps.tan_alpha:g}",
        }


def spectrum(
    tan_alpha: float,
    motion: GroundMotion,
    *,
    workers: int | None = None,
    progress: ProgressCallback | None = None,
    **options: Any,
) -> OverturningSpectrum:
    """Run every size at every intensity, in three dimensions and in the planes of both components.

    Parameters
    ----------
    tan_alpha : float
        Slenderness b/h [-].
    motion : GroundMotion
    workers, progress, **options
        As in `tilt_maps`: semidiagonals [m], intensities [g tan alpha], support, search_step, probes, ...

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
    return spectrum_of(tilt_maps(tan_alpha, motion, workers=workers, progress=progress, **options))


def spectrum_of(maps: TiltMaps) -> OverturningSpectrum:
    """Return the results of maps that were run: their tables, with cells and lowest intensities verified."""
    facts = maps.facts() | {"doubts": doubts_of([maps.motion])}
    grid = maps.semidiagonals, maps.intensities
    facts["inputs"] = fingerprint([maps.facts(), *grid, maps.motion.acceleration, reduced_makers()])
    return OverturningSpectrum(tables=tables_of(maps), facts=facts)
