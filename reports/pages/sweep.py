"""The page of a sweep: what was run, and what became of each part of it."""

from __future__ import annotations

from rockwobble.studies import Sweep

from ..figures.sweep import pictures
from .cases import conditions
from .page import Page
from .wording import statement


def page_of(results: Sweep) -> Page:
    """Return the page of a sweep."""
    plan = results.facts
    values = {
        "plan": plan,
        "findings": list(map(statement, results.findings())),
        "conditions": conditions(plan["options"]),
        "parts": results.summary().to_dict("records"),
        "columns": [
            ("motion", "ground motion", "words"),
            ("model", "model", "words"),
            ("tan_alpha", "tan α"),
            ("runs", "runs", "d"),
            *((outcome, outcome, "d") for outcome in results.outcomes),
            ("no_uplift", "did not uplift", "d"),
            ("median", "median [α]", ".3f"),
            ("largest", "largest [α]", ".3f"),
        ],
        "about": results.manifest,
    }
    return Page(name="sweep", template="runs/sweep", values=values, pictures=pictures(results))
