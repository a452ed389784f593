"""Medians that no level tells: they lie between two levels, or beyond all, and no method is equal there."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from rockwobble.compare.studies.fragility.fit import Sample, fit_curves, resamples
from rockwobble.compare.studies.fragility.tables import _differences, contrast_row

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
    return contrast_row(_differences(one), _differences(many), MOTIONS, 0.1)


@pytest.mark.parametrize(
    ("first", "second"),
    [
        ((0, 5, 12), (0, 7, 12)),  # both medians anywhere about 4, and not the same
        ((0, 12, 12), (0, 12, 12)),  # between 2 and 4 each
        ((0, 0, 0), (0, 0, 3)),  # above 16 each
        ((12, 12, 12), (7, 12, 12)),  # below 2 each
    ],
)
def test_what_no_level_tells_is_undecided(first: tuple[int, ...], second: tuple[int, ...]) -> None:
    assert contrast(first, second)["verdict"] == "undecided"


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
