"""What can be drawn again from a folder of results: each kind, how it is read, and what draws its pages."""

from __future__ import annotations

import importlib
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

# kind: what loads it from a folder, and what returns name and content of each page; by name, because a
# command that shows one of them must not wait for the imports of all
KINDS: Mapping[str, tuple[str, str]] = {
    "comparison": (
        "rockwobble.compare.comparison.result:Comparison.load",
        "rockwobble.reports.pages.comparison.report:comparison_files",
    ),
    "ensemble": (
        "rockwobble.reports.pages.ensemble:stored_page",
        "rockwobble.reports.pages.page:Page.files",
    ),
    "fragility": (
        "rockwobble.reports.pages.fragility:stored_page",
        "rockwobble.reports.pages.page:Page.files",
    ),
    "overturning spectrum": (
        "rockwobble.reports.pages.spectrum:stored_page",
        "rockwobble.reports.pages.page:Page.files",
    ),
    "advice": (
        "rockwobble.reports.pages.advice:stored_page",
        "rockwobble.reports.pages.page:Page.files",
    ),
    "validity": (
        "rockwobble.reports.pages.validity:stored_page",
        "rockwobble.reports.pages.page:Page.files",
    ),
    "tradeoff": (
        "rockwobble.reports.pages.tradeoff:stored_page",
        "rockwobble.reports.pages.page:Page.files",
    ),
    "extremes": (
        "rockwobble.reports.pages.extremes:stored_page",
        "rockwobble.reports.pages.page:Page.files",
    ),
    "engine versions": (
        "rockwobble.reports.pages.versions:stored_page",
        "rockwobble.reports.pages.page:Page.files",
    ),
    "paper": (
        "rockwobble.reports.paper.page:stored_page",
        "rockwobble.reports.pages.page:Page.files",
    ),
}


def redrawn(kind: str, folder: Path) -> dict[str, bytes]:
    """Return name and content of each page of the results of a kind in `folder`.

    Raises
    ------
    ValueError
        If they cannot be read.
    """
    load, draw = (_named(name) for name in KINDS[kind])
    pages: dict[str, bytes] = draw(load(folder))
    return pages


def _named(name: str) -> Callable[..., Any]:
    module, _, path = name.partition(":")
    found: Any = importlib.import_module(module)
    for part in path.split("."):
        found = getattr(found, part)
    return found  # type: ignore[no-any-return]
