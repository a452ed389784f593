"""Grids of runs: the same as single runs, whatever the number of threads."""

import math

import numpy as np
import pytest

from rockwobble import reduced
from rockwobble.models import Cylinder, GroundMotion, el_centro_1940
from rockwobble.reduced import driver, problem

EL_CENTRO = el_centro_1940()
SIZES = np.array([0.8, 3.0, 10.0])
SCALES = np.linspace(0.3, 4.0, 12)


@pytest.mark.parametrize("model", ["recess", "rolling", "planar"])
def test_cells_are_single_runs(model):
    peaks = reduced.peak_tilts(SIZES, 0.1, EL_CENTRO, SCALES, model=model)
    assert peaks.shape == (3, 12)
    assert (peaks == 0.5 * math.pi).any()
    assert ((peaks > 0.0) & (peaks < 0.1)).any()
    for i, size in enumerate(SIZES):
        for j in (0, 2, 5, 11):
            single = reduced.simulate(
                Cylinder(semidiagonal=size, tan_alpha=0.1),
                EL_CENTRO.scaled(SCALES[j]),
                model=model,
                rtol=1e-7,
            )
            # the same steps of the same kernel, but for the factor applied before or inside
            assert peaks[i, j] == pytest.approx(single.peak_tilt, rel=1e-6)


def test_the_same_bits_whatever_the_number_of_threads():
    one = reduced.peak_tilts(SIZES, 0.1, EL_CENTRO, SCALES, workers=1)
    four = reduced.peak_tilts(SIZES, 0.1, EL_CENTRO, SCALES, workers=4)
    assert np.array_equal(one, four)


def test_progress_ends_at_one():
    seen = []
    reduced.peak_tilts(SIZES, 0.1, EL_CENTRO, [0.1], progress=seen.append)
    assert seen == pytest.approx([1 / 3, 2 / 3, 1.0])


def test_an_interruption_passes_through_at_once():
    def interrupt(fraction):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        reduced.peak_tilts(SIZES, 0.1, EL_CENTRO, SCALES, progress=interrupt)


# Size [m] and peak of the resultant over g tan(alpha): small cylinders that the record only just lifts.
# Undamped they rock hundreds of times a second for the rest of it: single runs take 29 to 350 steps a sample.
BARELY_LIFTED = [
    ("recess", 0.1, 0.5, 1.01727),
    ("recess", 0.3, 0.2, 1.00962),
    ("rolling", 0.1, 0.5, 1.01727),
    ("rolling", 0.1, 0.161, 1.00962),
]


@pytest.mark.parametrize(("model", "tan_alpha", "size", "intensity"), BARELY_LIFTED)
def test_chatter_costs_a_few_whole_runs(model, tan_alpha, size, intensity, monkeypatch):
    marches = record_marches(monkeypatch)
    scale = 9.81 * tan_alpha / EL_CENTRO.peak
    peaks = reduced.peak_tilts([size], tan_alpha, EL_CENTRO, [intensity * scale], model=model)
    # a whole run is one step a sample; the rule is raised after 4, and again after each half more
    samples = len(EL_CENTRO.acceleration)
    assert 4 * samples < marches[-1].step_count <= 6 * samples
    assert marches[-1].status == driver.REST
    assert 0.0 < peaks[0, 0] < 0.01 * math.atan(tan_alpha)
    if model == "recess":  # the single run rocks on to the end, no higher than it first rose
        cylinder = Cylinder(semidiagonal=size, tan_alpha=tan_alpha)
        single = reduced.simulate(cylinder, EL_CENTRO.scaled(intensity * scale), rtol=1e-7)
        assert single.step_count > 20 * samples
        assert peaks[0, 0] == pytest.approx(single.peak_tilt, rel=1e-6)


def test_the_seating_is_raised_as_often_as_it_takes():
    motion = EL_CENTRO.scaled(1.01727 * 0.981 / EL_CENTRO.peak)
    run = problem.make_problem(
        "recess", Cylinder(semidiagonal=0.5, tan_alpha=0.1), motion, None, None,
        gravity=9.81, rtol=1e-7, seating=1e-8, plane=0.0, restitution=1.0,
    )  # fmt: skip
    # it rocks at some 2e-5 to 9e-5 of alpha: not below a thousand times the seating given
    march = run.scaled_solver(2000, 100)(1.0)
    assert march.status == driver.REST
    assert 2300 < march.step_count < 2800
    given_up = run.scaled_solver(2000, 0)(1.0)
    assert given_up.status == driver.OVER_BUDGET
    assert given_up.step_count == 2001


def test_runs_that_do_not_chatter_are_single_runs_to_the_bit(monkeypatch):
    with_rise = reduced.peak_tilts(SIZES, 0.1, EL_CENTRO, SCALES)
    marches = record_marches(monkeypatch, relief=0)
    without = reduced.peak_tilts(SIZES, 0.1, EL_CENTRO, SCALES, workers=1)
    assert max(march.step_count for march in marches) < 2 * len(EL_CENTRO.acceleration)
    assert np.array_equal(with_rise, without)


def record_marches(monkeypatch, relief=None):
    """Return the list to which every march of a grid is appended from now on."""
    marches = []
    scaled_solver = problem.Problem.scaled_solver

    def recorded(self, step_budget, given):
        solve = scaled_solver(self, step_budget, given if relief is None else relief)

        def recording(factor):
            marches.append(solve(factor))
            return marches[-1]

        return recording

    monkeypatch.setattr(problem.Problem, "scaled_solver", recorded)
    return marches


def test_chatter_beyond_the_step_budget_is_masked():
    shape = np.sin(np.linspace(0.0, math.pi, 1001))
    angle = np.linspace(0.0, 2.0, 1001)
    wave = GroundMotion(9.81 * 0.2 * np.column_stack([shape * np.cos(angle), shape * np.sin(angle)]), 0.01)
    peaks = reduced.peak_tilts([6.0], 0.2, wave, [0.9, 1.0 + 1e-6], seating=0.0)
    assert peaks[0, 0] == 0.0
    assert math.isnan(peaks[0, 1])


@pytest.mark.parametrize(
    ("sizes", "scales", "words"),
    [([[1.0]], [1.0], "semidiagonals"), ([1.0], [-1.0], "scales"), ([0.0], [1.0], "semidiagonal")],
)
def test_bad_axes_are_named(sizes, scales, words):
    with pytest.raises(ValueError, match=words):
        reduced.peak_tilts(sizes, 0.1, EL_CENTRO, scales)


def test_the_samples_of_a_coarse_record_do_not_limit_a_run(monkeypatch):
    given = []
    monkeypatch.setattr(
        problem.Problem,
        "scaled_solver",
        lambda self, budget, relief: given.append(budget) or pytest.fail("enough"),
    )
    coarse = GroundMotion(np.full((100, 2), 0.1), 10.0)
    with pytest.raises(pytest.fail.Exception):
        reduced.peak_tilts([1.0], 0.2, coarse, [1.0])
    # rocking at a hundredth of alpha takes some 60 steps for each time 1/p
    p = math.sqrt(12.0 / (15.0 + math.cos(math.atan(0.2)) ** 2) * 9.81)
    assert given == [int(60 * 990.0 * p)]
