"""Overturning spectra: peak tilts over size and intensity, in three dimensions and in two planes.

The three runs of a cell share one factor on the record: the planar runs take the east-west or the north-south
component of the same shaking and leave the other out, as a planar analysis does.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any, ClassVar

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from rockwobble.compare.metrics.pair import overturned
from rockwobble.compare.runs.plan import options_of
from rockwobble.compare.runs.progress import ProgressCallback
from rockwobble.models import GroundMotion
from rockwobble.models.plain_json import Facts

from ..plans import SpectrumPlan
from ..study import Study
from .parts import SERIES, SPATIAL, SpectrumPart, SpectrumRuns, blocks_of_sizes, run_part, runs_of
from .search import lowest_on_grid

Array = NDArray[np.float64]
KIND = "overturning spectrum"


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class TiltMaps(SpectrumRuns):
    """Peak tilts of `SpectrumRuns`, and the lowest intensities that overturn.

    Attributes
    ----------
    peak_tilt : mapping
        For each of `SERIES` an ndarray, shape (n_R, n_I) [rad]: 0 without uplift, pi/2 if overturned,
        NaN if the run failed.
    lowest : mapping
        For each of `SERIES` an ndarray, shape (n_R,): the lowest intensity found to overturn [-]; NaN
        where none was found.
    below : mapping
        For each of `SERIES` an ndarray, shape (n_R,): how many intensities drawn at random below what the
        search had found overturned; then `lowest` is one of them.
    """

    peak_tilt: Mapping[str, Array]
    lowest: Mapping[str, Array]
    below: Mapping[str, Array]

    def component_share(self, series: str) -> float:
        """Peak of the component that drives a series over the peak horizontal resultant [-]."""
        if series == SPATIAL:
            return 1.0
        column = self.motion.acceleration[:, SERIES.index(series) - 1]
        return float(np.abs(column).max()) / self.motion.peak

    def overturned(self, series: str) -> NDArray[np.bool_]:
        """Whether each cell overturns (n_R, n_I); False where the run failed."""
        return overturned(self.peak_tilt[series])

    def failed(self) -> NDArray[np.bool_]:
        """Whether any run of a cell failed (n_R, n_I); such cells are excluded from all shares."""
        tilts = np.stack([self.peak_tilt[series] for series in SERIES])
        return np.asarray(np.isnan(tilts).any(axis=0), dtype=np.bool_)

    def facts(self) -> dict[str, object]:
        """Facts beyond the tables, for a manifest."""
        stated = {name: getattr(self.plan, name) for name in _STATED}
        motion = {"name": self.motion.name, "time_step": self.motion.time_step}
        return {"tan_alpha": self.tan_alpha, "searched_from": self.searched_from, **stated, "motion": motion}

    def to_frame(self) -> pd.DataFrame:
        """One row for each cell and series.

        Columns: series, semidiagonal [m], intensity [-], scale [-], peak_acceleration [m/s^2] (of what
        drives the series), peak_tilt [rad], peak_tilt_over_alpha [-], overturned.
        """
        axes: list[Sequence[Any] | Array] = [SERIES, self.semidiagonals, self.intensities]
        names = ["series", "semidiagonal", "intensity"]
        table: pd.DataFrame = pd.MultiIndex.from_product(axes, names=names).to_frame(index=False)
        tilts = np.concatenate([self.peak_tilt[series].ravel() for series in SERIES])
        scale, share = self.unit * table["intensity"], table["series"].map(self.component_share)
        return table.assign(
            scale=scale,
            peak_acceleration=share * self.motion.peak * scale,
            peak_tilt=tilts,
            peak_tilt_over_alpha=tilts / self.alpha,
            overturned=overturned(tilts),
        )

    def lowest_frame(self) -> pd.DataFrame:
        """The lowest intensities found to overturn, one row for each size and series.

        Columns: series, semidiagonal [m], intensity [-], peak_acceleration [m/s^2] (of what drives the
        series), on_grid [-], the lowest intensity of the grid that overturns, each NaN where nothing does;
        searched_from and search_step [-]; probed, intensities drawn below, none of which overturns, and
        overturned_below, those that did on the way to it.
        """
        plan, start = self.plan, self.searched_from
        tables = [
            pd.DataFrame(
                {
                    "series": series,
                    "semidiagonal": self.semidiagonals,
                    "intensity": self.lowest[series],
                    "peak_acceleration": self.lowest[series]
                    * (plan.gravity * self.tan_alpha * self.component_share(series)),
                    "on_grid": lowest_on_grid(self.intensities, self.peak_tilt[series]),
                    "searched_from": start[series],
                    "search_step": plan.search_step,
                    "probed": plan.probes if start[series] < self.intensities[-1] else 0,
                    "overturned_below": self.below[series].astype(int),
                }
            )
            for series in SERIES
        ]
        return pd.concat(tables, ignore_index=True)


# options of the plan that are no axes
_STATED = [name for name in options_of(SpectrumPlan) if name not in ("semidiagonals", "intensities")]


def record_frame(motion: GroundMotion) -> pd.DataFrame:
    """Samples of a ground motion, one column for each component [m/s^2]."""
    return pd.DataFrame(dict(zip("xyz", motion.acceleration.T, strict=False)))


def maps_of(tables: Mapping[str, pd.DataFrame], facts: Facts) -> TiltMaps:
    """Maps from stored tables, bitwise equal to the originals."""
    cells, lowest = tables["spectrum"], dict(iter(tables["lowest"].groupby("series")))
    sizes, levels = (np.unique(cells[name].to_numpy()) for name in ("semidiagonal", "intensity"))
    tilts = dict(iter(cells.groupby("series")["peak_tilt"]))
    return TiltMaps(
        tan_alpha=facts["tan_alpha"],
        motion=GroundMotion(tables["record"].to_numpy(), **facts["motion"]),
        plan=SpectrumPlan(**{name: facts[name] for name in _STATED if name in facts}),
        semidiagonals=sizes,
        intensities=levels,
        searched_from=facts["searched_from"],
        peak_tilt={name: tilts[name].to_numpy().reshape(len(sizes), -1) for name in SERIES},
        lowest={name: lowest[name]["intensity"].to_numpy() for name in SERIES},
        below={name: lowest[name]["overturned_below"].to_numpy(float) for name in SERIES},
    )


def safe_gaps(spectrum: TiltMaps) -> pd.DataFrame:
    """Safe gaps: intensity ranges above the lowest overturning one in which a cylinder stands.

    Columns: series, semidiagonal [m], lower and upper, the first and last intensity of the grid that the
    cylinder stands [-], closed, whether a higher one overturns it again. A failed run ends a gap, and
    neither opens one nor closes it.
    """
    rows, levels = [], spectrum.intensities
    for series in SERIES:
        fell = spectrum.overturned(series)
        stands = ~fell & ~np.isnan(spectrum.peak_tilt[series])
        for i in np.flatnonzero(np.isfinite(spectrum.lowest[series])):
            first = int(np.searchsorted(levels, spectrum.lowest[series][i]))
            turns = np.diff(stands[i, first:].astype(np.int8), prepend=0, append=0)
            begins, ends = (np.flatnonzero(turns == turn) + first for turn in (1, -1))
            rows += [
                (series, spectrum.semidiagonals[i], levels[begin], levels[end - 1], bool(fell[i, end:].any()))
                for begin, end in zip(begins, ends, strict=True)
            ]
    return pd.DataFrame(rows, columns=["series", "semidiagonal", "lower", "upper", "closed"])


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

    Raises
    ------
    ValueError
        As `runs_of`.

    Examples
    --------
    >>> from rockwobble.models import el_centro_1940
    >>> coarse = SpectrumPlan(semidiagonals=[1, 20], intensities=[0.9, 4], search_step=0.2, probes=9)
    >>> spectrum = tilt_maps(0.1, el_centro_1940(), coarse)
    >>> spectrum.overturned("3d").tolist()
    [[False, True], [False, False]]
    """
    study = MapStudy(runs_of(tan_alpha, motion, plan or SpectrumPlan()), workers)
    return study.run(folder=resume, workers=1, progress=progress)  # one worker, as each part runs in threads


@dataclass(frozen=True, slots=True)
class MapStudy(Study[SpectrumPart, TiltMaps]):
    """Sizes at intensities in each series, some sizes of one series per task; see `SpectrumPart`."""

    kind: ClassVar[str] = KIND
    what: ClassVar[str] = "parts"
    runs: SpectrumRuns
    threads: int | None = None

    def tasks(self) -> list[SpectrumPart]:
        """Tasks, series by series."""
        return [
            SpectrumPart(series=name, places=places, runs=self.runs, threads=self.threads)
            for name in SERIES
            for places in blocks_of_sizes(len(self.runs.semidiagonals))
        ]

    @staticmethod
    def row(task: SpectrumPart) -> pd.DataFrame:
        """Rows of a task, one for each size."""
        return run_part(task)

    def key(self, task: SpectrumPart) -> str:
        """Hash of the inputs of a task."""
        return task.key()

    def results(self, tables: list[pd.DataFrame]) -> TiltMaps:
        """Maps from all tasks."""
        series = [part.series for part in self.tasks()]
        whole = {
            name: pd.concat([table for own, table in zip(series, tables, strict=True) if own == name])
            for name in SERIES
        }
        places = [str(place) for place in range(len(self.runs.intensities))]
        return TiltMaps(
            **{each.name: getattr(self.runs, each.name) for each in fields(SpectrumRuns)},
            peak_tilt={name: table[places].to_numpy() for name, table in whole.items()},
            lowest={name: table["lowest"].to_numpy() for name, table in whole.items()},
            below={name: table["below"].to_numpy() for name, table in whole.items()},
        )
