"""The report on the limits: it says what its numbers say, is complete, drawn, and small enough."""

from __future__ import annotations

import dataclasses
import math
import re
from pathlib import Path

import pandas as pd
import pytest
from tiny_validity import TINY, tiny_validity
from typer.testing import CliRunner

from rockwobble.models.support import RECESS
from rockwobble.reports.cli.main import app
from rockwobble.reports.pages import page_of, stored_page
from rockwobble.reports.pages.page import Page
from rockwobble.studies.validity import study
from rockwobble.studies.validity.study import Validity, validity_of

pytestmark = pytest.mark.slow

LARGEST = 8_000_000  # bytes of a page


@pytest.fixture(scope="module")
def found(tmp_path_factory: pytest.TempPathFactory) -> Validity:
    return tiny_validity(tmp_path_factory.getbasetemp())


def changed(found: Validity, name: str, table: pd.DataFrame) -> str:
    """The document with another table of a part."""
    return page_of(dataclasses.replace(found, tables={**found.tables, name: table})).markdown()


def test_the_document_shows_every_picture_and_its_tables_are_whole(found: Validity) -> None:
    page = page_of(found)
    document = page.markdown()
    shown = re.findall(r"\]\((.*?)\.svg\)", document)
    assert sorted(shown) == sorted(picture.name for picture in page.pictures)
    assert not re.search(r"\bnan\b|None|\{\{|\}\}|@@", document)
    tables = [block.splitlines() for block in document.split("\n\n") if block.startswith("| ")]
    assert len(tables) >= 5
    assert all(len({row.count("|") for row in table}) == 1 for table in tables)


def test_every_figure_can_be_read(found: Validity) -> None:
    for picture in page_of(found).pictures:
        assert len(picture.entries()) <= 8
        assert picture.title
        assert picture.caption


def test_the_headline_says_what_the_records_show(found: Validity) -> None:
    records = found.tables["records"]
    document = page_of(found).markdown()
    assert "**It is undecided whether the engine in an ideal recess" in document
    assert "one record in twenty" not in document  # of so few records none is
    # twenty times the same records: the interval closes
    many = pd.concat(
        [records.assign(motion=[f"{name} {n}" for name in records["motion"]]) for n in range(20)]
    )
    model = many[many["method"] == RECESS.model].set_index("motion")["peak"]
    same = many.assign(peak=many["peak"].where(many["method"] != "recess", many["motion"].map(model)))
    document = changed(found, "records", same)
    assert "**In an ideal recess the engine has the model's peak tilt: over 40 records" in document
    assert "one record in twenty exceeds the model's" in document.split("## What must hold")[0]
    off = same.assign(peak=same["peak"].where(same["method"] != "recess", 1.2 * same["peak"]))
    assert "**The reduced model is not established even in an ideal recess" in changed(found, "records", off)


def test_other_numbers_say_something_else(found: Validity) -> None:
    peaks = found.tables["peaks"]
    assert "| Contact | kept in all" in page_of(found).markdown()
    assert "| Contact | lost in" in changed(
        found, "peaks", peaks.assign(least_normal=peaks["least_normal"] - 1.0)
    )
    ring = found.tables["records"]
    high = ring.assign(peak=ring["peak"].where(ring["method"] != "ring", 9.0 * ring["peak"]))
    # of fewer records than six no quantile is stated
    high = pd.concat([high.assign(motion=[f"{name} {n}" for name in high["motion"]]) for n in range(20)])
    assert "not on the safe side" in changed(found, "records", high)


def test_with_a_slab_it_is_named_and_no_clearance_is(found: Validity) -> None:
    tables = {name: table for name, table in found.tables.items() if name != "rings"}
    facts = {**found.facts, "slab_mass_ratio": 0.25}
    page = page_of(dataclasses.replace(found, tables=tables, facts=facts))
    document = page.markdown()
    assert "under a slab of 0.25 times its mass" in document
    assert "## A recess with clearance" not in document
    shown = re.findall(r"\]\((.*?)\.svg\)", document)
    assert sorted(shown) == sorted(picture.name for picture in page.pictures)


def test_with_a_tendon_it_is_stated_and_nothing_stands_against_flat_ground(found: Validity) -> None:
    tables = dict(found.tables)
    tables["peaks"] = tables["peaks"].assign(flat=math.nan, tension=1.25)
    free = dict.fromkeys(("flat_turn", "flat_period", "flat_peak"), math.nan)
    tables["free_response"] = tables["free_response"].assign(tension=1.0, **free)
    for name, model in (("records", "method"), ("following", "reference_support")):
        tables[name] = tables[name][~tables[name][model].isin(("flat-ground model", "flat"))]
    tables["verification"] = tables["verification"].query("support == 'recess'")
    facts = {**found.facts, "tendon_prestress": 0.5, "tendon_stiffness": 2.0}
    page = page_of(dataclasses.replace(found, tables=tables, facts=facts))
    document = page.markdown()
    assert "prestress 0.5 weights of a column, stiffness 2 weights per base radius" in document
    assert "raises uplift to 1.5 g tan α" in document
    assert "carries at most 1.25 weights of a column" in document
    assert "rolling out" not in document.split("## Free response")[1].split("## Friction")[0]
    assert "El Centro at 2.25 g tan α" in document
    assert not re.search(r"\bnan\b|None|\{\{|\}\}|@@", document)
    shown = re.findall(r"\]\((.*?)\.svg\)", document)
    assert sorted(shown) == sorted(picture.name for picture in page.pictures)


def test_the_command_stores_what_its_pages_are_drawn_from(
    found: Validity, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(study, "measure_all", lambda *_, **__: dict(found.tables))
    done = CliRunner().invoke(app, ["validity", "--quick", "--out", str(tmp_path)])
    assert done.exit_code == 0
    assert "What must hold" in done.stdout
    stored = Validity.load(tmp_path)
    anew = validity_of(stored.tables, TINY).limits
    pd.testing.assert_frame_equal(stored.limits, anew, check_exact=True)
    page = (tmp_path / "validity.html").read_text()
    assert len(page) < LARGEST
    assert not re.search(r'<(script|link|img)[^>]*(src|href)="https?:', page)
    before = stored_page("validity", tmp_path).markdown()
    assert "| Contact | kept in all" in before
    shaken = stored.tables["peaks"].assign(least_normal=-1.0)
    dataclasses.replace(stored, tables={**stored.tables, "peaks": shaken}).save(tmp_path)
    # drawn to the end once, above
    with monkeypatch.context() as patch:
        patch.setattr(Page, "html", lambda *_, **__: "")
        patch.setattr("rockwobble.reports.figures.svg.svg", lambda *_, **__: b"")
        assert CliRunner().invoke(app, ["report", str(tmp_path)]).exit_code == 0
    assert "| Contact | lost in" in (tmp_path / "validity.md").read_text() != before
