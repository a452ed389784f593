"""Sweeps: more runs than fit into one sitting, in chunks that are kept as they are finished."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Mapping
from concurrent.futures import FIRST_COMPLETED, Future, wait
from contextlib import nullcontext
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from rockwobble.models import Case, GroundMotion, Run, Suite

from ...runs.executor import Chunk, Workers, open_workers, run_chunk
from ...storage.files import remove_leftovers, sole_writer
from ...storage.fingerprint import fingerprint
from ...storage.provenance import about_results
from .cases import CaseSweep
from .grid import Grid
from .store import CHUNKS, KIND, SweepStore, create_sweep_store

if TYPE_CHECKING:
    import pandas as pd

# a chunk whose process died is tried this often: the process may have been ended from outside
_TRIES = 3
_RECESS = Run(None, "recess")


@dataclass(frozen=True, slots=True, kw_only=True)
class SweepProgress:
    """How far a sweep is.

    Parameters
    ----------
    done, total : int
        Runs finished, those found in the store included, and in all.
    found : int
        Runs found in the store.
    left : float
        Seconds to go if the rest is as fast as what ran so far; NaN before anything has.
    """

    done: int
    total: int
    found: int
    left: float


SweepCallback = Callable[[SweepProgress], None]


class SweepIncompleteError(RuntimeError):
    """Some chunks ended their processes again and again; all others are finished."""


def sweep(
    plan: Grid | CaseSweep | Suite | Iterable[Case],
    *,
    out: str | Path | None = None,
    scheduler: str | None = None,
    workers: int | None = None,
    chunk_size: int | None = None,
    seeds: Mapping[str, int] | None = None,
    progress: SweepCallback | None = None,
) -> pd.DataFrame:
    """Run every combination, and return the tidy table of what became of each.

    The runs are cut into chunks. With `out` each chunk is kept there as soon as it is finished, named by
    a hash of its inputs, the versions and the code; a second call, after whatever ended the first, repeats
    none that is there. The table has the same bits whatever the number of workers, the chunks, and
    where they ran.

    Parameters
    ----------
    plan : Grid, CaseSweep, Suite or iterable of Case
        A grid of peak tilts; cases with methods; a suite stands for its cases with its runs, cases alone
        are run with the recess model.
    out : str or Path, optional
        Folder of the sweep; see `sweep_store`. One that holds another sweep keeps its chunks until
        this one is complete.
    scheduler : str, optional
        Address of a Dask scheduler, such as "tcp://10.0.0.1:8786"; its workers must have the same
        versions. Default: processes on this machine.
    workers : int, optional
        Number of those processes; 1 runs everything in this one. Default: one for each core.
    chunk_size : int, optional
        Runs in a chunk. Default: about a second of computing. The hash of a chunk depends on it.
    seeds : mapping, optional
        Seeds of whatever random numbers the cases were drawn with, to be kept with the results.
    progress : callable, optional
        Called with a `SweepProgress` at the start and after each chunk.

    Returns
    -------
    DataFrame
        One row for each run, in the order of the plan.

    Raises
    ------
    ValueError
        If the plan, the folder or the scheduler is not usable.
    SweepIncompleteError
        If chunks could not be finished because their processes died.

    Examples
    --------
    >>> from rockwobble.models import el_centro_1940
    >>> grid = Grid(semidiagonals=[2.0, 6.0], tan_alphas=[0.2], scales=[1.0, 3.0], motions=[el_centro_1940()])
    >>> sweep(grid, workers=1)[["semidiagonal", "scale", "outcome"]].values.tolist()
    [[2.0, 1.0, 'rocked'], [2.0, 3.0, 'overturned'], [6.0, 1.0, 'rocked'], [6.0, 3.0, 'overturned']]
    """
    whole = _plan(plan)
    if chunk_size is not None and chunk_size < 1:
        raise ValueError(f"chunk_size must be at least 1, got {chunk_size!r}")
    chunks: list[Chunk] = list(whole.chunks(chunk_size))
    if out is None:
        return _frame(_run(chunks, None, scheduler, workers, progress))
    folder = Path(out) / CHUNKS
    with sole_writer(folder):
        remove_leftovers(folder)
        keys = [chunk.key() for chunk in chunks]
        about = {
            **about_results(KIND, fingerprint(keys), seeds=seeds),
            "plan": whole.kind,
            "runs": whole.rows,
            **whole.describe(),
            "chunks": [[key, chunk.rows] for key, chunk in zip(keys, chunks, strict=True)],
        }
        store = create_sweep_store(Path(out), about, _motions(whole))
        _run(chunks, store, scheduler, workers, progress)
        for path in store.others():
            path.unlink()
        return store.read()


def _plan(plan: Grid | CaseSweep | Suite | Iterable[Case]) -> Grid | CaseSweep:
    if isinstance(plan, Grid | CaseSweep):
        return plan
    if isinstance(plan, Suite):
        return CaseSweep(plan.cases, plan.runs or (_RECESS,))
    return CaseSweep(plan, (_RECESS,))


def _motions(plan: Grid | CaseSweep) -> dict[str, GroundMotion]:
    return {motion.name or "record": motion for motion in plan.motions} if isinstance(plan, Grid) else {}


def _run(
    chunks: list[Chunk],
    store: SweepStore | None,
    scheduler: str | None,
    workers: int | None,
    progress: SweepCallback | None,
) -> list[dict[str, Any]]:
    """Run the chunks that the store does not hold; return their columns where there is no store."""
    finished = set() if store is None else set(store.finished())
    keys = [None] * len(chunks) if store is None else store.keys
    # in a mixed order the runs that take long are spread evenly, and so the time left can be predicted
    order = np.random.default_rng(0).permutation(len(chunks)).tolist()
    waiting = [index for index in order if keys[index] not in finished]
    clock = _Clock(chunks, waiting, progress)
    results: list[dict[str, Any]] = [{} for _ in chunks]

    def keep(index: int, columns: dict[str, Any]) -> None:
        if store is None:
            results[index] = columns
        else:
            store.write_chunk(index, columns, chunks[index].makers)
        clock.finished(chunks[index].rows)

    with open_workers(scheduler, workers, len(waiting)) if waiting else nullcontext() as place:
        if place is not None:
            _drive(chunks, waiting, place, keep)
    return results


def _drive(
    chunks: list[Chunk], waiting: list[int], place: Workers, keep: Callable[[int, dict[str, Any]], None]
) -> None:
    waiting = waiting[::-1]
    tries = dict.fromkeys(waiting, 0)
    running: dict[Future[dict[str, Any]], int] = {}
    lost: dict[int, BaseException] = {}
    while waiting or running:
        for _ in range(min(len(waiting), max(1, place.window()) - len(running))):
            index = waiting.pop()
            tries[index] += 1
            chunk = chunks[index]
            running[place.executor.submit(run_chunk, chunk, chunk.makers)] = index
        for future in wait(running, return_when=FIRST_COMPLETED).done:
            index = running.pop(future)
            try:
                columns = future.result()
            except place.losses as error:
                if tries[index] < _TRIES:
                    waiting.append(index)
                else:
                    lost[index] = error
            else:
                keep(index, columns)
    if lost:
        last = next(iter(lost.values()))
        raise SweepIncompleteError(
            f"{len(lost)} of {len(chunks)} chunks ended their processes {_TRIES} times, all others are "
            f"finished; the last words: {last}"
        )


class _Clock:
    """Tells how far the sweep is."""

    def __init__(self, chunks: list[Chunk], waiting: list[int], progress: SweepCallback | None) -> None:
        self._total = sum(chunk.rows for chunk in chunks)
        self._found = self._done = self._total - sum(chunks[index].rows for index in waiting)
        self._progress = progress
        self._begun = time.monotonic()
        self.finished(0)

    def finished(self, rows: int) -> None:
        self._done += rows
        ran = self._done - self._found
        pace = (time.monotonic() - self._begun) / ran if ran else float("nan")
        if self._progress is not None:
            left = pace * (self._total - self._done)
            self._progress(SweepProgress(done=self._done, total=self._total, found=self._found, left=left))


def _frame(results: list[dict[str, Any]]) -> pd.DataFrame:
    import pyarrow as pa

    frame: pd.DataFrame = pa.concat_tables([pa.table(columns) for columns in results]).to_pandas()
    return frame
