"""Validity report: numbers, completeness, figures, and size."""

from __future__ import annotations

import dataclasses
import math
import re
from pathlib import Path

import pandas as pd
import pytest
from tiny_validity import TINY, tiny_validity
from typer.testing import CliRunner

from rockwobble.models.finding import Finding
from rockwobble.reports.cli.main import app
from rockwobble.reports.pages import page_of, stored_page
from rockwobble.reports.pages.page import Page
from rockwobble.reports.pages.wording import lines_of
from rockwobble.studies.validity import study
from rockwobble.studies.validity.study import Validity, validity_of

pytestmark = pytest.mark.slow

LARGEST = 8_000_000  # bytes of a page


@pytest.fixture(scope="module")
def validity(tmp_path_factory: pytest.TempPathFactory) -> Validity:
    return tiny_validity(tmp_path_factory.getbasetemp())


def test_document_has_every_picture_and_complete_tables(validity: Validity) -> None:
    page = page_of(validity)
    document = page.markdown()
    shown = re.findall(r"\]\((.*?)\.svg\)", document)
    assert sorted(shown) == sorted(picture.name for picture in page.pictures)
    assert not re.search(r"\bnan\b|None|\{\{|\}\}|@@", document)
    tables = [block.splitlines() for block in document.split("\n\n") if block.startswith("| ")]
    assert len(tables) >= 5
    assert all(len({row.count("|") for row in table}) == 1 for table in tables)


def test_validity_figures_are_legible(validity: Validity) -> None:
    for picture in page_of(validity).pictures:
        assert len(picture.entries()) <= 8
        assert isinstance(picture.caption, Finding)
        title, words = lines_of(picture.caption.key)
        assert title != words


def test_report_with_slab_names_it_and_omits_clearance(validity: Validity) -> None:
    tables = {name: table for name, table in validity.tables.items() if name != "rings"}
    facts = {**validity.facts, "slab_mass_ratio": 0.25}
    page = page_of(dataclasses.replace(validity, tables=tables, facts=facts))
    document = page.markdown()
    assert "## A recess with clearance" not in document
    shown = re.findall(r"\]\((.*?)\.svg\)", document)
    assert sorted(shown) == sorted(picture.name for picture in page.pictures)


def test_report_with_tendon_states_it_and_omits_flat_ground(validity: Validity) -> None:
    tables = dict(validity.tables)
    tables["peaks"] = tables["peaks"].assign(flat=math.nan, tension=1.25)
    free = dict.fromkeys(("flat_turn", "flat_period", "flat_peak"), math.nan)
    tables["free_response"] = tables["free_response"].assign(tension=1.0, **free)
    for name, model in (("records", "method"), ("following", "reference_support")):
        tables[name] = tables[name][~tables[name][model].isin(("flat-ground model", "flat"))]
    tables["verification"] = tables["verification"].query("support == 'recess'")
    facts = {**validity.facts, "tendon_prestress": 0.5, "tendon_stiffness": 2.0}
    changed = dataclasses.replace(validity, tables=tables, facts=facts)
    page = page_of(changed)
    document = page.markdown()
    assert "limit_requirement.tendon" in [each.key for each in changed.findings()]
    assert "rolling out" not in document.split("## Free response")[1].split("## Friction")[0]
    assert "El Centro at 2.25 g tan α" in document
    assert not re.search(r"\bnan\b|None|\{\{|\}\}|@@", document)
    shown = re.findall(r"\]\((.*?)\.svg\)", document)
    assert sorted(shown) == sorted(picture.name for picture in page.pictures)


def test_stored_tables_suffice_to_redraw_the_pages(
    validity: Validity, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(study, "measure_all", lambda *_, **__: dict(validity.tables))
    done = CliRunner().invoke(app, ["validity", "--quick", "--out", str(tmp_path)])
    assert done.exit_code == 0
    stored = Validity.load(tmp_path)
    anew = validity_of(stored.tables, TINY).limits
    pd.testing.assert_frame_equal(stored.limits, anew, check_exact=True)
    page = (tmp_path / "validity.html").read_text()
    assert len(page) < LARGEST
    assert not re.search(r'<(script|link|img)[^>]*(src|href)="https?:', page)
    before = stored_page("validity", tmp_path).markdown()
    shaken = stored.tables["peaks"].assign(least_normal=-1.0)
    dataclasses.replace(stored, tables={**stored.tables, "peaks": shaken}).save(tmp_path)
    # drawn completely once, above
    with monkeypatch.context() as patch:
        patch.setattr(Page, "html", lambda *_, **__: "")
        patch.setattr("rockwobble.reports.figures.svg.svg", lambda *_, **__: b"")
        assert CliRunner().invoke(app, ["report", str(tmp_path)]).exit_code == 0
    assert (tmp_path / "validity.md").read_text() != before
