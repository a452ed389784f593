"""Processors that this process may use, and compiled functions in threads on all of them."""

from __future__ import annotations

import itertools
import math
import os
from collections.abc import Callable, Generator, Iterable
from concurrent.futures import ThreadPoolExecutor
from contextlib import closing
from pathlib import Path
from typing import TypeVar

T = TypeVar("T")

_TASKS = 8  # tasks of a grid for each thread, so that the threads finish at about the same time

# quota of a container: microseconds of computing in a period, or "max"
_QUOTA = Path("/sys/fs/cgroup/cpu.max")


def usable_cpus() -> int:
    """Number of processors that this process may use, which a container or a job limits."""
    allowed = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    try:
        quota, period = _QUOTA.read_text().split()
        return max(1, min(allowed, math.ceil(int(quota) / int(period))))
    except (OSError, ValueError):  # no container, or one without a limit
        return allowed


def in_threads(
    function: Callable[..., T], *arguments: Iterable[object], workers: int | None = None
) -> Generator[T, None, None]:
    """Values of a compiled function for each of its arguments, in order; an exception ends all."""
    with ThreadPoolExecutor(usable_cpus() if workers is None else workers) as pool:
        try:
            yield from pool.map(function, *arguments)
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)
            raise


def grid_in_threads(
    fill: Callable[[int, slice], None], shape: tuple[int, ...], workers: int | None = None
) -> Generator[float, None, None]:
    """Fill a grid (rows, columns) in threads, each with some rows of a column; yield the finished share.

    The rows of a task share the preparation of their column, which takes as long as a short run.
    """
    rows, columns = shape
    threads = workers or usable_cpus()
    parts = min(rows, math.ceil(_TASKS * threads / columns))
    edges = [rows * part // parts for part in range(parts + 1)]
    tasks = [(column, slice(*part)) for column in range(columns) for part in itertools.pairwise(edges)]
    with closing(in_threads(fill, *zip(*tasks, strict=True), workers=threads)) as results:
        for done, _ in enumerate(results, start=1):
            yield done / len(tasks)
