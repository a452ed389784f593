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
        "rockwobble.compare.studies.ensemble.study:read_ensemble",
        "rockwobble.reports.console.ensemble_output:ensemble_pages",
    ),
    "validity": (
        "rockwobble.compare.studies.validity.store:read_validity",
        "rockwobble.reports.pages.validity.output:validity_pages",
    ),
    "tradeoff": (
        "rockwobble.compare.studies.tradeoff.store:read_tradeoff",
        "rockwobble.reports.pages.tradeoff.page:tradeoff_pages",
    ),
    "extremes": (
        "rockwobble.compare.studies.extremes.store:read_extremes",
        "rockwobble.reports.pages.extremes.page:extremes_pages",
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
