"""Tasks side by side: in this process, in others, or on the workers of a Dask scheduler."""

from __future__ import annotations

import math
import queue
import threading
from collections import deque
from collections.abc import Callable, Mapping, Sequence
from contextlib import closing
from dataclasses import dataclass
from typing import TypeVar

from rockwobble.models.cpus import usable_cpus

from ..storage.provenance import reduced_makers
from .cache import Cache
from .dask_backend import on_cluster
from .progress import Clock, ProgressCallback
from .task import Events, Finished, Lost, Started
from .worker import Worker, WorkerDiedError

T = TypeVar("T")
R = TypeVar("R")


def run_tasks(
    function: Callable[[T], R],
    tasks: Sequence[T],
    *,
    workers: int | None = None,
    scheduler: str | None = None,
    cost: Callable[[T], float] | None = None,
    label: Callable[[T], str] = str,
    progress: ProgressCallback | None = None,
    cache: Cache[T, R] | None = None,
    tries: int = 1,
    makers: Callable[[], Mapping[str, str]] = reduced_makers,
) -> list[R | Lost]:
    """Run a function on each task, and return the results in the order of the tasks.

    Parameters
    ----------
    function : callable
        Importable by name, and depending on nothing but its task.
    tasks : sequence
        Picklable.
    workers : int, optional
        Processes, of which no more than tasks are started; 1 runs one task after the other in this one.
        Default: one for each processor that this process may use, and this one for a single task.
    scheduler : str, optional
        Address of a Dask scheduler, such as `tcp://10.0.0.1:8786`; then `workers` has no part in it.
    cost : callable, optional
        Rough computing time of a task in any unit, by which the longest begin first; infinite: before all, of
        unknown length. Default: all alike, in their order.
    label : callable, optional
        Name of a task, for whoever waits.
    progress : callable, optional
        Told in this thread of the start and the end of each task that runs.
    cache : Cache, optional
        A task found there does not run again, and one that runs is kept there at its end.
    tries : int, optional
        How often a task begins whose process dies: it may have been ended from outside.
    makers : callable, optional
        Versions and code that results depend on, as they are where it is called: workers of another machine
        must have the same.

    Returns
    -------
    list
        `Lost` for a task whose process died.

    Raises
    ------
    ValueError
        If there is no such scheduler; and what a task raises, whatever it is: the others are given up.

    Examples
    --------
    >>> run_tasks(abs, [-1, 2, -3], workers=1)
    [1, 2, 3]
    """
    results: dict[int, R | Lost] = {}
    damaged: list[str] = []
    if cache is not None:
        cache.expect(len(tasks))
        found = {index: cache.find(task) for index, task in enumerate(tasks)}
        results |= {index: result for index, result in found.items() if result is not None}
        damaged = [str(path) for path in cache.damaged]
    costs = [1.0 if cost is None else cost(task) for task in tasks]
    order = sorted((index for index in range(len(tasks)) if index not in results), key=lambda i: -costs[i])
    waiting = [tasks[index] for index in order]
    known = [costs[i] if math.isfinite(costs[i]) else 0.0 for i in order]
    tell = Clock(progress, known, len(results), damaged)
    # a number that is given holds even for one task: in a process of its own it can be ended in a long call
    count = min(usable_cpus(), len(waiting)) if workers is None else workers
    if scheduler is not None:
        events = on_cluster(scheduler, function, waiting, tries, makers)
    elif count > 1:
        events = _in_processes(function, waiting, min(count, len(waiting)), tries)
    else:
        events = _here(function, waiting)
    with closing(events):
        for event in events:
            index = order[event.place]
            if isinstance(event, Finished):
                results[index] = event.result
                if cache is not None and not isinstance(event.result, Lost):
                    cache.keep(tasks[index], event.result)
            tell("finished" if isinstance(event, Finished) else "started", label(tasks[index]), event.place)
    return [results[index] for index in range(len(tasks))]


def _here(function: Callable[[T], R], tasks: Sequence[T]) -> Events[R]:
    for place, task in enumerate(tasks):
        yield Started(place)
        yield Finished(place, function(task))


@dataclass(frozen=True, slots=True)
class _Raised:
    error: BaseException


def _in_processes(function: Callable[[T], R], tasks: Sequence[T], workers: int, tries: int) -> Events[R]:
    """Give each process, which a thread waits for, one task after the other."""
    waiting = deque(range(len(tasks)))
    told: queue.SimpleQueue[Started | Finished[R | _Raised]] = queue.SimpleQueue()
    pool: list[Worker] = []
    lock, stopped = threading.Lock(), threading.Event()

    def opened() -> Worker:
        with lock:
            if stopped.is_set():
                raise WorkerDiedError("the tasks were given up")
            pool.append(Worker())
            return pool[-1]

    def one(worker: Worker | None, place: int) -> tuple[Worker | None, R | Lost | _Raised]:
        last = Lost("")
        for _ in range(tries):
            try:
                worker = worker or opened()
                return worker, worker.call(function, tasks[place])
            except WorkerDiedError as error:
                worker, last = None, Lost(str(error))
            except BaseException as error:  # what the task raised is for the caller
                return worker, _Raised(error)
        return worker, last

    def work() -> None:
        worker: Worker | None = None
        while not stopped.is_set():
            try:
                place = waiting.popleft()
            except IndexError:
                break
            told.put(Started(place))
            worker, result = one(worker, place)
            told.put(Finished(place, result))
        if worker is not None:
            worker.close()

    threads = [threading.Thread(target=work, daemon=True) for _ in range(workers)]
    for thread in threads:
        thread.start()
    left = len(tasks)
    try:
        while left:
            event = told.get()
            if isinstance(event, Started):
                yield event
                continue
            if isinstance(event.result, _Raised):
                raise event.result.error
            left -= 1
            yield Finished(event.place, event.result)
    finally:
        # left early, by an exception or Ctrl-C, no process outlives its tasks
        if left:
            with lock:
                stopped.set()
                for worker in pool:
                    worker.kill()
        for thread in threads:
            thread.join()
