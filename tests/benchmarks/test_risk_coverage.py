"""Guide on intervals of annual frequencies matches the trials."""

from __future__ import annotations

import math
import re
from pathlib import Path

import pytest

from benchmarks.risk_coverage import PROBLEMS, coverage

GUIDE = Path(__file__).parents[2] / "docs" / "guide" / "risk.md"
ROW = re.compile(
    r"\| (\d+)(, at each level)? \| ([\d.]+) \| ([\d.]+) \| ([\d.]+) \| (\d+) \| (\d+) \| (\d+) \|"
)
TRIALS = 80


def said() -> dict[tuple[object, ...], tuple[float, ...]]:
    rows = [row.groups() for row in ROW.finditer(GUIDE.read_text(encoding="utf-8"))]
    return {
        (int(row[0]), bool(row[1]), *map(float, row[2:5])): tuple(0.01 * float(each) for each in row[5:])
        for row in rows
    }


def test_guide_lists_every_coverage_problem() -> None:
    assert list(said()) == [(problem[0], problem[1], problem[2], *problem[4:]) for problem in PROBLEMS]


@pytest.mark.slow
@pytest.mark.parametrize("place", [0, 3, 8])
def test_guide_coverage_shares_match_the_trials(place: int) -> None:
    (row,) = coverage(TRIALS, 7, [PROBLEMS[place]])
    for name, share in zip(("frequency", "above", "ratio"), list(said().values())[place], strict=True):
        error = math.sqrt(max(share * (1.0 - share), 0.02) * (1.0 / TRIALS + 1.0 / 400.0))
        assert row[name] == pytest.approx(share, abs=3.0 * error)  # three standard errors of both
