"""Search for the lowest overturning intensity, between the steps of a grid and below it."""

from __future__ import annotations

import math
import threading
import time

import numpy as np
import pytest

from rockwobble import reduced
from rockwobble.compare.metrics.pair import overturned
from rockwobble.models import Case, Cylinder, GroundMotion, el_centro_1940
from rockwobble.models.cpus import in_threads
from rockwobble.studies.plans import STEP
from rockwobble.studies.spectrum.parts import uplift_factor
from rockwobble.studies.spectrum.search import (
    gap_bound,
    lowest_on_grid,
    probe_below,
    run_searches,
    search_lowest,
)

FALL = 0.5 * math.pi
ALPHA = 0.1
EL_CENTRO = el_centro_1940()
UNIT = 9.81 * 0.1 / EL_CENTRO.peak  # factor on the record for an intensity of 1 at tan(alpha) = 0.1
SAME = 1e-12  # rounding of the intensities


class Window:
    """Peak tilts about one overturning window, with a record of all intensities asked for."""

    def __init__(self, centre: float, width: float, flank: float) -> None:
        self.centre, self.width, self.flank = centre, width, flank
        self.run: list[float] = []

    def __call__(self, levels: np.ndarray) -> np.ndarray:
        self.run += levels.tolist()
        away = np.abs(levels - self.centre) - 0.5 * self.width
        # tilt grows logarithmically towards a window, as the balance is left exponentially
        beside = 0.3 - 0.1 * np.log(np.maximum(np.abs(away), 1e-9) / self.flank)
        return np.where(away <= 0.0, FALL, ALPHA * np.clip(beside, 0.3, 0.999))


def search(window, start: float, grid: np.ndarray, known: np.ndarray | None = None) -> float:
    """Result of the search for the lowest overturning intensity of one cylinder."""
    known = window(grid) if known is None else known
    going = search_lowest(grid, known, start=start, step=STEP, alpha=ALPHA)
    return run_searches([going], lambda _, levels: window(levels), workers=1)[0]


GRID = np.linspace(1.0, 4.0, 28)


@pytest.mark.parametrize("centre", [1.3152, 1.5037, 2.7182])
def test_an_overturning_window_narrower_than_the_grid_is_found(centre):
    window = Window(centre, 0.015, 0.3)
    lowest = search(window, 1.0, GRID)
    assert abs(lowest - centre) <= 0.0075
    run = np.array(window.run)
    assert not overturned(window(run[run < lowest])).any()
    assert lowest - run[run < lowest].max() <= STEP * (1.0 + SAME)


def test_coarse_grid_is_refined_and_never_exceeded():
    far = Window(9.0, 0.1, 0.02)
    assert math.isnan(search(far, 1.003, np.array([0.5, 3.5]), known=np.zeros(2)))
    run = np.sort(far.run)
    assert run[0] > 1.003  # cylinder stands there
    assert np.diff([1.003, *run, 3.5]).max() <= 8.0 * STEP * (1.0 + SAME)
    far.run.clear()
    for start in (5.0, math.inf):
        assert math.isnan(search(far, start, GRID, known=np.zeros(28)))
    assert far.run == []


def test_failed_run_counts_as_standing_and_hides_only_its_step():
    window = Window(1.5003, 0.02, 0.3)

    def partly(levels: np.ndarray) -> np.ndarray:
        return np.where((levels > 1.25) & (levels < 1.35), math.nan, window(levels))

    assert 0.0 <= search(partly, 1.0, GRID) - 1.4903 <= STEP


def test_parallel_searches_equal_separate_searches():
    edges = np.array([1.5, 2.345, 9.0, 0.5])

    def peaks(i: int, levels: np.ndarray) -> np.ndarray:
        return np.where(levels >= edges[i], FALL, 0.0)

    known = np.where(edges[:, None] <= GRID, FALL, 0.0)
    options = {"start": 1.0, "step": STEP, "alpha": ALPHA}
    results = run_searches([search_lowest(GRID, each, **options) for each in known], peaks, workers=1)
    alone = [search(lambda levels, e=e: np.where(levels >= e, FALL, 0.0), 1.0, GRID) for e in edges]
    assert np.array_equal(results, alone, equal_nan=True)
    assert all(0.0 <= low - edge <= STEP for low, edge in zip(results[:2], edges[:2], strict=True))
    assert math.isnan(results[2])
    for start, grid, known in ((1.0, [1.2345, 3.0], 1.2345), (2.0, [1.0, 2.0], 2.0)):
        # known overturning ends a search
        assert search(lambda levels: np.where(levels >= 1.2345, FALL, 0.0), start, np.array(grid)) == known


@pytest.mark.parametrize("stands", [True, False])
def test_search_runs_its_start_unless_it_is_known_to_stand(stands: bool):
    run: list[float] = []

    def still(_: int, levels: np.ndarray) -> np.ndarray:
        run.extend(levels.tolist())
        return np.zeros_like(levels)

    going = search_lowest(np.array([2.0]), np.zeros(1), start=1.0, step=STEP, alpha=ALPHA, stands=stands)
    run_searches([going], still)
    assert (1.0 in run) is not stands


def test_thread_count_is_the_number_of_usable_processors(monkeypatch):
    monkeypatch.setattr("rockwobble.models.cpus.usable_cpus", lambda: 1)

    def thread(_: int) -> int:
        time.sleep(0.001)  # long enough for a second thread to take the next
        return threading.get_ident()

    assert len(set(in_threads(thread, range(20)))) == 1


def test_an_interruption_passes_through_a_search():
    def peaks(i: int, levels: np.ndarray) -> np.ndarray:
        raise KeyboardInterrupt

    going = search_lowest(np.array([2.0]), np.zeros(1), start=1.0, step=STEP, alpha=ALPHA)
    with pytest.raises(KeyboardInterrupt):
        run_searches([going], peaks)


def test_probes_go_down_until_none_overturns():
    def third(_: int, levels: np.ndarray) -> np.ndarray:
        return np.where(10.0 * levels % 1.0 < 1.0 / 3.0, FALL, 0.0)

    # lowest third, down to the first window, regardless of earlier results
    for lowest in (2.0, math.nan):
        low, missed = run_searches([probe_below(1.0, 4.0, lowest, probes=500, seed=(1,))], third, workers=1)[
            0
        ]
        assert 1.0 < low < 1.0 + 1.0 / 500
        assert missed > 100
    assert run_searches([probe_below(2.0, 4.0, 1.0, probes=9, seed=(0,))], third)[0] == (1.0, 0)
    assert run_searches([probe_below(1.0, 4.0, 2.0, probes=0, seed=(0,))], third)[0] == (2.0, 0)
    # share that this many draws miss
    assert (1.0 - gap_bound(500)) ** 500 == pytest.approx(0.05)


@pytest.mark.slow
@pytest.mark.parametrize(("width", "chance"), [(2.0 / 500, 1.0), (0.5 / 500, 0.5), (0.1 / 500, 0.1)])
def test_narrow_gaps_are_found_at_the_stated_rate(width: float, chance: float):
    """One probe lies in each of 500 parts: its chance to hit a gap inside equals the gap's share."""
    trials, hits = 200, 0
    for seed in range(trials):
        centre = 1.0 + np.random.default_rng(seed).uniform(0.1, 0.9)

        def gap(_: int, levels: np.ndarray, centre: float = centre) -> np.ndarray:
            return np.where((np.abs(levels - centre) < 0.5 * width) | (levels >= 2.0), FALL, 0.0)

        low, missed = run_searches([probe_below(1.0, 3.0, 2.0, probes=500, seed=(seed,))], gap, workers=1)[0]
        assert (missed > 0) == (low < 2.0)
        assert low == 2.0 or abs(low - centre) < 0.5 * width
        hits += low < 2.0
    # four standard deviations of a share of that many trials
    assert hits / trials == pytest.approx(
        chance, abs=4.0 * math.sqrt(chance * (1.0 - chance) / trials) + SAME
    )


def test_search_detects_windows_missed_by_a_grid():
    def peaks(levels: np.ndarray) -> np.ndarray:
        return reduced.peak_tilts([3.177], 0.1, EL_CENTRO, UNIT * levels, rtol=1e-8)[0]

    # at this size the lowest of a grid of 100 intensities is 1.667
    grid = np.linspace(1.0, 12.0, 100)[:8]
    known = lowest_on_grid(grid, peaks(grid)[None])[0]
    lowest = search(peaks, 1.0, grid)
    assert overturned(peaks(np.array([lowest]))).all()
    assert lowest < known - 0.05


def test_the_lowest_of_a_grid_is_the_first_that_overturns():
    tilts = np.array([[0.1, FALL, 0.1, FALL], [0.1, 0.2, 0.3, 0.4], [FALL, math.nan, 0.1, 0.1]])
    lowest = lowest_on_grid(np.array([1.0, 2.0, 3.0, 4.0]), tilts)
    assert lowest[[0, 2]].tolist() == [2.0, 1.0]
    assert math.isnan(lowest[1])


HAIR = 1e-6  # relative: either side of the exact threshold, far above rounding


@pytest.mark.parametrize("options", [{}, {"plane": 0.5 * math.pi}, {"plane": 0.7}, {"until": 3.0}])
def test_cylinder_stays_at_rest_below_the_uplift_factor(options):
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
