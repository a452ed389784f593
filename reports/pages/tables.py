"""Default page of results: main numbers, findings, tables."""

from __future__ import annotations

import inspect

from rockwobble.compare.storage.results import Results

from ..figures.tables import pictures
from ..registry import KINDS
from .page import Page
from .wording import statement

_MOST = 50  # rows of a table that are shown; the file has all


def _words(name: str) -> str:
    return name.replace("_", " ")


def page_of(results: Results) -> Page:
    """Page of the results."""
    drawn = pictures(results)
    values = {
        "title": (inspect.getdoc(type(results)) or results.kind).partition("\n")[0].rstrip("."),
        "headline": results.headline(),
        "findings": [statement(each) for each in results.findings()],
        "tables": {
            name: (
                table.head(_MOST).to_dict("records"),
                [[str(key), str(key).replace("_", " ")] for key in table],
            )
            for name, table in results.tables.items()
        },
        "pictures": [each.name for each in drawn],
        "about": results.manifest,
    }
    return Page(name=KINDS[results.kind].name, template="tables", values=values, pictures=drawn)
