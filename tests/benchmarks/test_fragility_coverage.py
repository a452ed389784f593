"""Coverage of fragility intervals in few studies; the command runs more."""

from __future__ import annotations

from benchmarks.fragility_coverage import Kind, coverage


def test_intervals_from_22_motions_cover_median_and_ratio() -> None:
    median, dispersion, ratio = coverage(Kind(name="22 motions", levels=12), studies=200, draws=200)
    # of 200 a share of 0.95 scatters by 0.015, and three times that is allowed for
    assert 0.905 <= median <= 0.995
    assert 0.905 <= dispersion <= 1.0
    assert 0.905 <= ratio <= 0.995
