"""Grids of runs: the same as single runs, whatever the number of threads."""

import math

import numpy as np
import pytest

from rockwobble import reduced
from rockwobble.models import Cylinder, GroundMotion, el_centro_1940

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
