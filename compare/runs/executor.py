"""Where the chunks of a sweep run: processes of this machine, or the workers of a Dask scheduler."""

from __future__ import annotations

import importlib
import logging
import os
import platform
from collections.abc import Callable, Iterator
from concurrent.futures import CancelledError, Executor, Future
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any, Protocol, TypeVar

from .process_pool import ProcessPool, WorkerDiedError

T = TypeVar("T")

# seconds to wait for the scheduler: a machine that is there answers in a fraction of one
_PATIENCE = 15.0
# calls submitted for each that can run
_AHEAD = 2


class Chunk(Protocol):
    """Some of the runs of a sweep."""

    @property
    def rows(self) -> int: ...  # noqa: D102
    @property
    def makers(self) -> dict[str, str]: ...  # noqa: D102
    def key(self) -> str: ...  # noqa: D102
    def run(self) -> dict[str, Any]: ...  # noqa: D102


@dataclass(frozen=True, slots=True)
class Workers:
    """An executor with what a sweep must know of it.

    Parameters
    ----------
    executor : Executor
    window : callable
        How many calls to have submitted just now: some more than can run, so that no worker waits.
    losses : tuple of exceptions
        What a future raises if the process of its call died: the call may be tried again.
    """

    executor: Executor
    window: Callable[[], int]
    losses: tuple[type[BaseException], ...]


class InThisProcess(Executor):
    """An executor whose calls run when they are submitted."""

    def submit(self, fn: Callable[..., T], /, *args: Any, **kwargs: Any) -> Future[T]:
        """Run the call now."""
        future: Future[T] = Future()
        try:
            future.set_result(fn(*args, **kwargs))
        except Exception as error:
            future.set_exception(error)
        return future


def run_chunk(chunk: Chunk, makers: dict[str, str]) -> dict[str, Any]:
    """Run a chunk where this is called, if the code here is that of the caller.

    Raises
    ------
    ValueError
        If a version differs: the results would be filed under the wrong one.
    """
    here = chunk.makers
    for name in makers:
        if here.get(name) != makers[name]:
            raise ValueError(
                f"a worker on {platform.node()} must have what the caller has: {name} is "
                f"{here.get(name)} there and {makers[name]} here"
            )
    return chunk.run()


@contextmanager
def open_workers(scheduler: str | None, workers: int | None, calls: int) -> Iterator[Workers]:
    """Open the place where `calls` calls run; leaving by an exception gives up those under way.

    Raises
    ------
    ValueError
        If the scheduler does not answer, or Dask is not installed.
    """
    if scheduler is not None:
        with _dask(scheduler) as cluster:
            yield cluster
        return
    count = min(_cores() if workers is None else workers, calls)
    if count <= 1:
        yield Workers(InThisProcess(), lambda: 1, ())
        return
    with ProcessPool(count) as pool:
        yield Workers(pool, lambda: _AHEAD * count, (WorkerDiedError,))


@contextmanager
def _dask(address: str) -> Iterator[Workers]:
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
    try:
        executor = client.get_executor(pure=False)
        threads = client.nthreads
        losses = (distributed.KilledWorker, CancelledError)
        completed = False
        try:
            yield Workers(executor, lambda: _AHEAD * sum(threads().values()), losses)
            completed = True
        finally:
            executor.shutdown(wait=completed)
    finally:
        client.close()


def _first_line(error: BaseException) -> str:
    return str(error).partition("\n")[0] or type(error).__name__


def _cores() -> int:
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
