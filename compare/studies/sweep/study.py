"""Sweeps: any number of runs, in chunks that are kept as they are finished."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import partial
from pathlib import Path

import numpy as np
import pandas as pd

from rockwobble.models import Case, GroundMotion, Suite
from rockwobble.models.records.units import doubts_of

from ...runs.execution import all_makers
from ...runs.progress import ProgressCallback
from ...runs.tables import run_tables
from ...storage.fingerprint import fingerprint
from .cases import CaseChunk, chunks_of, describe_suite, runnable_suite
from .grid import Grid, GridChunk
from .result import KIND, Sweep

# a chunk whose process died is tried this often: the process may have been ended from outside
_TRIES = 3
Chunk = GridChunk | CaseChunk


def sweep(
    plan: Grid | Suite | Iterable[Case],
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
    plan : Grid, Suite or iterable of Case
        A grid of peak tilts; every case of a suite with each of its runs; cases alone are run with the recess
        model.
    out : str or Path, optional
        Folder of the sweep: sweep.parquet is the table, motions.parquet the ground motions of a grid. The
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

    Every case of a suite with each of its runs:

    >>> from rockwobble.models import Cylinder, InitialState, Run
    >>> pier = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    >>> case = Case(pier, initial=InitialState(0.5 * pier.alpha, rolling_rate=0.5), duration=4.0)
    >>> sweep(Suite([case], [Run(None, "recess"), Run(None, "flat")]), workers=1)
    Sweep(runs 2, stands 2)
    """
    whole = plan if isinstance(plan, Grid) else runnable_suite(plan)
    if chunk_size is not None and chunk_size < 1:
        raise ValueError(f"chunk_size must be at least 1, got {chunk_size!r}")
    chunks: list[Chunk] = (
        [*whole.chunks(chunk_size)] if isinstance(whole, Grid) else [*chunks_of(whole, chunk_size)]
    )
    # in a mixed order the runs that take long are spread evenly, and so the time left can be predicted
    order = np.random.default_rng(0).permutation(len(chunks)).tolist()
    with run_tables(
        run_chunk,
        [chunks[index] for index in order],
        kind=KIND,
        key=lambda chunk: chunk.key(),
        label=lambda chunk: chunk.name,
        folder=out,
        what="chunks",
        tries=_TRIES,
        makers=partial(all_makers, () if isinstance(whole, Grid) else whole.runs),
        workers=workers,
        scheduler=scheduler,
        progress=progress,
    ) as found:
        by_place = dict(zip(order, found, strict=True))
        table: pd.DataFrame = pd.concat([by_place[place] for place in range(len(chunks))], ignore_index=True)
        motions = whole.motions if isinstance(whole, Grid) else [case.motion for case in whole.cases]
        plain = whole.describe() if isinstance(whole, Grid) else describe_suite(whole)
        inputs = fingerprint([chunk.key() for chunk in chunks])
        result = Sweep(
            tables={KIND: table, **_motions(whole)},
            facts={**plain, "doubts": doubts_of(motions), "inputs": inputs},
        )
        if out is not None:
            result.save(out) if save is None else save(result)
    return result


def run_chunk(chunk: Chunk) -> pd.DataFrame:
    """Return the table of a chunk, one row for each run."""
    return pd.DataFrame(chunk.run())


def _motions(plan: Grid | Suite) -> dict[str, pd.DataFrame]:
    """Return the table of the motions of a grid; a component that one does not have is missing, not zero."""
    if not isinstance(plan, Grid):
        return {}
    return {"motions": pd.concat([_samples(motion) for motion in plan.motions], ignore_index=True)}


def _samples(motion: GroundMotion) -> pd.DataFrame:
    samples = motion.acceleration
    columns = {f"acceleration_{axis}": np.full(len(samples), np.nan) for axis in "xyz"}
    columns |= {f"acceleration_{axis}": column for axis, column in zip("xyz", samples.T, strict=False)}
    time = np.arange(len(samples)) * motion.time_step
    return pd.DataFrame({"motion": motion.name or "record", "time": time, **columns})
