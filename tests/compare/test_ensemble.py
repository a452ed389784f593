from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.stats import ks_2samp

from rockwobble.compare import ensemble, execution, perturbed_starts, synthetic_motions
from rockwobble.compare.distributions import contrast, ks_distance, median_ratio, standing_wasserstein
from rockwobble.compare.execution import Job
from rockwobble.models import Case, Cylinder, InitialState

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
    ("options", "message"), [({"size": 1}, "at least 2 members"), ({"perturbation": 0.5}, "perturbation")]
)
def test_bad_input_is_refused(options, message):
    with pytest.raises(ValueError, match=message):
        ensemble(CASE, runs=[], **options)
