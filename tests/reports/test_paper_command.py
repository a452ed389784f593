"""`rockwobble figures` from the outside."""

from __future__ import annotations

import math
import xml.etree.ElementTree as ET
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from rockwobble.compare.storage.manifest import read_results
from rockwobble.reports.cli.main import main
from rockwobble.reports.pages import stored_page
from rockwobble.reports.paper import earthquake, overturning
from rockwobble.reports.paper.page import Paper, page_of

pytestmark = pytest.mark.slow

SVG_LIMIT = 400_000  # bytes, of each committed picture


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    with pytest.MonkeyPatch.context() as patch:
        # three neighbours tell as much of the command as forty do
        patch.setattr(earthquake, "_NEIGHBOURS", (0.95, 1.0, 1.05))
        # and coarse steps of the search of figure 6 as much as fine ones
        asked = replace(overturning.plan_of(6), search_step=0.2)
        patch.setattr(overturning, "plan_of", lambda grid: asked)
        folder = tmp_path_factory.mktemp("paper")
        with pytest.raises(SystemExit) as ended:
            main(["figures", "--grid", "6", "--out", str(folder)])
    assert ended.value.code == 0
    return folder


def test_every_picture_is_on_the_page_small_and_valid(made):
    page = (made / "paper.md").read_text()
    for number in (3, 4, 5, 6):
        picture = made / f"figure-{number}.svg"
        assert f"(figure-{number}.svg)" in page
        assert ET.parse(picture).getroot().tag.endswith("svg")
        assert picture.stat().st_size < SVG_LIMIT


def test_every_statement_has_numbers_and_a_verdict_on_the_page(made):
    table = pd.read_parquet(made / "statements.parquet")
    assert set(table["figure"]) == {3, 4, 5, 6}
    assert set(table["verdict"]) <= {"holds", "holds in part", "does not hold"}
    page = (made / "paper.md").read_text()
    judged = table.drop_duplicates("statement")["verdict"].value_counts()
    for verdict in judged.index:
        assert page.count(f"t {verdict}.**") == judged[verdict]
    headline = read_results(made, "paper").manifest.headline
    assert headline == judged.to_dict()


def test_numbers_on_the_page_are_those_of_the_tables(made):
    page = (made / "paper.md").read_text()
    lowest = pd.read_parquet(made / "lowest.parquet").pivot_table(
        index="semidiagonal", columns="series", values="intensity"
    )
    record = pd.read_parquet(made / "record.parquet")
    peak = np.hypot(record["x"], record["y"]).max()
    own = pd.DataFrame(
        {name: lowest[f"planar_{name}"] * record[name].abs().max() / peak for name in ("x", "y")}
    ).min(axis=1)
    large = lowest.index >= 20.0
    lower = (lowest["3d"] < own)[large].sum()
    words = " ".join(page.split())
    assert f"the curve of 3D is the lowest at {lower} of {large.sum()} sizes from R = 20 m up" in words


@pytest.mark.parametrize(
    ("statement", "number", "value", "words"),
    [
        ("housner", "good", 0.0, "tan α = 3: never so close."),
        ("housner", "good", 0.2, "up to tan α = 0.2."),
        ("abrupt", "agreement", math.inf, "stays within 1 % of α of this response to the end."),
        ("abrupt", "agreement", 7.04, "differs by 1 % of α from 7.0 s on: passes close to upright amplify"),
        ("place", "rests", 1.0, "at the end of the record it stands where it stood."),
        ("place", "rests", 0.0, "at the end of the record it still rocks, undamped as it is, at"),
        ("large_equal", "from", 12.5, "in the median, and from R = 12.5 m up at every size; at R ="),
        ("large_equal", "from", math.nan, "in the median; at R ="),
    ],
)
def test_other_numbers_make_other_sentences(made, statement, number, value, words):
    found = Paper.load(made)
    table = found.statements
    chosen = (table["statement"] == statement) & (table["number"] == number)
    assert chosen.sum() == 1
    tables = {**found.tables, "statements": table.assign(value=table["value"].mask(chosen, value))}
    assert words in " ".join(page_of(replace(found, tables=tables)).markdown().split())


def test_the_report_is_drawn_again_from_what_is_kept(made):
    again = stored_page("paper", made)
    # the page holds what the pictures beside the document show
    assert again.html() == (made / "paper.html").read_text()
    assert again.markdown() == (made / "paper.md").read_text()


def test_the_page_says_how_it_was_made(made):
    page = (made / "paper.md").read_text()
    assert f"numpy {np.__version__}" in page
    assert "Made by `rockwobble" in page


def test_the_data_of_the_pictures_are_beside_them(made):
    shaken = pd.read_parquet(made / "figure-5.parquet")
    assert shaken["time"].iloc[-1] == pytest.approx(53.45, abs=0.1)
    record = pd.read_parquet(made / "record.parquet")
    assert len(record) == 5346
    assert record["y"].abs().max() == pytest.approx(0.2808 * 9.80665, rel=1e-3)
    modes = pd.read_parquet(made / "figure-4.parquet")
    steady = modes[modes["mode"] == "steady wobble"]
    assert np.ptp(steady["tilt"]) < 1e-6


def test_bad_input_is_one_line(tmp_path, capsys):
    with pytest.raises(SystemExit) as ended:
        main(["figures", "--grid", "2", "--out", str(tmp_path / "out")])
    assert ended.value.code == 2
    assert "'--grid': must be from 3 to 1000, got 2" in capsys.readouterr().err
    assert not (tmp_path / "out").exists()
