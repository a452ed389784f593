"""The command `python tests/stress`.

python tests/stress kills 20   kills of a local sweep at random moments
python tests/stress dask       three Dask workers, one killed in the middle
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

TESTS = Path(__file__).resolve().parents[1]


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the trial that is asked for; return 1 if its table differs from that of an undisturbed sweep."""
    from rockwobble import sweep
    from stress.sweep_trial import (
        CHUNK_SIZE,
        DASK_CHUNK_SIZE,
        ROWS_OF_A_SIZE,
        dask_sweep_with_a_death,
        killed_sweep,
        trial_grid,
    )

    parser = argparse.ArgumentParser(
        prog="python tests/stress",
        description="Sweeps whose processes are killed. Example: dask --runs 40000",
    )
    parser.add_argument("what", choices=("kills", "dask"))
    parser.add_argument("kills", nargs="?", type=int, default=20, help="of a local sweep (%(default)s)")
    parser.add_argument("--runs", type=int, help="of the sweep; default: 8,000 with kills, 40,000 with dask")
    parser.add_argument("--seed", type=int, default=1, help="of the moments of the kills (%(default)s)")
    given = parser.parse_args(arguments)
    chunk_size = CHUNK_SIZE if given.what == "kills" else DASK_CHUNK_SIZE
    sizes = max(1, (given.runs or (8_000 if given.what == "kills" else 40_000)) // ROWS_OF_A_SIZE)
    with tempfile.TemporaryDirectory(prefix="rockwobble-") as folder:
        undisturbed = sweep(trial_grid(sizes), chunk_size=chunk_size).table
        if given.what == "dask":
            table, done = dask_sweep_with_a_death(Path(folder), sizes=sizes, chunk_size=chunk_size)
            print(f"one of three Dask workers killed with -9 after {done:,} of {len(table):,} runs")
        else:
            trial = killed_sweep(Path(folder), sizes=sizes, kills=given.kills, seed=given.seed)
            table = trial.table
            chunks = -(-len(table) // chunk_size)
            print(f"{given.kills} kills; of {chunks} chunks finished after each: ", end="")
            print(", ".join(map(str, trial.chunks)))
            print(f"chunks written again: {trial.repeated}")
    same = table.equals(undisturbed)
    print(f"{len(table):,} runs, {'the same table to the last bit' if same else 'A DIFFERENT TABLE'}")
    return 0 if same else 1


if __name__ == "__main__":
    sys.path[0] = str(TESTS)  # the folder of the package in place of that of its modules
    sys.exit(main())
