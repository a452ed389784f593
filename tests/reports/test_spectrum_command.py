"""`rockwobble spectrum`: command, wording and picture of its page."""

from __future__ import annotations

import dataclasses
import math
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
from showing import call as command_line
from showing import is_golden

import rockwobble as rw
from rockwobble import reduced
from rockwobble.models import GroundMotion, el_centro_1940
from rockwobble.reports.figures.heat import Heat
from rockwobble.reports.figures.spectrum import picture_of
from rockwobble.reports.figures.svg import svg
from rockwobble.reports.pages import stored_page
from rockwobble.reports.pages.page import Page
from rockwobble.studies.plans import SpectrumPlan
from rockwobble.studies.spectrum.maps import TiltMaps, record_frame, safe_gaps, tilt_maps
from rockwobble.studies.spectrum.parts import PLANAR_X, SERIES, SPATIAL
from rockwobble.studies.spectrum.study import KIND, OverturningSpectrum
from rockwobble.studies.spectrum.verification import planar_contrast

call = partial(command_line, "spectrum")

# the factors on the record differ by a rounding, grown by a few passes
SAME_RUN = 1e-6
SVG_LIMIT = 500_000  # bytes; the smallest page that a slow line still loads at once
SMALL = ["--semidiagonal", "0.5:20:4", "--intensity", "1:9:8"]
TABLES = {"spectrum", "record", "lowest", "gaps", "contrast", "checked"}


@pytest.mark.slow
def test_spectrum_command_prints_writes_and_redraws_its_results(tmp_path: Path, capsys):
    (tmp_path / "kept.txt").write_text("mine")
    coarse = ["--search-step", "0.4", "--probes", "3"]
    assert call(*SMALL, *coarse, "--tan-alpha", "0.2", "--out", str(tmp_path)) == 0
    printed = " ".join(capsys.readouterr().out.split())
    assert "b = " not in printed  # no b, as sizes differ
    written = {"spectrum.html", "spectrum.json", "manifest.json"} | {f"{name}.parquet" for name in TABLES}
    assert {path.name for path in tmp_path.iterdir()} == written | {"kept.txt", "finished"}
    loaded = OverturningSpectrum.load(tmp_path).maps
    sizes, levels = np.linspace(0.5, 20.0, 4), np.linspace(1.0, 9.0, 8)
    assert np.array_equal(loaded.semidiagonals, sizes)
    peaks = reduced.peak_tilts(
        sizes, 0.2, el_centro_1940(), levels * 9.81 * 0.2 / el_centro_1940().peak, rtol=1e-8
    )
    assert loaded.peak_tilt[SPATIAL] == pytest.approx(peaks, rel=SAME_RUN)
    lowest = pd.read_parquet(tmp_path / "lowest.parquet")
    assert lowest["confirmed"].any()
    assert (lowest["intensity"] <= lowest["on_grid"].fillna(np.inf)).sum() >= 6
    assert stored_page(KIND, tmp_path).html().encode() == (tmp_path / "spectrum.html").read_bytes()


@pytest.mark.slow
def test_spectrum_command_accepts_any_record(tmp_path: Path, monkeypatch):
    monkeypatch.setattr(Page, "files", lambda _, **__: {})  # other tests draw a page
    time = np.arange(0.0, 3.0, 0.02)
    for name, phase in (("x.csv", 0.0), ("y.csv", 1.0)):
        rows = "\n".join(f"{t:.2f}, {0.3 * np.sin(5.0 * t + phase) * (t < 2.0):.6f}" for t in time)
        (tmp_path / name).write_text(f"time [s], acceleration [g]\n{rows}\n")
    records = ["--record-x", str(tmp_path / "x.csv"), "--record-y", str(tmp_path / "y.csv")]
    assert call(*SMALL, *records, "--out", str(tmp_path / "out")) == 0
    table = OverturningSpectrum.load(tmp_path / "out").findings().to_frame()
    assert list(table.loc[table["name"] == "intensity_step", "value"]) == [0.015]
    cells = pd.read_parquet(tmp_path / "out" / "spectrum.parquet")
    assert cells["overturned"].any()
    assert not cells["peak_tilt"].isna().any()


@pytest.fixture(scope="module")
def spectrum() -> TiltMaps:
    whole = el_centro_1940()
    grid = {"semidiagonals": np.linspace(0.5, 30.0, 12), "intensities": np.linspace(1.0, 12.0, 12)}
    motion = GroundMotion(whole.acceleration[:1500], whole.time_step, whole.name)
    return tilt_maps(0.1, motion, SpectrumPlan(**grid, search_step=0.2, probes=5))


@pytest.mark.slow
def test_page_matches_golden_file():
    levels = {"semidiagonals": [1.0, 20.0], "intensities": [0.9, 4.0]}
    is_golden(rw.spectrum(0.1, el_centro_1940(), **levels, search_step=0.2, probes=9, workers=1))


Numbers = dict[str, dict[str, Any]]


def numbers(maps: TiltMaps, checked: pd.DataFrame | None = None, **columns: object) -> Numbers:
    """Numbers of the findings by key; `columns` replace columns of the table of lowest intensities."""
    lowest = maps.lowest_frame().assign(**({"confirmed": True} | columns))
    tables = {"lowest": lowest, "gaps": safe_gaps(maps), "contrast": planar_contrast(maps)}
    tables["checked"] = pd.DataFrame({"agrees": [True], "sensitive": [False]}) if checked is None else checked
    tables |= {"spectrum": maps.to_frame(), "record": record_frame(maps.motion)}
    spectrum = OverturningSpectrum(tables=tables, facts=maps.facts())
    return {
        each.key.removeprefix("spectrum."): {name: value for name, value, _ in each.quantities()}
        for each in spectrum.findings()
    }


def test_headline_counts_missed_overturning_without_failed_cells(spectrum):
    falls = {name: spectrum.overturned(name) for name in SERIES}
    planar = falls["planar_x"] | falls["planar_y"]
    shares = (falls[SPATIAL] & ~planar).mean(), (planar & ~falls[SPATIAL]).mean()
    assert all(0.01 < share < 0.1 for share in shares)
    values = numbers(spectrum)["overturned"]
    assert (values["share_unconservative"], values["share_conservative"]) == shares
    assert (values["share"], values["count"]) == (falls[SPATIAL].mean(), 144)
    tilt = spectrum.peak_tilt[PLANAR_X].copy()
    tilt[3, 4] = tilt[5, 6] = np.nan
    without = numbers(dataclasses.replace(spectrum, peak_tilt={**spectrum.peak_tilt, PLANAR_X: tilt}))
    assert (without["overturned"]["count"], without["failed"]["count"]) == (142, 2)
    every = {**spectrum.peak_tilt, PLANAR_X: np.full_like(tilt, np.nan)}
    assert [*numbers(dataclasses.replace(spectrum, peak_tilt=every))] == ["unsolved"]


def test_size_bands_where_planar_analysis_is_unconservative_are_listed(spectrum):
    bands = planar_contrast(spectrum).iloc[:-1]
    wrong = bands[bands["unconservative"] > bands["conservative"]]
    assert 0 < len(wrong) < len(bands)
    listed = tuple(f"{band.smallest:.3g} to {band.largest:.3g} m" for band in wrong.itertuples())
    assert numbers(spectrum)["unconservative"]["names"] == listed


def test_a_spectrum_without_overturning_says_how_it_was_searched(spectrum):
    still = {name: np.zeros_like(tilt) for name, tilt in spectrum.peak_tilt.items()}
    none = {name: np.full_like(lowest, np.nan) for name, lowest in spectrum.lowest.items()}
    values = numbers(dataclasses.replace(spectrum, peak_tilt=still, lowest=none))
    assert values["overturned"]["share"] == 0.0
    assert values["search"] == {"intensity": 1.0, "intensity_step": 0.2}
    assert not {"gaps", "boundary"} & {*values}


def with_safe(maps: TiltMaps, cells: list[tuple[int, int]]) -> TiltMaps:
    """Spectrum overturned from the fourth intensity on, except in some cells."""
    tilt = np.full((12, 12), math.inf)
    tilt[:, :3] = 0.1
    for cell in cells:
        tilt[cell] = 0.1
    edge = np.full(12, maps.intensities[3])
    peaks, lowest = {**maps.peak_tilt, SPATIAL: tilt}, {**maps.lowest, SPATIAL: edge}
    return dataclasses.replace(maps, peak_tilt=peaks, lowest=lowest)


def test_gaps_are_counted_with_the_range_of_the_widest(spectrum):
    stated = ("count", "count_sizes", "count_all", "intensity", "intensity_end")
    for cells, count, end in (([(2, 5)], 1, 6.0), ([(2, 5), (2, 6), (4, 8)], 2, 7.0)):
        gaps = numbers(with_safe(spectrum, cells))["gaps"]
        assert [gaps[name] for name in stated] == [count, count, 12, 6.0, end]


def test_search_finding_states_missed_windows_and_sensitive_cells(spectrum):
    none = dataclasses.replace(spectrum, below={name: np.zeros(12) for name in SERIES})
    count = int(np.isfinite(spectrum.lowest[SPATIAL]).sum())
    values = numbers(none, on_grid=none.lowest_frame()["intensity"] + 0.5)  # less than a grid step of 1
    # 0 of 5 draws: below 1 - 0.05^(1/5)
    assert values["probes"]["share"] == pytest.approx(1.0 - 0.05**0.2)
    assert values["unseen"] == {"count": 0, "count_all": count}
    assert "chance" not in values
    confirmed = np.ones(36, dtype=bool)
    confirmed[[0, 3]] = False
    chance = numbers(none, confirmed=confirmed)["chance"]
    assert (chance["count"], chance["length"], chance["length_end"]) == (2, *spectrum.semidiagonals[[0, 3]])


def test_verification_distinguishes_sensitive_from_wrong_cells(spectrum):
    cells = pd.DataFrame({"agrees": [True, False, False], "sensitive": [False, True, False]})
    values = numbers(spectrum, cells)["checked"]
    assert [values[f"count{name}"] for name in ("", "_agree", "_chance", "_other")] == [3, 1, 1, 1]


@pytest.mark.slow
def test_picture_is_small_and_explains_empty_cells(spectrum):
    picture = picture_of(spectrum)
    assert len(svg(picture)) < SVG_LIMIT
    space = next(layer for layer in picture.panels[0].layers if isinstance(layer, Heat))
    fell, still, failed = (gap.cells for gap in space.gaps)
    assert np.array_equal(fell.T, spectrum.overturned(SPATIAL))
    assert np.array_equal(np.isnan(space.values), fell | still | failed)


@pytest.mark.slow
@pytest.mark.parametrize("still", [0, 1])
def test_a_record_of_one_component_has_a_picture_and_a_page(still):
    acceleration = np.array(el_centro_1940().acceleration[:1500])  # with the strongest shaking
    acceleration[:, still] = 0.0
    motion = GroundMotion(acceleration, 0.01, "one component")
    plan = SpectrumPlan(semidiagonals=[1.0, 8.0], intensities=[0.5, 4.0, 9.0], search_step=1.0, probes=0)
    maps = tilt_maps(0.1, motion, plan)
    assert not maps.peak_tilt[SERIES[1 + still]].any()
    picture = picture_of(maps)
    assert still or svg(picture)  # planes differ by their position only
    # planar run equals the 3D run
    assert numbers(maps)["overturned"]["share_unconservative"] == 0.0
