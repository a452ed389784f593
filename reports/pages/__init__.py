"""Pages: what draws the results of each kind, also again from a folder."""

from __future__ import annotations

import importlib
from pathlib import Path
from typing import TYPE_CHECKING

from ..registry import KINDS

if TYPE_CHECKING:
    from rockwobble.compare.storage.results import Results

    from .page import Page


def stored_page(kind: str, folder: Path) -> Page:
    """Return the page of the results of a kind in `folder`, not drawn yet.

    Raises
    ------
    ValueError
        If they cannot be read.
    """
    return page_of(KINDS[kind].results_class().load(folder))


def page_of(found: Results) -> Page:
    """Return the page of results, not drawn yet."""
    whole = found if found.manifest else found.made_by()
    page: Page = importlib.import_module(f"rockwobble.reports.pages.{KINDS[found.kind].name}").page_of(whole)
    return page
