"""Values for the page of a sweep: its words are in the template runs/sweep.md.j2."""

from __future__ import annotations

from rockwobble.compare import Sweep

from ..figures.sweep import pictures
from .page import Page


def page_of(found: Sweep) -> Page:
    """Return the page of a sweep."""
    values = {
        "plan": found.facts,
        "grid": "model" in found.table,
        "parts": found.summary().to_dict("records"),
        "outcomes": found.outcomes,
        "about": found.manifest,
    }
    return Page(name="sweep", template="runs/sweep", values=values, pictures=pictures(found))
