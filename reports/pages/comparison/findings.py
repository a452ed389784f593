"""Findings of a comparison: sentences on each row of the summary, on budgets and on divergences."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import pandas as pd

from rockwobble.compare import LARGEST_SHARE, WORTH_EXPLAINING
from rockwobble.compare import findings as unexplained
from rockwobble.compare.external.trajectory import SUPPORT as EXTERNAL
from rockwobble.compare.metrics.pair import make_pair
from rockwobble.compare.runs.labels import REDUCED
from rockwobble.models import Case, Run, Trace
from rockwobble.models.diagnostic import parted

from ...figures.comparison.view import CaseView, own_rows, rows_of
from ..words.diagnostics import counted, failure, remarks
from ..words.sentences import sentence, the
from .external import explains_divergence, external_sentences, scope, within

WORDS = "comparison/findings.md.j2"
_LISTED = 10
# of the tilt at release, which an engine is given as a pose
_SAME_TILT = 1e-6


@dataclass(frozen=True, slots=True, kw_only=True)
class Finding:
    """Finding on one row of the summary.

    Attributes
    ----------
    row : namedtuple
    failed : str
        Why there is nothing to compare; empty where there is.
    uplifted, reference_uplifted : bool
    reason : str
        Why they diverge: "support", "walls", "pass" (one that contact does not resolve), "near passes",
        "mistake" (of an external trajectory), or "" (no pass: not chance).
    bound : str
        What agreement means, in words.
    passes : int
        Passes of the reference while they agree.
    end : float
        Up to when traces of different length are compared [s]; NaN where it is to the end.
    released : bool
        Whether the peak tilt of both is that of the release, which tells nothing of either.
    """

    row: Any
    failed: str
    uplifted: bool
    reference_uplifted: bool
    reason: str
    bound: str
    passes: int
    end: float
    released: bool = False

    @property
    def external(self) -> bool:
        """Whether it is of an external trajectory."""
        return bool(self.row.support == EXTERNAL)

    @property
    def peak_share(self) -> float:
        """Difference of the peak tilts over that of the reference."""
        ours, theirs = self.row.peak_tilt, self.row.reference_peak_tilt
        return abs(ours - theirs) / theirs if theirs > 0.0 else math.inf


def findings(view: CaseView) -> Iterator[Finding]:
    """Yield the finding on each row of a case."""
    traces, length = view.traces, view.case.length
    for row in rows_of(view.rows):
        lost = [
            f"{label} failed: {failure(view.facts.get(label, ()))}"
            for label, outcome in ((row.run, row.outcome), (row.reference, row.reference_outcome))
            if outcome == "failed"
        ]
        pair = [traces[label] for label in (row.run, row.reference) if label in traces]
        moved = [math.isfinite(trace.uplift_time) for trace in pair] if len(pair) == 2 else [True, True]
        end = min((float(trace.time[-1]) for trace in pair), default=length)
        yield Finding(
            row=row,
            failed="; ".join(lost),
            uplifted=moved[0],
            reference_uplifted=moved[1],
            reason=reason(
                row,
                length,
                touched=any(fact.code == "wall_contact" for fact in view.facts[row.run]),
                models_differ=_models_differ(view, row),
            ),
            bound=within(row),
            passes=_passes_before(row.within_tolerance_until, traces.get(row.reference)),
            end=end if end < length * (1.0 - 1e-9) else math.nan,
            released=_is_release(view.case, row.peak_tilt)
            and _is_release(view.case, row.reference_peak_tilt),
        )


def _passes_before(end: float, reference: Trace | None) -> int:
    return 0 if reference is None else int((reference.passes["time"] <= end).sum())


def _is_release(case: Case, peak: float) -> bool:
    """Whether a peak tilt [alpha] is the tilt at release."""
    if case.initial is None:
        return False
    tilt = case.initial.tilt / case.cylinder.alpha
    return abs(peak - tilt) <= _SAME_TILT * tilt


def _models_differ(view: CaseView, row: Any) -> bool:
    """Whether half of what ends an agreement lies between the models of recess and flat ground by then."""
    traces = view.traces
    models = [traces.get(str(Run(None, support))) for support in ("recess", "flat")]
    if not row.left_tolerance or row.reference not in traces or models[0] is None or models[1] is None:
        return True
    pair = make_pair(view.case.cylinder, models[0], models[1], until=row.within_tolerance_until)
    return bool((abs(pair.tilt_difference) > 0.5 * row.tolerance).any())


def reason(row: Any, length: float, *, touched: bool = False, models_differ: bool = True) -> str:
    """Return why a run diverges from its reference, see `Finding`.

    Parameters
    ----------
    row : namedtuple
        Of the summary.
    length : float
        Of the run [s].
    touched : bool, optional
        Whether the run met a wall.
    models_differ : bool, optional
        Whether the models of recess and flat ground differ by then: else it is not for the support.
    """
    against_recess = row.reference_support == "recess"
    if row.support == "flat" and against_recess and models_differ:
        return "support"
    if row.support == "ring" and row.reference_support != "ring" and (against_recess or touched):
        return "walls"
    if row.support == EXTERNAL and explains_divergence(row):
        return "mistake"
    predicted = row.predicted_until
    by_pass = row.predicted_by == "pass" and row.support != EXTERNAL and predicted < length
    if by_pass and row.within_tolerance_until >= predicted:
        return "pass"
    return "near passes" if math.isfinite(row.closest_pass) else ""


def finding(found: Finding) -> str:
    """Return the sentences on one row: how long it agrees, and why it diverges."""
    more = external_sentences(found.row) if found.external and not found.failed else ""
    return f"{sentence(WORDS, 'finding', found)} {more}".strip()


def finding_sentences(view: CaseView) -> list[str]:
    """Return one or two sentences on each row of a case, and what limits each run by its own account."""
    said = [finding(found) for found in findings(view)]
    # of a run that failed its finding says why
    sound = [row for row in rows_of(view.rows) if "failed" not in (row.outcome, row.reference_outcome)]
    runs = [run for run in dict.fromkeys(row.run for row in sound) if view.facts[run]]
    return [*said, *(sentence(WORDS, "remark", run, remarks(view.facts[run])) for run in runs)]


def counted_remarks(summary: pd.DataFrame) -> list[str]:
    """Return one sentence on how many runs of many cases have which diagnostic; none if no run has any."""
    runs = summary[(summary["outcome"] != "failed") & (summary["reference_outcome"] != "failed")]
    runs = runs.drop_duplicates(["case", "run"])
    counts = counted(map(parted, runs["diagnostics"]))
    return [sentence(WORDS, "remarks", counts)] if counts else []


def headline(rows: pd.DataFrame, length: float) -> str:
    """Return the headline above the rows of a case: how long runs of each support follow their own model."""
    rows = own_rows(rows[rows["outcome"] != "failed"])
    parts, diverged = [], False
    for support in rows["support"].unique():
        of_support = rows[rows["support"] == support]
        # external trajectories have little in common
        single = support == EXTERNAL
        groups = [[index] for index in of_support.index] if single else [list(of_support.index)]
        parts += [sentence(WORDS, "followed", _group(of_support.loc[group], length)) for group in groups]
        diverged = diverged or any(
            row.left_tolerance and not (single and explains_divergence(row)) for row in rows_of(of_support)
        )
    if not parts:
        return "No run could be compared."
    return " ".join([*parts, *(["Once traces have diverged, compare distributions."] if diverged else [])])


def _group(rows: pd.DataFrame, length: float) -> dict[str, object]:
    """Headline on the runs of one support, held against their own model."""
    first = next(iter(rows_of(rows)))
    external = first.support == EXTERNAL
    names = {the(row.run, REDUCED) if row.engine == REDUCED else row.engine: None for row in rows_of(rows)}
    references = {the(row.reference, row.reference_engine): None for row in rows_of(rows)}
    ends = rows["within_tolerance_until"]
    last = float(ends.max())
    return {
        "support": str(first.support),
        "names": list(names),
        "references": list(references),
        "rows": len(rows),
        "bound": within(first),
        "diverged": bool(rows["left_tolerance"].any()),
        "first": float(ends.min()),
        "last": last,
        # the file of an external trajectory may end before the run does
        "length": min(length, last) if external else length,
        "short": external and last < length * (1.0 - 1e-9),
        "scope": scope(first) if external else "",
    }


def budget_sentences(summary: pd.DataFrame) -> list[str]:
    """Return the sentences on the budgets: the findings first; empty where there are no budgets."""
    known = summary[summary["whole_rms"].notna()]
    if not len(known):
        return []
    large = known[known["whole_rms"] > WORTH_EXPLAINING]
    worth, found = large[large["not_split"] == ""], unexplained(known)
    lines = [sentence(WORDS, "unexplained", row) for row in rows_of(found.head(_LISTED))]
    counts = {
        "more": len(found) - _LISTED,
        "worth": len(worth),
        "explained": len(worth) - len(found),
        "cases": worth["case"].nunique(),
        "explained_cases": worth["case"].nunique() - found["case"].nunique(),
        "small": len(known) - len(large),
        "not_split": large.loc[large["not_split"] != "", "not_split"].value_counts().to_dict(),
        "missing": len(summary) - len(known),
        "largest": LARGEST_SHARE,
        "bound": WORTH_EXPLAINING,
    }
    said = [
        sentence(WORDS, macro, counts)
        for macro in ("more_unexplained", "explained", "not_split", "no_budget")
    ]
    return [*lines, *filter(None, said)]


def divergence_sentences(summary: pd.DataFrame) -> list[str]:
    """Return whether traces diverged as predicted, those that did so too early by name.

    Of external trajectories nobody can predict that: the prediction rests on the errors of an engine.
    """
    summary = summary[summary["support"] != EXTERNAL]
    counts = summary["divergence"].value_counts()
    said = [f"{counts[verdict]} {verdict}" for verdict in counts.index if verdict]
    early = [sentence(WORDS, "early", row) for row in rows_of(summary[summary["divergence"] == "earlier"])]
    return [*early, sentence(WORDS, "in_time", said)] if said else early
