"""Pages: renderers of the results of each kind, new or stored."""

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
    """Page of the stored results of a kind in `folder`, not rendered yet.

    Raises
    ------
    ValueError
        If they cannot be read.
    """
    return page_of(KINDS[kind].results_class().load(folder))


def page_of(results: Results) -> Page:
    """Page of results, not rendered yet."""
    whole = results if results.manifest else results.made_by()
    name = KINDS[results.kind].name
    module = name if find_spec(f".{name}", __name__) else "tables"
    page: Page = importlib.import_module(f".{module}", __name__).page_of(whole)
    return page
