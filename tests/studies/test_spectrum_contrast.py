"""Safe gaps and overturning shares from handwritten grids."""

import dataclasses
import math

import numpy as np
import pytest
from showing import loads_as_it_was, shows_itself

from rockwobble.models import GroundMotion
from rockwobble.studies.plans import SpectrumPlan
from rockwobble.studies.spectrum import verification as bands
from rockwobble.studies.spectrum.maps import TiltMaps, safe_gaps
from rockwobble.studies.spectrum.parts import PLANAR_X, PLANAR_Y, SPATIAL
from rockwobble.studies.spectrum.search import lowest_on_grid
from rockwobble.studies.spectrum.study import spectrum_of
from rockwobble.studies.spectrum.verification import (
    edge_difference,
    planar_contrast,
    size_bands,
    unconservative_from,
)

FALL = 0.5 * math.pi
LEVELS = np.array([1.0, 2.0, 3.0, 4.0, 5.0, 6.0])


def made_up(space: list[str], x: list[str], y: list[str]) -> TiltMaps:
    """Spectrum from rows of letters, one row per size: X overturned, o tilts, O tilts more, ? failed."""
    tilts = {"X": FALL, "o": 0.01, "O": 0.02, ".": 0.0, "?": math.nan}
    peaks = {
        name: np.array([[tilts[letter] for letter in row] for row in rows])
        for name, rows in ((SPATIAL, space), (PLANAR_X, x), (PLANAR_Y, y))
    }
    levels = LEVELS[: len(space[0])]
    return TiltMaps(
        tan_alpha=0.1,
        motion=GroundMotion([[0.0, 0.0], [3.0, 4.0], [0.0, 0.0]], 0.1),
        plan=SpectrumPlan(search_step=0.1, probes=0),
        semidiagonals=np.arange(1.0, len(space) + 1.0),
        intensities=levels,
        peak_tilt=peaks,
        lowest={name: lowest_on_grid(levels, tilt) for name, tilt in peaks.items()},
        below={name: np.zeros(len(space)) for name in peaks},
        searched_from=dict.fromkeys(peaks, 1.0),
    )


def test_safe_gaps_are_standing_cells_above_the_lowest_overturning_intensity():
    spectrum = made_up(["ooXoOX", "XooXX?", "oooooo", "oXo?oX", "oXoooo"], ["......"] * 5, ["......"] * 5)
    table = safe_gaps(spectrum)
    assert set(table["series"]) == {SPATIAL}
    assert table[["semidiagonal", "lower", "upper", "closed"]].to_numpy().tolist() == [
        [1.0, 4.0, 5.0, True],
        [2.0, 2.0, 3.0, True],
        [4.0, 3.0, 3.0, True],
        [4.0, 5.0, 5.0, True],
        [5.0, 3.0, 6.0, False],
    ]
    # an island begins above a window that the grid does not see
    spectrum = made_up(["oooXo"], ["....."], ["....."])
    seen = dataclasses.replace(spectrum, lowest={**spectrum.lowest, SPATIAL: np.array([1.5])})
    assert safe_gaps(seen)[["lower", "upper", "closed"]].to_numpy().tolist() == [
        [2.0, 3.0, True],
        [5.0, 5.0, False],
    ]


def test_overturning_shares_exclude_failed_cells(monkeypatch):
    spectrum = made_up(
        space=["oXXX", "oOoX", "oooX"],
        x=["ooXX", "ooXX", "ooo?"],
        y=["oooo", "oooX", "oooo"],
    )
    monkeypatch.setattr(bands, "size_bands", lambda sizes: np.array([0.0, 2.0, 4.0]))
    contrast = planar_contrast(spectrum)
    assert contrast["cells"].tolist() == [4, 7, 11]
    first, second, every = (row for _, row in contrast.iterrows())
    assert (first["smallest"], first["largest"]) == (1.0, 1.0)
    assert (second["smallest"], second["largest"]) == (2.0, 3.0)
    assert first["overturned"] == 3 / 4
    assert first["planar_overturned"] == 2 / 4
    assert first["unconservative"] == 1 / 4
    assert first["conservative"] == 0.0
    # failed cell is excluded, although it would count as missed
    assert second["unconservative"] == 0.0
    assert second["conservative"] == pytest.approx(1 / 7)
    assert every["unconservative"] == pytest.approx(1 / 11)
    assert every["larger_tilt"] == pytest.approx(2 / 11)
    assert (every["smallest"], every["largest"]) == (1.0, 3.0)


def test_planar_overturning_boundary_is_that_of_the_worse_plane():
    spectrum = made_up(
        space=["oXXX", "oooX", "ooXX", "oooo", "oooX"],
        x=["ooXX", "ooXX", "ooXX", "oooo", "oooo"],
        y=["oooX", "oooX", "oooo", "oooo", "oooo"],
    )
    assert edge_difference(spectrum).tolist() == [-1.0, 1.0, 0.0, 0.0, -math.inf]
    assert unconservative_from(spectrum) == 5.0
    every = planar_contrast(spectrum).iloc[-1]
    assert (every["lower_edge"], every["higher_edge"]) == (2 / 5, 1 / 5)
    # 2, 3, 4, 4 and none: middle one
    assert every["lowest"] == 4.0
    assert every["planar_y_lowest"] == math.inf


def test_boundary_differences_within_resolution_are_ignored():
    spectrum = made_up(["oX"], ["oX"], ["oo"])
    for expected in (0.0, -0.18):
        spectrum.lowest[SPATIAL][0] -= 0.09
        assert edge_difference(spectrum)[0] == pytest.approx(expected)
    assert math.isnan(unconservative_from(made_up(["oX", "oX"], ["oo", "oX"], ["oo", "oo"])))
    assert unconservative_from(made_up(["oX", "oX"], ["oo", "oo"], ["oo", "oo"])) == 1.0


@pytest.mark.parametrize(
    ("smallest", "largest", "width"), [(0.5, 30.0, 5.0), (0.05, 0.9, 0.2), (2.0, 400.0, 50.0)]
)
def test_size_bands_have_round_width_and_cover_all_sizes(smallest, largest, width):
    edges = size_bands(np.array([smallest, largest]))
    assert np.diff(edges) == pytest.approx(width)
    assert edges[0] <= smallest
    assert edges[-1] >= largest
    assert 4 <= len(edges) <= 10
    edges = size_bands(np.array([largest]))  # single size
    assert edges[0] <= largest <= edges[-1]
    assert len(planar_contrast(made_up(["oX"], ["oo"], ["oo"]))) == 2


@pytest.mark.slow
def test_spectrum_has_repr_table_and_plot(tmp_path):
    maps = made_up(["ooXoOX"] * 3, ["......"] * 3, ["......"] * 3)
    spectrum = spectrum_of(maps)
    shows_itself(spectrum, "cells 18", "share that overturns in 3D ")
    loads_as_it_was(spectrum, tmp_path)
