"""What runs, scenes and stores cost: times are times, and a ratio is taken between neighbours in time."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from benchmarks.run_overhead import run_overheads
from benchmarks.sweep_overhead import IN_MEMORY, KERNEL, STORED, Cost, measure, overhead_grid, ratios


def test_overhead_is_a_ratio_of_the_same_steps() -> None:
    table = run_overheads(rounds=1, seconds=0.05)
    assert list(table["support"]) == ["recess", "recess", "flat", "flat"]
    assert (table["steps"] == 500).all()
    np.testing.assert_allclose(table["ratio"], table["run"] / table["bare"])
    # a run does all that the bare steps do
    assert (table["ratio"] > 1.0).all()


def test_overhead_is_measured_in_turns_and_its_ratios_inside_each_round(tmp_path: Path) -> None:
    lines: list[str] = []
    rows = measure(2, 100, workers=1, folder=tmp_path, say=lines.append)
    assert [set(row) for row in rows] == [{STORED, IN_MEMORY, KERNEL}] * 2
    assert all(cost.wall > 0.0 and cost.cores > 0.0 for row in rows for cost in row.values())
    assert len(lines) == 2
    assert list(tmp_path.iterdir()) == []
    assert overhead_grid(10_000).rows == 10_000


def test_a_disturbed_round_does_not_move_the_ratio() -> None:
    quiet = {STORED: Cost(1.02, 2.02), IN_MEMORY: Cost(1.0, 2.0)}
    disturbed = {STORED: Cost(9.0, 2.02), IN_MEMORY: Cost(1.0, 2.0)}
    found = ratios([quiet, disturbed, quiet], STORED, IN_MEMORY)
    assert (found.wall, found.cores) == pytest.approx((1.02, 1.01), abs=1e-12)
