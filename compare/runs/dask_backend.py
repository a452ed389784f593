"""Tasks on the workers of a Dask scheduler."""

from __future__ import annotations

import importlib
import logging
import platform
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import FIRST_COMPLETED, CancelledError, Future, wait
from contextlib import contextmanager
from typing import Any, TypeVar

from .task import Events, Finished, Lost, Started

T = TypeVar("T")
R = TypeVar("R")

# seconds to wait for the scheduler: a machine that is there answers in a fraction of one
_PATIENCE = 15.0
# tasks submitted for each that can run, so that no worker waits
_AHEAD = 2


def on_cluster(
    address: str,
    function: Callable[[T], R],
    tasks: Sequence[T],
    tries: int,
    makers: Callable[[], Mapping[str, str]],
) -> Events[R]:
    """Yield start and end of each task; see `run_tasks`."""
    here, waiting, tried = dict(makers()), list(range(len(tasks)))[::-1], [0] * len(tasks)
    running: dict[Future[R], int] = {}
    with _cluster(address) as (executor, threads, losses):
        while waiting or running:
            for _ in range(min(len(waiting), max(1, _AHEAD * sum(threads().values())) - len(running))):
                place = waiting.pop()
                if not tried[place]:
                    yield Started(place)
                tried[place] += 1
                running[executor.submit(_with_the_same_code, function, tasks[place], here, makers)] = place
            for future in wait(running, return_when=FIRST_COMPLETED).done:
                place = running.pop(future)
                try:
                    yield Finished(place, future.result())
                except losses as error:
                    if tried[place] < tries:
                        waiting.append(place)
                    else:
                        yield Finished(place, Lost(_first_line(error)))


def _with_the_same_code(
    function: Callable[[T], R], task: T, expected: Mapping[str, str], makers: Callable[[], Mapping[str, str]]
) -> R:
    """Run a task where this is called; with other code its result would be filed under the wrong one."""
    here = makers()
    for name, value in expected.items():
        if here.get(name) != value:
            raise ValueError(
                f"a worker on {platform.node()} must have what the caller has: {name} is "
                f"{here.get(name)} there and {value} here"
            )
    return function(task)


@contextmanager
def _cluster(address: str) -> Iterator[tuple[Any, Callable[[], Mapping[str, int]], Any]]:
    """Open executor, threads of each worker, and what a future raises whose worker died."""
    try:
        distributed: Any = importlib.import_module("distributed")  # it has no types
    except ImportError:
        raise ValueError("--scheduler needs Dask: pip install 'rockwobble[distributed]'") from None
    # it repeats each failed try of a connection as a warning; one clear line follows
    logging.getLogger("distributed.comm").setLevel(logging.ERROR)
    try:
        client = distributed.Client(address, timeout=_PATIENCE, set_as_default=False)
    except (OSError, ValueError) as error:
        raise ValueError(f"no Dask scheduler answers at {address!r}: {_first_line(error)}") from None
    completed = False
    executor = client.get_executor(pure=False)
    try:
        yield executor, client.nthreads, (distributed.KilledWorker, CancelledError)
        completed = True
    finally:
        executor.shutdown(wait=completed)
        client.close()


def _first_line(error: BaseException) -> str:
    return str(error).partition("\n")[0] or type(error).__name__
