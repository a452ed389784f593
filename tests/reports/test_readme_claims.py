"""The numbers of the README, and of the guides that repeat them, are those of the published tables."""

from __future__ import annotations

import math
import re
import time
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

import rockwobble as rw
from rockwobble import reduced
from rockwobble.reports.pages import stored_page

pytestmark = pytest.mark.checkout

CHECKOUT = Path(__file__).parents[2]
PUBLISHED = CHECKOUT / "reports" / "published"
RATIO = r"(\d\.\d\d) \((\d\.\d\d) to (\d\.\d\d)\)"
# study, cylinder, method and reference of each ratio of the README, in their order
RATIOS = [
    ("fragility/p695", "all", "planar x", "recess model"),
    ("risk/p695", "pier", "planar x", None),
    ("fragility/p695", "all", "mujoco recess", "recess model"),
    ("fragility/p695", "all", "pybullet recess", "recess model"),
]
# the same of the guide to risk
RISK_RATIOS = [
    ("risk/p695", "pier", "planar x", None),
    ("risk/p695", "column", "planar x", None),
    ("risk/p695", "tower", "planar x", None),
    ("risk/p695", "column", "worse plane", None),
    ("risk/tendon", "pier", "planar x", None),
]
# the same of the guide to fragility
GUIDE_RATIOS = [
    ("fragility/p695", "all", "planar x", "recess model"),
    ("fragility/p695", "all", "planar y", "recess model"),
    ("fragility/p695", "all", "worse plane", "recess model"),
    ("fragility/synthetic", "all", "worse plane", "recess model"),
    ("fragility/p695", "all", "flat-ground model", "recess model"),
    ("fragility/synthetic", "all", "flat-ground model", "recess model"),
    ("fragility/p695", "all", "mujoco ring", "mujoco recess"),
    ("fragility/p695", "all", "mujoco recess", "recess model"),
    ("fragility/p695", "all", "pybullet recess", "recess model"),
    ("fragility/p695", "all", "mujoco flat", "flat-ground model"),
    ("fragility/p695", "all", "pybullet flat", "flat-ground model"),
    ("fragility/half-step", "all", "mujoco ring", "mujoco recess"),
    ("fragility/half-step", "all", "mujoco flat", "mujoco recess"),
]


def words(path: str) -> str:
    """The text of a file in one line, without the addresses of its links."""
    text = (CHECKOUT / path).read_text(encoding="utf-8")
    return " ".join(re.sub(r"\]\([^)]*\)", "]", text).split())


def median_ratios(study: str) -> dict[Any, dict[Any, Any]]:
    """Ratio of the medians that overturn, and its interval, by method and reference; of all cylinders."""
    table = pd.read_parquet(PUBLISHED / study / "contrasts.parquet")
    medians = (
        (table["cylinder"] == "all") & (table["limit"] == "overturned") if "limit" in table else slice(None)
    )
    rows = table[medians]
    return rows.set_index(["method", "against"]).to_dict("index")


def printed_ratio(study: str, cylinder: str, method: str, against: str | None) -> tuple[str, ...]:
    if against is None:  # annual frequencies, over those of the recess model
        table = pd.read_parquet(PUBLISHED / study / "risk.parquet")
        row = table.set_index(["cylinder", "method"]).loc[(cylinder, method)].to_dict()
    else:
        row = median_ratios(study)[method, against]
    return tuple(f"{row[name]:.2f}" for name in ("ratio", "ratio_low", "ratio_high"))


def test_each_ratio_of_the_readme_is_that_of_its_table() -> None:
    *stated, walls = re.findall(RATIO, words("README.md"))
    assert stated == [printed_ratio(*row) for row in RATIOS]
    copies = pd.read_parquet(PUBLISHED / "ensemble" / "copies" / "contrasts.parquet")
    ring = copies.set_index(["method", "against"]).loc[("mujoco ring", "recess model")]
    assert walls == tuple(f"{ring[name]:.2f}" for name in ("ratio", "ratio_low", "ratio_high"))


def test_each_ratio_of_the_paper_is_that_of_its_table() -> None:
    assert re.findall(RATIO, words("paper.md")) == [printed_ratio(*row) for row in RATIOS[:2]]


def test_each_ratio_of_the_guide_to_fragility_is_that_of_its_table() -> None:
    # a number may name its plane: "(1.21 to 1.97, component 2)"
    text = re.sub(r", component [12]\)", ")", words("docs/guide/fragility.md"))
    assert re.findall(RATIO, text) == [printed_ratio(*row) for row in GUIDE_RATIOS]


def test_the_ratios_of_the_guide_to_risk_are_those_of_its_table() -> None:
    text = words("docs/guide/risk.md")
    assert re.findall(RATIO, text) == [printed_ratio(*row) for row in RISK_RATIOS]
    tables = [pd.read_parquet(PUBLISHED / study / "risk.parquet") for study in ("risk/tendon", "risk/p695")]
    of_pier = [table[table["cylinder"] == "pier"].set_index("method") for table in tables]
    own = [f"{table['annual_frequency']['recess model']:.1e}".replace("e-0", "e-") for table in of_pier]
    assert f"overturns {own[0]} times a year under this hazard, without {own[1]}" in text


@pytest.mark.parametrize(
    "place", ["README.md", "docs/index.md", "docs/guide/fragility.md", "docs/guide/risk.md"]
)
def test_an_interval_that_includes_1_is_called_that_beside_it(place: str) -> None:
    text = words(place)
    for match in re.finditer(RATIO, text):
        ratio, low, high = (float(number) for number in match.groups())
        if (
            low < 1.0 < high and abs(ratio - 1.0) > 0.05
        ):  # nearer to 1 the sentence says that they hardly differ
            assert "includes 1" in text[match.end() : match.end() + 120], match.group()


def test_the_readme_shows_the_terminal_output_of_the_published_advice(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COLUMNS", "80")
    stored_page("advice", PUBLISHED / "advice" / "pier").show()
    shown = [line.rstrip() for line in capsys.readouterr().out.splitlines()]
    readme = (CHECKOUT / "README.md").read_text(encoding="utf-8")
    answer = re.search(r"^```text\n(.*?)\n```$", readme, re.M | re.S)
    assert answer is not None
    verdict, _, *table = answer[1].splitlines()
    assert len(table) == 6
    assert shown[0].startswith(f"{verdict}.")
    start = shown.index(table[0])
    assert shown[start : start + len(table)] == table


@pytest.mark.slow
def test_run_time_of_the_reduced_model_is_as_in_the_readme() -> None:
    case = rw.Case(rw.Cylinder(semidiagonal=6.0, tan_alpha=0.2), rw.el_centro_1940())
    sizes, scales = np.linspace(2.0, 20.0, 10), np.linspace(1.0, 3.0, 10)
    seconds: dict[str, list[float]] = {"trace": [], "peaks": []}
    for _ in range(4):  # the first compiles
        for name, compute in (
            ("trace", lambda: rw.simulate(case)),
            ("peaks", lambda: reduced.peak_tilts(sizes, 0.2, rw.el_centro_1940(), scales)),
        ):
            begin = time.process_time()
            compute()
            seconds[name].append(time.process_time() - begin)
    assert min(seconds["trace"]) < 0.01
    assert min(seconds["peaks"]) / 100 < 0.001


def test_what_a_pass_costs_with_default_settings_is_that_of_the_table() -> None:
    table = pd.read_csv(PUBLISHED / "simulators" / "simulators.csv").set_index(["simulator", "settings"])
    row = next(
        line for line in (CHECKOUT / "README.md").read_text().splitlines() if "default settings" in line
    )
    losses = re.findall(r"([\d.]+) % (?:of its tilt )?in (\w+)", row)
    assert [name for _, name in losses] == ["Rapier", "MuJoCo", "PyBullet", "DART", "Drake"]
    for loss, name in losses:
        assert f"{100.0 * (1.0 - table.loc[(name.lower(), 'default'), 'tilt']):.2g}" == loss


def test_the_guide_to_engines_has_the_default_settings_of_the_table() -> None:
    table = pd.read_csv(PUBLISHED / "simulators" / "simulators.csv").set_index(["simulator", "settings"])
    rows = re.findall(
        r"\| (\w+) [\d.]+ \| (?:double|single) \| ([\d.]+)°, ([\d.]+) \|", words("docs/guide/engines.md")
    )
    assert len(rows) == 5
    for name, turn, tilt in rows:
        row = table.loc[(name.lower(), "default")]
        assert (turn, tilt) == (f"{row['turn']:.2f}", f"{row['tilt']:.3f}")


def test_agreement_times_of_the_readme_are_those_published() -> None:
    rows = pd.read_csv(PUBLISHED / "compare" / "summary.csv")
    recess = rows[(rows["support"] == "recess") & (rows["reference"] == "recess model")]
    recess = recess[~recess["run"].str.contains("follow_load=False")]  # nothing steered
    assert len(recess) >= 2
    agreed = re.search(r"within 1 % of α for (\d+) s after uplift", words("README.md"))
    assert agreed is not None
    assert int(agreed[1]) <= recess["agreement_time"].min() < int(agreed[1]) + 1
    apart = re.search(r"by then up to ([\d.]+) b apart", words("README.md"))
    assert apart is not None
    assert f"{recess['largest_contact_difference'].max():.1g}" == apart[1]
    walls = rows[(rows["support"] == "ring") & (rows["reference"] == "recess model")]["agreement_time"]
    stated = re.search(r"the tilts agree for ([\d.]+) s", words("README.md"))
    assert stated is not None
    assert f"{walls.min():.1f}" == stated[1]


def test_halving_the_step_changes_ratios_as_the_guide_says() -> None:
    coarse, fine = median_ratios("fragility/p695"), median_ratios("fragility/half-step")
    engines = {pair for pair in fine if any(each.startswith("mujoco") for each in pair)}
    # a median above the levels has a bound, and a ratio to it has none
    known = {pair for pair in engines if all(0.0 < of[pair]["ratio"] < math.inf for of in (coarse, fine))}
    assert known >= {pair for _, _, *names in GUIDE_RATIOS if (pair := tuple(names)) in engines}
    assert len(known) >= 17
    assert max(abs(coarse[pair]["ratio"] - fine[pair]["ratio"]) for pair in known) < 0.05
