"""Error budget of one engine run, in lines for a terminal."""

from __future__ import annotations

import rockwobble as rw
from rockwobble.compare.comparison.budget import COVERED

from ..pages.words.sentences import lines

_PARTS = ("model_form", "numerics", "unexplained")


def budget_of_run(case: rw.Case, run: rw.Run, reference: rw.Run) -> list[str]:
    """Return the lines; they rest on runs at finer time steps, made here."""
    comparison = rw.compare(case, runs=[run], budget=True)
    label = next((label for (_, label), trace in comparison.traces.items() if trace.run == reference), None)
    rows = comparison.summary[comparison.summary["reference"] == label]
    budget = next((found for key, found in comparison.budgets.items() if key[2] == label), None)
    return lines(
        "comparison/budget_of_run.txt.j2",
        budget=budget,
        row=next(rows.itertuples(), None),  # a reference that is not its own has none
        share=100.0 * COVERED,
        verdict=budget and (budget.not_split or max(_PARTS, key=budget.rms)),
    )
