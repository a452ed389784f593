"""Tasks on the workers of a Dask scheduler."""

from __future__ import annotations

import importlib
import logging
import platform
import re
import time
from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import CancelledError, Future
from contextlib import contextmanager
from functools import partial
from typing import Any, TypeVar

T = TypeVar("T")
R = TypeVar("R")

# submit function, number of calls at a time, and the exception of a call whose process died
Backend = tuple[Callable[..., Future[Any]], Callable[[], int], tuple[type[BaseException], ...]]
# seconds to wait for the scheduler: a machine that is there answers in a fraction of one
_PATIENCE = 15.0
# tasks submitted for each that can run, so that no worker waits
_AHEAD = 2


class ClusterError(RuntimeError):
    """The scheduler is gone, or has no workers that can do the work; what is finished stays finished."""


@contextmanager
def on_cluster(address: str, makers: Callable[[], Mapping[str, str]]) -> Iterator[Backend]:
    """Open a Dask scheduler whose workers have the code and versions of the caller; see `run_tasks`."""
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
        why = str(error).partition("\n")[0]
        raise ValueError(f"no Dask scheduler answers at {address!r}: {why}") from None
    seen = time.monotonic()

    def capacity() -> int:
        nonlocal seen
        try:
            threads: int = sum(client.nthreads().values())
        except (OSError, ValueError, RuntimeError) as error:  # raised by a client without a scheduler
            raise ClusterError(f"the Dask scheduler at {address} does not answer any more: {error}") from None
        seen = time.monotonic() if threads else seen
        if time.monotonic() - seen > _PATIENCE:
            raise ClusterError(
                f"the Dask scheduler at {address} has had no worker for {_PATIENCE:g} s: start one by "
                f"dask worker {address}"
            )
        return max(1, _AHEAD * threads)

    completed = False
    executor = client.get_executor(pure=False)
    try:
        submit = partial(executor.submit, _with_the_same_code, dict(makers()), makers)
        yield submit, capacity, (distributed.KilledWorker, CancelledError)
        completed = True
    finally:
        executor.shutdown(wait=completed)
        client.close()


def _with_the_same_code(
    expected: Mapping[str, str], makers: Callable[[], Mapping[str, str]], function: Callable[[T], R], task: T
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
