"""Registry of the pages that can be drawn again from a folder of results: what draws each kind."""

from __future__ import annotations

import importlib
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .page import Page

# kind: the module whose `stored_page` draws it; by name, because a command that shows one of them must not
# wait for the imports of all
KINDS: Mapping[str, str] = {
    "comparison": "pages.comparison.report",
    "view": "pages.comparison.view",
    "run": "pages.runs.run",
    "sweep": "pages.runs.sweep",
    "ensemble": "pages.ensemble",
    "fragility": "pages.fragility",
    "overturning spectrum": "pages.spectrum",
    "advice": "pages.advice",
    "validity": "pages.validity",
    "tradeoff": "pages.tradeoff",
    "extremes": "pages.extremes",
    "engine versions": "pages.versions",
    "paper": "paper.page",
}


def redrawn(kind: str, folder: Path) -> dict[str, bytes]:
    """Return name and content of each page of the results of a kind in `folder`.

    Raises
    ------
    ValueError
        If they cannot be read.
    """
    pages = stored_pages(kind, folder)
    return pages if isinstance(pages, dict) else pages.files()


def stored_pages(kind: str, folder: Path) -> dict[str, bytes] | Page:
    """Return the page of the results of a kind in `folder`, not drawn yet, or name and content of several.

    Raises
    ------
    ValueError
        If they cannot be read.
    """
    from rockwobble.compare.storage.manifest import read_results  # it loads numpy, which no help needs

    drawer = importlib.import_module(f"rockwobble.reports.{KINDS[kind]}")
    pages: dict[str, bytes] | Page = drawer.stored_page(read_results(folder, kind))
    return pages
