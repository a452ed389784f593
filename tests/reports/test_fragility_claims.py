"""The three sentences of the README on fragility are what the published tables say."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from rockwobble.compare.storage.manifest import read_results
from rockwobble.compare.studies.fragility.result import KIND

CHECKOUT = Path(__file__).parents[2]
SECTION = r"## Is planar analysis safe\?.*?(?=\n## )"
# the pairs of methods of each sentence, in the order of their numbers
PAIRS = {
    "planar": [("planar x", "recess model"), ("planar y", "recess model"), ("worse plane", "recess model")],
    "support": [("flat-ground model", "recess model"), ("mujoco flat", "mujoco recess")],
    "engine": [("mujoco recess", "recess model"), ("mujoco flat", "flat-ground model")],
}


def numbers_said() -> list[tuple[str, str, str]]:
    readme = (CHECKOUT / "README.md").read_text(encoding="utf-8")
    section = re.search(SECTION, readme, re.DOTALL)
    assert section
    return re.findall(r"(\d\.\d\d) \((\d\.\d\d) to (\d\.\d\d)\)", " ".join(section.group().split()))


@pytest.mark.parametrize("question", list(PAIRS))
def test_each_ratio_with_its_interval_is_that_of_the_table(question: str) -> None:
    table = read_results(CHECKOUT / "reports" / "published" / "fragility" / "p695", KIND).table("contrasts")
    rows = table[(table["cylinder"] == "all") & (table["limit"] == "overturned")]
    own = rows.set_index(["method", "against"])
    order = [pair for pairs in PAIRS.values() for pair in pairs]
    said = dict(zip(order, numbers_said(), strict=True))
    for pair in PAIRS[question]:
        found = own.loc[pair]
        assert said[pair] == tuple(f"{found[name]:.2f}" for name in ("ratio", "ratio_low", "ratio_high"))
