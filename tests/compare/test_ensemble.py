from __future__ import annotations

import math

import numpy as np
import pandas as pd
import pytest
from scipy.stats import ks_2samp

from rockwobble.compare import (
    ensemble,
    ensemble_members,
    execution,
    far_field_motions,
    perturbed_starts,
    synthetic_motions,
)
from rockwobble.compare.distributions import (
    contrast,
    ks_distance,
    median_ratio,
    member_factor,
    smallest_distance,
    standing_wasserstein,
)
from rockwobble.compare.execution import Job
from rockwobble.models import Case, Cylinder, GroundMotion, InitialState

ROUNDING = 1e-12
PIER = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
CASE = Case("release", PIER, initial=InitialState(0.1, rolling_rate=0.5), duration=1.0)
UP = np.zeros(200, dtype=bool)


def sample(seed: int, scale: float = 1.0, count: int = 200) -> np.ndarray:
    return scale * np.random.default_rng(seed).lognormal(sigma=0.3, size=count)


def test_one_distribution_is_told_from_itself_by_chance_only():
    found = contrast(sample(1), sample(2), UP, UP, draws=200)
    assert found.ks_p > 0.05
    assert found.median_ratio.low < 1.0 < found.median_ratio.high


def test_a_fifth_more_is_told():
    found = contrast(sample(1, 1.2), sample(2), UP, UP, draws=200)
    assert found.ks_p < 1e-3
    assert found.median_ratio.low > 1.0
    assert found.median_ratio.low < 1.2 < found.median_ratio.high


def test_known_distances():
    ours, theirs = np.array([1.0, 2.0, 3.0, math.inf]), np.array([2.0, 3.0, 4.0, 5.0])
    assert ks_distance(ours, theirs) == 0.25
    assert standing_wasserstein(ours[:3], theirs[:3]) == pytest.approx(1.0, abs=ROUNDING)
    assert median_ratio(ours, theirs) == pytest.approx(2.0 / 3.0, abs=ROUNDING)
    a, b = sample(3), sample(4)
    assert ks_distance(a, b) == pytest.approx(ks_2samp(a, b).statistic, abs=ROUNDING)


def test_factor_between_the_peaks_of_a_member():
    ours, theirs = np.array([1.0, 4.0, 3.0, math.inf, 0.0]), np.array([2.0, 1.0, 3.0, 1.0, 1.0])
    # 2, 4 and 1: what falls or stays at rest has no factor
    assert member_factor(ours, theirs) == pytest.approx(2.0, abs=ROUNDING)
    assert math.isnan(member_factor(ours[3:], theirs[3:]))


def test_a_distance_within_chance_is_where_its_probability_is_a_twentieth():
    count = 400
    shift = round(smallest_distance(count) * count)
    values = np.arange(float(count))
    # the limit for large samples: a step of the distance is 1/400, which moves p by less than 0.005
    assert ks_2samp(values, values + shift, method="asymp").pvalue == pytest.approx(0.05, abs=0.005)


def test_an_overturned_run_is_the_largest_and_a_failed_one_does_not_count():
    peaks, against = np.array([0.1, 8.0, 0.3, math.nan]), np.array([0.1, 0.2, 0.3, 0.4])
    fell = np.array([False, True, False, False])
    found = contrast(peaks, against, fell, np.zeros(4, dtype=bool), draws=50)
    assert (found.count, found.overturned, found.against_overturned, found.both_overturned) == (3, 1, 0, 0)
    assert found.ks.value == pytest.approx(1.0 / 3.0, abs=ROUNDING)
    assert found.wasserstein.value < 0.1  # the tilt of a fall is no distance


def test_intervals_repeat_with_their_seed():
    first, again, other = (contrast(sample(1), sample(2), UP, UP, draws=50, seed=s) for s in (3, 3, 4))
    assert first == again
    assert first.ks != other.ks
    assert first.ks.value == other.ks.value


def test_two_members_are_the_least():
    with pytest.raises(ValueError, match="two members"):
        contrast(np.array([1.0, math.nan]), np.ones(2), UP[:2], UP[:2])


def test_starts_are_perturbed_by_the_stated_size():
    members = perturbed_starts(CASE, 400, perturbation=0.01, seed=5)
    tilts = np.array([case.initial.tilt for case in members]) / 0.1 - 1.0
    rates = np.array([case.initial.rolling_rate for case in members]) / 0.5 - 1.0
    # the standard deviation of 400 draws is known to 1/sqrt(800)
    assert np.std(tilts) == pytest.approx(0.01, rel=4.0 / math.sqrt(800.0))
    assert np.std(rates) == pytest.approx(0.01, rel=4.0 / math.sqrt(800.0))
    assert abs(np.corrcoef(tilts, rates)[0, 1]) < 4.0 / math.sqrt(400.0)
    assert len({case.name for case in members}) == 400


def test_synthetic_motions_repeat_with_their_seed_and_have_their_peak():
    first, again, other = (synthetic_motions(3, peak=4.0, seed=s, duration=5.0) for s in (1, 1, 2))
    assert np.array_equal(first[2].acceleration, again[2].acceleration)
    assert not np.array_equal(first[2].acceleration, other[2].acceleration)
    assert [motion.peak for motion in first] == pytest.approx([4.0] * 3, abs=1e-9)
    assert first[0].duration == pytest.approx(5.0)


def test_failed_runs_are_counted_and_named(monkeypatch, make_trace):
    time = np.arange(11) * 0.1

    def simulate(job: Job):
        if job.label == "rolling" and job.case.name.endswith("#2"):
            return make_trace(time, time, outcome="failed", message="no step", peak_tilt=math.nan)
        return make_trace(time, job.case.initial.tilt * time)

    monkeypatch.setattr(execution, "simulate", simulate)
    found = ensemble(CASE, runs=[], size=4, draws=20, workers=1)
    methods = found.methods.set_index("method")
    assert methods["failed"].to_dict() == {"recess": 0, "rolling": 1}
    assert methods.loc["rolling", "failed_members"] == "release #2"
    assert found.contrasts.loc[0, ["count", "masked"]].tolist() == [3, "release #2"]
    assert len(found.members) == 8
    assert found.contrasts.loc[0, "ks"] == 0.0


@pytest.mark.parametrize(
    ("rate", "length", "outcome"),
    [(0.1, 1.0, "overturned"), (-0.1, 1.0, "completed"), (0.1, 0.5, "completed")],
)
def test_what_falls_when_its_motion_ends_has_overturned(monkeypatch, make_trace, rate, length, outcome):
    motion = GroundMotion(np.ones((11, 2)), 0.1, "shaking")
    cases = [Case(name, PIER, motion, duration=length) for name in "ab"]
    time = np.arange(11) * 0.1
    trace = make_trace(time, 1.5 * PIER.alpha * time, tilt_rate=np.full(11, rate))
    monkeypatch.setattr(execution, "simulate", lambda job: trace)
    found = ensemble(cases, runs=[], draws=20, workers=1)
    assert set(found.members["outcome"]) == {outcome}
    tilt = 0.5 * math.pi if outcome == "overturned" else 1.5 * PIER.alpha
    assert found.members["peak_tilt"].tolist() == pytest.approx([tilt / PIER.alpha] * 4, abs=ROUNDING)
    assert (
        found.methods["peak_median"].tolist()
        == [math.inf if outcome == "overturned" else pytest.approx(1.5, abs=ROUNDING)] * 2
    )


def test_an_ensemble_that_was_ended_repeats_nothing_and_keeps_numbers_alone(monkeypatch, tmp_path):
    first = ensemble(CASE, runs=[], size=3, draws=20, workers=1, resume=tmp_path)
    monkeypatch.setattr(execution, "simulate", lambda job: pytest.fail("ran again"))
    again = ensemble(CASE, runs=[], size=3, draws=20, workers=1, resume=tmp_path)
    assert first.members.equals(again.members)
    assert first.contrasts.equals(again.contrasts)
    assert first.about == again.about
    assert {len(pd.read_parquet(path)) for path in (tmp_path / "members").glob("*.parquet")} == {1}


def test_every_input_is_in_the_hash_of_an_ensemble():
    hashes = [
        ensemble(CASE, runs=[], draws=2, workers=1, **options).about["inputs"]
        for options in ({"size": 2}, {"size": 3}, {"size": 2, "seed": 1}, {"size": 2, "models": ["recess"]})
    ]
    assert len(set(hashes)) == 4


def test_far_field_motions_have_their_peak_and_their_names(monkeypatch):
    def made_up(pair: int) -> GroundMotion:
        return GroundMotion([[0.0, 0.0], [float(pair), 0.0]], 0.01, f"pair {pair}")

    monkeypatch.setattr(ensemble_members, "p695_far_field", made_up)
    motions = far_field_motions(peak=3.0)
    assert [motion.peak for motion in motions] == pytest.approx([3.0] * 22, abs=ROUNDING)
    assert [motion.name for motion in motions] == [f"pair {pair}" for pair in range(1, 23)]
    with pytest.raises(ValueError, match="peak must be positive"):
        far_field_motions(peak=-1.0)


@pytest.mark.parametrize(
    ("options", "message"), [({"size": 1}, "at least 2 members"), ({"perturbation": 0.5}, "perturbation")]
)
def test_bad_input_is_refused(options, message):
    with pytest.raises(ValueError, match=message):
        ensemble(CASE, runs=[], **options)
