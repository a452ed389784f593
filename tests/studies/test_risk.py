"""Annual frequency of overturning: closed form, brute force, tails, resamples and pairs."""

from __future__ import annotations

import math

import numpy as np
import pandas as pd
import pytest

import rockwobble as rw
from rockwobble.models import GroundMotion, HazardCurve
from rockwobble.studies.fragility.fit import resamples
from rockwobble.studies.fragility.integral import continued, frequencies_of, lognormal_frequency, mean_over
from rockwobble.studies.fragility.intensity import uplift_scale
from rockwobble.studies.fragility.risk import Exposure, frequency_interval, resampled

K, K0 = 2.5, 1e-4


def power_law(count: int = 40, low: float = 1e-3, high: float = 1e3) -> HazardCurve:
    x = np.geomspace(low, high, count)
    return HazardCurve(x, K0 * x**-K, measure="pga")


@pytest.mark.parametrize(("median", "dispersion"), [(0.5, 0.4), (1.0, 0.7), (0.3, 0.05)])
def test_frequency_of_a_power_law_hazard_is_the_closed_form(median: float, dispersion: float) -> None:
    # k0 theta^-k exp(k^2 beta^2 / 2); the ends of the curve are 9 and more dispersions away
    exact = K0 * median**-K * math.exp(0.5 * (K * dispersion) ** 2)
    assert lognormal_frequency(power_law(), math.log(median), dispersion) == pytest.approx(exact, rel=1e-12)


def test_left_point_summation_underestimates_by_half_slope_times_step() -> None:
    hazard = power_law(100, 1e-3, 2.0)
    share = np.array([0.5 * math.erfc(-math.log(x / 0.4) / 0.4 / math.sqrt(2.0)) for x in hazard.intensity])
    steps = np.append(-np.diff(hazard.annual_frequency), hazard.annual_frequency[-1])
    short = 1.0 - float(share @ steps) / lognormal_frequency(hazard, math.log(0.4), 0.4)
    # the guide says 10 %; the next order is a tenth of it
    assert short == pytest.approx(0.5 * K * math.log(2000.0) / 99, rel=0.15)


def test_lognormal_motions_give_the_closed_form_without_a_fit() -> None:
    rng = np.random.default_rng(5)
    capacity = np.exp(rng.normal(math.log(0.8), 0.4, 4000))
    x = np.tile(np.log(np.geomspace(0.1, 8.0, 60)), (len(capacity), 1))
    y = (x >= np.log(capacity)[:, None]).astype(float)
    frequencies = frequencies_of(power_law(), x, y, np.full(len(x), -5.0), np.full(len(x), 9.0))
    # levels a factor e^d apart spread each capacity over such a step: an error of the order (k d)^2/12
    step = K * (x[0, 1] - x[0, 0])
    assert frequencies.total.mean() == pytest.approx(K0 * np.mean(capacity**-K), rel=1.5 * step**2 / 12.0)


def brute_force(hazard: HazardCurve, x: np.ndarray, y: np.ndarray, uplift: float, low: float) -> float:
    nodes = np.concatenate([[min(uplift, x[0])], x])
    values = np.concatenate([[0.0 if uplift < x[0] else y[0]], y])
    begin, end = np.log(hazard.intensity[[0, -1]])
    grid = np.linspace(max(nodes[0], begin, low), min(x[-1], end), 400_001)
    rate = hazard.exceedance(np.exp(np.clip(grid, begin + 1e-15, end - 1e-15)))
    p = np.interp(grid, nodes, values)
    return float(np.sum(0.5 * (p[1:] + p[:-1]) * (rate[:-1] - rate[1:])) + p[-1] * rate[-1])


@pytest.mark.parametrize("seed", range(3))
def test_indicators_with_gaps_on_an_uneven_curve_are_integrated_exactly(seed: int) -> None:
    rng = np.random.default_rng(seed)
    points = np.sort(rng.uniform(math.log(0.05), math.log(3.0), 12))
    hazard = HazardCurve(np.exp(points), 0.02 * np.exp(-np.cumsum(rng.uniform(0.05, 1.2, 12))), measure="pga")
    x = np.sort(rng.uniform(math.log(0.1), math.log(2.5), (5, 7)), axis=1)
    y = rng.integers(0, 2, (5, 7)).astype(float)
    uplift, far = x[:, 0] - rng.uniform(-0.1, 0.5, 5), rng.uniform(-1.5, 0.5, 5)
    frequencies = frequencies_of(hazard, x, y, uplift, far)
    for row in range(5):
        expected = brute_force(hazard, x[row], y[row], uplift[row], -math.inf)
        assert frequencies.total[row] == pytest.approx(expected, rel=1e-7, abs=1e-12)  # of the fine grid
        if far[row] < min(x[row, -1], points[-1]):
            expected = brute_force(hazard, x[row], y[row], uplift[row], far[row])
            assert frequencies.far[row] == pytest.approx(expected, rel=1e-7, abs=1e-12)


def test_a_finer_curve_of_the_same_power_law_changes_nothing() -> None:
    x, y = np.log([[0.2, 0.5, 1.0]]), np.array([[0.0, 1.0, 1.0]])
    ends = np.array([-2.0]), np.array([9.0])
    coarse, fine = (frequencies_of(power_law(count), x, y, *ends).total[0] for count in (2, 300))
    assert coarse == pytest.approx(fine, rel=1e-12)
    at = np.log(np.array([0.3, 0.3]))
    assert mean_over(power_law(), at, at) == pytest.approx(K0 * 0.3**-K, rel=1e-12)
    longer = continued(power_law(low=0.1), math.log(2e-3))
    assert longer.exceedance([2e-3 * (1 + 1e-9), 0.03]) == pytest.approx(K0 * np.array([2e-3, 0.03]) ** -K)
    hazard = power_law(low=0.1)  # below its first point the frequency there counts
    assert lognormal_frequency(hazard, math.log(1e-4), 0.3) == pytest.approx(hazard.annual_frequency[0])


def single(hazard: HazardCurve, levels: list[float], y: list[float], uplift: float) -> dict[str, float]:
    frequencies = frequencies_of(hazard, np.log([levels]), np.array([y]), np.log([uplift]), np.array([9.0]))
    return {name: float(getattr(frequencies, name)[0]) for name in ("total", "head", "tail", "least", "most")}


@pytest.mark.parametrize(
    "y", [[0.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [1.0, 1.0, 1.0], [1.0, 0.0, 1.0]]
)
def test_truncated_hazard_bounds_the_frequency_of_the_whole_curve(y: list[float]) -> None:
    """For a hazard that is not steeper at weak shaking, for any cut of hazard or levels."""
    points, levels = np.geomspace(0.01, 10.0, 13), [0.2, 0.5, 1.0]
    slope = 1.5 + np.log(points / 0.01) / 3.0
    rate = 0.1 * np.exp(
        -np.concatenate([[0.0], np.cumsum(0.5 * (slope[1:] + slope[:-1]) * np.diff(np.log(points)))])
    )
    whole = HazardCurve(points, rate, measure="pga")
    full = single(whole, levels, y, 0.1)
    for first in range(12):
        for last in range(first + 2, 14):
            cut = HazardCurve(points[first:last], rate[first:last], measure="pga")
            part = single(cut, levels, y, 0.1)
            assert 0.0 <= part["least"] <= part["total"] * (1.0 + 1e-12)
            assert part["total"] <= part["most"] * (1.0 + 1e-12)
            assert max(part["head"], part["tail"]) <= part["total"] * (1.0 + 1e-12)
            if y == sorted(y):  # beyond a cut nothing changes: gaps there are invisible
                assert part["least"] <= full["total"] * (1.0 + 1e-12)
            assert full["total"] <= part["most"] * (1.0 + 1e-12)


def test_tail_shares_of_both_ends_are_stated() -> None:
    law, levels = power_law(), [0.2, 0.5, 1.0]
    stands, falls = (single(law, levels, [0.0, 0.0, last], 0.1) for last in (0.0, 1.0))
    assert (stands["total"], stands["most"]) == (0.0, pytest.approx(K0))  # all that is above 1
    assert (falls["tail"], falls["head"]) == (pytest.approx(K0), 0.0)
    always = single(law, levels, [1.0, 1.0, 1.0], 0.1)
    assert always["head"] == pytest.approx(always["total"])
    assert (always["least"], always["most"]) == (pytest.approx(K0 * 0.2**-K), pytest.approx(K0 * 0.1**-K))
    above = single(power_law(low=0.7), levels, [0.0, 1.0, 1.0], 0.1)
    assert above["total"] == above["head"] == pytest.approx(K0 * 0.7**-K)
    mean = mean_over(law, np.log([0.2]), np.log([0.5]))[0]  # change lies between these two levels
    assert above["most"] == pytest.approx(mean)
    short = single(power_law(high=0.7), levels, [0.0, 0.0, 1.0], 0.1)
    assert short["tail"] == pytest.approx(math.log(0.7 / 0.5) / math.log(2.0) * K0 * 0.7**-K)
    assert short["most"] == pytest.approx(short["total"] + K0 * 0.7**-K - short["tail"])
    unseen = single(power_law(high=0.15), levels, [0.0, 0.0, 1.0], 0.1)
    assert (unseen["total"], unseen["most"]) == (0.0, pytest.approx(K0 * 0.15**-K))


@pytest.mark.filterwarnings("error")
def test_lognormal_frequency_equals_a_fine_sum_for_steep_hazards() -> None:
    rng = np.random.default_rng(3)
    for slopes in ([2.0, 40.0, 300.0], [150.0, 60.0, 5.0], [331.0, 57.0, 100.0]):
        widths, dispersion, centre = np.array([0.02, 0.03, 0.05]), 0.6, rng.normal(-1.0, 0.4)
        x = np.concatenate([[-1.2], -1.2 + np.cumsum(widths)])
        y = np.concatenate([[-3.0], -3.0 - np.cumsum(widths * slopes)])
        hazard = HazardCurve(np.exp(x), np.exp(y), measure="pga")
        grid = np.linspace(x[0], x[-1], 200_001)
        density = np.exp(-0.5 * ((grid - centre) / dispersion) ** 2) / dispersion / math.sqrt(2.0 * math.pi)
        inside = np.trapezoid(np.exp(np.interp(grid, x, y)) * density, grid)
        below = 0.5 * math.erfc((centre - x[0]) / dispersion / math.sqrt(2.0)) * math.exp(-3.0)
        # the step of the sum, 5e-7 of a slope of 331
        assert lognormal_frequency(hazard, centre, dispersion) == pytest.approx(inside + below, rel=1e-7)


def interval_of(
    hazard: HazardCurve, x: np.ndarray, y: np.ndarray, strata: np.ndarray
) -> tuple[float, float, float]:
    ends = {"uplift": np.full(len(y), math.log(0.1)), "far": np.full(len(y), 9.0)}
    exposure = Exposure(x=np.tile(x, (len(y), 1)), y=y, made=~np.isnan(y), **ends)
    weights = resamples(len(y), 100, 1, strata=strata)
    single = exposure.frequencies(hazard)
    interval = frequency_interval(
        hazard, exposure, single, resampled(exposure.terms(hazard, single), weights), 8
    )
    return interval.low, interval.value, interval.high


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("stripes", [False, True])
def test_every_frequency_interval_has_positive_width(stripes: bool) -> None:
    """For all outcomes and all positions of the hazard."""
    levels = np.log([0.2, 0.4, 0.8, 1.6])
    strata = np.tile(np.arange(4), 8) if stripes else np.zeros(8, dtype=np.int64)
    first = np.random.default_rng(2).integers(0, 5, len(strata))
    for lowest in (np.full_like(first, place) for place in range(5)):
        for firsts in (lowest, np.minimum(first, lowest), np.maximum(first, lowest)):
            y = (np.arange(4) >= firsts[:, None]).astype(float)
            y = np.where(strata[:, None] == np.arange(4), y, np.nan) if stripes else y
            for hazard in (
                power_law(),
                power_law(low=1.0),
                power_law(low=3.0),
                power_law(high=0.3),
                power_law(high=0.05),
                HazardCurve([1.0, 1.001, 3.0], [1e-1, 5e-3, 1e-4], measure="pga"),  # begins steeply
            ):
                low, value, high = interval_of(hazard, levels, y, strata)
                assert 0.0 <= low <= value * (1.0 + 1e-12)
                assert value < high
                assert high > low
                assert math.isfinite(high)


def test_nothing_below_uplift_overturns() -> None:
    x, y = np.log([[0.5, 1.0]]), np.array([[1.0, 1.0]])
    at = [frequencies_of(power_law(), x, y, np.log([lift]), np.array([9.0])).total[0] for lift in (0.1, 0.4)]
    assert at[1] < at[0] < K0 * 0.1**-K
    assert at[1] > K0 * 0.5**-K


@pytest.mark.parametrize("vertical", [0.0, 1.0])
def test_uplift_scale_is_the_uplift_threshold_of_the_model(vertical: float) -> None:
    rng = np.random.default_rng(3)
    a = rng.normal(size=(300, 3)) * [1.0, 1.0, vertical]
    motion = GroundMotion(a if vertical else a[:, :2], 0.01, "noise")
    pier = rw.Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    scale = uplift_scale(motion, pier)
    below, above = (
        rw.simulate(rw.Case(pier, motion.scaled(factor * scale))).peak_tilt for factor in (1 - 1e-3, 1 + 1e-3)
    )
    assert below == 0.0 < above


@pytest.fixture(scope="module")
def fragility() -> rw.studies.Fragility:
    pier = rw.Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    motions = rw.synthetic_motions(12, peak=1.0, seed=4)
    methods = ["recess", "planar-x"]
    return rw.fragility(
        pier, motions, methods=methods, levels=[1.5, 2, 3, 4.5, 7, 10], resamples=200, workers=1
    )


SITE = HazardCurve(np.geomspace(0.05, 5.0, 30), 1e-3 * np.geomspace(0.05, 5.0, 30) ** -2.0, measure="pga")


@pytest.mark.slow
def test_risk_has_a_row_for_each_cylinder_and_method(fragility: rw.studies.Fragility) -> None:
    table = fragility.risk(SITE)
    assert list(table["method"]) == ["recess model", "planar x"]
    assert table["ratio"].iloc[0] == 1.0
    rate = table["annual_frequency"].iloc[0]
    assert table["annual_frequency_low"].iloc[0] <= rate <= table["annual_frequency_high"].iloc[0]
    assert table["probability"].iloc[0] == pytest.approx(-math.expm1(-50.0 * rate), rel=1e-12)
    of_a_year = fragility.risk(SITE, years=1.0)["probability"].iloc[0]
    assert of_a_year == pytest.approx(-math.expm1(-rate), rel=1e-12)


def test_mean_frequency_of_motions_is_that_of_the_mean_indicator(
    fragility: rw.studies.Fragility,
) -> None:
    points = fragility.points
    for method, rate in fragility.risk(SITE)[["method", "annual_frequency"]].itertuples(index=False):
        totals = []
        for motion, own in points.groupby("motion"):
            runs = fragility.runs[(fragility.runs["motion"] == motion) & (fragility.runs["method"] == method)]
            y = (runs.sort_values("step")["outcome"] == "overturned").to_numpy(float)
            own = own.sort_values("step")
            x = np.log(own["pga"].to_numpy())
            lift = math.log(own["pga"].iloc[0] / own["peak_acceleration"].iloc[0])
            totals.append(brute_force(SITE, x, y, lift, -math.inf))
        assert rate == pytest.approx(np.mean(totals), rel=1e-6)


def test_risk_accepts_hazards_of_every_intensity_measure(fragility: rw.studies.Fragility) -> None:
    by_resultant = HazardCurve(SITE.intensity, SITE.annual_frequency, measure="pga_resultant")
    rates = [fragility.risk(each)["annual_frequency"].iloc[0] for each in (SITE, by_resultant)]
    assert rates[0] != rates[1]
    for measure in ("pgv", "pgv_resultant"):
        table = fragility.risk(HazardCurve(SITE.intensity, SITE.annual_frequency, measure=measure))
        assert table.drop(columns=["ratio_low", "ratio_high"]).notna().all().all()


def test_a_hazard_of_another_period_is_refused(fragility: rw.studies.Fragility) -> None:
    other = HazardCurve(SITE.intensity, SITE.annual_frequency, measure="sa", period=0.5)
    with pytest.raises(ValueError, match=r"Sa at 0\.5 s, the fragility has it at 1 s: .*--period 0\.5"):
        fragility.risk(other)


def test_a_total_dispersion_raises_the_frequency_of_the_curve_alone(fragility: rw.studies.Fragility) -> None:
    plain, wide = fragility.risk(SITE), fragility.risk(SITE, total_dispersion=0.8)
    assert (wide["annual_frequency_fit"] > plain["annual_frequency_fit"]).all()
    pd.testing.assert_series_equal(plain["annual_frequency"], wide["annual_frequency"])


def test_no_overturning_gives_an_upper_bound() -> None:
    pier = rw.Cylinder(semidiagonal=30.0, tan_alpha=0.3)
    motions = rw.synthetic_motions(8, peak=1.0, seed=4)
    none = rw.fragility(pier, motions, methods=["recess"], levels=[1.1, 1.3], resamples=50, workers=1)
    row = none.risk(SITE).iloc[0]
    assert row["overturning_motions"] == 0
    assert row["annual_frequency"] == row["annual_frequency_low"] == 0.0
    assert 0.0 < row["annual_frequency_most"] <= row["annual_frequency_high"]
    assert none.with_risk(SITE).findings().of("risk")[0].key == "risk.none"


def test_verdict_compares_the_interval_with_the_target(fragility: rw.studies.Fragility) -> None:
    low, high = (float(fragility.risk(SITE)[f"annual_frequency{end}"].iloc[0]) for end in ("_low", "_high"))
    for target, verdict in (
        (0.99 * low, "above"),
        (0.5 * (low + high), "inconclusive"),
        (1.01 * high, "below"),
    ):
        said = fragility.with_risk(SITE, target=target)
        assert said.tables["risk"]["verdict"].iloc[0] == verdict
        assert said.findings().of("risk")[0].to_json()["values"]["reason"]["value"] == verdict
    with pytest.raises(ValueError, match="target must be positive"):
        fragility.risk(SITE, target=0.0)


def test_a_tendon_yields_at_peak_tension_equal_to_yield_force() -> None:
    pier, motions = rw.Cylinder(semidiagonal=6.0, tan_alpha=0.2), rw.synthetic_motions(8, peak=1.0, seed=61)
    tendon = rw.Tendon(prestress=0.5, stiffness=1.0, yield_force=0.6)
    options = {"methods": ["recess"], "levels": [2, 3, 4.5], "resamples": 50, "workers": 1}
    tied = {"tendon_prestress": 0.5, "tendon_stiffness": 1.0}
    study = rw.fragility(pier, motions, **options, **tied, tendon_yield=0.6)
    elastic = rw.fragility(pier, motions, **options, **tied)
    tensions = [tendon.tension(pier, peak * pier.alpha) for peak in elastic.runs["peak_tilt"]]
    counts = study.counts[study.counts["limit"] == "tendon yields"]
    assert 0 < counts["k"].sum() == sum(tension >= 0.6 for tension in tensions) < len(tensions)
    assert (counts["n"] == 8).all()
    uplifts, yields = (study.risk(SITE, limit=limit).iloc[0] for limit in ("uplift", "tendon yields"))
    assert 0.0 < yields["annual_frequency"] < uplifts["annual_frequency"]
    # beyond yield nothing is known: all of these may overturn
    bound = study.risk(SITE).iloc[0]
    assert bound["annual_frequency_high"] >= bound["annual_frequency_most"] >= yields["annual_frequency"]
    with pytest.raises(ValueError, match="needs the yield force"):
        rw.fragility(pier, motions, **options, **tied, limits=["tendon yields"])
    with pytest.raises(ValueError, match="needs a prestress or a stiffness"):
        rw.fragility(pier, motions, **options, tendon_yield=0.6)
    with pytest.raises(ValueError, match="the limit of a risk"):
        elastic.risk(SITE, limit="tendon yields")


@pytest.mark.slow
def test_identical_motions_by_level_equal_one_common_set(
    fragility: rw.studies.Fragility,
) -> None:
    """One set of motions listed at each level gives the tables of a common set."""
    pier = rw.Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    motions = rw.synthetic_motions(12, peak=1.0, seed=4)
    levels = [10, 1.5, 2, 3, 4.5, 7]
    again = rw.fragility(
        pier,
        dict.fromkeys(levels, motions),
        methods=["recess", "planar-x"],
        resamples=200,
        workers=1,
    )
    for name in ("fits", "contrasts", "gaps", "counts"):
        pd.testing.assert_frame_equal(again.tables[name], fragility.tables[name])
    assert again.facts["motions_of_levels"] == [12] * 6


@pytest.mark.slow
def test_each_level_uses_only_its_listed_motions() -> None:
    pier = rw.Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    motions = rw.synthetic_motions(36, peak=1.0, seed=4)
    own = {1.5: motions[:12], 3.0: motions[12:24], 9.0: motions[24:]}
    run = rw.fragility(pier, own, methods=["recess", "planar-x"], resamples=200, workers=1)
    assert run.facts["motions_of_levels"] == [12, 12, 12]
    # the shares of each level are those of its motions alone
    for level, group in own.items():
        alone = rw.fragility(
            pier, group, methods=["recess"], levels=[level], limits=["overturned"], resamples=2, workers=1
        )
        counts = run.counts.query("limit == 'overturned' and method == 'recess model'").set_index("intensity")
        assert (counts.loc[level, "k"], counts.loc[level, "n"]) == tuple(alone.counts[["k", "n"]].iloc[0])
    fits = run.fits.set_index(["method", "limit"])
    assert (fits["failed"] == 0).all()
    assert (fits["median_if_exceeded"] == fits["median"])[("recess model", "overturned")]
    assert run.gaps.empty
    resultant = HazardCurve(SITE.intensity, SITE.annual_frequency, measure="pga_resultant")
    table = run.risk(resultant)
    assert (table["motions"] == 36).all()
    assert (table["failed"] == 0).all()
    assert table["far_share"].tolist() == [0.0, 0.0]  # synthetic motions may be scaled
    low, value, high = (table[f"annual_frequency{end}"].iloc[0] for end in ("_low", "", "_high"))
    assert 0.0 < low <= value <= high
    with pytest.raises(ValueError, match="motions by level are of the measure of their levels"):
        run.risk(SITE)


def test_motions_by_level_refuse_other_levels_and_ambiguous_names() -> None:
    pier = rw.Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    a, b = rw.synthetic_motions(2, peak=1.0, seed=4)
    with pytest.raises(ValueError, match="have levels of their own"):
        rw.fragility(pier, {1.0: [a, b]}, levels=[1.0])
    with pytest.raises(ValueError, match="must have different names"):
        rw.fragility(pier, {1.0: [a, a]})
    other = GroundMotion(b.acceleration, b.time_step, name=a.name)
    with pytest.raises(ValueError, match="must have different names"):
        rw.fragility(pier, {1.0: [a, b], 2.0: [other, b]})


@pytest.mark.parametrize(
    ("lowest", "least", "most"), [(100.0, 1.0, 1.0), (5.05, 1.0, 1.0), (0.6, 0.0, 0.999)]
)
def test_record_scale_factors_above_5_count_as_far(
    fragility: rw.studies.Fragility, lowest: float, least: float, most: float
) -> None:
    assert fragility.risk(SITE)["far_share"].tolist() == [0.0, 0.0]  # synthetic motions are never far
    more = lowest / fragility.points["uplift_scale"].min()
    points = fragility.points.assign(synthetic=False, scale=more * fragility.points["scale"])
    points = points.assign(uplift_scale=more * points["uplift_scale"])
    scaled = rw.studies.Fragility(tables={**fragility.tables, "points": points}, facts=fragility.facts)
    share = scaled.risk(SITE)["far_share"].iloc[0]
    assert least - 1e-9 <= share <= most + 1e-9
    assert share > 0.0


def test_the_margin_is_the_median_over_the_2475_year_intensity(fragility):
    table = fragility.risk(SITE).set_index("method")
    fits = fragility.fits[fragility.fits["limit"] == "overturned"].set_index("method")
    rare = SITE.intensity[0] * (SITE.annual_frequency[0] / (-math.log(0.98) / 50.0)) ** 0.5  # its power is -2
    for method in ("recess model", "planar x"):
        centre = math.log(table["margin"][method] * rare)
        of_curve = lognormal_frequency(SITE, centre, fits["dispersion"][method])
        # dispersion hardly differs by the measure: it is stated in the unit of the levels
        assert table["annual_frequency_fit"][method] == pytest.approx(of_curve, rel=0.5)
        assert table["annual_frequency_fit"][method] > SITE.exceedance(math.exp(centre))
