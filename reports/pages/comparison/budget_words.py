"""What the error budgets of a comparison say, in sentences made from their numbers."""

from __future__ import annotations

from typing import Any

from rockwobble.compare import LARGEST_SHARE, WORTH_EXPLAINING, findings
from rockwobble.compare.traces.trajectory import SUPPORT as EXTERNAL

from ..template import small

_LISTED = 10


def budget_lines(summary: Any) -> list[str]:
    """Return the sentences on the budgets: the findings first; empty where there are no budgets."""
    known = summary[summary["whole_rms"].notna()]
    if not len(known):
        return []
    worth = known[known["whole_rms"] > WORTH_EXPLAINING]
    found = findings(known)
    lines = [
        f"{row.case}, {row.run} against {row.reference}: {100.0 * row.unexplained_share:.0f} % of the "
        f"difference of {small(row.whole_rms)} alpha stay unexplained (the extrapolation itself is known "
        f"to {small(row.limit_error)} alpha)."
        for _, row in found.head(_LISTED).iterrows()
    ]
    if len(found) > _LISTED:
        more = len(found) - _LISTED
        lines.append(f"So they do in {more} more row{'s' if more > 1 else ''} of the summary.")
    explained = len(worth) - len(found)
    share = f" ({100.0 * explained / len(worth):.0f} %)" if len(worth) else ""
    cases, with_findings = worth["case"].nunique(), found["case"].nunique()
    lines.append(
        f"Model form and numerics explain all but {100.0 * LARGEST_SHARE:.0f} % of the difference in "
        f"{explained} of the {len(worth)} rows{share} that differ by more than {small(WORTH_EXPLAINING)} "
        f"alpha, and in every such row of {cases - with_findings} of {cases} cases; "
        f"{len(known) - len(worth)} rows differ by less."
    )
    missing = len(summary) - len(known)
    if missing:
        lines.append(f"{missing} rows have no budget: their runs failed, never moved, or have no finer step.")
    return lines


def divergence_lines(summary: Any) -> list[str]:
    """Return whether traces diverged when they had to, those that did so too early by name.

    Of trajectories from elsewhere nobody can predict that: the prediction rests on the errors of an engine.
    """
    summary = summary[summary["support"] != EXTERNAL]
    counts = summary["divergence"].value_counts()
    words = ", ".join(f"{counts[word]} {word}" for word in counts.index if word)
    lines = [
        f"{row.case}, {row.run} against {row.reference}: they diverge after {row.agreement_time:.2f} s, "
        f"{row.predicted_agreement_time:.2f} s were predicted. Earlier than they had to: a finding."
        for _, row in summary[summary["divergence"] == "earlier"].iterrows()
    ]
    return (
        [*lines, f"Did traces diverge when they had to, within a factor of 2? {words}."] if words else lines
    )
