from __future__ import annotations

import numpy as np
import pytest

from rockwobble.reports.figures.thinning import POINTS, envelope, kept_samples


def test_few_samples_are_all_kept():
    assert kept_samples(np.arange(POINTS, dtype=float)).tolist() == list(range(POINTS))


@pytest.mark.parametrize("count", [POINTS + 1, 5346, 1_000_000])
def test_many_samples_become_no_more_than_the_limit_and_keep_their_extremes(count):
    rng = np.random.default_rng(1)
    values = rng.normal(size=count)
    at = count // 3
    values[at], values[at + 1] = 50.0, -50.0  # two samples wide
    keep = kept_samples(values)
    assert POINTS // 2 < len(keep) <= POINTS
    assert keep[0] == 0
    assert keep[-1] == count - 1
    assert (np.diff(keep) > 0).all()
    assert {at, at + 1} <= set(keep.tolist())


def test_edges_of_gaps_are_kept():
    values = np.sin(np.linspace(0.0, 20.0, 10_000))
    values[4000:6000] = np.nan
    keep = kept_samples(values)
    assert {3999, 4000, 5999, 6000} <= set(keep.tolist())
    drawn = values[keep]
    assert np.isnan(drawn).any()  # a line without the gap would bridge it


def test_a_path_keeps_the_extremes_of_both_coordinates():
    angle = np.linspace(0.0, 40.0, 20_000)
    x, y = np.cos(angle), np.sin(angle)
    keep = kept_samples(x, y)
    assert len(keep) <= POINTS
    for coordinate in (x, y):
        assert coordinate[keep].max() == coordinate.max()
        assert coordinate[keep].min() == coordinate.min()


def test_the_envelope_is_the_maximum_over_the_last_second():
    time = np.arange(1001) * 0.01
    values = np.abs(np.sin(np.pi * time)) * np.exp(0.5 * time)
    upper = envelope(time, values)
    assert np.argmax(upper > 5.0) == np.argmax(values > 5.0)
    assert upper[500] == values[401:501].max()
    assert upper[0] == values[0]
    assert (upper >= values).all()
    assert envelope(time[:1], values[:1]).tolist() == values[:1].tolist()
