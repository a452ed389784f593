"""Numbers of the README, the paper, guides and pages of results are those of the published tables."""

from __future__ import annotations

import json
import math
import re
import time
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

import rockwobble as rw
from rockwobble import reduced
from rockwobble.reports.pages import stored_page
from rockwobble.studies.validity.limits import limits_of
from rockwobble.studies.validity.study import Validity

pytestmark = pytest.mark.checkout

CHECKOUT = Path(__file__).parents[2]
PUBLISHED = CHECKOUT / "reports" / "published"
ENSEMBLES = PUBLISHED / "ensemble"
RATIO = r"(\d\.\d\d) \((\d\.\d\d) to (\d\.\d\d)\)"
# study, cylinder, method and reference of each ratio of a page, in their order
README = [
    ("fragility/p695", "all", "planar x", "recess model"),
    ("risk/p695", "pier", "planar x", None),
    ("fragility/p695", "all", "mujoco recess", "recess model"),
    ("fragility/p695", "all", "pybullet recess", "recess model"),
    ("ensemble/copies", None, "mujoco ring", "recess model"),
]
RISK = [
    ("risk/p695", "pier", "planar x", None),
    ("risk/p695", "column", "planar x", None),
    ("risk/p695", "tower", "planar x", None),
    ("risk/p695", "column", "worse plane", None),
    ("risk/tendon", "pier", "planar x", None),
]
FRAGILITY = [
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
PAGES = {
    "README.md": README,
    "paper.md": README[:2],
    "docs/guide/fragility.md": FRAGILITY,
    "docs/guide/risk.md": RISK,
}


def words(path: str | Path) -> str:
    """Text of a file in one line, without link addresses and components of planes."""
    text = (CHECKOUT / path).read_text(encoding="utf-8")
    return " ".join(re.sub(r", component [12](?=\))", "", re.sub(r"\]\([^)]*\)", "]", text)).split())


def unstated(path: str | Path, *sentences: str) -> list[str]:
    """Sentences that are missing from a file."""
    text = words(path)
    return [sentence for sentence in sentences if sentence not in text]


def ratios_of(study: str) -> dict[Any, dict[Any, Any]]:
    """Ratios and intervals by method and reference; means over cylinders if there are several."""
    table = pd.read_parquet(PUBLISHED / study / "contrasts.parquet")
    if "limit" in table:
        table = table[(table["cylinder"] == "all") & (table["limit"] == "overturned")]
    return table.set_index(["method", "against"]).to_dict("index")


def printed(row: Mapping[Any, Any], form: str = ".2f") -> tuple[str, ...]:
    return tuple(f"{row[name]:{form}}" for name in ("ratio", "ratio_low", "ratio_high"))


def printed_ratio(study: str, cylinder: str | None, method: str, against: str | None) -> tuple[str, ...]:
    if against is not None:
        return printed(ratios_of(study)[method, against])
    frequencies = pd.read_parquet(PUBLISHED / study / "risk.parquet")  # over that of the recess model
    return printed(frequencies.set_index(["cylinder", "method"]).loc[(cylinder, method)].to_dict())


@pytest.mark.parametrize("page", PAGES)
def test_page_ratios_equal_their_tables(page: str) -> None:
    assert re.findall(RATIO, words(page)) == [printed_ratio(*row) for row in PAGES[page]]


@pytest.mark.parametrize(
    "page", ["README.md", "docs/index.md", "docs/guide/fragility.md", "docs/guide/risk.md"]
)
def test_ratios_with_intervals_including_1_say_so(page: str) -> None:
    text = words(page)
    for match in re.finditer(RATIO, text):
        ratio, low, high = map(float, match.groups())
        if low < 1.0 < high and abs(ratio - 1.0) > 0.05:  # nearer to 1 they hardly differ, as it says
            assert "includes 1" in text[match.end() : match.end() + 120], match.group()


def test_guide_frequency_with_a_tendon_matches_the_table() -> None:
    tables = [pd.read_parquet(PUBLISHED / study / "risk.parquet") for study in ("risk/tendon", "risk/p695")]
    of_pier = [table[table["cylinder"] == "pier"].set_index("method") for table in tables]
    tied, free = (f"{rows['annual_frequency']['recess model']:.1e}".replace("e-0", "e-") for rows in of_pier)
    said = f"overturns {tied} times a year under this hazard, without {free}"
    assert unstated("docs/guide/risk.md", said) == []


def test_the_readme_shows_the_terminal_output_of_the_published_advice(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COLUMNS", "80")
    stored_page("advice", PUBLISHED / "advice" / "pier").show()
    shown = [line.rstrip() for line in capsys.readouterr().out.splitlines()]
    readme = (CHECKOUT / "README.md").read_text(encoding="utf-8")
    (answer,) = re.findall(r"^```text\n(.*?)\n```$", readme, re.M | re.S)[:1]
    verdict, _, *table = answer.splitlines()
    assert len(table) == 6
    assert shown[0].startswith(f"{verdict}.")
    start = shown.index(table[0])
    assert shown[start : start + len(table)] == table


@pytest.mark.slow
def test_readme_run_time_of_the_reduced_model_holds() -> None:
    case = rw.Case(rw.Cylinder(semidiagonal=6.0, tan_alpha=0.2), rw.el_centro_1940())
    sizes, scales = np.linspace(2.0, 20.0, 10), np.linspace(1.0, 3.0, 10)

    def seconds(compute: Callable[[], object]) -> float:
        taken = []
        for _ in range(4):  # first call compiles
            begin = time.process_time()
            compute()
            taken.append(time.process_time() - begin)
        return min(taken)

    assert seconds(lambda: rw.simulate(case)) < 0.01
    assert seconds(lambda: reduced.peak_tilts(sizes, 0.2, rw.el_centro_1940(), scales)) / 100 < 0.001


def test_stated_default_settings_of_engines_match_the_table() -> None:
    table = pd.read_csv(PUBLISHED / "simulators" / "simulators.csv").set_index(["simulator", "settings"])
    readme = (CHECKOUT / "README.md").read_text()
    row = next(line for line in readme.splitlines() if "default settings" in line)
    losses = {name: loss for loss, name in re.findall(r"([\d.]+) % (?:of its tilt )?in (\w+)", row)}
    pattern = r"\| (\w+) [\d.]+ \| (?:double|single) \| ([\d.]+)°, ([\d.]+) \|"
    guide = re.findall(pattern, words("docs/guide/engines.md"))
    assert [*losses] == ["Rapier", "MuJoCo", "PyBullet", "DART", "Drake"]
    assert len(guide) == 5
    for name, loss in losses.items():
        assert f"{100.0 * (1.0 - table.loc[(name.lower(), 'default'), 'tilt']):.2g}" == loss
    for name, turn, tilt in guide:
        own = table.loc[(name.lower(), "default")]
        assert (turn, tilt) == (f"{own['turn']:.2f}", f"{own['tilt']:.3f}")


def test_guide_ratios_at_half_the_step_match_the_tables() -> None:
    coarse, fine = ratios_of("fragility/p695"), ratios_of("fragility/half-step")
    engines = {pair for pair in fine if any(each.startswith("mujoco") for each in pair)}
    # a median above the levels has a bound, and a ratio to it has none
    known = {pair for pair in engines if all(0.0 < of[pair]["ratio"] < math.inf for of in (coarse, fine))}
    assert known >= {pair for _, _, *names in FRAGILITY if (pair := tuple(names)) in engines}
    assert len(known) >= 17
    assert max(abs(coarse[pair]["ratio"] - fine[pair]["ratio"]) for pair in known) < 0.05


@pytest.fixture(scope="module")
def compared() -> pd.DataFrame:
    rows = pd.read_csv(PUBLISHED / "compare" / "summary.csv")
    return rows.assign(fixed=rows["run"].str.contains("follow_load=False"))  # nothing steered


def agreement(rows: pd.DataFrame, support: str, model: str, *, fixed: bool = False) -> pd.DataFrame:
    return rows[(rows["support"] == support) & (rows["reference"] == model) & (rows["fixed"] == fixed)]


@pytest.mark.parametrize("page", ["README.md", "docs/start.md", "docs/index.md"])
def test_stated_agreement_times_match_the_tables(page: str, compared: pd.DataFrame) -> None:
    text = words(page)
    (until,) = set(re.findall(r"for (\d+) s after uplift", text))
    recess = agreement(compared, "recess", "recess model")
    assert len(recess) >= 2
    assert int(until) == math.floor(recess["agreement_time"].min())
    steered = agreement(compared, "recess", "recess model", fixed=True)["agreement_time"].item()
    for either in re.findall(r"(\d+) s with nothing steered|nothing steered [^.]*? for (\d+) s", text):
        assert int(max(either)) == math.floor(steered)
    own = agreement(compared, "flat", "flat-ground model")["agreement_time"].min()
    assert set(re.findall(r"another model, for (\d+\.\d) s after uplift", text)) <= {f"{own:.1f}"}
    if page == "README.md":
        walls = agreement(compared, "ring", "recess model")["agreement_time"].min()
        apart = recess["largest_contact_difference"].max()
        said = (f"by then up to {apart:.1g} b apart", f"the tilts agree for {walls:.1f} s")
        assert unstated(page, *said) == []


def test_stated_agreement_with_fixed_contact_load_matches_published_tables(compared: pd.DataFrame) -> None:
    ends = compared.set_index(["run", "reference"])["within_tolerance_until"]
    runs = [("recess", "recess model"), ("flat", "flat-ground model")]
    fixed, followed = (
        [f"{ends[f'mujoco {support}{more}', model]:.1f}" for support, model in runs]
        for more in (" follow_load=False", "")
    )
    said = f"the two agree until {fixed[0]} s in the recess and {fixed[1]} s on flat ground"
    more = f"{said}, and until {followed[0]} s and {followed[1]} s where"
    assert unstated("docs/guide/engines.md", more) == unstated("docs/guide/comparison.md", said) == []


def test_stated_ensemble_commands_match_their_manifests() -> None:
    stated = dict(re.findall(r"\[(\S+)\] \| `(rockwobble ensemble [^`]*)`", words(ENSEMBLES / "README.md")))
    assert sorted(stated) == sorted(path.parent.name for path in ENSEMBLES.glob("*/manifest.json"))
    for name, command in stated.items():
        made = json.loads((ENSEMBLES / name / "manifest.json").read_text(encoding="utf-8"))["command"]
        assert f"{command} --out ensemble/{name}" == made.removesuffix(" --overwrite")


def test_stated_ensemble_findings_match_their_tables() -> None:
    page = ENSEMBLES / "README.md"
    rows = {name: ratios_of(f"ensemble/{name}") for name in ("p695-2", "p695-3.5", "copies")}
    lines = {line.partition("]")[0]: line for line in words(page).split(" | [")}
    for name, supports in (
        ("p695-2", ("recess", "flat")),
        ("p695-3.5", ("recess", "flat")),
        ("copies", ("recess",)),
    ):
        for support in supports:
            model = {"recess": "recess model", "flat": "flat-ground model"}[support]
            own = [
                row
                for (run, other), row in rows[name].items()
                if other == model and run.endswith(f" {support}")
            ]
            assert {row["verdict"] for row in own} == {"within"}
            low, high = min(row["ratio_low"] for row in own), max(row["ratio_high"] for row in own)
            assert f"{low:.3f} to {high:.3f}" in lines[name]
    higher = [rows["p695-2"][f"{engine} recess", "recess model"] for engine in ("mujoco", "pybullet")]
    assert [(row["higher"], row["compared"]) for row in higher] == [(16, 20), (16, 20)]
    assert all(row["ratio"] < 1.002 and row["ratio_p_adjusted"] > 0.05 for row in higher)
    said = ["each higher in 16 of 20", "(p = {:.3f} and {:.3f};".format(*(row["ratio_p"] for row in higher))]
    copies, two, more = (
        rows[name]["flat-ground model", "recess model"] for name in ("copies", "p695-2", "p695-3.5")
    )
    said.append("has {} ({} to {}) of the recess model's peak".format(*printed(copies)))
    ends = [f"from {row['ratio_low']:.2f} to {row['ratio_high']:.2f} at" for row in (two, more)]
    said.append(f"{ends[0]} 2 g tan α, {ends[1]} 3.5")
    assert unstated(page, *said) == []


def test_summary_of_limits_matches_the_published_tables() -> None:
    loaded = Validity.load(PUBLISHED / "validity")
    number = limits_of(loaded.tables, loaded.structure).set_index(["limit", "number"])["value"]

    def ends(models: str, form: str) -> str:
        return " to ".join(f"{number[f'traces.{models}', end]:{form}}" for end in ("low", "high"))

    low, high = (number["limit_model.strays", f"ratio_ring_{end}"] for end in ("least", "largest"))
    flat = (
        f"{ends('flat_recess', '.1f')} s by the recess model, {ends('flat_flat', '.0f')} s by the flat-ground"
    )
    page = (PUBLISHED / "validity" / "validity.md").read_text(encoding="utf-8")
    engine = re.findall(r"\| engine, flat ground \| 22 \| \S+ \| (\S+) \| (\S+) \|", page)
    assert len(engine) == 12
    least, largest = min(float(each) for each, _ in engine), max(float(each) for _, each in engine)
    model = re.findall(r"\| flat-ground model \| 22 \| \S+ \| (\S+) \|", page)
    changed = [number["vertical.vertical", name] for name in ("other", "cells")]
    other, all_of, chance = (f"{each:.0f}" for each in (*changed, number["vertical.copy", "other"]))
    (known,) = re.findall(r"known within 5 % at \d+ of \d+ points", page)[:1]
    said = [
        f"is {low:.2g} to {high:.2g}, by case",
        f"{ends('recess_recess', '.0f')} s in a recess",
        f"on flat ground {flat}",
        f"interval of the median ratio of the peaks extends from {least:.1f} to {largest:.1f} by the engine",
        f"from {min(map(float, model)):.1f} by the flat-ground model",
        f"changes {other} of {all_of} verdicts, as many as chance (a record 1 % stronger changes {chance})",
        known,
    ]
    assert unstated("docs/guide/limits.md", *said) == []
    # the same peak within a thousandth in the median
    medians = [number["limit_model.established", f"ratio_{end}"] for end in ("least", "largest")]
    assert max(abs(each - 1.0) for each in medians) < 1e-3


@pytest.mark.parametrize("page", ["docs/guide/frames.md", "docs/published/frames.md"])
def test_guide_factor_of_deck_as_larger_cylinder_is_right(page: str) -> None:
    from benchmarks.decks import PIER, equivalent

    size = {ratio: f"{equivalent(ratio).semidiagonal / PIER.semidiagonal:.2f}" for ratio in (1.0, 4.0, 1e6)}
    for ratio in (1.0, 4.0):
        assert re.search(rf"{size[ratio]} times (?:at|\()\s?γ = {ratio:g}", words(page))
    medians = pd.read_csv(PUBLISHED / "decks" / "medians-300.csv")
    planes = medians[medians["method"] == "worse plane"].set_index("slab_mass_ratio")["over_3d"]
    shares = "{:.0f} %, {:.0f} % and {:.0f} %".format(*(100.0 * (planes - 1.0)))
    assert unstated(page, size[1e6], shares) == []


def test_certificates_page_states_the_number_of_cases() -> None:
    folder = PUBLISHED / "certificates"
    made = [json.loads((folder / f"{name}.json").read_text("utf-8")) for name in ("reduced", "mujoco")]
    low, high = (len(each["fingerprint"]) for each in made)
    compared = pd.read_csv(folder / "releases.csv")
    assert set(compared.groupby(["engine", "verified", "python"]).size()) == {12}
    said = (
        f"a fingerprint of {low} or {high} short cases",
        "of twelve cases, before frames, tendons and rings",
    )
    assert unstated("docs/published/certificates.md", *said) == []
