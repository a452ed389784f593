"""Page of a sweep: input, and outcomes of each part."""

from __future__ import annotations

from rockwobble.studies import Sweep

from ..figures.sweep import pictures
from .cases import conditions
from .page import Page
from .wording import statement

# columns that tell the parts of a grid apart, and those of a suite of cases
_OF_GRID = (("motion", "ground motion", "words"), ("model", "model", "words"), ("tan_alpha", "tan α"))
_OF_CASES = (("run", "run", "words"),)


def page_of(results: Sweep) -> Page:
    """Page of a sweep."""
    plan, grid = results.facts, "model" in results.table
    values = {
        "plan": plan,
        "findings": list(map(statement, results.findings())),
        # suite cases have individual conditions
        "conditions": conditions(plan.get("options", plan)) if grid else [],
        "parts": results.summary().to_dict("records"),
        "columns": [
            *(_OF_GRID if grid else _OF_CASES),
            ("runs", "runs", "d"),
            *((outcome, outcome, "d") for outcome in results.outcomes),
            ("no_uplift", "did not uplift", "d"),
            ("median", "median [α]", ".3f"),
            ("largest", "largest [α]", ".3f"),
        ],
        "about": results.manifest,
    }
    return Page(name="sweep", template="runs/sweep", values=values, pictures=pictures(results))
