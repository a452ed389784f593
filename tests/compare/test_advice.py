"""What an advice rests on: demands, spread, scales, and the grades at their thresholds."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest

from rockwobble import reduced
from rockwobble.compare.metrics.tilt import overturned
from rockwobble.compare.studies.advice import (
    Demands,
    advise,
    demands_of,
    planar_view,
    scan_scales,
    spread_of_starts,
)
from rockwobble.compare.studies.advice.grades import (
    BROKEN,
    CHANCE,
    NEAR,
    grade_contact,
    grade_engine,
    grade_friction,
    grade_overturning,
    overall,
    trust_of,
)
from rockwobble.compare.studies.advice.planar import PlanarView
from rockwobble.compare.studies.spectrum.series import uplift_factor
from rockwobble.compare.studies.spectrum.series import SERIES, intensity_unit
from rockwobble.compare.studies.spectrum.study import overturning_spectrum
from rockwobble.models import Case, Cylinder, GroundMotion, InitialState, el_centro_1940

PIER = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
SAME_RUN = 1e-9  # of two runs that differ in what comes after their end

STILL = Demands(
    moving_time=10.0,
    friction=0.5,
    friction_needed=0.3,
    friction_usual=0.2,
    slip_from=math.nan,
    slip_time=0.0,
    slides=False,
    couple=1.0,
    couple_usual=0.5,
    couple_in_radii=0.1,
    least_normal_force=0.9,
    largest_normal_force=2.0,
    lost_from=math.nan,
    lost_time=0.0,
)


def case(scale: float = 1.0, **fields) -> Case:
    return Case(PIER, el_centro_1940().scaled(scale), name="El Centro", **fields)


@pytest.fixture(scope="module")
def advice():
    return advise(case(), count=20)


def test_demands_are_those_of_the_solution():
    response = reduced.simulate(Case(PIER, el_centro_1940(), friction=0.15))
    found = demands_of(response)
    assert found.slides
    assert found.friction_needed == response.assumptions.largest_friction_needed > found.friction_usual > 0.1
    assert found.slip_time == response.assumptions.breaches[0].duration > 0.0
    assert found.couple == pytest.approx(9.81 * found.couple_in_radii * PIER.base_radius, rel=1e-12)
    assert found.couple >= found.couple_usual > 0.0
    assert found.moving_time == pytest.approx(53.45 - response.uplift_time, abs=0.02)
    enough = demands_of(reduced.simulate(Case(PIER, el_centro_1940(), friction=0.3)))
    assert (enough.slides, enough.slip_time) == (False, 0.0)


def test_a_release_needs_no_friction_to_uplift():
    start = InitialState(tilt=0.1, rolling_rate=0.5)
    assert not demands_of(reduced.simulate(Case(PIER, initial=start, duration=1.0, friction=0.1))).slides


@pytest.mark.parametrize(
    ("missing", "grade"), [(0.0, "good"), (10.0 * BROKEN * 0.99, "care"), (10.0 * BROKEN * 1.01, "bad")]
)
def test_short_lacks_want_care_and_long_ones_rule_the_model_out(missing, grade):
    assert grade_friction(dataclasses.replace(STILL, slip_time=missing)) == grade
    assert grade_contact(dataclasses.replace(STILL, lost_time=missing)) == grade
    assert grade_friction(dataclasses.replace(STILL, slip_time=missing, slides=True)) == "bad"


@pytest.mark.parametrize(
    ("methods", "data", "peak", "expected"),
    [
        (math.inf, math.inf, 5.0, ("trace", 10.0, "")),
        (10.0, 12.0, 5.0, ("trace", 10.0, "")),
        (8.0, 9.0, 8.0, ("peak", 8.0, "methods")),
        (9.0, 8.0, 8.01, ("statistics", 8.0, "data")),
    ],
)
def test_trust_turns_on_what_comes_before_the_largest_tilt(methods, data, peak, expected):
    trust = trust_of(methods, data, peak, 10.0)
    assert (trust.kind, trust.until, trust.because) == expected


@pytest.mark.parametrize(
    ("fell", "lowest", "chance", "grade"),
    [
        (True, 1.0, 0.0, "bad"),
        (False, NEAR * 0.99, 0.0, "care"),
        (False, NEAR, CHANCE * 0.99, "good"),
        (False, math.nan, CHANCE, "care"),
        (False, math.nan, math.nan, "good"),
    ],
)
def test_overturning_is_near_or_far(fell, lowest, chance, grade):
    assert grade_overturning(fell, lowest, chance) == grade


def test_an_engine_that_parts_early_rules_out_and_the_worst_grade_counts():
    assert grade_engine("earlier", False) == "bad"
    assert grade_engine("later", True) == "care"
    assert grade_engine("in time", False) == "good"
    assert overall(["good", "bad", "care"]) == "bad"
    assert overall([]) == "good"


def test_scales_hold_what_single_runs_give():
    motion = GroundMotion(el_centro_1940().acceleration[:1000], 0.01)
    scan = scan_scales(Case(PIER, motion, name="x"))
    assert scan.factors[scan.here] == 1.0
    assert scan.peaks["3d"][scan.here] == reduced.simulate(Case(PIER, motion)).peak_tilt
    in_y = reduced.simulate(Case(PIER, motion), plane=0.5 * math.pi).peak_tilt
    assert scan.peaks["planar_y"][scan.here] == in_y
    for series, options in (("3d", {}), ("planar_x", {"plane": 0.0})):
        lowest = scan.lowest[series]
        assert reduced.simulate(Case(PIER, motion.scaled(lowest)), **options).outcome == "overturned"
        # nothing lower that a scan beside its steps would see
        start, step = scan.searched_from[series], scan.search_step
        scales = np.arange(start + 0.2 * step, lowest - step / 16.0, 0.5 * step)
        beside = reduced.peak_tilts([6.0], 0.2, motion, scales, rtol=1e-8, **options)
        assert not overturned(beside).any()
        assert lowest < scan.factors[overturned(scan.peaks[series]).argmax()]
    assert scan_scales(Case(PIER, GroundMotion(np.zeros((9, 2)), 0.1), name="x")) is None


def test_advice_and_spectrum_find_the_same_lowest():
    motion = GroundMotion(el_centro_1940().acceleration[:1000], 0.01)
    scan = scan_scales(Case(PIER, motion, name="x"))
    spectrum = overturning_spectrum(0.2, motion, semidiagonals=[6.0], intensities=[1.0, 2.0, 3.0])
    unit = intensity_unit(0.2, motion, 9.81)
    for series in SERIES:
        if math.isfinite(spectrum.lowest[series][0]):
            assert scan.lowest[series] == pytest.approx(unit * spectrum.lowest[series][0], rel=1e-12)
        assert scan.searched_from[series] == pytest.approx(unit * spectrum.searched_from[series], rel=1e-12)
    assert math.isfinite(spectrum.lowest["3d"][0])


def test_the_lowest_of_a_release_is_searched_from_still_ground():
    motion = GroundMotion(el_centro_1940().acceleration[:300], 0.01)
    held = scan_scales(Case(PIER, motion, initial=InitialState(tilt=0.9 * PIER.alpha), name="x"))
    assert held.searched_from == {"3d": 0.0}
    assert held.confirmed["3d"]
    gone = scan_scales(Case(PIER, motion, initial=InitialState(tilt=1.05 * PIER.alpha), name="x"))
    assert gone.lowest == {"3d": 0.0}


def test_a_release_has_no_planar_analysis():
    motion = GroundMotion(el_centro_1940().acceleration[:500], 0.01)
    scan = scan_scales(Case(PIER, motion, initial=InitialState(tilt=0.05, rolling_rate=0.3), name="x"))
    assert list(scan.peaks) == ["3d"]
    assert planar_view(scan) is None
    assert planar_view(None) is None


@pytest.mark.parametrize(
    ("spatial", "x", "y", "kind"),
    [
        (0.1, 0.05, 0.099, "unconservative"),
        (0.1, 0.05, 0.0999, "equal"),
        (0.1, 0.102, 0.0, "conservative"),
        (0.1, 0.0, 0.0, "unconservative"),
        (0.0, 0.0, 0.0, "unknown"),
        (math.nan, 0.1, 0.0, "unknown"),
    ],
)
def test_the_kind_of_planar_analysis(spatial, x, y, kind):
    view = PlanarView(
        spatial=spatial,
        planar_x=x,
        planar_y=y,
        neighbours=0,
        larger=math.nan,
        missed=math.nan,
        lowest_spatial=math.nan,
        lowest_planar=math.nan,
    )
    assert view.kind == kind


def test_the_same_seed_gives_the_same_starts(advice):
    def again(seed: int) -> np.ndarray:
        models = (advice.model, advice.other)
        runs = (advice.response, advice.other_response)
        return spread_of_starts(advice.case, *runs, models=models, count=20, seed=seed).peaks

    assert np.array_equal(advice.spread.peaks, again(1))
    assert not np.array_equal(advice.spread.peaks, again(2))


def test_the_error_of_the_largest_tilt_is_that_of_the_members(advice):
    low, high = (np.quantile(advice.spread.peaks, share, method="inverted_cdf") for share in (0.05, 0.95))
    assert advice.data_error == pytest.approx(max(high / advice.peak - 1.0, 1.0 - low / advice.peak))
    assert advice.trust.kind == "statistics"
    ratio = advice.spread.quantile(0.5, other=True) / advice.spread.quantile(0.5)
    assert advice.form_error == pytest.approx(ratio - 1.0)


def test_a_cylinder_at_rest_needs_nothing():
    found = advise(case(0.5), count=20)
    assert not found.moves
    assert found.grades == {}
    assert found.spread is None
    assert found.uplift_factor == pytest.approx(2.0 * uplift_factor(el_centro_1940(), 0.2, 9.81))
    assert found.lowest_overturning > found.uplift_factor


def pulse(still: float) -> GroundMotion:
    """One sine of 4 g tan(alpha) and 1.2 s, and still ground after it for so long [s]."""
    time = np.arange(121) * 0.01
    wave = 4.0 * 9.81 * 0.2 * np.sin(2.0 * np.pi * time / 1.2)
    along = np.concatenate([wave, np.zeros(round(100.0 * still))])
    return GroundMotion(np.column_stack([along, np.zeros_like(along)]), 0.01)


@pytest.fixture(scope="module")
def fallen():
    return advise(Case(PIER, pulse(0.0), name="pulse"), count=20)


def test_a_fall_that_the_record_does_not_see_is_a_fall(fallen):
    followed = advise(Case(PIER, pulse(20.0), name="pulse"), count=20)
    for found in (fallen, followed):
        assert found.overturned
        assert found.overturning_share == 1.0
        assert found.lowest_overturning == pytest.approx(0.506, abs=0.001)
        assert found.grades["overturning"] == "bad"
    assert fallen.peak_time == pytest.approx(followed.peak_time, rel=SAME_RUN)
    assert fallen.trust.kind == followed.trust.kind
    assert fallen.trust.until == pytest.approx(followed.trust.until, abs=0.011)  # a sample
    assert fallen.demands.friction_needed == pytest.approx(followed.demands.friction_needed, rel=1e-6)


def test_a_case_lasts_until_its_fall_and_so_does_all_that_is_run_for_it(fallen):
    assert fallen.case.length == pytest.approx(fallen.peak_time, abs=0.011)
    assert fallen.case.motion.duration == pytest.approx(1.2)
    assert fallen.spread.time[-1] > 5.0
    # every start lies on its side at the end
    assert fallen.spread.low[-1] > 1.0
    # the pass that no engine resolves comes after the pulse
    assert 1.2 < fallen.prediction.length + fallen.response.uplift_time < fallen.case.length


def test_a_run_cut_short_falls_over_ground_that_is_still_from_there():
    found = advise(case(4.0, duration=5.0), count=20)
    assert found.overturned
    assert found.case.motion.duration == pytest.approx(5.0)
    assert found.response.time[-1] == pytest.approx(found.case.length, abs=0.011)
    assert found.overturning_share == 1.0


def test_what_stands_ends_when_it_was_asked_to():
    found = advise(case(1.0, duration=5.0), count=20)
    assert found.case.length == found.response.time[-1] == 5.0


def test_demands_of_samples_are_those_of_the_solution():
    response = reduced.simulate(Case(PIER, el_centro_1940(), duration=8.0, friction=0.21), sample_step=4e-5)
    whole, sampled = demands_of(response), demands_of(response, until=8.0)
    for name in ("friction_needed", "couple", "least_normal_force", "largest_normal_force", "slip_from"):
        assert getattr(sampled, name) == pytest.approx(getattr(whole, name), rel=1e-3), name
    assert sampled.slip_time == pytest.approx(whole.slip_time, abs=1e-3)
    assert whole.slip_time > 0.01
    first = demands_of(response, until=0.5 * (response.uplift_time + whole.slip_from))
    assert (first.slip_time, first.friction_needed < 0.21) == (0.0, True)
    assert first.moving_time < whole.moving_time


def test_what_a_falling_cylinder_asks_is_no_demand():
    found = advise(case(4.0), count=20)
    assert found.overturned
    assert math.isinf(found.response.assumptions.largest_friction_needed)
    assert found.demands.friction_needed < 0.5
    assert math.isnan(found.data_error)
    assert found.grades["overturning"] == "bad"
    assert found.model_grade != "bad"


def test_open_ground_asks_for_the_rolling_model():
    found = advise(
        Case(PIER, initial=InitialState(0.05, rolling_rate=0.5), duration=2.0, name="x"), support="flat"
    )
    assert (found.model.support, found.other.support) == ("flat", "recess")
    assert found.demands.couple == 0.0
    assert found.trust.kind == "trace"


def test_bad_numbers_are_refused():
    for options in ({"count": 5}, {"support": "glued"}, {"count": 10**6}):
        with pytest.raises(ValueError, match="must be"):
            advise(case(), **options)
