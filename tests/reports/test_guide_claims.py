"""The numbers of guides and of the README of a folder of results are those of the published tables."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pandas as pd
import pytest

from rockwobble.studies.validity.limits import limits_of
from rockwobble.studies.validity.study import Validity

pytestmark = pytest.mark.checkout

CHECKOUT = Path(__file__).parents[2]
PUBLISHED = CHECKOUT / "reports" / "published"
ENSEMBLES = PUBLISHED / "ensemble"
COMMAND = r"\[(\S+)\]\(\S+\) \| `(rockwobble ensemble [^`]*)`"


def words(path: str | Path) -> str:
    return " ".join((CHECKOUT / path).read_text(encoding="utf-8").split())


def contrasts(name: str) -> pd.DataFrame:
    table = pd.read_parquet(ENSEMBLES / name / "contrasts.parquet")
    return table.set_index(["method", "against"])


def test_the_commands_of_the_ensembles_are_those_of_their_manifests() -> None:
    stated = dict(re.findall(COMMAND, words(ENSEMBLES / "README.md")))
    assert sorted(stated) == sorted(path.parent.name for path in ENSEMBLES.glob("*/manifest.json"))
    for name, command in stated.items():
        made = json.loads((ENSEMBLES / name / "manifest.json").read_text(encoding="utf-8"))["command"]
        assert f"{command} --out ensemble/{name}" == made.removesuffix(" --overwrite")


@pytest.mark.parametrize(("name", "support"), [("p695-2", "flat"), ("p695-3.5", "flat"), ("copies", "")])
def test_the_intervals_of_the_ensembles_are_those_of_their_tables(name: str, support: str) -> None:
    (line,) = (row for row in words(ENSEMBLES / "README.md").split(" | [") if row.startswith(f"{name}]"))
    table = contrasts(name).reset_index()
    for each, own in (("recess", "recess model"), ("flat", "flat-ground model")):
        if each == "flat" and not support:
            continue
        rows = table[(table["against"] == own) & table["method"].str.endswith(f" {each}")]
        assert (rows["verdict"] == "within").all()
        ends = f"{rows['ratio_low'].min():.3f} to {rows['ratio_high'].max():.3f}"
        assert ends in line


def test_the_findings_of_the_ensembles_are_those_of_their_tables() -> None:
    text = words(ENSEMBLES / "README.md")
    two = contrasts("p695-2")
    higher = [two.loc[(f"{engine} recess", "recess model")] for engine in ("mujoco", "pybullet")]
    assert [(row["higher"], row["compared"]) for row in higher] == [(16, 20), (16, 20)]
    assert "each higher in 16 of 20" in text
    assert "(p = {:.3f} and {:.3f};".format(*(row["ratio_p"] for row in higher)) in text
    assert all(row["ratio"] < 1.002 and row["ratio_p_adjusted"] > 0.05 for row in higher)
    support = ("flat-ground model", "recess model")
    copies = contrasts("copies").loc[support]
    numbers = "{:.2f} ({:.2f} to {:.2f})".format(*(copies[f"ratio{end}"] for end in ("", "_low", "_high")))
    assert f"has {numbers} of the recess model's peak" in text
    ends = [contrasts(name).loc[support] for name in ("p695-2", "p695-3.5")]
    stated = [f"from {row['ratio_low']:.2f} to {row['ratio_high']:.2f} at" for row in ends]
    assert f"{stated[0]} 2 g tan α, {stated[1]} 3.5" in text


def test_the_limits_on_one_screen_are_the_published_ones() -> None:
    found = Validity.load(PUBLISHED / "validity")
    number = limits_of(found.tables, found.structure).set_index(["limit", "number"])["value"]
    text = words("docs/guide/limits.md")

    def ends(models: str, form: str) -> str:
        return " to ".join(f"{number[f'traces.{models}', end]:{form}}" for end in ("low", "high"))

    low, high = (number["limit_model.strays", f"ratio_ring_{end}"] for end in ("least", "largest"))
    assert f"is {low:.2g} to {high:.2g}, by case" in text
    assert f"{ends('recess_recess', '.0f')} s in a recess" in text
    flat = (
        f"{ends('flat_recess', '.1f')} s by the recess model, {ends('flat_flat', '.0f')} s by the flat-ground"
    )
    assert f"on flat ground {flat}" in text
    page = (PUBLISHED / "validity" / "validity.md").read_text(encoding="utf-8")
    rows = re.findall(r"\| engine, flat ground \| 22 \| \S+ \| (\S+) \| (\S+) \|", page)
    assert len(rows) == 12
    low, high = min(float(each) for each, _ in rows), max(float(each) for _, each in rows)
    assert (
        f"interval of the median ratio of the peaks extends from {low:.1f} to {high:.1f} by the engine"
        in text
    )
    rows = re.findall(r"\| flat-ground model \| 22 \| \S+ \| (\S+) \|", page)
    assert f"from {min(map(float, rows)):.1f} by the flat-ground model" in text
    changed = [number["vertical.vertical", name] for name in ("other", "cells")]
    changed.append(number["vertical.copy", "other"])
    assert (
        "changes {:.0f} of {:.0f} verdicts, as many as chance (a record 1 % stronger changes {:.0f})".format(
            *changed
        )
        in text
    )
    known = re.search(r"known within 5 % at (\d+ of \d+ points)", page)
    assert known is not None
    assert known[0] in text
    # the same peak within a thousandth in the median
    medians = [number["limit_model.established", f"ratio_{end}"] for end in ("least", "largest")]
    assert max(abs(each - 1.0) for each in medians) < 1e-3


@pytest.mark.parametrize("page", ["README.md", "docs/start.md", "docs/index.md"])
def test_for_how_long_traces_agree(page: str) -> None:
    rows = pd.read_csv(PUBLISHED / "compare" / "summary.csv")
    fixed = rows["run"].str.contains("follow_load=False")  # nothing steered
    recess = rows[(rows["support"] == "recess") & (rows["reference"] == "recess model")]
    (time,) = set(re.findall(r"for (\d+) s after uplift", words(page)))
    assert int(time) <= recess[~fixed[recess.index]]["agreement_time"].min() < int(time) + 1
    for either in re.findall(r"(\d+) s with nothing steered|nothing steered [^.]*? for (\d+) s", words(page)):
        assert int(max(either)) <= recess[fixed[recess.index]]["agreement_time"].item() < int(max(either)) + 1
    own = rows[(rows["support"] == "flat") & (rows["reference"] == "flat-ground model") & ~fixed]
    for time in re.findall(r"another model, for (\d+\.\d) s after uplift", words(page)):
        assert time == f"{own['agreement_time'].min():.1f}"


def test_with_nothing_steered_the_two_agree_for_as_long_as_published() -> None:
    rows = pd.read_csv(PUBLISHED / "compare" / "summary.csv").set_index(["run", "reference"])
    ends = rows["within_tolerance_until"]
    runs = [("recess", "recess model"), ("flat", "flat-ground model")]
    fixed, followed = (
        [f"{ends[f'mujoco {support}{more}', model]:.1f}" for support, model in runs]
        for more in (" follow_load=False", "")
    )
    said = f"the two agree until {fixed[0]} s in the recess and {fixed[1]} s on flat ground"
    assert f"{said}, and until {followed[0]} s and {followed[1]} s where" in words("docs/guide/engines.md")
    assert said in words("docs/guide/comparison.md")


@pytest.mark.parametrize("page", ["docs/guide/frames.md", "docs/published/frames.md"])
def test_a_deck_is_a_larger_cylinder_by_what_the_guide_says(page: str) -> None:
    from benchmarks.decks import PIER, equivalent

    text = words(page)
    for ratio in (1.0, 4.0):
        size = equivalent(ratio).semidiagonal / PIER.semidiagonal
        assert re.search(rf"{size:.2f} times (?:at|\()\s?γ = {ratio:g}", text)
    most = equivalent(1e6).semidiagonal / PIER.semidiagonal
    assert f"{most:.2f}" in text
    medians = pd.read_csv(PUBLISHED / "decks" / "medians-300.csv")
    planes = medians[medians["method"] == "worse plane"].set_index("slab_mass_ratio")["over_3d"]
    assert "{:.0f} %, {:.0f} % and {:.0f} %".format(*(100.0 * (planes - 1.0))) in text


def test_the_page_of_certificates_counts_their_cases() -> None:
    made = {
        name: json.loads((PUBLISHED / "certificates" / f"{name}.json").read_text(encoding="utf-8"))
        for name in ("reduced", "mujoco")
    }
    low, high = (len(each["fingerprint"]) for each in made.values())
    page = words("docs/published/certificates.md")
    assert f"a fingerprint of {low} or {high} short cases" in page
    compared = pd.read_csv(PUBLISHED / "certificates" / "releases.csv")
    assert set(compared.groupby(["engine", "verified", "python"]).size()) == {12}
    assert "of twelve cases, before frames, tendons and rings had theirs" in page
