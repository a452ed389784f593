"""What the guide says of the intervals of annual frequencies is what the trials give."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from benchmarks.risk_coverage import coverage

GUIDE = Path(__file__).parents[2] / "docs" / "guide" / "risk.md"
SAID = re.compile(
    r"with 22 motions where the truth is known the first holds it in (\d+) to (\d+) of 100 "
    r"\(the plain percentiles of the resamples in (\d+) to (\d+)\), the second in (\d+) to (\d+):"
)


def test_the_shares_of_the_guide_are_those_of_the_trials() -> None:
    found = SAID.search(" ".join(GUIDE.read_text(encoding="utf-8").split()))
    assert found
    rows = [row for row in coverage(600, 4) if row["motions"] == 22]
    shares = [[row[name] for row in rows] for name in ("frequency", "percentiles", "ratio")]
    ends = [100.0 * end for each in shares for end in (min(each), max(each))]
    assert [float(each) for each in found.groups()] == pytest.approx(
        ends, abs=0.6
    )  # a trial or two by rounding
