"""The page that plays one case of a comparison: its words are in the template comparison/view.md.j2."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from rockwobble.compare import Comparison
from rockwobble.compare.storage.manifest import Manifest, Results, made_now, write_results
from rockwobble.models import plain_json

from ...figures.comparison.playback import playback
from ...figures.comparison.view import case_views
from ..page import Page
from ..words.cases import describe
from ..words.sentences import fragment
from .findings import finding_sentences

KIND, _VALUES = "view", "view.json"


def view_values(comparison: Comparison, name: str) -> dict[str, object] | None:
    """Return what the page of a case is given, plain values; None where nothing moves."""
    (view,) = (view for view in case_views(comparison) if view.case.name == name)
    spec = playback(view)
    if spec is None:
        return None
    return {"name": name, "lines": describe(view.case), "findings": finding_sentences(view), "spec": spec}


def view_page(values: Mapping[str, object], manifest: Manifest) -> Page:
    """Return the page of what `view_values` gave."""
    player = fragment("comparison/player.html.j2", name="player", spec=values["spec"])
    return Page(
        name="view",
        template="comparison/view",
        values={**values, "about": manifest},
        blocks={"player": player},
    )


def save_view(folder: Path, comparison: Comparison, name: str, command: str) -> list[str]:
    """Write the page of a case and what it is given, and return the names of the files.

    Raises
    ------
    ValueError
        If nothing moves, or the folder cannot be written.
    """
    values = view_values(comparison, name)
    if values is None:
        raise ValueError(f"there is nothing to play in {name!r}: the cylinder never uplifts")
    inputs, versions = comparison.manifest().inputs, comparison.versions
    made = made_now(KIND, inputs=inputs, command=command, headline={"case": name}, versions=versions)
    files, pages = {_VALUES: plain_json.dumps(values).encode()}, _drawn(values, made)
    write_results(folder, made, {}, files=files, pages=pages)
    return [*files, *pages]


def stored_page(results: Results) -> dict[str, bytes]:
    """Return the page of the view that is stored."""
    return _drawn(plain_json.loads(results.content(_VALUES)), results.manifest)


def _drawn(values: Mapping[str, object], manifest: Manifest) -> dict[str, bytes]:
    return {"view.html": view_page(values, manifest).html().encode()}
