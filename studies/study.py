"""Base of the studies: tasks, a table for each, and results from all tables."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from contextlib import nullcontext
from pathlib import Path
from typing import Any, ClassVar, Generic, TypeVar, cast

import numpy as np
import pandas as pd

from rockwobble.compare.runs.cache import open_table_cache
from rockwobble.compare.runs.plan import options_of
from rockwobble.compare.runs.progress import FailedTask, IncompleteError, ProgressCallback
from rockwobble.compare.runs.scheduler import ClusterError, run_tasks
from rockwobble.compare.storage.provenance import fingerprint, reduced_makers, result_fingerprint
from rockwobble.compare.storage.results import Results
from rockwobble.models.plain_json import plain

T = TypeVar("T")  # task
R = TypeVar("R")  # results


class Study(Generic[T, R]):
    """Base of the studies: a subclass defines `kind`, `tasks`, `row` and `results`.

    Attributes
    ----------
    kind : str
        Kind of the results.
    yields : type of Results
        Class of results that are one table of all rows, with the options of the study as facts.
    what : str
        The tasks are called so, for people.
    tries : int
        How often a task begins whose process dies: it may have been ended from outside.
    cost : callable or None
        Rough computing time of a task, see `run_tasks`; None: all alike.
    """

    kind: ClassVar[str]
    yields: ClassVar[type[Results]]
    what: ClassVar[str] = "tasks"
    tries: ClassVar[int] = 1
    cost: ClassVar[Callable[..., float] | None] = None

    def tasks(self) -> Sequence[T]:
        """Tasks, picklable, in the order of their tables."""
        raise NotImplementedError

    @staticmethod
    def row(task: Any) -> pd.DataFrame:
        """Row or rows of a task, computed in any process from the task alone."""
        rows: pd.DataFrame = task.run()
        return rows

    def results(self, tables: list[pd.DataFrame]) -> R:
        """Results of the tables of all tasks, in their order."""
        stated = {name: getattr(self, name) for name in options_of(type(self))}
        inputs = fingerprint([self.key(task) for task in self.tasks()])
        return cast(
            "R",
            self.yields(
                tables={self.kind: pd.concat(tables, ignore_index=True)},
                facts=plain({**stated, "inputs": inputs}),
            ),
        )

    def key(self, task: T) -> str:
        """Hash of all inputs of the table of a task, see `result_fingerprint`."""
        return result_fingerprint(task, reduced_makers())

    def name(self, task: T) -> str:
        """Description of a task, for the progress callback."""
        return str(getattr(task, "name", task))

    def lost(self, task: T, why: str) -> pd.DataFrame | None:
        """Table of a task whose process died; None if the study cannot continue."""
        return None

    def here(self) -> Callable[[T], bool]:
        """Whether a task takes less time than starting a process."""
        return lambda task: False

    def makers(self) -> Mapping[str, str]:
        """Versions and code of all methods of the tasks."""
        return reduced_makers()

    def run(
        self,
        *,
        folder: str | Path | None = None,
        workers: int | None = None,
        scheduler: str | None = None,
        progress: ProgressCallback | None = None,
        save: Callable[[R], object] | None = None,
    ) -> R:
        """Run all tasks; return their results.

        Parameters
        ----------
        folder : str or Path, optional
            Keeps each finished task: a second call, after whatever ended the first, repeats none. It is this
            process's until the results are saved; then the tasks of other results of this kind go.
        workers, scheduler, progress : optional
            As in `run_tasks`.
        save : callable, optional
            Writes the results, before finished tasks go.

        Raises
        ------
        IncompleteError
            If the process of a task died and `lost` has no table of it, or the Dask cluster cannot do the
            tasks.
        ValueError
            If the folder or the scheduler is not usable; and what a task raises, whatever it is.
        """
        tasks, cost = list(self.tasks()), type(self).cost
        # the mean time of the tasks so far is that of the rest, if they are not in the order of their sizes
        order = np.random.default_rng(0).permutation(len(tasks)) if cost is None else np.arange(len(tasks))
        with nullcontext() if folder is None else open_table_cache(folder, self.kind, self.key) as cache:
            try:
                tables = run_tasks(
                    self.row,
                    [tasks[place] for place in order],
                    workers=workers,
                    scheduler=scheduler,
                    cost=cost,
                    label=self.name,
                    progress=progress,
                    cache=cache,
                    tries=self.tries,
                    makers=self.makers,
                    here=self.here(),
                )
            except ClusterError as error:
                kept = (
                    "nothing is kept" if cache is None else f"{cache.count} {self.what} are kept in {folder}"
                )
                raise IncompleteError(f"{error}; {kept}") from None
            results = self.results(self._tables(tasks, [tables[place] for place in np.argsort(order)]))
            if save is not None:
                save(results)
        return results

    def _tables(self, tasks: Sequence[T], parts: Sequence[pd.DataFrame | FailedTask]) -> list[pd.DataFrame]:
        tables: list[pd.DataFrame] = []
        died: list[str] = []
        for task, each in zip(tasks, parts, strict=True):
            table = self.lost(task, each.why) if isinstance(each, FailedTask) else each
            if table is not None:
                tables.append(table)
            elif isinstance(each, FailedTask):
                died.append(f"{self.name(task)}: {each.why}")
        if died:
            times = f" {self.tries} times" if self.tries > 1 else ""
            raise IncompleteError(
                f"{len(died)} of {len(tasks)} {self.what} ended their processes{times}, all others are "
                f"finished; the last words of {died[0]}"
            )
        return tables
