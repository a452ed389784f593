"""Trials of the sweep: its processes are killed, and the table must not differ in a single bit."""

from __future__ import annotations

import contextlib
import json
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from rockwobble.compare.runs.progress import Progress
from rockwobble.compare.storage.claim import CACHE
from rockwobble.models import el_centro_1940
from rockwobble.studies.grid import Grid
from rockwobble.studies.sweep import KIND, sweep

if TYPE_CHECKING:
    import pandas as pd

# some tens of milliseconds of work: most kills fall into the middle of several chunks
CHUNK_SIZE = 40
# of Dask, which takes some milliseconds for each: the killed worker is in the middle of one
DASK_CHUNK_SIZE = 200
_TESTS = Path(__file__).resolve().parents[1]
# slendernesses times scales of the trial's grid
ROWS_OF_A_SIZE = 80
# of the kills, those that come while a process is still starting or cleaning up
_EARLY = 0.25
# how long after its first chunk a process may live at most [s]
_LONGEST_LIFE = 0.3
# for a scheduler or a worker to come up on a busy machine [s]
_PATIENCE = 120.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Kills:
    """A sweep that was killed again and again, and then left to finish.

    Parameters
    ----------
    table : DataFrame
        What the last process returned.
    chunks : tuple of int
        Chunks finished after each kill.
    repeated : int
        Chunks that a later process wrote again.
    """

    table: pd.DataFrame
    chunks: tuple[int, ...]
    repeated: int


def trial_grid(sizes: int) -> Grid:
    """Return a grid of 80 runs for each size, small enough to be swept many times."""
    return Grid(
        semidiagonals=np.linspace(0.5, 30.0, sizes).tolist(),
        tan_alphas=[0.1, 0.2],
        scales=np.linspace(0.5, 6.0, 40).tolist(),
        motions=[el_centro_1940()],
    )


def killed_sweep(folder: Path, *, sizes: int, kills: int, seed: int, workers: int | None = None) -> Kills:
    """Sweep into `folder` in processes that are killed with -9 at random moments, then to the end."""
    random = np.random.default_rng(seed)
    # started where this package is found, so the folder must be given whole
    code = f"from stress.sweep_trial import swept; swept({str(folder.resolve())!r}, {sizes}, {workers})"
    finished: dict[str, int] = {}
    counts: list[int] = []
    repeated = 0
    while len(counts) < kills:
        process = subprocess.Popen(
            [sys.executable, "-c", code], cwd=_TESTS, stdout=subprocess.PIPE, text=True
        )
        assert process.stdout is not None
        if random.random() < _EARLY:
            time.sleep(random.uniform(0.0, 1.0))
        else:
            process.stdout.readline()  # of the first chunk that this process finished
            time.sleep(random.uniform(0.0, _LONGEST_LIFE))
        process.kill()
        process.wait()
        process.stdout.close()
        now = {path.name: path.stat().st_ino for path in (folder / CACHE / KIND).glob("*.parquet")}
        repeated += sum(now.get(name) != inode for name, inode in finished.items())
        finished = now
        counts.append(len(finished))
    table = sweep(trial_grid(sizes), out=folder, chunk_size=CHUNK_SIZE, workers=workers).table
    now = {path.name: path.stat().st_ino for path in (folder / CACHE / KIND).glob("*.parquet")}
    repeated += sum(now.get(name) != inode for name, inode in finished.items())
    return Kills(table=table, chunks=tuple(counts), repeated=repeated)


def swept(folder: str, sizes: int, workers: int | None) -> None:
    """Sweep the grid of a trial and say when the first chunk is finished; the body of a killed process."""

    def tell(event: Progress) -> None:
        if event.done > event.found:
            print(event.done, flush=True)

    sweep(trial_grid(sizes), out=folder, chunk_size=CHUNK_SIZE, workers=workers, progress=tell)


@contextlib.contextmanager
def dask_cluster(workers: int) -> Iterator[tuple[str, list[subprocess.Popen[bytes]]]]:
    """Start a Dask scheduler and workers of one thread here; yield its address and their processes."""
    with tempfile.TemporaryDirectory(prefix="rockwobble-") as folder, contextlib.ExitStack() as stack:
        scheduler_file = Path(folder) / "scheduler.json"

        def start(what: str, *arguments: str) -> subprocess.Popen[bytes]:
            command = [sys.executable, "-m", f"distributed.cli.dask_{what}", "--no-dashboard", *arguments]
            process = subprocess.Popen(command, cwd=folder, stderr=subprocess.DEVNULL)
            stack.callback(process.wait)
            stack.callback(process.kill)
            return process

        start("scheduler", "--host", "127.0.0.1", "--port", "0", "--scheduler-file", str(scheduler_file))
        address = _address(scheduler_file)
        processes = [start("worker", address, "--nthreads", "1", "--no-nanny") for _ in range(workers)]
        yield address, processes


def _address(scheduler_file: Path) -> str:
    deadline = time.monotonic() + _PATIENCE
    while time.monotonic() < deadline:
        with contextlib.suppress(OSError, ValueError):
            return str(json.loads(scheduler_file.read_text())["address"])
        time.sleep(0.05)
    raise RuntimeError("the Dask scheduler did not start")


def dask_sweep_with_a_death(
    folder: Path, *, sizes: int, chunk_size: int = CHUNK_SIZE, workers: int = 3
) -> tuple[pd.DataFrame, int]:
    """Sweep on Dask workers and kill one in the middle; return table and chunks done by then."""
    killed_at: list[int] = []
    with dask_cluster(workers) as (address, processes):

        def tell(event: Progress) -> None:
            if not killed_at and 3 * event.done >= event.total:
                processes[0].kill()
                killed_at.append(event.done)

        table = sweep(
            trial_grid(sizes), out=folder, chunk_size=chunk_size, scheduler=address, progress=tell
        ).table
        status = processes[0].wait()
    if status != -9:
        raise RuntimeError(f"the Dask worker must have been killed, it ended with {status}")
    return table, killed_at[0]
