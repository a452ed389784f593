"""Pages: what draws the results of each kind, also again from a folder."""

from __future__ import annotations

import importlib
from importlib.util import find_spec
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


def page_of(results: Results) -> Page:
    """Return the page of results, not drawn yet."""
    whole = results if results.manifest else results.made_by()
    name = KINDS[results.kind].name
    module = name if find_spec(f".{name}", __name__) else "tables"
    page: Page = importlib.import_module(f".{module}", __name__).page_of(whole)
    return page
