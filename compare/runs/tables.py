"""Tables of tasks: each kept in a folder of results as it is finished, and what became of the lost ones."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager, nullcontext
from pathlib import Path
from typing import TypeVar

import pandas as pd

from ..storage.provenance import reduced_makers
from .cache import open_table_cache
from .dask_backend import ClusterError
from .progress import ProgressCallback
from .scheduler import run_tasks
from .task import IncompleteError, Lost

T = TypeVar("T")


@contextmanager
def run_tables(
    function: Callable[[T], pd.DataFrame],
    tasks: Sequence[T],
    *,
    kind: str,
    key: Callable[[T], str],
    label: Callable[[T], str],
    folder: str | Path | None = None,
    lost: Callable[[T], pd.DataFrame] | None = None,
    what: str = "tasks",
    cost: Callable[[T], float] | None = None,
    tries: int = 1,
    makers: Callable[[], Mapping[str, str]] = reduced_makers,
    workers: int | None = None,
    scheduler: str | None = None,
    progress: ProgressCallback | None = None,
) -> Iterator[list[pd.DataFrame]]:
    """Yield the table of each task, in their order.

    Parameters
    ----------
    function : callable
        Returns the table of a task; importable by name.
    tasks : sequence
    kind : str
        Of the results.
    key : callable
        Returns the hash of all that the table of a task depends on.
    folder : str or Path, optional
        Keeps each finished task: a second call, after whatever ended the first, repeats none. It is this
        process's until the block ends; if the block ends well, the tasks of other results of this kind go.
    lost : callable, optional
        Returns the table of a task whose process died. Default: there is none.
    what : str, optional
        The tasks are called so, for people.
    label, cost, tries, makers, workers, scheduler, progress : optional
        As in `run_tasks`. Whoever takes a scheduler states the `makers` of all that its tasks run.

    Raises
    ------
    IncompleteError
        If the process of a task died and `lost` has no table of it, or the Dask cluster cannot do the tasks.
    ValueError
        If the folder or the scheduler is not usable; and what a task raises, whatever it is.
    """
    with nullcontext() if folder is None else open_table_cache(folder, kind, key) as cache:
        try:
            found = run_tasks(
                function,
                tasks,
                workers=workers,
                scheduler=scheduler,
                cost=cost,
                label=label,
                progress=progress,
                cache=cache,
                tries=tries,
                makers=makers,
            )
        except ClusterError as error:
            kept = "nothing is kept" if cache is None else f"{cache.count} {what} are kept in {folder}"
            raise IncompleteError(f"{error}; {kept}") from None
        if lost is None:
            _require_finished(tasks, found, what, label, tries)
            yield [each for each in found if not isinstance(each, Lost)]
        else:
            pairs = zip(tasks, found, strict=True)
            yield [lost(task) if isinstance(each, Lost) else each for task, each in pairs]


def _require_finished(
    tasks: Sequence[T],
    found: Sequence[pd.DataFrame | Lost],
    what: str,
    label: Callable[[T], str],
    tries: int,
) -> None:
    died = [(task, each.why) for task, each in zip(tasks, found, strict=True) if isinstance(each, Lost)]
    if died:
        first, why = died[0]
        times = f" {tries} times" if tries > 1 else ""
        raise IncompleteError(
            f"{len(died)} of {len(tasks)} {what} ended their processes{times}, all others are finished; "
            f"the last words of {label(first)}: {why}"
        )
