"""Page on rolling contact in the releases of an engine, and how it moves between them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from rockwobble.compare.storage.manifest import Number
from rockwobble.compare.storage.results import Results
from rockwobble.multibody.engines.registry import engine_facts

from .page import Page
from .table import Row

if TYPE_CHECKING:
    import pandas as pd

KIND = "engine versions"


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class EngineVersions(Results, kind=KIND):
    """Rolling contact in the releases of engines: the table `versions`, a row for each release."""

    def headline(self) -> dict[str, Number]:
        """Return the number of releases of each engine."""
        counts = self.versions["engine"].value_counts()
        return {f"releases of {name}": int(count) for name, count in counts.items()}

    def sheets(self) -> dict[str, bytes]:
        """Return the table as CSV."""
        return {"versions.csv": self.versions.to_csv(index=False).encode()}


def page_of(found: EngineVersions) -> Page:
    """Return the page of a table that `tests/benchmarks/engine_versions.py` has measured."""
    rows: list[Row] = [
        {**{str(name): value for name, value in row.items()}, "title": engine_facts(str(row["engine"])).title}
        for row in found.versions.to_dict("records")
    ]
    values = {
        "rows": rows,
        "about": found.manifest,
        "answer": _answer(_changes(found.versions)),
        "earlier": _earlier(found.facts.get("earlier", {})),
    }
    return Page(name="versions", template="versions", values=values)


def _answer(moved: Sequence[Row]) -> str:
    """Which releases have moved the error, or that none has."""
    if not moved:
        return "No release has moved the error under El Centro by more than a tenth."
    each = [f"{row['engine']} {row['since']} ({row['ratio']:.2g} times)" for row in moved]
    count = f"{len(moved)} releases have" if len(moved) > 1 else "1 release has"
    return f"{count} moved the error under El Centro by more than a tenth: {', '.join(each)}."


def _earlier(origins: Mapping[str, Mapping[str, str]]) -> str:
    """What made the rows of earlier runs; empty without such rows."""
    each = [
        f"{engine_facts(name).title} ({made['date']}, commit {made['commit'][:12]})"
        for name, made in origins.items()
    ]
    return f"Rows of earlier runs: {', '.join(each)}." if each else ""


def _changes(table: pd.DataFrame) -> list[Row]:
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
