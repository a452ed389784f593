"""What the error budgets of a comparison say, and whether traces diverged when they had to."""

from __future__ import annotations

import pandas as pd

from rockwobble.compare import LARGEST_SHARE, WORTH_EXPLAINING, findings
from rockwobble.compare.traces.trajectory import SUPPORT as EXTERNAL

from ...figures.comparison.view import rows_of
from ..words.sentences import sentence
from .findings import WORDS

_LISTED = 10


def budget_sentences(summary: pd.DataFrame) -> list[str]:
    """Return the sentences on the budgets: the findings first; empty where there are no budgets."""
    known = summary[summary["whole_rms"].notna()]
    if not len(known):
        return []
    worth, found = known[known["whole_rms"] > WORTH_EXPLAINING], findings(known)
    lines = [sentence(WORDS, "unexplained", row) for row in rows_of(found.head(_LISTED))]
    counts = {
        "more": len(found) - _LISTED,
        "worth": len(worth),
        "explained": len(worth) - len(found),
        "cases": worth["case"].nunique(),
        "explained_cases": worth["case"].nunique() - found["case"].nunique(),
        "small": len(known) - len(worth),
        "missing": len(summary) - len(known),
        "largest": LARGEST_SHARE,
        "bound": WORTH_EXPLAINING,
    }
    said = [sentence(WORDS, macro, counts) for macro in ("more_unexplained", "explained", "no_budget")]
    return [*lines, *filter(None, said)]


def divergence_sentences(summary: pd.DataFrame) -> list[str]:
    """Return whether traces diverged when they had to, those that did so too early by name.

    Of external trajectories nobody can predict that: the prediction rests on the errors of an engine.
    """
    summary = summary[summary["support"] != EXTERNAL]
    counts = summary["divergence"].value_counts()
    said = [f"{counts[verdict]} {verdict}" for verdict in counts.index if verdict]
    early = [sentence(WORDS, "early", row) for row in rows_of(summary[summary["divergence"] == "earlier"])]
    return [*early, sentence(WORDS, "in_time", said)] if said else early
