"""Page on rolling contact in the releases of an engine, and how it moves between them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rockwobble.compare.storage.manifest import Manifest, Results
from rockwobble.multibody.engines.registry import engine_facts

from .page import Page
from .table import Row

if TYPE_CHECKING:
    import pandas as pd

KIND = "engine versions"


def versions_page(table: pd.DataFrame, made: Manifest) -> Page:
    """Return the page of a table that `tests/benchmarks/engine_versions.py` has measured."""
    rows: list[Row] = [
        {**{str(name): value for name, value in row.items()}, "title": engine_facts(str(row["engine"])).title}
        for row in table.to_dict("records")
    ]
    values = {"rows": rows, "about": made, "moved": _moved(table)}
    return Page(name="versions", template="versions", values=values)


def stored_page(results: Results) -> Page:
    """Return the page of what is stored."""
    return versions_page(results.table("versions"), results.manifest)


def _moved(table: pd.DataFrame) -> list[Row]:
    """Say between which releases the error of El Centro has changed by more than a tenth."""
    found: list[Row] = []
    for engine, own in table.groupby("engine", sort=False):
        known = own[own["el_centro"].notna()]
        pairs = zip(known.to_dict("records"), known.to_dict("records")[1:], strict=False)
        for before, after in pairs:
            ratio = after["el_centro"] / before["el_centro"]
            if not 0.9 < ratio < 1.1:
                title = engine_facts(str(engine)).title
                found.append({"engine": title, "since": after["version"], "ratio": ratio})
    return found
