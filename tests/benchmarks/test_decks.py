"""Deck guide and published tables agree, and the tables match the equations."""

from __future__ import annotations

import re
from pathlib import Path

import pandas as pd
import pytest

from benchmarks.decks import PIER, PUBLISHED, deck, equivalent, main
from rockwobble import reduced

DOCS = Path(__file__).parents[2] / "docs"
GUIDE = DOCS / "guide" / "frames.md"
PAGE = DOCS / "published" / "frames.md"
SECTION = re.search(r"## Does a deck help or harm\?.*?(?=\n## )", PAGE.read_text(encoding="utf-8"), re.DOTALL)
WORDS = SECTION.group() if SECTION else ""
METHODS = {"in three dimensions": "recess model", "in the worse of two planes": "worse plane"}


@pytest.fixture(scope="module")
def medians() -> pd.DataFrame:
    return pd.read_csv(PUBLISHED / "medians-300.csv")


def row_of(table: pd.DataFrame, method: str, ratio: float) -> dict[str, float]:
    own = table[(table["method"] == method) & (table["slab_mass_ratio"] == ratio)]
    return {str(name): value for name, value in own.iloc[0].items()}


@pytest.mark.parametrize("title", METHODS)
@pytest.mark.parametrize("ratio", [1.0, 4.0])
def test_deck_guide_numbers_equal_the_table(medians: pd.DataFrame, title: str, ratio: float) -> None:
    row = row_of(medians, METHODS[title], ratio)
    numbers = [
        "{:.2f} ({:.2f} to {:.2f})".format(*(row[f"{name}{end}"] for end in ("", "_low", "_high")))
        for name in ("median", "over_alone", "over_equivalent", "over_3d")
    ]
    if METHODS[title] == "recess model":
        numbers[-1] = ""
    line = f"| γ = {ratio:g}, {title} | {' | '.join(numbers)} |".replace("  ", " ")
    assert line in WORDS


def test_guide_benefit_of_a_deck_matches_the_table(medians: pd.DataFrame) -> None:
    few = pd.read_csv(PUBLISHED / "medians-p695.csv")
    for table in (medians, few):
        for ratio in (1.0, 4.0):
            row = row_of(table, "recess model", ratio)
            numbers = [row[f"over_alone{end}"] for end in ("", "_low", "_high")]
            words = "{:.2f} ({:.2f} to {:.2f})".format(*numbers)
            assert words in WORDS.replace("\n", " ")
            assert table is few or words in " ".join(GUIDE.read_text(encoding="utf-8").split())
    # equal benefit of the larger cylinder
    rows = medians[medians["slab_mass_ratio"] > 0.0]
    assert ((rows["over_equivalent_low"] <= 1.0) & (rows["over_equivalent_high"] >= 1.0)).all()


def test_guide_demands_of_a_deck_match_the_table() -> None:
    rows = pd.read_csv(PUBLISHED / "needs-300.csv").set_index("slab_mass_ratio")
    words = WORDS.replace("\n", " ")
    assert "a friction of {:.2f}, {:.2f} and {:.2f} at the base".format(*rows["friction_base"]) in words
    assert "of {:.2f} and {:.2f} at the top".format(*rows["friction_top"].iloc[1:]) in words
    assert "moment of {:.3f}, {:.3f} and {:.3f} b".format(*rows["moment"]) in words


@pytest.mark.parametrize("motions", ["p695", "300"])
def test_planar_motion_under_a_deck_equals_a_larger_cylinder(motions: str) -> None:
    table = pd.read_csv(PUBLISHED / f"medians-{motions}.csv")
    planar = table[table["method"].str.startswith("planar") & (table["slab_mass_ratio"] > 0.0)]
    # levels at which rounding decides; synthetic motions have none
    assert planar["over_equivalent"].to_numpy() == pytest.approx(1.0, abs=0.02)


@pytest.mark.parametrize("ratio", [1.0, 4.0])
def test_the_equivalent_cylinder_rocks_as_the_frame_does(ratio: float) -> None:
    tilt = 0.4 * PIER.alpha
    periods = [reduced.rocking_period(body, tilt) for body in (deck(ratio), equivalent(ratio))]
    assert periods[0] == pytest.approx(periods[1], rel=1e-12)  # rounding


def test_the_tables_are_printed(capsys: pytest.CaptureFixture[str]) -> None:
    assert main([]) == 0
    printed = capsys.readouterr().out
    assert "medians-300" in printed
    assert "needs-300" in printed
