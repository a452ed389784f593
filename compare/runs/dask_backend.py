"""Tasks on the workers of a Dask scheduler."""

from __future__ import annotations

import importlib
import logging
import platform
import re
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import FIRST_COMPLETED, CancelledError, Executor, Future, wait
from contextlib import contextmanager
from typing import TypeVar

from .progress import Events, Finished, Lost, Started

T = TypeVar("T")
R = TypeVar("R")

# seconds to wait for the scheduler: a machine that is there answers in a fraction of one
_PATIENCE = 15.0
_LOOK = 0.5  # between two looks at the scheduler and its workers [s]
# tasks submitted for each that can run, so that no worker waits
_AHEAD = 2


class ClusterError(RuntimeError):
    """The scheduler is gone, or has no workers that can do the work; what is finished stays finished."""


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
        seen = time.monotonic()
        while waiting or running:
            for _ in range(min(len(waiting), max(1, _AHEAD * sum(threads().values())) - len(running))):
                place = waiting.pop()
                if not tried[place]:
                    yield Started(place)
                tried[place] += 1
                running[executor.submit(_with_the_same_code, function, tasks[place], here, makers)] = place
            done = wait(running, timeout=_LOOK, return_when=FIRST_COMPLETED).done
            seen = time.monotonic() if _has_workers(address, threads) else seen
            if time.monotonic() - seen > _PATIENCE:
                raise ClusterError(
                    f"the Dask scheduler at {address} has had no worker for {_PATIENCE:g} s: start one by "
                    f"dask worker {address}"
                )
            for future in done:
                place = running.pop(future)
                try:
                    yield Finished(place, future.result())
                except losses as error:
                    if tried[place] < tries:
                        waiting.append(place)
                    else:
                        yield Finished(place, Lost(_first_line(error)))


def _has_workers(address: str, threads: Callable[[], Mapping[str, int]]) -> bool:
    try:
        return bool(threads())
    except (OSError, ValueError, RuntimeError) as error:  # what a client without a scheduler raises
        raise ClusterError(f"the Dask scheduler at {address} does not answer any more: {error}") from None


def _with_the_same_code(
    function: Callable[[T], R], task: T, expected: Mapping[str, str], makers: Callable[[], Mapping[str, str]]
) -> R:
    """Run a task where this is called; with other code its result would be filed under the wrong one."""
    here = makers()
    for name, value in expected.items():
        if here.get(name) != value:
            raise ClusterError(
                f"a worker on {platform.node()} must have what the caller has: {name} is "
                f"{here.get(name)} there and {value} here"
            )
    return function(task)


Cluster = tuple[Executor, Callable[[], Mapping[str, int]], tuple[type[BaseException], ...]]


@contextmanager
def _cluster(
    address: str,
) -> Iterator[Cluster]:
    """Open executor, threads of each worker, and what a future raises whose worker died."""
    if re.fullmatch(r"\w+://\S+", address) is None:
        raise ValueError(f"a Dask scheduler has an address such as tcp://10.0.0.1:8786, got {address!r}")
    try:
        distributed = importlib.import_module("distributed")
    except ImportError:
        raise ValueError("--scheduler needs Dask: pip install 'dask[distributed]'") from None
    # it repeats each failed try of a connection, and each lost one; one clear line follows
    for name in ("distributed.comm", "distributed.client"):
        logging.getLogger(name).setLevel(logging.CRITICAL)
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
