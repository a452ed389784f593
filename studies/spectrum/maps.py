"""Overturning spectra: peak tilts over size and intensity, in three dimensions and in two planes.

The three runs of a cell share one factor on the record: the planar runs take the east-west or the north-south
component of the same shaking and leave the other out, as a planar analysis does.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import ClassVar

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from rockwobble.compare.metrics.pair import overturned
from rockwobble.compare.runs.choice import require_runnable
from rockwobble.compare.runs.progress import ProgressCallback
from rockwobble.models import Case, Cylinder, GroundMotion, Run, WobblingFrame
from rockwobble.models.number_checks import require_increasing
from rockwobble.models.plain_json import Facts
from rockwobble.models.support import support_named

from ..plans import SpectrumPlan
from ..study import Study
from .parts import (
    AZIMUTH,
    SERIES,
    SPATIAL,
    SpectrumPart,
    blocks_of_sizes,
    run_part,
)
from .search import lowest_on_grid


def uplift_of_series(
    series: str, motion: GroundMotion, tan_alpha: float, gravity: float, *, until: float = math.inf
) -> float:
    """Return the factor on a ground motion at which a series uplifts from rest; see `uplift_factor`."""
    return uplift_factor(motion, tan_alpha, gravity, plane=AZIMUTH.get(series), until=until)


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


def uplift_factor(
    motion: GroundMotion,
    tan_alpha: float,
    gravity: float,
    *,
    plane: float | None = None,
    until: float = math.inf,
) -> float:
    """Return the factor on a ground motion at which a cylinder at rest uplifts [-]; inf if none does.

    Without rolling resistance, which holds it longer.

    Exact: f of equation (25) is convex between samples, and so is largest at one of them.

    Parameters
    ----------
    motion : GroundMotion
    tan_alpha : float
    gravity : float
        [m/s^2]
    plane : float, optional
        Azimuth of the plane of planar motion [rad]. Default: motion in space.
    until : float, optional
        End of the run [s].
    """
    samples = motion.until(until)
    x, y = samples[:, 0], samples[:, 1]
    drive = np.hypot(x, y) if plane is None else np.abs(x * math.cos(plane) + y * math.sin(plane))
    if motion.has_vertical:
        drive = drive - samples[:, 2] * tan_alpha
    largest = float(drive.max())
    return gravity * tan_alpha / largest if largest > 0.0 else math.inf


Array = NDArray[np.float64]
KIND = "overturning spectrum"
_FACTS = (
    "tan_alpha",
    "gravity",
    "support",
    "searched_from",
    "search_step",
    "probes",
    "slab_mass_ratio",
    "rolling_resistance",
    "friction",
    "tendon_prestress",
    "tendon_stiffness",
    "tendon_yield",
)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class TiltMaps:
    """Peak tilts of cylinders of one slenderness under one record, over size and intensity.

    Attributes
    ----------
    tan_alpha : float
        Slenderness b/h [-].
    motion : GroundMotion
        The record at its own scale.
    gravity : float
        [m/s^2]
    support : str
        Support of the model in three dimensions, "recess" or "flat".
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
    below : mapping
        For each of `SERIES` an ndarray, shape (n_R,): how many intensities drawn at random below what the
        search had found overturned; then `lowest` is one of them.
    searched_from : mapping
        For each of `SERIES` the intensity at which it uplifts [-], from which `lowest` was searched: up to
        where something overturns, or to the last of the grid. inf where it uplifts at none.
    search_step : float
        Finest step of that search [-].
    probes : int
        Intensities drawn at random below each of `lowest`, none of which overturns.
    slab_mass_ratio : float
        Mass of a slab over that of the cylinders that carry it [-]; 0 without one.
    rolling_resistance : float
        [m]
    friction : float, optional
        That decides which motion it is [-]; the runs take it for enough.
    tendon_prestress, tendon_stiffness : float
        Tendon prestress and tendon stiffness of a tendon [weights of one column, and these per base radius].
    tendon_yield : float, optional
        Its yield force [weights of one column]: a run that passes it is no answer, NaN.
    """

    tan_alpha: float
    motion: GroundMotion
    gravity: float
    support: str
    semidiagonals: Array
    intensities: Array
    peak_tilt: Mapping[str, Array]
    lowest: Mapping[str, Array]
    below: Mapping[str, Array]
    searched_from: Mapping[str, float]
    search_step: float
    probes: int = 0
    slab_mass_ratio: float = 0.0
    rolling_resistance: float = 0.0
    friction: float | None = None
    tendon_prestress: float = 0.0
    tendon_stiffness: float = 0.0
    tendon_yield: float | None = None

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

    def facts(self) -> dict[str, object]:
        """Return the facts that the tables do not hold, for a manifest."""
        motion = {"name": self.motion.name, "time_step": self.motion.time_step}
        return {name: getattr(self, name) for name in _FACTS} | {"motion": motion}

    def to_frame(self) -> pd.DataFrame:
        """Return one row for each cell and series.

        Columns: series, semidiagonal [m], intensity [-], scale [-], peak_acceleration [m/s^2] (of what
        drives the series), peak_tilt [rad], peak_tilt_over_alpha [-], overturned.
        """
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
        searched_from and search_step [-]; probed, intensities drawn below, none of which overturns, and
        overturned_below, those that did on the way to it.
        """
        tables = []
        for series in SERIES:
            lowest = self.lowest[series]
            searched = self.searched_from[series] < self.intensities[-1]
            tables.append(
                pd.DataFrame(
                    {
                        "series": series,
                        "semidiagonal": self.semidiagonals,
                        "intensity": lowest,
                        "peak_acceleration": lowest
                        * (self.gravity * self.tan_alpha * self.component_share(series)),
                        "on_grid": lowest_on_grid(self.intensities, self.peak_tilt[series]),
                        "searched_from": self.searched_from[series],
                        "search_step": self.search_step,
                        "probed": self.probes if searched else 0,
                        "overturned_below": self.below[series].astype(int),
                    }
                )
            )
        return pd.concat(tables, ignore_index=True)


def record_frame(motion: GroundMotion) -> pd.DataFrame:
    """Return the samples of a ground motion, one column for each component [m/s^2]."""
    return pd.DataFrame(dict(zip("xyz", motion.acceleration.T, strict=False)))


def maps_of(tables: Mapping[str, pd.DataFrame], facts: Facts) -> TiltMaps:
    """Return the maps of stored tables, with the same bits."""
    cells, lowest = tables["spectrum"], tables["lowest"]
    motion = GroundMotion(tables["record"].to_numpy(), **facts["motion"])
    sizes, levels = (np.unique(cells[name].to_numpy()) for name in ("semidiagonal", "intensity"))
    by_series = dict(iter(lowest.groupby("series")))
    return TiltMaps(
        **{name: facts[name] for name in _FACTS if name in facts},
        motion=motion,
        semidiagonals=sizes,
        intensities=levels,
        peak_tilt={
            name: cells.loc[cells["series"] == name, "peak_tilt"].to_numpy().reshape(len(sizes), -1)
            for name in SERIES
        },
        lowest={name: by_series[name]["intensity"].to_numpy() for name in SERIES},
        below={name: by_series[name]["overturned_below"].to_numpy(float) for name in SERIES},
    )


def safe_gaps(spectrum: TiltMaps) -> pd.DataFrame:
    """Return the ranges of intensities above the lowest overturning one in which a cylinder stands.

    Columns: series, semidiagonal [m], lower and upper, the first and last intensity of the grid that the
    cylinder stands [-], closed, whether a higher one overturns it again. A failed run ends a gap, and
    neither opens one nor closes it.
    """
    rows = []
    for series in SERIES:
        tilts, fell = spectrum.peak_tilt[series], spectrum.overturned(series)
        stands = ~fell & ~np.isnan(tilts)
        for i in np.flatnonzero(np.isfinite(spectrum.lowest[series])):
            first = int(np.searchsorted(spectrum.intensities, spectrum.lowest[series][i]))
            row = np.concatenate([[False], stands[i, first:], [False]]).astype(np.int8)
            begins, ends = (np.flatnonzero(np.diff(row) == turn) + first for turn in (1, -1))
            rows += [
                (
                    series,
                    spectrum.semidiagonals[i],
                    spectrum.intensities[begin],
                    spectrum.intensities[end - 1],
                    bool(fell[i, end:].any()),
                )
                for begin, end in zip(begins, ends, strict=True)
            ]
    return pd.DataFrame(rows, columns=["series", "semidiagonal", "lower", "upper", "closed"])


def require_cases(tan_alpha: float, motion: GroundMotion, plan: SpectrumPlan) -> None:
    """Refuse, before anything runs, what is out of range for the smallest of the sizes or for the largest.

    Raises
    ------
    ValueError
        As for a `Case` of it, and where all of them slide and nothing more.
    """
    sizes = SpectrumPlan.SIZES[:2] if plan.semidiagonals is None else plan.semidiagonals
    for size in (sizes[0], sizes[-1]):
        body = WobblingFrame(Cylinder(semidiagonal=float(size), tan_alpha=tan_alpha), plan.slab_mass_ratio)
        case = Case(
            body,
            motion,
            gravity=plan.gravity,
            friction=1.0 if plan.friction is None else plan.friction,
            rolling_resistance=plan.rolling_resistance,
            tendon=plan.tendon,
        )
        bound = case.friction_of_uplift
        if plan.friction is not None and plan.friction < bound and support_named(plan.support).lets_slide:
            raise ValueError(
                f"friction {plan.friction:g} is below b/h = {bound:g}: on flat ground every size slides "
                "alike and none uplifts; a fragility with a gap, or reduced.peak_displacements, says how far"
            )
        require_runnable(case, Run(None, plan.support))


def tilt_maps(
    tan_alpha: float,
    motion: GroundMotion,
    plan: SpectrumPlan | None = None,
    *,
    workers: int | None = None,
    progress: ProgressCallback | None = None,
    resume: str | Path | None = None,
) -> TiltMaps:
    """Run every size at every intensity, in three dimensions and in the planes of both components.

    Parameters
    ----------
    tan_alpha : float
        Slenderness b/h [-].
    motion : GroundMotion
    plan : SpectrumPlan, optional
        Grid, support and search. Default: those of figure 6 of the paper.
    workers : int, optional
        Number of threads. It does not influence the result.
    progress : callable, optional
        Called with a `Progress` at the start and the end of each part: some sizes in one series.
    resume : str or Path, optional
        Folder that keeps each finished part: a second call, after whatever ended the first, repeats none.

    Returns
    -------
    TiltMaps

    Raises
    ------
    ValueError
        If an axis is not increasing and positive, the motion is still, or an option is out of range.

    Examples
    --------
    >>> from rockwobble.models import el_centro_1940
    >>> coarse = SpectrumPlan(semidiagonals=[1, 20], intensities=[0.9, 4], search_step=0.2, probes=9)
    >>> spectrum = tilt_maps(0.1, el_centro_1940(), coarse)
    >>> spectrum.overturned("3d").tolist()
    [[False, True], [False, False]]
    """
    asked = SpectrumPlan() if plan is None else plan
    sizes, levels = (
        np.linspace(*default) if given is None else require_increasing(name, given)
        for name, given, default in (
            ("semidiagonals", asked.semidiagonals, SpectrumPlan.SIZES),
            ("intensities", asked.intensities, SpectrumPlan.INTENSITIES),
        )
    )
    gravity = asked.gravity
    unit = intensity_unit(tan_alpha, motion, gravity)
    require_cases(tan_alpha, motion, asked)
    held = 1.0
    if asked.tendon is not None:
        column = Cylinder(semidiagonal=1.0, tan_alpha=tan_alpha)
        held = asked.tendon.uplift_factor(WobblingFrame(column, asked.slab_mass_ratio))
    start = {name: held * uplift_of_series(name, motion, tan_alpha, gravity) / unit for name in SERIES}
    return MapStudy(
        tan_alpha=tan_alpha,
        motion=motion,
        plan=asked,
        sizes=sizes,
        levels=levels,
        unit=unit,
        start=start,
        threads=workers,
    ).run(folder=resume, workers=1, progress=progress)  # each part runs in threads


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class MapStudy(Study[SpectrumPart, TiltMaps]):
    """Sizes at intensities in each series, some sizes of one series a part; see `SpectrumPart`."""

    kind: ClassVar[str] = KIND
    what: ClassVar[str] = "parts"
    tan_alpha: float
    motion: GroundMotion
    plan: SpectrumPlan
    sizes: Array
    levels: Array
    unit: float
    start: Mapping[str, float]
    threads: int | None = None

    def tasks(self) -> list[SpectrumPart]:
        """Parts, series by series."""
        return [
            SpectrumPart(
                series=name,
                places=places,
                semidiagonals=self.sizes[places.start : places.stop],
                levels=self.levels,
                unit=self.unit,
                start=self.start[name],
                tan_alpha=self.tan_alpha,
                motion=self.motion,
                plan=self.plan,
                threads=self.threads,
            )
            for name in SERIES
            for places in blocks_of_sizes(len(self.sizes))
        ]

    @staticmethod
    def row(task: SpectrumPart) -> pd.DataFrame:
        """Rows of a part, one for each size."""
        return run_part(task)

    def key(self, task: SpectrumPart) -> str:
        """Hash of what a part depends on."""
        return task.key()

    def results(self, tables: list[pd.DataFrame]) -> TiltMaps:
        """Maps of all parts."""
        series = [part.series for part in self.tasks()]
        whole = {
            name: pd.concat([table for own, table in zip(series, tables, strict=True) if own == name])
            for name in SERIES
        }
        places = [str(place) for place in range(len(self.levels))]
        return TiltMaps(
            **{name: getattr(self.plan, name) for name in _FACTS if hasattr(self.plan, name)},
            tan_alpha=self.tan_alpha,
            motion=self.motion,
            semidiagonals=self.sizes,
            intensities=self.levels,
            peak_tilt={name: table[places].to_numpy() for name, table in whole.items()},
            lowest={name: table["lowest"].to_numpy() for name, table in whole.items()},
            below={name: table["below"].to_numpy() for name, table in whole.items()},
            searched_from=self.start,
        )
