"""Sweeps whose processes are killed: the table must not differ in a single bit."""

from __future__ import annotations

import contextlib
import importlib.util
import json
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from rockwobble import el_centro_1940, sweep
from rockwobble.compare import Progress
from rockwobble.compare.storage.claim import CACHE
from rockwobble.studies import Grid
from rockwobble.studies.sweep import KIND

CHUNK_SIZE = 40  # some tens of milliseconds of work: a kill falls into the middle of several chunks
KILLED = """
import sys
sys.path[:0] = {path!r}
from stress.test_sweep_trial import CHUNK_SIZE, grid, sweep

def tell(event):
    if event.done > event.found:
        print(event.done, flush=True)

sweep(grid(15), out={folder!r}, chunk_size=CHUNK_SIZE, workers=1, progress=tell)
"""


def grid(sizes: int) -> Grid:
    """A grid of 80 runs for each size."""
    return Grid(
        semidiagonals=np.linspace(0.5, 30.0, sizes).tolist(),
        tan_alphas=[0.1, 0.2],
        scales=np.linspace(0.5, 6.0, 40).tolist(),
        motions=[el_centro_1940()],
    )


def chunks(folder: Path) -> dict[str, int]:
    return {path.name: path.stat().st_ino for path in (folder / CACHE / KIND).glob("*.parquet")}


def same(table: pd.DataFrame, sizes: int) -> None:
    pd.testing.assert_frame_equal(table, sweep(grid(sizes), chunk_size=CHUNK_SIZE).table, check_exact=True)


def test_kills_at_random_moments_lose_and_repeat_nothing(tmp_path: Path) -> None:
    random = np.random.default_rng(2)
    code = KILLED.format(path=[str(Path(__file__).parents[1])], folder=str(tmp_path))
    finished: dict[str, int] = {}
    for _ in range(2):
        process = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True)
        assert process.stdout is not None
        process.stdout.readline()  # of the first chunk that this process finished
        time.sleep(random.uniform(0.0, 0.3))
        process.kill()
        process.wait()
        process.stdout.close()
        assert finished.items() <= chunks(tmp_path).items()  # none is written again
        assert len(chunks(tmp_path)) > len(finished)
        finished = chunks(tmp_path)
    same(sweep(grid(15), out=tmp_path, chunk_size=CHUNK_SIZE).table, 15)
    assert finished.items() <= chunks(tmp_path).items()
    assert [path.name for path in (tmp_path / CACHE / KIND).iterdir() if path.suffix != ".parquet"] == []


@contextlib.contextmanager
def dask_cluster(folder: Path, workers: int) -> Iterator[tuple[str, list[subprocess.Popen[bytes]]]]:
    """A Dask scheduler and workers of one thread here: its address and their processes."""
    scheduler_file = folder / "scheduler.json"
    with contextlib.ExitStack() as stack:

        def start(what: str, *arguments: str) -> subprocess.Popen[bytes]:
            command = [sys.executable, "-m", f"distributed.cli.dask_{what}", "--no-dashboard", *arguments]
            process = subprocess.Popen(command, cwd=folder, stderr=subprocess.DEVNULL)
            stack.callback(process.wait)
            stack.callback(process.kill)
            return process

        start("scheduler", "--host", "127.0.0.1", "--port", "0", "--scheduler-file", str(scheduler_file))
        deadline = time.monotonic() + 120.0
        while not scheduler_file.exists() or not scheduler_file.read_text().strip():
            assert time.monotonic() < deadline, "the Dask scheduler did not start"
            time.sleep(0.05)
        address = str(json.loads(scheduler_file.read_text())["address"])
        yield address, [start("worker", address, "--nthreads", "1", "--no-nanny") for _ in range(workers)]


@pytest.mark.skipif(importlib.util.find_spec("distributed") is None, reason="Dask is not installed")
def test_dask_gives_the_same_bits_though_a_worker_is_killed(tmp_path: Path) -> None:
    (tmp_path / "dask").mkdir()
    killed_at: list[int] = []
    with dask_cluster(tmp_path / "dask", 2) as (address, processes):

        def tell(event: Progress) -> None:
            if not killed_at and 3 * event.done >= event.total:
                processes[0].kill()
                killed_at.append(event.done)

        table = sweep(
            grid(8), out=tmp_path / "swept", chunk_size=CHUNK_SIZE, scheduler=address, progress=tell
        ).table
        assert processes[0].wait() == -9
    assert 0 < killed_at[0] < len(table)
    same(table, 8)
