"""Findings of the validity study: what establishes the model, what contradicts it, and what they count."""

from __future__ import annotations

import re
from pathlib import Path

import pandas as pd
import pytest

from rockwobble.compare.metrics.statistics import MARGIN
from rockwobble.models.finding import Finding
from rockwobble.reports.pages.wording import words
from rockwobble.studies.validity.findings import converges_by_record, findings_of, model_verdict
from rockwobble.studies.validity.limits import Numbers, limits_of
from rockwobble.studies.validity.plan import Structure
from rockwobble.studies.validity.study import Validity

pytestmark = pytest.mark.checkout

PUBLISHED = Path(__file__).parents[2] / "reports" / "published" / "validity"


@pytest.fixture(scope="module")
def found() -> Validity:
    return Validity.load(PUBLISHED)


@pytest.fixture(scope="module")
def limits(found: Validity) -> dict[str, Numbers]:
    return limits_of(found.tables)


def by_key(limits: dict[str, Numbers], **structure: float) -> dict[str, Finding]:
    return {each.key: each for each in findings_of(limits, Structure(**structure))}


@pytest.mark.parametrize(
    ("limit", "numbers", "key"),
    [
        ("records", {"recess_beyond": 1.0}, "limit_model.contradicted"),
        ("records", {"recess_within": 0.0}, "limit_model.undecided"),
        ("records", {"strays_bounded": 1.0}, "limit_model.strays"),
        ("contact", {"lost": 2.0, "lost_from": 0.4, "lost_intensity": 3.0}, "limit_requirement.contact_lost"),
        ("records", {"halved_05_least": 1.0, "halved_95_largest": 1.0}, "limit_records.converged"),
    ],
)
def test_findings_change_with_the_numbers(
    limits: dict[str, Numbers], limit: str, numbers: Numbers, key: str
) -> None:
    plain, other = by_key(limits), by_key({**limits, limit: {**limits[limit], **numbers}})
    assert key in other
    assert plain.keys() != other.keys()


def test_under_a_slab_no_clearance_is_spoken_of(limits: dict[str, Numbers]) -> None:
    records = {name: value for name, value in limits["records"].items() if not name.startswith("ring_")}
    without = {name: numbers for name, numbers in limits.items() if name != "rings"}
    keys = by_key(without | {"records": records}, slab_mass_ratio=0.5)
    assert "limit_scope.slab" in keys
    assert not any(key.startswith("limit_ring.") for key in keys)
    assert "ratio" not in dict(keys["limit_force.slip"].values)


def test_findings_count_what_the_tables_hold(found: Validity, limits: dict[str, Numbers]) -> None:
    values = {key: each.values for key, each in by_key(limits).items()}  # noqa: PD011
    records = found.tables["records"]
    standing = records.loc[(records["method"] == "ring") & (records["outcome"] == "stands"), "peak"]
    beyond = values["limit_records.beyond_alpha"]
    assert (beyond["runs"], beyond["runs_all"], beyond["peak"]) == (
        (standing >= 1.0).sum(),
        len(standing),
        standing.max(),
    )
    ends, left_out = records["outcome"].value_counts(), values["limit_records.left_out"]
    assert (left_out["count"], left_out["count_undecided"]) == (ends["failed"], ends["undecided"])
    rings = found.tables["rings"][found.tables["rings"]["support"] == "ring"]
    twist = rings["twist"].abs().groupby(rings["motion"]).max()
    place = values["limit_ring.place"]
    assert (place["bound"], place["bound_free"]) == (twist["El Centro 1940"], twist["free response"])
    shaken = rings[(rings["motion"] != "free response") & (rings["outcome"] != "failed")]
    ratio = shaken["peak"] / shaken["recess_peak"]
    assert (
        values["limit_ring.worst"]["ratio"]
        == ratio[pd.concat([ratio, 1.0 / ratio], axis=1).max(axis=1).idxmax()]
    )
    table = found.tables["verification"]
    turns = table.groupby(["tan_alpha", "release", "spin"])["turn"]
    error = (table["engine_turn"] - table["turn"]).abs() / (turns.transform("max") - turns.transform("min"))
    unsure, decided = int((error >= 0.5).sum()), values["limit_release.decided"]
    assert (decided["runs"], decided["runs_open"]) == (len(table) - unsure, unsure)
    assert decided["count"] == turns.ngroups


def test_bounds_are_rounded_to_the_safe_side() -> None:
    checked = 0
    for group in ("requirement", "records", "release", "force", "ring"):
        for line in words()[f"limit_{group}"].values():
            text = line if isinstance(line, str) else line[-1]
            # a softness may be used up to its bound, which is rounded down
            for side, form in re.findall(r"at (most|least) \{\w+:([^}]*)\}(?!/p)", text):
                assert form.startswith(side), text
                checked += 1
    assert checked >= 10


@pytest.mark.parametrize(
    ("contradicted", "beyond", "within", "verdict"),
    [
        (0.0, 0.0, 0.0, "undecided"),
        (0.0, 0.0, 1.0, "established"),
        (0.0, 1.0, 2.0, "contradicted"),
        (1.0, 0.0, 2.0, "contradicted"),
    ],
)
def test_one_contradiction_outweighs_any_agreement(contradicted, beyond, within, verdict):
    records = {"recess_beyond": beyond, "recess_within": within}
    assert model_verdict({"free_response": {"contradicted": contradicted}, "records": records}) == verdict


@pytest.mark.parametrize(
    ("least", "largest", "expected"),
    [
        (1.0 / (1.0 + MARGIN), 1.0 + MARGIN, True),
        (1.0 / (1.0 + MARGIN) - 1e-3, 1.0, False),
        (1.0, 1.0 + MARGIN + 1e-3, False),
    ],
)
def test_runs_converge_where_neither_tail_leaves_the_margin(least, largest, expected):
    records = {"halved_05_least": least, "halved_95_largest": largest}
    assert converges_by_record({"records": records}) == expected
