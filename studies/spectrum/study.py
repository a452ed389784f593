"""Overturning spectrum: sizes and intensities that overturn, in 3D and by planar analysis."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from rockwobble.compare.runs.progress import ProgressCallback
from rockwobble.compare.storage.manifest import Number
from rockwobble.compare.storage.provenance import reduced_makers, result_fingerprint
from rockwobble.compare.storage.results import Results
from rockwobble.models import Cylinder, GroundMotion
from rockwobble.models.argument_kinds import with_argument_kinds
from rockwobble.models.doubts import doubts_about
from rockwobble.models.finding import Findings
from rockwobble.models.ground_motion import sources_of
from rockwobble.models.plain_json import plain
from rockwobble.models.support import RECESS

from ..plans import PROBES, STEP, SpectrumPlan
from .findings import spectrum_findings
from .maps import KIND, TiltMaps, maps_of, record_frame, safe_gaps, tilt_maps
from .verification import check_cells, confirm_lowest, planar_contrast


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class OverturningSpectrum(Results, kind=KIND, findings_file="spectrum.json"):
    """Peak tilts over size and intensity in 3D and in two planes, and overturning.

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
    >>> spectrum = rw.spectrum(0.1, rw.el_centro_1940(), **coarse)
    >>> spectrum.headline()["share that overturns in 3D"]
    0.25
    """

    @cached_property
    def maps(self) -> TiltMaps:
        """The tables as arrays."""
        return maps_of(self.tables, self.facts)

    def findings(self) -> Findings:
        """Findings: overturning, difference of planar analysis, and the reliability of both."""
        return Findings(spectrum_findings(self.maps, self.tables))

    def headline(self) -> dict[str, Number]:
        """Shares of cells that overturn, and of cells where planar analysis differs."""
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
    friction: float | None = None,
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
    friction : float, optional
        Friction coefficient, by which the mode of motion is said; the runs take it for enough.
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
        If an axis is not increasing and positive, the motion is still, an option is out of range, or friction
        is below b/h on flat ground, where all sizes slide.

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
        friction=friction,
        tendon_prestress=tendon_prestress,
        tendon_stiffness=tendon_stiffness,
        tendon_yield=tendon_yield,
        support=support,
        search_step=search_step,
        probes=probes,
    )
    return spectrum_of(tilt_maps(tan_alpha, motion, plan, workers=workers, progress=progress, resume=resume))


def spectrum_of(maps: TiltMaps) -> OverturningSpectrum:
    """Results from maps: their tables, with cells and lowest intensities verified."""
    motion, facts = maps.motion, maps.facts()
    sizes = [Cylinder(semidiagonal=size, tan_alpha=maps.tan_alpha) for size in maps.semidiagonals.tolist()]
    doubts = doubts_about(motions=[motion], cylinders=sizes, gravities=[maps.plan.gravity])
    grid = maps.semidiagonals, maps.intensities
    inputs = result_fingerprint([facts, *grid, motion.acceleration], reduced_makers())
    facts |= {"doubts": doubts, "record_sources": sources_of([motion]), "inputs": inputs}
    tables = {
        "spectrum": maps.to_frame(),
        "record": record_frame(motion),
        "lowest": confirm_lowest(maps),
        "gaps": safe_gaps(maps),
        "contrast": planar_contrast(maps),
        "checked": check_cells(maps),
    }
    return OverturningSpectrum(tables=tables, facts=plain(facts))
