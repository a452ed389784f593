"""Lognormal curves by maximum likelihood, bootstrap intervals, and medians outside the levels."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from scipy.optimize import root
from scipy.special import log_ndtr
from scipy.stats import norm

from rockwobble.compare.metrics.statistics import Interval
from rockwobble.studies.fragility.fit import (
    ALWAYS,
    EXTRAPOLATED,
    FALLING,
    FITTED,
    KINDS,
    NEVER,
    ONE_MOTION,
    SEPARATED,
    Array,
    Sample,
    bands,
    expanded_shares,
    fit_curves,
    goodness,
    interval,
    resamples,
    spread_interval,
)
from rockwobble.studies.fragility.tables import _bounds_of_failed, _differences, curve_contrast, margin_of

# of the root of the score by MINPACK, whose own tolerance is 1e-8
ROOT = 1e-7
X = np.log([1.0, 1.5, 2.0, 3.0, 4.0])


def kind_of(k: list[float], n: float = 10.0) -> tuple[str, float, float]:
    curves = fit_curves(X, np.full((1, 5), n), np.array([k]))
    return KINDS[curves.kinds[0]], float(curves.centre[0]), float(curves.dispersion[0])


def data_set(seed: int) -> tuple[Array, Array, Array]:
    """Logarithms of intensities, runs and exceedances of a random set of stripes."""
    random = np.random.default_rng(seed)
    levels = int(random.integers(4, 21))
    x, n = np.sort(random.uniform(-1.0, 2.0, levels)), random.integers(5, 45, levels)
    centre, dispersion = random.uniform(-0.2, 1.2), random.uniform(0.2, 1.0)
    return x, n.astype(float), random.binomial(n, norm.cdf((x - centre) / dispersion)).astype(float)


def test_fits_of_random_data_are_roots_of_the_score():
    solved_sets = 0
    for seed in range(60):
        x, n, k = data_set(seed)
        if not (k > 0.0).any() or x[k < n].max(initial=-9.0) <= x[k > 0.0].min():
            continue  # separated: there is no maximum

        def score(guess: Array, x: Array = x, n: Array = n, k: Array = k) -> Array:
            z = (x - guess[0]) / math.exp(guess[1])
            hit, miss = (np.exp(norm.logpdf(z) - tail) for tail in (norm.logcdf(z), norm.logsf(z)))
            slope = k * hit - (n - k) * miss
            return np.array([slope.sum(), (slope * z).sum()])

        curves = fit_curves(x, n[None], k[None])
        # from a start that knows only the data
        middle = float(x[np.argmin(np.abs(k / n - 0.5))])
        solved = root(score, [middle, math.log(0.5)])
        if not solved.success:
            continue
        solved_sets += 1
        assert KINDS[curves.kinds[0]] == FITTED
        assert curves.centre[0] == pytest.approx(solved.x[0], abs=ROOT)
        assert curves.dispersion[0] == pytest.approx(math.exp(solved.x[1]), abs=ROOT)
    assert solved_sets > 50


def test_likelihood_maximum_is_unique_and_scales_with_intensities():
    n, k = np.full((1, 5), 20.0), np.array([[1.0, 4.0, 9.0, 15.0, 18.0]])
    whole = fit_curves(X, n, k)
    centre, spread = float(whole.centre[0]), float(whole.dispersion[0])
    best = log_likelihood(X, n[0], k[0], centre, spread)
    for shift, factor in ((0.01, 1.0), (-0.01, 1.0), (0.0, 1.02), (0.0, 0.98)):
        assert log_likelihood(X, n[0], k[0], centre + shift, spread * factor) < best
    moved = fit_curves(X + math.log(9.81), n, k)
    assert moved.centre[0] - math.log(9.81) == pytest.approx(centre, abs=1e-12)
    assert moved.dispersion[0] == pytest.approx(spread, abs=1e-12)
    doubled = fit_curves(X, 2.0 * n, 2.0 * k)
    assert doubled.dispersion[0] == pytest.approx(spread, abs=1e-12)


def test_a_likelihood_without_maximum_is_reported():
    assert kind_of([0.0] * 5)[:2] == (NEVER, math.inf)
    assert kind_of([10.0] * 5)[:2] == (ALWAYS, -math.inf)
    name, centre, spread = kind_of([0.0, 0.0, 10.0, 10.0, 10.0])
    assert (name, spread) == (SEPARATED, 0.0)
    assert centre == pytest.approx(math.log(math.sqrt(1.5 * 2.0)))
    # one mixed level between none and all: likelihood grows towards a step there
    name, centre, spread = kind_of([0.0, 0.0, 3.0, 10.0, 10.0])
    assert (name, centre, spread) == (SEPARATED, math.log(2.0), 0.0)
    assert kind_of([10.0, 10.0, 10.0, 0.0, 0.0])[0] == FALLING
    name, centre, _ = kind_of([9.0, 8.0, 6.0, 3.0, 1.0])
    assert name == FALLING
    assert math.isnan(centre)
    assert kind_of([0.0, 0.0, 1.0, 9.0, 10.0])[0] == FITTED
    same = fit_curves(X[:2], np.array([[4.0, 12.0]]), np.array([[2.0, 6.0]]))
    assert KINDS[same.kinds[0]] == FALLING


def test_simultaneous_fits_equal_separate_fits():
    random = np.random.default_rng(3)
    n = random.integers(1, 6, (60, 5)).astype(float)
    k = random.binomial(n.astype(int), norm.cdf((X - random.uniform(-2.0, 4.0, (60, 1))) / 0.4)).astype(float)
    together = fit_curves(X, n, k)
    assert len(set(together.kinds.tolist())) > 2
    for row in range(60):
        alone = fit_curves(X, n[row : row + 1], k[row : row + 1])
        assert alone.kinds[0] == together.kinds[row]
        np.testing.assert_allclose(alone.centre[0], together.centre[row], rtol=0.0, atol=1e-12)
        np.testing.assert_allclose(alone.dispersion[0], together.dispersion[row], rtol=0.0, atol=1e-12)


def test_probabilities_of_curves_of_every_kind():
    n = np.full((4, 5), 10.0)
    k = np.array([[0, 2, 5, 9, 10], [0] * 5, [10] * 5, [0, 0, 10, 10, 10]], dtype=float)
    curves = fit_curves(X, n, k)
    at = curves.at(np.array([curves.centre[0], curves.centre[3], X[0], X[-1]]))
    assert at[0, 0] == pytest.approx(0.5)
    assert at[1].tolist() == [0.0] * 4
    assert at[2].tolist() == [1.0] * 4
    assert at[3, 1:].tolist() == [0.5, 0.0, 1.0]
    assert np.isnan(fit_curves(X, n[:1], n[:1] - k[:1]).at(X)).all()


def log_likelihood(x: Array, n: Array, k: Array, centre: float, dispersion: float) -> float:
    """Binomial log likelihood without its constant."""
    eta = (x - centre) / dispersion
    return float((k * log_ndtr(eta) + (n - k) * log_ndtr(-eta)).sum())


def test_goodness_of_fit_is_the_deviance():
    n, k = np.full(5, 20.0), np.array([1.0, 2.0, 12.0, 13.0, 19.0])
    curves = fit_curves(X, n[None], k[None])
    centre, spread = float(curves.centre[0]), float(curves.dispersion[0])
    held = goodness(X, n, k, centre, spread)
    share = k / n
    own = (k * np.log(share) + (n - k) * np.log(1.0 - share)).sum()
    assert held["deviance"] == pytest.approx(2.0 * (own - log_likelihood(X, n, k, centre, spread)), rel=1e-9)
    assert held["degrees"] == 3
    assert held["largest"] == pytest.approx(np.abs(share - norm.cdf((X - centre) / spread)).max())
    # counts that no lognormal curve follows
    poor = np.array([0.0, 10.0, 10.0, 10.0, 20.0])
    bent = fit_curves(X, n[None], poor[None])
    assert goodness(X, n, poor, float(bent.centre[0]), float(bent.dispersion[0]))["p"] < 0.01 < held["p"]


def stripes(random: np.random.Generator, levels: Array, *, motions: int = 22) -> Sample:
    """Motions with one capacity each, median 4 and dispersion 0.5."""
    capacity = random.normal(math.log(4.0), 0.5, motions)
    return Sample(x=np.tile(levels, (motions, 1)), y=(levels >= capacity[:, None]).astype(float))


def test_stripe_and_cloud_of_identical_runs_give_one_curve():
    sample = stripes(np.random.default_rng(2), np.log(np.geomspace(1.0, 12.0, 9)))
    nudged = Sample(x=sample.x + 1e-13 * np.arange(22)[:, None], y=sample.y)
    weights = resamples(22, 20, 1)
    np.testing.assert_allclose(
        nudged.curves(weights).centre, sample.curves(weights).centre, rtol=0.0, atol=1e-9
    )
    n = sample.counts()[1]
    assert n.tolist() == [[22.0] * 9]


def test_failed_runs_are_left_out_of_the_fit():
    sample = stripes(np.random.default_rng(2), np.log(np.geomspace(1.0, 12.0, 9)))
    y = sample.y.copy()
    y[3] = np.nan
    without = Sample(x=np.delete(sample.x, 3, axis=0), y=np.delete(sample.y, 3, axis=0))
    assert Sample(x=sample.x, y=y).curves().centre[0] == pytest.approx(without.curves().centre[0], abs=1e-12)


def test_intervals_keep_infinite_and_unknown_ends():
    drawn = np.linspace(-1.0, 1.0, 1001)
    low, high = expanded_shares(22)
    assert low == pytest.approx(norm.cdf(math.sqrt(22.0 / 21.0) * -2.0796), abs=1e-5)
    bounds = interval(0.0, drawn, 22)
    assert (bounds.low, bounds.high) == pytest.approx((2.0 * low - 1.0, 2.0 * high - 1.0), abs=0.003)
    drawn[:40] = math.inf
    assert interval(0.0, drawn, 22).high == math.inf
    drawn[:40] = math.nan
    unknown = interval(0.0, drawn, 22)
    assert (unknown.low, unknown.high) == (-math.inf, math.inf)


def test_dispersion_interval_is_reflected_about_the_estimate():
    bounds = spread_interval(0.5, np.linspace(0.4, 0.6, 1001), 22)
    low, high = expanded_shares(22)
    assert (bounds.low, bounds.high) == pytest.approx(
        (0.25 / (0.4 + 0.2 * high), 0.25 / (0.4 + 0.2 * low)), rel=1e-3
    )
    # a resample without dispersion bounds nothing
    assert spread_interval(0.5, np.zeros(100), 22).high == math.inf


def test_band_contains_its_curve_and_has_no_width_if_all_resamples_agree():
    sample = stripes(np.random.default_rng(5), np.log(np.geomspace(1.0, 12.0, 12)))
    curves = sample.curves(resamples(22, 300, 0))
    x = np.log([1.0, 3.0, 4.0, 6.0, 12.0])
    low, high = bands(curves, x, 22)
    middle = sample.curves().at(x)[0]
    assert ((low < middle) & (middle < high)).all()
    never = Sample(x=sample.x, y=np.zeros_like(sample.y)).curves(resamples(22, 30, 0))
    assert [end.tolist() for end in bands(never, x, 22)] == [[0.0] * 5, [0.0] * 5]


def test_equivalence_is_an_interval_inside_a_margin():
    close, far, wide = (
        Interval(value=1.0, low=low, high=high) for low, high in ((0.97, 1.06), (1.2, 1.5), (0.9, 1.2))
    )
    assert [each.about_one(0.1) for each in (close, far, wide)] == ["within", "beyond", "undecided"]
    assert margin_of(close) == pytest.approx(0.06)
    assert margin_of(Interval(value=1.0, low=0.8, high=1.1)) == pytest.approx(0.25)
    assert margin_of(Interval(value=1.0, low=0.0, high=1.1)) == math.inf


LEVELS = np.log([2.0, 4.0, 16.0])
MOTIONS = 12
LOG2, LOG4, LOG16 = LEVELS.tolist()


def contrast(first: tuple[int, ...], second: tuple[int, ...]) -> dict[str, Any]:
    """Contrast of two methods from counts at each level, with nested sets of motions."""
    exceeded = [
        np.array([[float(motion < count) for count in counts] for motion in range(MOTIONS)])
        for counts in (first, second)
    ]
    samples = [Sample(x=np.tile(LEVELS, (MOTIONS, 1)), y=y) for y in exceeded]
    weights = resamples(MOTIONS, 200, 0)
    one, many = ([sample.curves(each) for sample in samples] for each in (None, weights))
    return curve_contrast(_differences(one), _differences(many), MOTIONS, 0.1)


@pytest.mark.parametrize(
    ("first", "second", "verdict"),
    [
        ((0, 5, 12), (0, 7, 12), "undecided"),  # both medians anywhere about 4, possibly different
        ((0, 12, 12), (0, 12, 12), "undecided"),  # between 2 and 4 each
        ((0, 0, 0), (0, 0, 3), "undecided"),  # above 16 each
        ((12, 12, 12), (7, 12, 12), "undecided"),  # below 2 each
        ((0, 0, 12), (12, 12, 12), "beyond"),  # apart by a level
    ],
)
def test_medians_not_resolved_by_levels_do_not_differ(
    first: tuple[int, ...], second: tuple[int, ...], verdict: str
) -> None:
    difference = contrast(first, second)
    assert difference["verdict"] == verdict
    assert verdict == "undecided" or difference["ratio_low"] == pytest.approx(2.0)


def exceeded(*rows: str) -> Sample:
    """Row of 0 and 1 for each motion, at the levels LEVELS."""
    return Sample(x=np.tile(LEVELS, (len(rows), 1)), y=np.array([[float(c) for c in row] for row in rows]))


@pytest.mark.parametrize(("one", "rest", "median"), [("011", "000", math.inf), ("001", "111", -math.inf)])
def test_one_motion_gives_no_curve(one: str, rest: str, median: float) -> None:
    # of many motions the counts have a maximum, which is that motion's alone
    sample = exceeded(one, *[rest] * 30)
    assert KINDS[fit_curves(*sample.counts()).kinds[0]] == FITTED
    curves = sample.curves()
    assert KINDS[curves.kinds[0]] == ONE_MOTION
    assert curves.median.tolist() == [median]
    assert np.isnan(curves.at(LEVELS)).all()
    ends = (LOG16, math.inf) if median > 0.0 else (-math.inf, LOG2)
    assert (curves.low[0], curves.high[0]) == ends


@pytest.mark.parametrize("seed", range(8))
def test_medians_outside_the_levels_run_are_bounds_not_numbers(seed: int) -> None:
    random = np.random.default_rng(seed)
    levels = np.sort(random.uniform(0.0, 3.0, 4))
    capacity = random.normal(random.uniform(-1.0, 4.0), random.uniform(0.2, 1.5), 25)
    x = np.tile(levels, (25, 1))
    sample = Sample(x=x, y=(x > capacity[:, None]).astype(float))
    curve, many = sample.curves(), sample.curves(resamples(25, 200, seed))
    median, low, high = float(curve.median[0]), float(curve.low[0]), float(curve.high[0])
    assert math.isinf(median) or math.isnan(median) or levels[0] <= median <= levels[-1]
    if math.isinf(median):
        edge = levels[-1] if median > 0.0 else levels[0]
        assert (low, high) == ((edge, math.inf) if median > 0.0 else (-math.inf, edge))
    if KINDS[curve.kinds[0]] in (EXTRAPOLATED, ONE_MOTION):  # resamples cannot resolve more than the motions
        edge = levels[-1] if median > 0.0 else levels[0]
        ends, inner = (many.high, many.low) if median > 0.0 else (-many.low, -many.high)
        assert (np.isnan(ends) | (ends == math.inf)).all()  # NaN counts as anything
        assert not (inner > math.copysign(1.0, median) * edge).any()
    elif KINDS[curve.kinds[0]] == FITTED:
        assert median == curve.centre[0] == low == high


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
def test_adjacent_levels_bound_the_median_without_a_curve(
    counts: list[float], centre: float, low: float, high: float
) -> None:
    curves = fit_curves(LEVELS, np.full((1, 3), 12.0), np.array([counts]))
    assert [curves.centre[0], curves.low[0], curves.high[0]] == pytest.approx([centre, low, high])


@pytest.mark.parametrize("one", ["011", "000"])
def test_failed_run_bounds_beyond_the_levels_are_not_numbers(one: str) -> None:
    """If the failed runs exceed nothing, at most one motion exceeds: the median is above all levels."""
    sample = exceeded(one, *["000"] * 7)
    sample.y[1, 1:] = math.nan
    if_exceeded, if_not = _bounds_of_failed(sample)
    assert if_not == math.inf
    # exceedance of one motion, or two as a curve beyond the levels
    assert if_exceeded == math.inf
