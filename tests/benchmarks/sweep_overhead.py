"""What the store of a sweep costs: the same runs with and without one, in turn.

    python tests/benchmarks sweep_overhead --rounds 9 --runs 10000

Each round runs the same grid as a sweep into a folder, as one into memory, and by `reduced.peak_tilts`
alone, in an order that turns round with every round: what else the machine does falls on all three alike.
The ratios are taken inside each round, and their medians over the rounds.
"""

from __future__ import annotations

import os
import resource
import statistics
import tempfile
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from rockwobble import reduced
from rockwobble.models import el_centro_1940
from rockwobble.studies.grid import Grid
from rockwobble.studies.sweep import sweep

from .console import options_of

STORED, IN_MEMORY, KERNEL = "sweep with a store", "sweep without", "peak_tilts alone"
# largest share of the store in the time of a sweep
ALLOWED = 0.05
_SCALES = 100
_TAN_ALPHA = 0.2


@dataclass(frozen=True, slots=True)
class Cost:
    """Time of one sweep: on the clock, and on the cores in this process and its children [s]."""

    wall: float
    cores: float


def overhead_grid(runs: int) -> Grid:
    """Return a grid of about so many runs, in rows of 100 scales."""
    return Grid(
        semidiagonals=np.linspace(0.5, 30.0, max(1, runs // _SCALES)).tolist(),
        tan_alphas=[_TAN_ALPHA],
        scales=np.linspace(0.5, 6.0, _SCALES).tolist(),
        motions=[el_centro_1940()],
    )


def measure(
    rounds: int,
    runs: int,
    *,
    workers: int | None = None,
    folder: Path | None = None,
    say: Callable[[str], None] | None = None,
) -> list[dict[str, Cost]]:
    """Measure what the runs cost in each of the three ways, once in every round.

    Parameters
    ----------
    rounds, runs : int
    workers : int, optional
        Processes, and threads of `reduced.peak_tilts`. Default: one for each core.
    folder : Path, optional
        Where the stores are made and removed: the disk is part of the cost. Default: that of temporary files.
    say : callable, optional
        Told each round.
    """
    grid = overhead_grid(runs)
    ways: dict[str, Callable[[], object]] = {
        STORED: lambda: _into_a_folder(grid, workers, folder),
        IN_MEMORY: lambda: sweep(grid, workers=workers),
        KERNEL: lambda: reduced.peak_tilts(
            grid.semidiagonals, _TAN_ALPHA, grid.motions[0], grid.scales, workers=workers
        ),
    }
    # compiled code is loaded, and files are in the memory of the system, before anything counts
    small = overhead_grid(_SCALES)
    sweep(small, workers=1)
    rows = []
    for turn in range(rounds):
        names = list(ways) if turn % 2 == 0 else list(ways)[::-1]
        row = {name: _cost(ways[name]) for name in names}
        rows.append(row)
        if say is not None:
            say(_round_line(turn, row))
    return rows


def ratios(rows: list[dict[str, Cost]], name: str, over: str) -> Cost:
    """Return the medians over the rounds of what one way costs over another."""
    return Cost(
        statistics.median(row[name].wall / row[over].wall for row in rows),
        statistics.median(row[name].cores / row[over].cores for row in rows),
    )


def _into_a_folder(grid: Grid, workers: int | None, folder: Path | None) -> None:
    with tempfile.TemporaryDirectory(prefix="rockwobble-", dir=folder) as place:
        sweep(grid, out=place, workers=workers)


def _cost(way: Callable[[], object]) -> Cost:
    used, begun = _cores(), time.perf_counter()
    way()
    return Cost(time.perf_counter() - begun, _cores() - used)


def _cores() -> float:
    """Processor time of this process and of its children that have ended [s]."""
    spent = (resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))
    return sum(usage.ru_utime + usage.ru_stime for usage in spent)


def _round_line(turn: int, row: dict[str, Cost]) -> str:
    times = ", ".join(
        f"{name} {row[name].wall:.2f} s (cores {row[name].cores:.2f} s)" for name in sorted(row)
    )
    ratio = row[STORED].wall / row[IN_MEMORY].wall
    return f"round {turn + 1}: ratio {ratio:.3f}; {times}; load of the machine {os.getloadavg()[0]:.1f}"


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the ratios of each round and their medians; return 1 if the store costs more than it may."""
    parser = options_of("sweep_overhead", "What the store of a sweep costs. Example: --rounds 9 --runs 10000")
    parser.add_argument("--rounds", type=int, default=9, help="times each way is measured (%(default)s)")
    parser.add_argument("--runs", type=int, default=10_000, help="of each sweep (%(default)s)")
    parser.add_argument("--workers", type=int, help="processes; default: one for each core")
    parser.add_argument("--folder", type=Path, help="where the stores are made; default: temporary files")
    given = parser.parse_args(arguments)
    rows = measure(
        given.rounds,
        given.runs,
        workers=given.workers,
        folder=given.folder,
        say=lambda line: print(line, flush=True),
    )
    runs = overhead_grid(given.runs).rows
    for over in (IN_MEMORY, KERNEL):
        ratio = ratios(rows, STORED, over)
        print(
            f"{STORED} over {over}: median ratio {ratio.wall:.3f} of the time, {ratio.cores:.3f} of the time "
            f"on the cores ({len(rows)} rounds of {runs:,} runs)"
        )
    wall = statistics.median(row[STORED].wall for row in rows)
    print(f"median time of a sweep with a store {wall:.1f} s, {runs / wall:,.0f} runs a second")
    return 0 if ratios(rows, STORED, IN_MEMORY).wall <= 1.0 + ALLOWED else 1
