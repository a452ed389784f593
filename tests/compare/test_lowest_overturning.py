"""The lowest intensity that overturns: found between the steps of a grid and below it."""

from __future__ import annotations

import math

import numpy as np
import pytest

from rockwobble import reduced
from rockwobble.compare.metrics.tilt import overturned
from rockwobble.compare.studies.spectrum.lowest_overturning import (
    STEP,
    lowest_intensities,
    lowest_on_grid,
    search_lowest,
    uplift_factor,
)
from rockwobble.models import Case, Cylinder, GroundMotion, el_centro_1940

FALL = 0.5 * math.pi
ALPHA = 0.1
EL_CENTRO = el_centro_1940()
UNIT = 9.81 * 0.1 / EL_CENTRO.peak  # factor on the record for an intensity of 1 at tan(alpha) = 0.1
SAME = 1e-12  # rounding of the intensities


class Window:
    """Peak tilts about one window of overturning, and every intensity at which they were asked for."""

    def __init__(self, centre: float, width: float, flank: float) -> None:
        self.centre, self.width, self.flank = centre, width, flank
        self.run: list[float] = []

    def __call__(self, levels: np.ndarray) -> np.ndarray:
        self.run += levels.tolist()
        away = np.abs(levels - self.centre) - 0.5 * self.width
        # the tilt grows by its logarithm towards a window, because the balance is left exponentially
        beside = 0.3 - 0.1 * np.log(np.maximum(np.abs(away), 1e-9) / self.flank)
        return np.where(away <= 0.0, FALL, ALPHA * np.clip(beside, 0.3, 0.999))


# the second lies between two calls of the model
@pytest.mark.parametrize("centre", [1.4951, 1.3152, 1.5037, 2.7182])
def test_a_window_narrower_than_the_step_is_found_by_its_flanks(centre):
    window = Window(centre, 0.0012, 0.02)
    found = search_lowest(window, 1.0, 4.0, STEP, ALPHA)
    assert abs(found - centre) <= 0.0006
    run = np.array(window.run)
    assert not overturned(window(run[run < found])).any()
    assert found - run[run < found].max() <= STEP / 16.0 * (1.0 + SAME)
    # a search from below ends where it has found something
    assert run.max() < found + 32.0 * STEP


def test_everything_between_start_and_stop_is_run_in_steps_and_nothing_else():
    far = Window(9.0, 0.1, 0.02)
    assert math.isnan(search_lowest(far, 1.003, 3.5, STEP, ALPHA))
    run = np.sort(far.run)
    assert (run[0], run[-1]) == (1.003, 3.5)
    assert np.diff(run).max() <= STEP * (1.0 + SAME)
    far.run.clear()
    assert math.isnan(search_lowest(far, 2.0, 1.0, STEP, ALPHA))
    assert math.isnan(search_lowest(far, math.inf, 1.0, STEP, ALPHA))
    assert far.run == []
    assert (
        search_lowest(lambda levels: np.where(levels == 1.2345, FALL, 0.0), 1.0, 1.2345, STEP, ALPHA)
        == 1.2345
    )


def test_a_failed_run_stands_and_hides_nothing_beyond_its_own_step():
    window = Window(1.5003, 0.02, 0.02)

    def partly(levels):
        return np.where((levels > 1.25) & (levels < 1.35), math.nan, window(levels))

    assert 0.0 <= search_lowest(partly, 1.0, 4.0, STEP, ALPHA) - 1.4903 <= STEP / 16.0


# at these sizes a grid of 100 intensities finds 1.667 as the lowest
@pytest.mark.parametrize("size", [3.177, 4.08])
def test_a_scan_finds_nothing_lower(size):
    def peaks(levels):
        return reduced.peak_tilts([size], 0.1, EL_CENTRO, UNIT * levels, rtol=1e-8)[0]

    grid = np.linspace(1.0, 12.0, 100)[:8]
    known = lowest_on_grid(grid, peaks(grid)[None])[0]
    assert known > 1.65
    found = search_lowest(peaks, 1.0, known, STEP, math.atan(0.1))
    assert overturned(peaks(np.array([found]))).all()
    # beside the steps of the search
    scan = peaks(np.arange(1.0025, found, 0.005))
    assert not overturned(scan).any()
    assert found < known - 0.05


def test_sizes_are_searched_below_their_grid_and_to_its_end():
    levels = np.array([2.0, 3.0, 4.0])
    edges = np.array([1.5, 2.345, 9.0, 0.5])

    def peaks(sizes, intensities):
        return np.where(intensities[None, :] >= edges[sizes.astype(int)][:, None], FALL, 0.0)

    sizes = np.arange(4.0)
    seen: list[float] = []
    found = lowest_intensities(
        sizes, levels, peaks(sizes, levels), peaks, start=1.0, step=STEP, alpha=ALPHA, progress=seen.append
    )
    assert found[:2] == pytest.approx([1.5, 2.345], abs=STEP / 16.0)
    assert (found[:2] >= edges[:2]).all()
    assert math.isnan(found[2])
    assert found[3] == 1.0
    assert seen == [0.25, 0.5, 0.75, 1.0]
    # where the search may not go below the grid its lowest stands
    above = lowest_intensities(sizes, levels, peaks(sizes, levels), peaks, start=5.0, step=STEP, alpha=ALPHA)
    assert above[:2].tolist() == [2.0, 3.0]


def test_an_interruption_passes_through_a_search():
    def peaks(sizes, levels):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        lowest_intensities(
            np.ones(1), np.array([2.0]), np.zeros((1, 1)), peaks, start=1.0, step=STEP, alpha=ALPHA
        )


def test_the_lowest_of_a_grid_is_the_first_that_overturns():
    tilts = np.array([[0.1, FALL, 0.1, FALL], [0.1, 0.2, 0.3, 0.4], [FALL, math.nan, 0.1, 0.1]])
    found = lowest_on_grid(np.array([1.0, 2.0, 3.0, 4.0]), tilts)
    assert found[[0, 2]].tolist() == [2.0, 1.0]
    assert math.isnan(found[1])


HAIR = 1e-6  # relative: either side of the exact threshold, far above rounding


@pytest.mark.parametrize(
    "options", [{}, {"plane": 0.0}, {"plane": 0.5 * math.pi}, {"plane": 0.7}, {"until": 3.0}]
)
def test_nothing_moves_below_the_factor_of_uplift(options):
    motion = el_centro_1940(vertical=True)
    factor = uplift_factor(motion, 0.2, 9.81, **options)
    pier = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    below, above = (
        reduced.simulate(
            Case(pier, motion.scaled(factor * near), duration=options.get("until")),
            plane=options.get("plane"),
        )
        for near in (1.0 - HAIR, 1.0 + HAIR)
    )
    assert math.isnan(below.uplift_time)
    assert math.isfinite(above.uplift_time)


def test_the_end_of_a_run_between_two_samples_counts():
    ramp = GroundMotion([[0.0, 0.0], [1.0, 0.0]], 1.0)
    assert uplift_factor(ramp, 0.1, 10.0) == pytest.approx(1.0, rel=SAME)
    assert uplift_factor(ramp, 0.1, 10.0, until=0.25) == pytest.approx(4.0, rel=SAME)
    assert uplift_factor(ramp, 0.1, 10.0, plane=0.5 * math.pi) > 1e15
