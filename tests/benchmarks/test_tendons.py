"""Published tendon page matches its tables, and the tables match statics."""

from __future__ import annotations

import itertools
import re

import pandas as pd
import pytest

from benchmarks.tendons import BODIES, PRESTRESS, PUBLISHED, main, medians_of_many
from rockwobble import reduced
from rockwobble.models import Case, Tendon, synthetic_motions

RATIO = re.compile(r"(\d+\.\d+) \((\d+\.\d+) to (\d+\.\d+)")
PAGE = " ".join((PUBLISHED / "README.md").read_text(encoding="utf-8").split())
ORDER = ("pier", "column", "tower", "pier under a deck")
PLANES = ("planar x", "worse plane")
# prestress and stiffness of the ratios of the page in their order, by table: to no tendon, and to 3D
STATED = {
    "p695": (((1.0, 0.0), (0.0, 0.5)), ((0.0, 0.0), (0.5, 0.0), (0.0, 0.5))),
    "2000": (
        ((1.0, 0.0), (0.5, 0.0), (0.0, 0.5), (0.0, 1.0)),
        ((0.0, 0.0), (0.5, 0.0), (0.0, 0.5), (0.0, 1.0)),
    ),
}


def medians(motions: str) -> pd.DataFrame:
    table = pd.read_csv(PUBLISHED / f"medians-{motions}.csv")
    return table.set_index(["body", "prestress", "stiffness", "method"])


def test_tendon_page_ratios_equal_their_tables() -> None:
    numbers = []
    for motions, (without, planes) in STATED.items():
        table = medians(motions)
        keys = [((body, *each, "recess model"), "over_without") for each in without for body in ORDER]
        keys += [(("pier", *each, method), "over_3d") for method in PLANES for each in planes]
        ends = ("", "_low", "_high")
        numbers += [tuple(f"{table[name + end][key]:.2f}" for end in ends) for key, name in keys]
    assert [match.groups() for match in RATIO.finditer(PAGE[: PAGE.index("On flat ground")])] == numbers
    for match in RATIO.finditer(PAGE):
        ratio, low, high = map(float, match.groups())
        if low < 1.0 < high and abs(ratio - 1.0) > 0.05:
            assert "includes 1" in PAGE[match.end() : match.end() + 20]


def test_claims_on_flat_ground_match_their_table() -> None:
    tables = [pd.read_csv(PUBLISHED / f"flat-{engine}.csv") for engine in ("mujoco", "pybullet")]
    stated = re.findall(r"(\d+\.\d+) b \((\d+\.\d+) to (\d+\.\d+)\)", PAGE)
    ends = ("displacement", "displacement_low", "displacement_high")
    rows = [row for table in tables for _, row in table.iterrows()]
    assert stated == [tuple(f"{row[name]:.2f}" for name in ends) for row in rows]
    for table in tables:
        assert list(table["prestress"]) == list(PRESTRESS)
        overturned = ", ".join(str(each) for each in table["overturned"])
        assert f"{overturned} of {table['motions'].iloc[0]} overturn" in PAGE


def test_overturning_median_increases_with_prestress() -> None:
    for (_, stiffness, method), rows in medians("p695").groupby(level=["body", "stiffness", "method"]):
        if method == "recess model" and stiffness == 0.0:
            assert rows["median"].is_monotonic_increasing


@pytest.mark.slow
def test_many_motion_medians_count_overturning_at_levels_around_them() -> None:
    motions = synthetic_motions(3, peak=1.0, seed=3)
    rows = itertools.islice(medians_of_many(motions), 8)  # without a tendon, and with half a weight
    table = pd.DataFrame(rows)
    assert list(table["prestress"]) == [0.0] * 4 + [0.5] * 4
    assert table["highest_level"].to_list() == pytest.approx([3.8 * 3.2] * 4 + [1.5 * 3.8 * 3.2] * 4)
    own = [
        reduced.simulate(
            Case(
                BODIES["pier"],
                motion.scaled(1.5 * 3.8 * 3.2 * 9.81 * 0.2 / motion.peak),
                tendon=Tendon(prestress=0.5),
            ),
            rtol=1e-7,
        ).outcome
        == "overturned"
        for motion in motions
    ]
    assert table["overturned_there"][4] == sum(own) / 3.0


def test_claims_on_highest_levels_match_their_table() -> None:
    rows = medians("2000")["median"]
    of_g = [rows[body, 0.0, 1.0, "recess model"] * BODIES[body].tan_alpha for body in ORDER]
    assert "peaks of {:.1f}, {:.1f}, {:.1f} and {:.1f} g".format(*of_g) in PAGE


@pytest.mark.slow
def test_the_tables_are_printed(capsys: pytest.CaptureFixture[str]) -> None:
    assert main([]) == 0
    assert "medians-p695" in capsys.readouterr().out
