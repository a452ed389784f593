"""The report on the limits: what is published is what its tables say, drawn, complete and small enough."""

from __future__ import annotations

import html
import re
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from typer.testing import CliRunner

from rockwobble.compare.studies.validity import FULL, PARTS, QUICK, read_validity
from rockwobble.reports.cli.main import app
from rockwobble.reports.figures.picture import MOST_ENTRIES
from rockwobble.reports.pages.validity.page import validity_document, validity_page
from rockwobble.reports.pages.validity.sections import sections_of

PUBLISHED = Path(__file__).parents[2] / "reports" / "published" / "validity"
LARGEST = 8_000_000  # bytes of a page


@pytest.fixture(scope="module")
def published():
    return read_validity(PUBLISHED)


@pytest.fixture(scope="module")
def tables(published):
    return published.tables


@pytest.fixture(scope="module")
def page(published, tables):
    return validity_page(sections_of(tables), published)


def test_published_limits_are_those_of_the_published_tables(tables):
    published = pd.read_parquet(PUBLISHED / "limits.parquet").set_index(["limit", "number"])
    document = (PUBLISHED / "validity.md").read_text()
    for section in sections_of(tables):
        limit = section.limit
        for words in (limit.use, limit.error, limit.avoid):
            assert words in document
        for name, value in limit.numbers.items():
            np.testing.assert_equal(published.loc[(limit.subject, name), "value"], value)


def test_other_numbers_say_something_else(tables):
    limit = next(s.limit for s in sections_of(tables) if s.limit.subject == "Loss of contact")
    shaking = tables["shaking"].assign(least_normal=tables["shaking"]["least_normal"] - 1.0)
    lost = next(
        s.limit for s in sections_of(tables | {"shaking": shaking}) if s.limit.subject == "Loss of contact"
    )
    assert limit.use != lost.use == "At no slenderness mapped is contact kept everywhere."


def test_page_holds_every_limit_and_is_small_enough(page, tables):
    assert len(page) < LARGEST
    assert page.index('id="section-1"') < page.index('id="limits"')
    for section in sections_of(tables):
        assert html.escape(section.limit.subject) in page
        for picture in section.pictures:
            assert picture.title in page
    assert not re.search(r'<(script|link|img)[^>]*(src|href)="https?:', page)


def test_document_shows_every_picture_and_its_table_is_whole(published, tables):
    sections = sections_of(tables)
    document = validity_document(sections, published)
    shown = re.findall(r"\]\((.*?)\.svg\)", document)
    assert shown == [picture.name for section in sections for picture in section.pictures]
    assert len(set(shown)) == len(shown)
    assert all((PUBLISHED / f"{name}.svg").is_file() for name in shown)
    rows = [line for line in document.splitlines() if line.startswith("| ")]
    assert {row.count("|") for row in rows} == {5}


def test_every_picture_is_readable_alone(tables):
    for section in sections_of(tables):
        for picture in section.pictures:
            assert len(picture.entries()) <= MOST_ENTRIES, picture.name
            assert picture.caption


@pytest.mark.parametrize(
    ("options", "says"),
    [
        (["--workers", "0"], "--workers must be at least 1, got 0"),
        (["--out", "{file}"], "the output folder must be a folder"),
    ],
)
def test_bad_input_is_one_line(tmp_path, options, says):
    file = tmp_path / "file"
    file.touch()
    given = [option.format(file=file) for option in options]
    out = [] if "--out" in given else ["--out", str(tmp_path / "out")]
    done = CliRunner().invoke(app, ["validity", "--quick", *given, *out])
    assert done.exit_code == 2
    assert says in done.stderr
    assert done.stderr.count("\n") == 1
    assert not (tmp_path / "out").exists()


def test_quick_is_a_part_of_the_full_report_in_every_respect():
    for part in PARTS:
        assert 0 < len(part.tasks(QUICK)) <= len(part.tasks(FULL))
        quick, full = (sum(part.cost(inputs) for inputs in part.tasks(extent)) for extent in (QUICK, FULL))
        assert quick < full
