"""What can be drawn again from a folder of results: each kind, how it is read, and what draws its pages."""

from __future__ import annotations

import importlib
from collections.abc import Callable, Mapping
from operator import attrgetter
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .page import Page

# kind: what reads a folder, and what draws a page or files of that; by name, because a command that shows
# one of them must not wait for the imports of all
KINDS: Mapping[str, tuple[str, ...]] = {
    "comparison": ("compare:Comparison.load", "reports.pages.comparison.report:comparison_files"),
    "ensemble": ("reports.pages.ensemble:stored_page",),
    "fragility": ("reports.pages.fragility:stored_page",),
    "overturning spectrum": ("reports.pages.spectrum:stored_page",),
    "advice": ("reports.pages.advice:stored_page",),
    "validity": ("compare.studies.validity.study:read_validity", "reports.pages.validity:validity_page"),
    "tradeoff": ("compare.studies.tradeoff.study:read_tradeoff", "reports.pages.tradeoff:tradeoff_page"),
    "extremes": ("compare.studies.extremes.study:read_extremes", "reports.pages.extremes:extremes_page"),
    "engine versions": ("reports.pages.versions:stored_page",),
    "paper": ("reports.paper.page:stored_page",),
}


def redrawn(kind: str, folder: Path) -> dict[str, bytes]:
    """Return name and content of each page of the results of a kind in `folder`.

    Raises
    ------
    ValueError
        If they cannot be read.
    """
    found: Any = folder
    for name in KINDS[kind]:
        found = _named(name)(found)
    pages: dict[str, bytes] | Page = found
    return pages if isinstance(pages, dict) else pages.files()


def _named(name: str) -> Callable[..., object]:
    module, _, function = name.partition(":")
    found: Callable[..., object] = attrgetter(function)(importlib.import_module(f"rockwobble.{module}"))
    return found
