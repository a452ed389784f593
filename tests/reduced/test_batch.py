"""Grids of runs: equal to single runs, whatever the number of threads."""

import math

import numpy as np
import pytest

from rockwobble import reduced
from rockwobble.models import Case, Cylinder, GroundMotion, WobblingFrame, el_centro_1940

EL_CENTRO = el_centro_1940()
SIZES = np.array([0.8, 3.0, 10.0])
SCALES = np.linspace(0.3, 4.0, 12)


def test_peaks_are_the_same_bits_for_any_number_of_threads():
    one = reduced.peak_tilts(SIZES, 0.1, EL_CENTRO, SCALES, workers=1)
    four = reduced.peak_tilts(SIZES, 0.1, EL_CENTRO, SCALES, workers=4)
    assert np.array_equal(one, four)


def test_progress_ends_at_one_and_an_interruption_passes_through():
    seen = []
    reduced.peak_tilts(SIZES, 0.1, EL_CENTRO, [0.1], progress=seen.append)
    assert seen == sorted(seen)
    assert (seen[-1], len(seen)) == (1.0, len(SIZES))

    def interrupt(fraction):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        reduced.peak_tilts(SIZES, 0.1, EL_CENTRO, SCALES, progress=interrupt)


# Size [m] and peak of the resultant over g tan(alpha): small cylinders just above uplift. Undamped they rock
# hundreds of times a second to the end of the record: some 30 to 350 steps a sample, for which a third of the
# record suffices.
BEGINNING = GroundMotion(EL_CENTRO.acceleration[:1800], EL_CENTRO.time_step)
BARELY_LIFTED = [
    ("recess", 0.1, 0.5, 1.01727),
    ("recess", 0.3, 0.2, 1.00962),
    ("flat", 0.1, 0.5, 1.01727),
    ("flat", 0.1, 0.161, 1.00962),
]


@pytest.mark.slow
@pytest.mark.parametrize(("model", "tan_alpha", "size", "intensity"), BARELY_LIFTED)
def test_a_cell_that_chatters_is_its_single_run_to_the_bit(model, tan_alpha, size, intensity):
    scale = intensity * 9.81 * tan_alpha / BEGINNING.peak
    peaks = reduced.peak_tilts([size], tan_alpha, BEGINNING, [scale], **reduced.MODELS[model])
    cylinder = Cylinder(semidiagonal=size, tan_alpha=tan_alpha)
    single = reduced.simulate(Case(cylinder, BEGINNING.scaled(scale)), rtol=1e-7, **reduced.MODELS[model])
    assert single.step_count > 10 * len(BEGINNING.acceleration)
    assert 0.0 < peaks[0, 0] == single.peak_tilt < 0.01 * cylinder.alpha


@pytest.mark.parametrize("model", ["recess", "flat", "planar"])
@pytest.mark.parametrize(("slab", "length"), [(0.0, 0.0), (1.5, 0.002)])
def test_every_cell_is_its_single_run_to_the_bit(model, slab, length):
    # factors that round, an azimuth that rounds, more tasks than threads
    sizes, scales = np.geomspace(0.3, 40.0, 5), np.linspace(0.31, 1.7, 7) / 3.0
    turned = EL_CENTRO.rotated(0.3)
    method = {"plane": 0.7} if model == "planar" else reduced.MODELS[model]
    stated = {"slab_mass_ratio": slab, "rolling_resistance": length}
    peaks = reduced.peak_tilts(sizes, 0.1, turned, scales, **method, **stated, workers=2)

    def single(size, scale):
        body = WobblingFrame(Cylinder(semidiagonal=size, tan_alpha=0.1), slab)
        case = Case(body, turned.scaled(scale), rolling_resistance=length)
        return reduced.simulate(case, rtol=1e-7, **method).peak_tilt

    assert np.array_equal(peaks, [[single(size, scale) for scale in scales] for size in sizes])


@pytest.mark.parametrize(
    ("sizes", "scales", "words"),
    [
        ([[1.0]], [1.0], "semidiagonals"),
        ([1.0], [-1.0], "scales"),
        ([0.0], [1.0], "semidiagonal"),
        ([*300 * [1.0], math.nan], [1.0], "semidiagonals .* got nan at index 300$"),
        ([1.0], 300 * ["a"], "scales .* got 300 items$"),
    ],
)
def test_bad_axes_are_refused_by_name(sizes, scales, words):
    with pytest.raises(ValueError, match=words) as caught:
        reduced.peak_tilts(sizes, 0.1, EL_CENTRO, scales)
    assert len(str(caught.value)) <= 110
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("push", "length", "weight"),
    [(3.4, 2.0, 1.0), (3.3, 2.0, 0.1), (3.8, 2.5, -0.1)],
    ids=["later shaking", "a tenth of the weight", "ground that falls faster than g"],
)
def test_a_fall_that_later_shaking_stops_is_not_called_certain(push, length, weight):
    # falls that would be certain under half of the shaking or under the whole weight; the loss at the landing
    # lets a cylinder that returns stand
    pier = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    times = np.array([0.0, 0.5, 1.0, 2.0, 2.25, 2.25 + length, 2.5 + length, 10.0])
    at = 0.25 * np.arange(41)
    options = {"plane": 0.0, "rtol": 1e-9, "rest_tilt": 1e-4, "restitution": 0.6}
    back = 0
    for strength in np.arange(0.1, 3.0, 0.1):
        along = 9.81 * 0.2 * np.array([0.0, -push, 0.0, 0.0, strength, strength, 0.0, 0.0])
        up = (weight - 1.0) * 9.81 * np.array([0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0])
        columns = [np.interp(at, times, values) for values in (along, 0.0 * along, up)]
        record = GroundMotion(np.column_stack(columns), 0.25)
        whole = reduced.simulate(Case(pier, record), sample_step=1.0, **options)
        # half of the record times a scale of two: equal numbers, with a scale in the batch
        early = reduced.peak_tilts([6.0], 0.2, record.scaled(0.5), [2.0], workers=1, **options)[0, 0]
        assert early == pytest.approx(whole.peak_tilt, abs=1e-12 * pier.alpha), strength
        back += whole.outcome != "overturned" and whole.peak_tilt > pier.alpha
    assert back > 0
