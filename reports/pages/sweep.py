"""The page of a sweep: what was run, and what became of each part of it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from rockwobble.studies import Sweep

from ..figures.sweep import pictures
from .cases import conditions
from .page import Page
from .table import number

# columns that tell the parts of a grid apart, and those of a suite of cases
_OF_GRID = (("motion", "ground motion", "words"), ("model", "model", "words"), ("tan_alpha", "tan α"))
_OF_CASES = (("run", "run", "words"),)


def page_of(results: Sweep) -> Page:
    """Return the page of a sweep."""
    plan, grid = results.facts, "model" in results.table
    values = {
        "plan": plan,
        **(_of_grid(plan) if grid else _of_cases(plan)),
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


def _of_grid(plan: Mapping[str, Any]) -> dict[str, object]:
    sizes, slendernesses, scales = (plan[name] for name in ("semidiagonals", "tan_alphas", "scales"))
    motions = _count_of(len(plan["motions"]), "ground motion")
    return {
        "size": f"{_count_of(plan['runs'], 'run')} from rest, without sliding.",
        "axes": [
            f"{_count_of(len(plan['models']), 'model')}: {', '.join(plan['models'])}",
            f"{_count_of(len(sizes), 'size')}: R = {_span(sizes)} m",
            f"{_count_of(len(slendernesses), 'slenderness', 'es')}: tan α = {_span(slendernesses)}",
            f"{motions} at {_count_of(len(scales), 'scale')}: {_span(scales)}",
        ],
        "conditions": conditions(plan.get("options", plan)),
    }


def _of_cases(plan: Mapping[str, Any]) -> dict[str, object]:
    """A suite of cases, of which each has conditions of its own."""
    cases, runs = _count_of(len(plan["cases"]), "case"), _count_of(len(plan["runs of each"]), "run")
    size = f"{_count_of(plan['runs'], 'run')}: {cases}, {runs} of each."
    return {"size": size, "axes": [], "conditions": []}


def _count_of(count: int, what: str, ending: str = "s") -> str:
    return f"{count:,d} {what}{'' if count == 1 else ending}"


def _span(values: Sequence[float]) -> str:
    least, largest = number(min(values)), number(max(values))
    return f"{least} to {largest}" if len(values) > 1 else least
