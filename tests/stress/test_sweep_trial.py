"""A few kills on small sweeps; `python tests/stress` has many, on larger ones."""

from __future__ import annotations

import importlib.util
from pathlib import Path

import pandas as pd
import pytest

from rockwobble import sweep
from rockwobble.compare.storage.claim import CACHE
from rockwobble.studies.sweep import KIND
from stress.sweep_trial import CHUNK_SIZE, dask_sweep_with_a_death, killed_sweep, trial_grid


def test_kills_at_random_moments_lose_and_repeat_nothing(tmp_path: Path) -> None:
    trial = killed_sweep(tmp_path, sizes=15, kills=2, seed=2, workers=1)
    assert trial.repeated == 0
    assert trial.chunks[-1] > 0
    pd.testing.assert_frame_equal(
        trial.table, sweep(trial_grid(15), chunk_size=CHUNK_SIZE).table, check_exact=True
    )
    assert [path.name for path in (tmp_path / CACHE / KIND).iterdir() if path.suffix != ".parquet"] == []


@pytest.mark.skipif(importlib.util.find_spec("distributed") is None, reason="Dask is not installed")
def test_dask_gives_the_same_bits_though_a_worker_is_killed(tmp_path: Path) -> None:
    table, done = dask_sweep_with_a_death(tmp_path, sizes=8, workers=2)
    assert 0 < done < len(table)
    pd.testing.assert_frame_equal(table, sweep(trial_grid(8), chunk_size=CHUNK_SIZE).table, check_exact=True)
