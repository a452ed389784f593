"""The three sentences of the README on fragility are what the published tables say."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import pandas as pd
import pytest

CHECKOUT = Path(__file__).parents[2]
PUBLISHED = CHECKOUT / "reports" / "published" / "fragility"
SECTION = r"## Is planar analysis safe\?.*?(?=\n## )"
# study and pair of methods of each number, in their order
PAIRS = {
    "planar": [
        ("p695", "planar x", "recess model"),
        ("synthetic", "worse plane", "recess model"),
    ],
    "support": [
        ("synthetic", "flat-ground model", "recess model"),
        ("p695", "mujoco ring", "mujoco recess"),
    ],
    "engine": [
        ("p695", "mujoco recess", "recess model"),
        ("p695", "pybullet recess", "recess model"),
    ],
}


def numbers_said() -> list[tuple[str, str, str]]:
    readme = (CHECKOUT / "README.md").read_text(encoding="utf-8")
    section = re.search(SECTION, readme, re.DOTALL)
    assert section
    return re.findall(r"(\d\.\d\d) \((\d\.\d\d) to (\d\.\d\d)\)", " ".join(section.group().split()))


def contrasts(study: str) -> dict[Any, dict[Any, Any]]:
    """The row of each pair of methods, of all cylinders, for overturning."""
    table = pd.read_parquet(PUBLISHED / study / "contrasts.parquet")
    rows = table[(table["cylinder"] == "all") & (table["limit"] == "overturned")]
    return rows.set_index(["method", "against"]).to_dict("index")


@pytest.mark.parametrize("question", list(PAIRS))
def test_each_ratio_with_its_interval_is_that_of_the_table(question: str) -> None:
    said = dict(zip([pair for pairs in PAIRS.values() for pair in pairs], numbers_said(), strict=True))
    for study, method, against in PAIRS[question]:
        found = contrasts(study)[method, against]
        numbers = tuple(f"{found[name]:.2f}" for name in ("ratio", "ratio_low", "ratio_high"))
        assert said[study, method, against] == numbers


def test_at_half_the_step_of_an_engine_no_ratio_moves_by_more_than_the_guide_says() -> None:
    coarse, fine = contrasts("p695"), contrasts("half-step")
    engines = [pair for pair in fine if any(each.startswith("mujoco") for each in pair)]
    assert len(engines) >= 18
    assert max(abs(coarse[pair]["ratio"] - fine[pair]["ratio"]) for pair in engines) < 0.05
