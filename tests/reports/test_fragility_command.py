"""`rockwobble fragility`: from the command line to the files, the page and its figures."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
from browser import complaints, needs_chromium
from fragility_example import LEVELS, MOTIONS, made_up
from showing import call, loads_as_it_was, shows_itself

from rockwobble import fragility
from rockwobble.compare.storage.manifest import read_manifests
from rockwobble.models import Cylinder, synthetic_motions
from rockwobble.reports.figures.fragility import pictures
from rockwobble.reports.figures.picture import Band, Line
from rockwobble.reports.pages import page_of, stored_page
from rockwobble.reports.pages.page import Page
from rockwobble.studies import Fragility
from rockwobble.studies.fragility.study import KIND, fragility_of, main_contrasts

PIER = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
SMALL = [
    "--synthetic",
    "8",
    "--levels",
    "1.5:8:5",
    "--resamples",
    "40",
    "--model",
    "recess",
    "--workers",
    "1",
]


@pytest.fixture(scope="module")
def study() -> Fragility:
    return made_up()


@pytest.mark.slow
def test_main_contrasts_are_grouped_by_question(study):
    pairs = {
        question: [f"{row['method']} / {row['against']}" for row in rows if row["cylinder"] == "pier"]
        for question, rows in main_contrasts(study).items()
    }
    assert pairs == {
        "planar": ["planar x / recess model"],
        "support": [
            *(
                "flat-ground model / recess model",
                "mujoco flat / mujoco recess",
                "mujoco ring / mujoco recess",
            )
        ],
        "engine": [
            *("mujoco recess / recess model", "pybullet recess / recess model"),
            *("mujoco flat / flat-ground model", "pybullet recess / mujoco recess"),
        ],
    }


def test_reversed_pairs_are_inverted(study):
    order = ["planar x", "recess model"]
    runs = pd.concat([study.runs[study.runs["method"] == name] for name in order])
    turned = main_contrasts(fragility_of(runs, study.points, study.facts))["planar"][0]
    straight = main_contrasts(study)["planar"][0]
    assert (turned["method"], turned["against"]) == ("planar x", "recess model")
    for name in ("ratio", "ratio_low", "ratio_high", "dispersion_difference"):
        assert turned[name] == pytest.approx(straight[name], rel=1e-9)


def test_the_curves_have_bands_and_counts_in_a_panel_for_each_support(study):
    ratios, pier, _ = pictures(study)
    assert [panel.title for panel in ratios.panels] == ["Mean of all cylinders"]
    supports = ["Planar analysis", "Ideal recess", "Flat ground", "Recess with clearance"]
    assert [panel.title for panel in pier.panels] == supports
    recess = pier.panels[1]
    lines = [layer for layer in recess.layers if isinstance(layer, Line) and layer.name]
    assert [line.name for line in lines] == ["recess model", "mujoco recess", "pybullet recess"]
    assert sum(isinstance(layer, Band) for layer in recess.layers) == 3
    marks = next(layer for layer in recess.layers if isinstance(layer, Line) and layer.notes)
    counts = study.counts.query("cylinder == 'pier' and method == 'recess model' and limit == 'overturned'")
    np.testing.assert_allclose(marks.x, LEVELS)
    np.testing.assert_allclose(marks.y, counts["k"] / MOTIONS)
    assert marks.notes[0] == f"recess model: {counts['k'].iloc[0]} of 15"


@pytest.mark.slow
@needs_chromium
def test_the_page_is_drawn_quiet_and_no_wider_than_the_window(study, tmp_path):
    page = page_of(study).html()
    assert complaints(page, tmp_path, figures=1 + 2 * 4) == []


@pytest.mark.slow
def test_small_fragility_writes_files_and_redraws_its_page(tmp_path, capsys):
    cylinders = ["--cylinder", "pier=6,0.2", "--cylinder", "column=3,0.15"]
    assert call("fragility", *SMALL, *cylinders, "--out", str(tmp_path)) == 0
    printed = " ".join(capsys.readouterr().out.split())
    assert "tan α = 0.15" in printed
    (manifest,) = read_manifests(tmp_path)
    assert (manifest.kind, manifest.seeds) == (KIND, {"seed": 0})
    assert stored_page(KIND, tmp_path).files(document=False) == {
        name: (tmp_path / name).read_bytes() for name in manifest.pages
    }
    counts = pd.read_csv(tmp_path / "counts.csv")
    assert counts.to_dict("records") == json.loads((tmp_path / "counts.json").read_text())
    levels = sorted(set(counts["intensity"]))
    # evenly in the logarithm
    assert levels == pytest.approx(np.geomspace(1.5, 8.0, 5).tolist())
    stored = Fragility.load(tmp_path)
    pd.testing.assert_frame_equal(
        stored.fits, fragility_of(stored.runs, stored.points, stored.facts).fits, check_exact=True
    )


@pytest.mark.slow
def test_cloud_uses_the_chosen_intensity_measure(tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(Page, "files", lambda *_, **__: {})  # the test above draws a page
    options = ["--synthetic", "8", "--scale", "3,6", "--measure", "pgv", "--model", "worse-plane"]
    assert call("fragility", *options, "--resamples", "20", "--workers", "1", "--out", str(tmp_path)) == 0
    assert "as they are" in " ".join(capsys.readouterr().out.split())
    counts = pd.read_csv(tmp_path / "counts.csv")
    assert set(counts["measure"]) == {"pgv"}
    assert set(counts["n"]) == {1}
    assert set(counts["method"]) == {"planar x", "planar y", "worse plane"}


@pytest.mark.slow
def test_pages_are_drawn_for_scales_and_without_an_overturning_limit() -> None:
    options: dict[str, Any] = {"methods": ["recess"], "resamples": 2, "workers": 1}
    motions = synthetic_motions(4, peak=1.0, seed=1)
    cloud = fragility(PIER, motions, scales=[2.0, 6.0], **options)
    assert cloud.counts.loc[cloud.counts["limit"] == "overturned", "n"].tolist() == [4, 4]
    assert "times 2 and 6;" in page_of(cloud).markdown()
    lifted = fragility(PIER, motions, levels=[2.0, 4.0], limits=["uplift"], **options)
    words = page_of(lifted).markdown()
    assert "uplift" in words
    assert "## Medians of overturning" not in words
    assert pictures(lifted) == []


def test_fragility_has_repr_table_and_plot(study, tmp_path):
    shows_itself(study, "motions ", "runs ")
    loads_as_it_was(study, tmp_path)


def stripes_folder(folder: Path, levels: tuple[float, ...] = (2.0, 9.0)) -> Path:
    """Folder with six separate records at each level."""
    folder.mkdir()
    lines = ["level,x,y,name,units"]
    for place, level in enumerate(levels):
        for motion in synthetic_motions(6, peak=1.0, seed=place):
            name = f"{place}-{motion.name}".replace(" ", "-")
            time = motion.time_step * np.arange(len(motion.acceleration))
            for axis, column in zip("xy", motion.acceleration.T, strict=True):
                np.savetxt(folder / f"{name}-{axis}.csv", np.column_stack([time, column]), delimiter=",")
            lines.append(f"{level},{name}-x.csv,{name}-y.csv,{name},m/s2")
    (folder / "records.csv").write_text("\n".join(lines) + "\n")
    return folder


@pytest.mark.slow
def test_records_by_level_form_separate_stripes(tmp_path: Path, capsys: Any) -> None:
    records = stripes_folder(tmp_path / "records")
    out = tmp_path / "out"
    small = ["--model", "recess", "--resamples", "40", "--workers", "1"]
    assert call("fragility", "--records", str(records), *small, "--out", str(out)) == 0
    assert "each of 2 levels" in " ".join(capsys.readouterr().out.split())
    loaded = Fragility.load(out)
    assert (loaded.facts["levels"], loaded.facts["motions_of_levels"]) == ([2.0, 9.0], [6, 6])
    assert len(loaded.runs) == 12
    assert "each of 2 levels" in (out / "fragility.html").read_text()
    assert call("fragility", "--records", str(records), "--levels", "1,2", "--out", str(tmp_path / "b")) == 2
    said = capsys.readouterr().err
    assert "--levels" in said.splitlines()[-1]
    table = records / "records.csv"
    table.write_text(table.read_text().replace("9.0,", ",", 1))
    assert call("fragility", "--records", str(records), "--out", str(tmp_path / "c")) == 2
    assert "1 of 12 have none" in capsys.readouterr().err
