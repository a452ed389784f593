"""The README's table on accuracy: what it states, and whether a measurement is within a factor of two."""

from __future__ import annotations

import re
from pathlib import Path

README = Path(__file__).parents[1] / "README.md"
FACTOR = 2.0


def stated(row: str, pattern: str) -> float:
    """The number in the group of a pattern, in the row that has these words."""
    (line,) = (
        line for line in README.read_text("utf-8").splitlines() if line.startswith("|") and row in line
    )
    match = re.search(pattern, line.split("|")[2])
    assert match, (row, pattern)
    return float(match[1])


def is_stated(measured: float, row: str, pattern: str) -> bool:
    """Whether a figure is within a factor of two of the stated one, from either side."""
    return stated(row, pattern) / FACTOR < measured < stated(row, pattern) * FACTOR
