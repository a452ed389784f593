"""Medians that no level tells: they lie between two levels, or beyond all, and no method is equal there."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from rockwobble.studies.fragility.fit import (
    EXTRAPOLATED,
    FALLING,
    FITTED,
    KINDS,
    ONE_MOTION,
    Sample,
    fit_curves,
    resamples,
)
from rockwobble.studies.fragility.tables import _bounds_of_failed, _differences, curve_contrast

X = np.log([2.0, 4.0, 16.0])
MOTIONS = 12
LOG2, LOG4, LOG16 = X.tolist()


def contrast(first: tuple[int, ...], second: tuple[int, ...]) -> dict[str, Any]:
    """Two methods by their counts at each level, the same motions first."""
    exceeded = [
        np.array([[float(motion < count) for count in counts] for motion in range(MOTIONS)])
        for counts in (first, second)
    ]
    samples = [Sample(x=np.tile(X, (MOTIONS, 1)), y=y) for y in exceeded]
    weights = resamples(MOTIONS, 200, 0)
    one, many = ([sample.curves(each) for sample in samples] for each in (None, weights))
    return curve_contrast(_differences(one), _differences(many), MOTIONS, 0.1)


@pytest.mark.parametrize(
    ("first", "second"),
    [
        ((0, 5, 12), (0, 7, 12)),  # both medians anywhere about 4, and not the same
        ((0, 12, 12), (0, 12, 12)),  # between 2 and 4 each
        ((0, 0, 0), (0, 0, 3)),  # above 16 each
        ((12, 12, 12), (7, 12, 12)),  # below 2 each
    ],
)
def test_a_median_beyond_all_levels_is_undecided(first: tuple[int, ...], second: tuple[int, ...]) -> None:
    assert contrast(first, second)["verdict"] == "undecided"


def exceeded(*rows: str) -> Sample:
    """One row of 0 and 1 for each motion, at the levels X."""
    return Sample(x=np.tile(X, (len(rows), 1)), y=np.array([[float(c) for c in row] for row in rows]))


@pytest.mark.parametrize("others", [6, 30])
@pytest.mark.parametrize(("one", "rest", "median"), [("011", "000", math.inf), ("001", "111", -math.inf)])
def test_one_motion_gives_no_curve(one: str, rest: str, median: float, others: int) -> None:
    # of many motions the counts have a maximum, which is that motion's alone
    sample = exceeded(one, *[rest] * others)
    assert KINDS[fit_curves(*sample.counts()).kinds[0]] in (FITTED, FALLING)
    found = sample.curves()
    if KINDS[fit_curves(*sample.counts()).kinds[0]] == FITTED:
        assert KINDS[found.kinds[0]] == ONE_MOTION
        assert found.median.tolist() == [median]
        assert np.isnan(found.at(X)).all()
        ends = (LOG16, math.inf) if median > 0.0 else (-math.inf, LOG2)
        assert (found.low[0], found.high[0]) == ends


@pytest.mark.parametrize("seed", range(20))
def test_no_median_is_a_number_outside_of_the_levels_that_were_run(seed: int) -> None:
    random = np.random.default_rng(seed)
    levels = np.sort(random.uniform(0.0, 3.0, 4))
    capacity = random.normal(random.uniform(-1.0, 4.0), random.uniform(0.2, 1.5), 25)
    x = np.tile(levels, (25, 1))
    sample = Sample(x=x, y=(x > capacity[:, None]).astype(float))
    found, many = sample.curves(), sample.curves(resamples(25, 200, seed))
    median, low, high = float(found.median[0]), float(found.low[0]), float(found.high[0])
    assert math.isinf(median) or math.isnan(median) or levels[0] <= median <= levels[-1]
    if math.isinf(median):
        edge = levels[-1] if median > 0.0 else levels[0]
        assert (low, high) == ((edge, math.inf) if median > 0.0 else (-math.inf, edge))
    if KINDS[found.kinds[0]] in (EXTRAPOLATED, ONE_MOTION):  # no resample tells more than the motions do
        edge = levels[-1] if median > 0.0 else levels[0]
        ends, inner = (many.high, many.low) if median > 0.0 else (-many.low, -many.high)
        assert (np.isnan(ends) | (ends == math.inf)).all()  # NaN counts as anything
        assert not (inner > math.copysign(1.0, median) * edge).any()
    elif KINDS[found.kinds[0]] == FITTED:
        assert median == found.centre[0] == low == high


def test_counts_that_are_apart_by_a_level_are_told() -> None:
    found = contrast((0, 0, 12), (12, 12, 12))
    assert (found["ratio_low"], found["verdict"]) == (pytest.approx(2.0), "beyond")


@pytest.mark.parametrize(
    ("counts", "centre", "low", "high"),
    [
        ([9.0, 12.0, 12.0], -math.inf, -math.inf, LOG2),
        ([0.0, 0.0, 1.0], math.inf, LOG16, math.inf),
        ([0.0, 12.0, 12.0], 0.5 * (LOG2 + LOG4), LOG2, LOG4),
        ([0.0, 5.0, 12.0], LOG4, LOG4, LOG16),
        ([0.0, 7.0, 12.0], LOG4, LOG2, LOG4),
        ([0.0, 6.0, 12.0], LOG4, LOG4, LOG4),
        ([0.0, 0.0, 0.0], math.inf, LOG16, math.inf),
    ],
)
def test_the_levels_beside_bound_a_median_without_a_curve(
    counts: list[float], centre: float, low: float, high: float
) -> None:
    found = fit_curves(X, np.full((1, 3), 12.0), np.array([counts]))
    assert [found.centre[0], found.low[0], found.high[0]] == pytest.approx([centre, low, high])


@pytest.mark.parametrize("one", ["011", "000"])
def test_a_bound_by_failed_runs_beyond_the_levels_is_no_number(one: str) -> None:
    """If what failed exceeds nothing, at most one motion exceeds: the median is above all levels."""
    sample = exceeded(one, *["000"] * 7)
    sample.y[1, 1:] = math.nan
    if_exceeded, if_not = _bounds_of_failed(sample)
    assert if_not == math.inf
    # and if it exceeds, of one motion, or of two as a curve beyond the levels
    assert if_exceeded == math.inf
