"""The table and the sentences of a spectrum, from one whose every number is known."""

from __future__ import annotations

import dataclasses
import xml.etree.ElementTree as ET

import numpy as np
import pandas as pd
import pytest

from rockwobble.compare.studies.spectrum.planar_contrast import planar_contrast
from rockwobble.compare.studies.spectrum.series import PLANAR_X, SERIES, SPATIAL
from rockwobble.compare.studies.spectrum.study import OverturningSpectrum, overturning_spectrum
from rockwobble.compare.studies.spectrum.verification import confirm_lowest
from rockwobble.models import GroundMotion, el_centro_1940
from rockwobble.reports.console.spectrum_progress import shown_fraction
from rockwobble.reports.figures.spectrum_figure import spectrum_figure
from rockwobble.reports.pages.spectrum.page import spectrum_page
from rockwobble.reports.pages.spectrum.words import (
    HEADINGS,
    check_statement,
    search_statement,
    statements,
    table_cells,
)

SVG_LIMIT = 500_000  # bytes; the smallest page that a slow line still loads at once


@pytest.fixture(scope="module")
def spectrum() -> OverturningSpectrum:
    return overturning_spectrum(
        0.1,
        el_centro_1940(),
        semidiagonals=np.linspace(0.5, 30.0, 12),
        intensities=np.linspace(1.0, 12.0, 12),
        search_step=0.2,
    )


def forged(spectrum: OverturningSpectrum, **tilts: np.ndarray) -> OverturningSpectrum:
    return dataclasses.replace(spectrum, peak_tilt={**spectrum.peak_tilt, **tilts})


def test_the_headline_counts_what_is_missed(spectrum):
    falls = {name: spectrum.overturned(name) for name in SERIES}
    planar = falls["planar_x"] | falls["planar_y"]
    missed = 100.0 * (falls[SPATIAL] & ~planar).mean()
    overcalled = 100.0 * (planar & ~falls[SPATIAL]).mean()
    assert missed > 0.0
    assert overcalled > 0.0
    headline = statements(spectrum)[0]
    assert f"unconservative in {missed:.1f} % of the cells" in headline
    assert f"conservative in {overcalled:.1f} %" in headline
    assert f"{100.0 * falls[SPATIAL].mean():.1f} % of 144 cells" in headline


def test_failed_cells_are_named_and_left_out(spectrum):
    tilt = spectrum.peak_tilt[PLANAR_X].copy()
    tilt[3, 4] = tilt[5, 6] = np.nan
    said = statements(forged(spectrum, planar_x=tilt))
    assert said[-1] == "2 cells could not be solved and are left out."
    assert "of 142 cells" in said[0]
    every = np.full_like(tilt, np.nan)
    assert statements(forged(spectrum, planar_x=every)) == ["No cell could be solved."]


def test_a_spectrum_without_overturning_says_no_more_than_that(spectrum):
    still = {name: np.zeros_like(tilt) for name, tilt in spectrum.peak_tilt.items()}
    none = {name: np.full_like(lowest, np.nan) for name, lowest in spectrum.lowest.items()}
    said = statements(dataclasses.replace(forged(spectrum, **still), lowest=none))
    assert len(said) == 1
    assert "overturns in 0.0 % of 144 cells" in said[0]


def test_the_table_has_a_row_for_each_band_and_one_for_all(spectrum):
    contrast = planar_contrast(spectrum)
    rows = table_cells(contrast)
    assert len(rows) == len(contrast)
    assert all(len(row) == len(HEADINGS) for row in rows)
    assert rows[-1][0] == "all, 0.5 to 30"
    assert rows[0][HEADINGS.index("missed [%]")] == f"{100.0 * contrast['missed'].iloc[0]:.1f}"
    # the north-south component overturns no large cylinder
    assert rows[-2][HEADINGS.index("lowest planar NS")] == "-"


def checked(agrees: list[bool], sensitive: list[bool]) -> pd.DataFrame:
    return pd.DataFrame({"agrees": agrees, "sensitive": sensitive})


def test_the_check_tells_chance_from_error():
    assert check_statement(checked([True, True], [False, True])).endswith(
        ", 2 agree to 2 % of the peak tilt."
    )
    mixed = check_statement(checked([True, False, False], [False, True, False]))
    assert "Of 3 cells" in mixed
    assert "1 agree" in mixed
    assert "1 is a matter of chance" in mixed
    assert mixed.endswith("1 does not.")


def test_the_search_says_its_steps_and_what_is_chance(spectrum):
    table = spectrum.lowest_frame()
    space = table["series"] == SPATIAL
    table["on_grid"] = table["intensity"] + 0.5  # less than a step of the grid, 1
    table.loc[table.index[space][:2], "on_grid"] = np.nan
    table["confirmed"] = True
    said = search_statement(spectrum, table)
    assert (
        "from the threshold of uplift up (1 g tan alpha in 3D), in steps of 0.2, down to a sixteenth" in said
    )
    assert "a narrower window of overturning may lie in between" in said
    found = int(np.isfinite(spectrum.lowest[SPATIAL]).sum())
    assert f"Of {found} sizes that overturn in 3D 2 do so more than a step of the grid below" in said
    assert said.endswith("All overturn again at a tolerance of 1e-09.")
    table.loc[table.index[space][[0, 3]], "confirmed"] = False
    sizes = spectrum.semidiagonals[[0, 3]]
    said = search_statement(spectrum, table)
    assert f"2, with R from {sizes[0]:.3g} to {sizes[1]:.3g} m, are a matter of chance" in said


def test_a_spectrum_in_which_nothing_overturns_says_how_it_was_searched(spectrum):
    table = spectrum.lowest_frame().assign(intensity=np.nan, confirmed=False)
    assert search_statement(spectrum, table).endswith("window of overturning may lie in between.")


def test_the_picture_is_small_valid_and_the_same_each_time(spectrum):
    picture = spectrum_figure(spectrum)
    assert ET.fromstring(picture).tag.endswith("svg")
    assert len(picture) < SVG_LIMIT
    assert picture == spectrum_figure(spectrum)


def test_the_picture_shows_other_tilts_otherwise(spectrum):
    tilt = spectrum.peak_tilt[SPATIAL].copy()
    tilt[2, 2] = np.nan
    assert spectrum_figure(forged(spectrum, **{SPATIAL: tilt})) != spectrum_figure(spectrum)


@pytest.mark.parametrize("still", [0, 1])
def test_a_record_of_one_component_has_a_picture_and_a_page(still):
    acceleration = np.array(el_centro_1940().acceleration)
    acceleration[:, still] = 0.0
    motion = GroundMotion(acceleration, 0.01, "one component")
    spectrum = overturning_spectrum(
        0.1, motion, semidiagonals=[1.0, 8.0], intensities=[0.5, 4.0, 9.0], search_step=1.0
    )
    assert not spectrum.peak_tilt[SERIES[1 + still]].any()
    assert ET.fromstring(spectrum_figure(spectrum)).tag.endswith("svg")
    page = spectrum_page(spectrum, checked([True], [False]), confirm_lowest(spectrum))
    # the planar run is the 3D run
    assert "unconservative in 0.0 % of the cells" in page
    assert page.count("|") > 40


def test_progress_is_told_in_lines_where_there_is_no_terminal(capsys):
    with shown_fraction(["first", "second"]) as tell:
        tell("first", 0.5)
        tell("second", 1.0)
    assert capsys.readouterr().err == "second: 100 % done, about 0 s left\n"
