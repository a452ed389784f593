"""Sweeps: more runs than fit into one sitting, in chunks that are kept as they are finished."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from contextlib import nullcontext
from itertools import chain
from pathlib import Path
from typing import TYPE_CHECKING, Protocol

from rockwobble.models import Case, Run, Suite

from ...runs.cache import open_cache
from ...runs.progress import ProgressCallback
from ...runs.scheduler import run_tasks
from ...runs.task import Lost
from ...storage.fingerprint import fingerprint
from ...storage.manifest import made_now, write_results
from ...storage.parquet_file import pack, read
from .cases import CaseSweep
from .grid import Grid

if TYPE_CHECKING:
    import pandas as pd

KIND = "sweep"
# a chunk whose process died is tried this often: the process may have been ended from outside
_TRIES = 3
_RECESS = Run(None, "recess")


class Chunk(Protocol):
    """Some of the runs of a sweep."""

    @property
    def rows(self) -> int:
        """Number of runs."""
        ...

    @property
    def name(self) -> str:
        """What it is, for whoever waits."""
        ...

    @property
    def makers(self) -> dict[str, str]:
        """Versions and code on which the results depend."""
        ...

    def key(self) -> str:
        """Return the hash of all that the results depend on."""
        ...

    def run(self) -> pd.DataFrame:
        """Return one row for each run."""
        ...


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
    progress: ProgressCallback | None = None,
    command: str = "",
) -> pd.DataFrame:
    """Run every combination, and return the tidy table of what became of each.

    The runs are cut into chunks. With `out` each chunk is kept there as soon as it is finished, named by
    a hash of its inputs, the versions and the code; a second call, after whatever ended the first, repeats
    none that is there. The table has the same bits whatever the number of workers, the chunks, and
    where they ran.

    Parameters
    ----------
    plan : Grid, CaseSweep, Suite or iterable of Case
        A grid of peak tilts; cases with runs; a suite stands for its cases with its runs, cases alone are run
        with the recess model.
    out : str or Path, optional
        Folder of the sweep: sweep.parquet, the chunks in finished/sweep, and a manifest. One that holds
        another sweep keeps its chunks until this one is complete.
    scheduler : str, optional
        Address of a Dask scheduler, such as "tcp://10.0.0.1:8786"; its workers must have the same
        versions. Default: processes on this machine.
    workers : int, optional
        Number of those processes; 1 runs everything in this one.
    chunk_size : int, optional
        Runs in a chunk. Default: about a second of computing. The hash of a chunk depends on it.
    seeds : mapping, optional
        Seeds of whatever random numbers the cases were drawn with, to be kept with the results.
    progress : callable, optional
        Told of the start and the end of each chunk.
    command : str, optional
        That asked for the sweep, for the manifest.

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
    keeping = (
        nullcontext() if out is None else open_cache(out, KIND, name=_key, pack=_packed, unpack=_unpacked)
    )
    with keeping as cache:
        results = run_tasks(
            run_chunk,
            chunks,
            workers=workers,
            scheduler=scheduler,
            cost=_rows,
            label=_name,
            progress=progress,
            cache=cache,
            tries=_TRIES,
            makers=_Makers(chunks),
        )
        table = _table(results)
    if out is not None:
        motions = {"motions": whole.motion_frame()} if isinstance(whole, Grid) else {}
        manifest = made_now(
            KIND,
            inputs=fingerprint([chunk.key() for chunk in chunks]),
            command=command,
            seeds=seeds,
            headline={
                "runs": len(table),
                **{str(k): int(v) for k, v in table["outcome"].value_counts().items()},
            },
            about=whole.describe(),
        )
        write_results(out, manifest, {"sweep": table} | motions)
    return table


def run_chunk(chunk: Chunk) -> pd.DataFrame:
    """Run a chunk where this is called."""
    return chunk.run()


class _Makers:
    """Versions and code that any of the chunks depends on, as they are where it is called."""

    def __init__(self, chunks: Sequence[Chunk]) -> None:
        # one of each: those of a method are alike
        self._chunks = list({tuple(chunk.makers): chunk for chunk in chunks}.values())

    def __call__(self) -> dict[str, str]:
        return dict(chain.from_iterable(chunk.makers.items() for chunk in self._chunks))


def _plan(plan: Grid | CaseSweep | Suite | Iterable[Case]) -> Grid | CaseSweep:
    if isinstance(plan, Grid | CaseSweep):
        return plan
    if isinstance(plan, Suite):
        return CaseSweep(plan.cases, plan.runs or (_RECESS,))
    return CaseSweep(plan, (_RECESS,))


def _key(chunk: Chunk) -> str:
    return chunk.key()


def _name(chunk: Chunk) -> str:
    return chunk.name


def _rows(chunk: Chunk) -> float:
    return float(chunk.rows)


def _packed(chunk: Chunk, table: pd.DataFrame) -> bytes:
    return pack(table, {"kind": f"task of {KIND}", "inputs": chunk.key(), "versions": chunk.makers})


def _unpacked(_: Chunk, path: Path) -> pd.DataFrame:
    return read(path)[0]


def _table(results: Sequence[pd.DataFrame | Lost]) -> pd.DataFrame:
    import pandas as pd

    lost = [result for result in results if isinstance(result, Lost)]
    if lost:
        raise SweepIncompleteError(
            f"{len(lost)} of {len(results)} chunks ended their processes {_TRIES} times, all others are "
            f"finished; the last words: {lost[0].why}"
        )
    return pd.concat([result for result in results if not isinstance(result, Lost)], ignore_index=True)
