"""Values for the page of a sweep: its words are in the template runs/sweep.md.j2."""

from __future__ import annotations

from rockwobble.compare import Sweep
from rockwobble.compare.storage.manifest import Manifest, Results
from rockwobble.compare.studies.sweep.result import stored_sweep

from ...figures.runs.sweep import pictures
from ..page import Page


def sweep_page(found: Sweep, manifest: Manifest) -> Page:
    """Return the page of a sweep."""
    values = {
        "plan": found.about,
        "grid": "model" in found.table,
        "parts": found.summary().to_dict("records"),
        "outcomes": found.outcomes,
        "about": manifest,
    }
    return Page(name="sweep", template="runs/sweep", values=values, pictures=pictures(found))


def stored_page(results: Results) -> Page:
    """Return the page of the sweep that is stored."""
    return sweep_page(stored_sweep(results), results.manifest)
