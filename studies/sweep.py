"""Sweeps: any number of runs of a grid, in chunks that are kept as they are finished."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from numbers import Integral
from pathlib import Path
from typing import ClassVar

import numpy as np
import pandas as pd

from rockwobble.compare.metrics.statistics import value_if_enough
from rockwobble.compare.runs.progress import ProgressCallback
from rockwobble.compare.storage.manifest import Number
from rockwobble.compare.storage.provenance import fingerprint
from rockwobble.compare.storage.results import Results
from rockwobble.models import GroundMotion
from rockwobble.models.argument_kinds import with_argument_kinds
from rockwobble.models.finding import Finding, Findings, Value
from rockwobble.models.number_checks import require_in_range
from rockwobble.models.plain_json import plain
from rockwobble.models.records.units import sources_of

from .grid import Grid, GridChunk
from .study import Study

KIND = "sweep"
PARTS = ["motion", "model", "tan_alpha"]  # columns whose values tell its parts apart
_OUTCOMES = ("stands", "overturned", "undecided", "failed")


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class Sweep(Results, kind=KIND):
    """Outcome and numbers of each run.

    Attributes
    ----------
    sweep : DataFrame
        One row for each run, in the order of the grid; `table`, too.
    motions : DataFrame
        Samples of its ground motions.

    Its facts are the number of runs and the axes of the grid.
    """

    def __post_init__(self) -> None:
        if "model" not in self.table:
            raise ValueError("a sweep is of a grid, got one of cases: the release that made it draws it")

    @property
    def table(self) -> pd.DataFrame:
        """One row for each run, in the order of the grid."""
        return self.tables[KIND]

    def headline(self) -> dict[str, Number]:
        """Return the number of runs, and of those that ended in each way."""
        outcome = self.table["outcome"]
        return {"runs": len(outcome), **{name: int((outcome == name).sum()) for name in self.outcomes}}

    def findings(self) -> Findings:
        """Return what was run, and how many runs ended in each way."""
        plan = self.facts
        values: dict[str, Value] = {"runs": len(self.table)}
        axes = {"length": "semidiagonals", "ratio": "tan_alphas", "factor": "scales"}
        for name, axis in axes.items():
            values |= {f"count_{name}": len(plan[axis]), name: min(plan[axis])}
            values[f"{name}_end"] = max(plan[axis])
        values |= {"count_motions": len(plan["motions"]), "names": tuple(plan["models"])}
        ended = {f"count_{name}": value for name, value in self.headline().items() if name != "runs"}
        return Findings([Finding(key="sweep.grid", values=values), Finding(key="sweep.ended", values=ended)])

    @property
    def outcomes(self) -> list[str]:
        """The outcomes that there are."""
        entries = set(self.table["outcome"])
        return [name for name in _OUTCOMES if name in entries]

    def summary(self) -> pd.DataFrame:
        """Return one row for each part: how many runs ended how, and their peak tilts.

        Columns: motion, model, tan_alpha, runs, a count for each outcome that there is, no_uplift (how many
        of them stood still throughout), and in alpha median, in which an overturned run is infinite, NaN of
        fewer than six, and largest, of those that do not overturn.
        """
        rows, outcomes = [], self.outcomes
        for key, own in self.table.groupby(PARTS, sort=False):
            fell, peaks = own["outcome"] == "overturned", own["peak_tilt_over_alpha"]
            rows.append(
                {
                    **dict(zip(PARTS, key, strict=True)),
                    "runs": len(own),
                    **{name: int((own["outcome"] == name).sum()) for name in outcomes},
                    "no_uplift": int((peaks == 0.0).sum()),
                    "median": value_if_enough(peaks.mask(fell, math.inf).median(), int(peaks.notna().sum())),
                    "largest": peaks[~fell].max(),
                }
            )
        return pd.DataFrame(rows)


@with_argument_kinds
def sweep(
    plan: Grid,
    *,
    out: str | Path | None = None,
    scheduler: str | None = None,
    workers: int | None = None,
    chunk_size: int | None = None,
    progress: ProgressCallback | None = None,
    save: Callable[[Sweep], object] | None = None,
) -> Sweep:
    """Run every combination, and return the tidy table of what became of each.

    The runs are cut into chunks. With `out` each chunk is kept there as soon as it is finished, named by
    a hash of its inputs, the versions and the code; a second call, after whatever ended the first, repeats
    none that is there. The table has the same bits whatever the number of workers, the chunks, and
    where they ran.

    Parameters
    ----------
    plan : Grid
    out : str or Path, optional
        Folder of the sweep: sweep.parquet is the table, motions.parquet the ground motions. The
        chunks of another sweep stay there until this one is complete.
    scheduler : str, optional
        Address of a Dask scheduler, such as `tcp://10.0.0.1:8786`; its workers must have the same
        versions. Default: processes on this machine.
    workers : int, optional
        Number of those processes; 1 runs everything in this one. Default: one for each processor.
    chunk_size : int, optional
        Runs in a chunk. Default: about a second of computing. The hash of a chunk depends on it.
    progress : callable, optional
        Called with a `Progress` at the start and the end of each chunk.
    save : callable, optional
        Writes the sweep into `out`, perhaps with pages; the chunks there are kept until it has. Default:
        `Sweep.save`.

    Returns
    -------
    Sweep

    Raises
    ------
    ValueError
        If the plan, the folder or the scheduler is not usable.
    IncompleteError
        If chunks could not be finished because their processes died, or the Dask cluster cannot do them.

    Examples
    --------
    >>> from rockwobble.models import el_centro_1940
    >>> grid = Grid(semidiagonals=[2.0, 6.0], tan_alphas=[0.2], scales=[1.0, 3.0], motions=[el_centro_1940()])
    >>> found = sweep(grid, workers=1)
    >>> found
    Sweep(runs 4, stands 2, overturned 2)
    >>> found.table[["semidiagonal", "scale", "outcome"]].values.tolist()
    [[2.0, 1.0, 'stands'], [2.0, 3.0, 'overturned'], [6.0, 1.0, 'stands'], [6.0, 3.0, 'overturned']]
    """
    if chunk_size is not None:
        require_in_range("chunk_size", chunk_size, Integral, least=1)
    return SweepStudy(plan, [*plan.chunks(chunk_size)]).run(
        folder=out,
        workers=workers,
        scheduler=scheduler,
        progress=progress,
        save=save if out is None or save is not None else lambda found: found.save(out),
    )


@dataclass(frozen=True, slots=True)
class SweepStudy(Study[GridChunk, Sweep]):
    """All runs of a grid, in chunks."""

    kind: ClassVar[str] = KIND
    what: ClassVar[str] = "chunks"
    tries: ClassVar[int] = 3
    plan: Grid
    chunks: Sequence[GridChunk]

    def tasks(self) -> Sequence[GridChunk]:
        """Chunks."""
        return self.chunks

    def key(self, task: GridChunk) -> str:
        """Hash of what the table of a chunk depends on."""
        return task.key()

    def results(self, tables: list[pd.DataFrame]) -> Sweep:
        """Sweep of the tables of all chunks."""
        plan = self.plan
        about = {"doubts": plan.doubts(), "record_sources": sources_of(plan.motions)}
        inputs = fingerprint([chunk.key() for chunk in self.chunks])
        samples = [_samples(motion) for motion in plan.motions]
        return Sweep(
            tables={
                KIND: pd.concat(tables, ignore_index=True),
                "motions": pd.concat(samples, ignore_index=True),
            },
            facts=plain({**plan.describe(), **about, "inputs": inputs}),
        )


def _samples(motion: GroundMotion) -> pd.DataFrame:
    """Samples of a motion; a component that it does not have is missing, not zero."""
    samples = motion.acceleration
    columns = {f"acceleration_{axis}": np.full(len(samples), np.nan) for axis in "xyz"}
    columns |= {f"acceleration_{axis}": column for axis, column in zip("xyz", samples.T, strict=False)}
    time = np.arange(len(samples)) * motion.time_step
    return pd.DataFrame({"motion": motion.name or "record", "time": time, **columns})
