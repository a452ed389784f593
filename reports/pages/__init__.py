"""Pages: what draws the results of each kind, also again from a folder."""

from __future__ import annotations

import importlib
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rockwobble.compare.storage.results import Results

    from .page import Page

# kind: the module whose `page_of` draws it; by name, because a command that shows one of them must not
# wait for the imports of all
KINDS: Mapping[str, str] = {
    "comparison": "pages.comparison",
    "view": "pages.view",
    "run": "pages.run",
    "sweep": "pages.sweep",
    "ensemble": "pages.ensemble",
    "fragility": "pages.fragility",
    "overturning spectrum": "pages.spectrum",
    "advice": "pages.advice",
    "validity": "pages.validity",
    "tradeoff": "pages.tradeoff",
    "extremes": "pages.extremes",
    "check": "pages.check",
    "engine versions": "pages.versions",
    "paper": "paper.page",
}


def stored_page(kind: str, folder: Path) -> Page:
    """Return the page of the results of a kind in `folder`, not drawn yet.

    Raises
    ------
    ValueError
        If they cannot be read.
    """
    importlib.import_module(f"rockwobble.reports.{KINDS[kind]}")  # which registers the kind
    from rockwobble.compare.storage.results import Results

    return page_of(Results.kinds[kind].load(folder))


def page_of(found: Results) -> Page:
    """Return the page of results, not drawn yet."""
    whole = found if found.manifest else found.made_by()
    page: Page = importlib.import_module(f"rockwobble.reports.{KINDS[found.kind]}").page_of(whole)
    return page
