"""What the published page says of tendons is in its tables, which say what statics asks for."""

from __future__ import annotations

import re
from typing import Any

import pandas as pd
import pytest

from benchmarks.tendons import BODIES, PRESTRESS, PUBLISHED, main, neutral_stiffness
from rockwobble import reduced
from rockwobble.models import Case, Tendon

RATIO = re.compile(r"(\d+\.\d+) \((\d+\.\d+) to (\d+\.\d+)")
# body, prestress, stiffness, method and column of each ratio of the page, in their order
_ORDER = ("pier", "column", "tower", "pier under a deck")
SAID: list[Any] = [
    *((body, 1.0, 0.0, "recess model", "over_without") for body in _ORDER),
    *((body, 0.0, 0.5, "recess model", "over_without") for body in _ORDER),
    *(
        ("pier", prestress, stiffness, method, "over_3d")
        for method in ("planar x", "worse plane")
        for prestress, stiffness in ((0.0, 0.0), (0.5, 0.0), (0.0, 0.5))
    ),
]


@pytest.fixture(scope="module")
def medians() -> pd.DataFrame:
    table = pd.read_csv(PUBLISHED / "medians-p695.csv")
    return table.set_index(["body", "prestress", "stiffness", "method"])


def test_each_ratio_of_the_page_is_that_of_its_table(medians: pd.DataFrame) -> None:
    page = " ".join((PUBLISHED / "README.md").read_text(encoding="utf-8").split())
    of_key = medians.to_dict("index")
    numbers = [
        tuple(f"{of_key[tuple(key)][f'{name}{end}']:.2f}" for end in ("", "_low", "_high"))
        for *key, name in SAID
    ]
    assert [match.groups() for match in RATIO.finditer(page[: page.index("On flat ground")])] == numbers
    for match in RATIO.finditer(page):
        ratio, low, high = map(float, match.groups())
        if low < 1.0 < high and abs(ratio - 1.0) > 0.05:
            assert "includes 1" in page[match.end() : match.end() + 20]


def test_what_the_page_says_of_flat_ground_is_in_its_table() -> None:
    page = " ".join((PUBLISHED / "README.md").read_text(encoding="utf-8").split())
    tables = [pd.read_csv(PUBLISHED / f"flat-{engine}.csv") for engine in ("mujoco", "pybullet")]
    stated = re.findall(r"(\d+\.\d+) b \((\d+\.\d+) to (\d+\.\d+)\)", page)
    ends = ("displacement", "displacement_low", "displacement_high")
    rows = [row for table in tables for _, row in table.iterrows()]
    assert stated == [tuple(f"{row[name]:.2f}" for name in ends) for row in rows]
    for table in tables:
        assert list(table["prestress"]) == list(PRESTRESS)
        overturned = ", ".join(str(each) for each in table["overturned"])
        assert f"{overturned} of {table['motions'].iloc[0]} overturn" in page


@pytest.mark.parametrize("name", BODIES)
def test_at_the_neutral_stiffness_the_balance_goes(name: str) -> None:
    body = BODIES[name]
    below, above = (
        reduced.balance_tilt_of_case(
            Case(body, duration=1.0, tendon=Tendon(stiffness=share * neutral_stiffness(body)))
        )
        for share in (0.5, 1.001)
    )
    assert body.alpha < below < 2.5 * body.alpha
    assert above > 1.5


def test_more_prestress_takes_more_to_overturn(medians: pd.DataFrame) -> None:
    for (_, stiffness, method), rows in medians.groupby(level=["body", "stiffness", "method"]):
        if method == "recess model" and stiffness == 0.0:
            assert rows["median"].is_monotonic_increasing


def test_the_tables_are_printed(capsys: pytest.CaptureFixture[str]) -> None:
    assert main([]) == 0
    assert "medians-p695" in capsys.readouterr().out
