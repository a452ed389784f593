"""`rockwobble figures` from the outside."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from rockwobble.reports.cli.main import main
from rockwobble.reports.paper import earthquake

SVG_LIMIT = 400_000  # bytes, of each committed picture


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    with pytest.MonkeyPatch.context() as patch:
        # three neighbours tell as much of the command as forty do
        patch.setattr(earthquake, "_NEIGHBOURS", (0.95, 1.0, 1.05))
        folder = tmp_path_factory.mktemp("paper")
        with pytest.raises(SystemExit) as ended:
            main(["figures", "--grid", "8", "--out", str(folder)])
    assert ended.value.code == 0
    return folder


def test_every_picture_is_on_the_page_small_and_valid(made):
    page = (made / "paper.md").read_text()
    for number in (3, 4, 5, 6):
        picture = made / f"figure-{number}.svg"
        assert f"(figure-{number}.svg)" in page
        assert ET.parse(picture).getroot().tag.endswith("svg")
        assert picture.stat().st_size < SVG_LIMIT


def test_every_claim_has_numbers_and_a_verdict(made):
    claims = pd.read_csv(made / "claims.csv")
    assert set(claims["figure"]) == {3, 4, 5, 6}
    assert set(claims["verdict"]) <= {"holds", "holds in part", "does not hold"}
    assert claims["run"].str.contains(r"\d").all()
    page = (made / "paper.md").read_text()
    for claim in claims.itertuples():
        assert f"{claim.run} **It {claim.verdict}.**" in page


def test_the_page_says_how_it_was_made(made):
    page = (made / "paper.md").read_text()
    assert f"numpy {np.__version__}" in page
    assert "Made by `rockwobble" in page


def test_the_data_of_the_pictures_are_beside_them(made):
    page = (made / "paper.md").read_text()
    tables = sorted(path.name for path in made.glob("*.parquet"))
    assert len(tables) == 8
    for name in tables:
        assert f"({name})" in page
        assert len(pd.read_parquet(made / name)) > 0
    shaken = pd.read_parquet(made / "figure-5.parquet")
    # every sample of the record, and the response at the same times
    assert len(shaken) == 5346
    assert shaken["ground_y"].abs().max() == pytest.approx(0.2808 * 9.80665, rel=1e-3)
    modes = pd.read_parquet(made / "figure-4.parquet")
    steady = modes[modes["mode"] == "steady wobble"]
    assert np.ptp(steady["tilt"]) < 1e-6


def test_bad_input_is_one_line(tmp_path, capsys):
    with pytest.raises(SystemExit) as ended:
        main(["figures", "--grid", "2", "--out", str(tmp_path / "out")])
    assert ended.value.code == 2
    assert "--grid must be from 3 to 1000, got 2" in capsys.readouterr().err
    assert not (tmp_path / "out").exists()
