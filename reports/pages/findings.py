"""Findings of a comparison: causes of divergence, and sentences on what its tables do not say."""

from __future__ import annotations

import math
from collections.abc import Mapping

import pandas as pd

import rockwobble as rw
from rockwobble.compare import LARGEST_SHARE, WORTH_EXPLAINING
from rockwobble.compare import findings as unexplained
from rockwobble.compare.comparison.budget import COVERED
from rockwobble.compare.comparison.prediction import BEATEN
from rockwobble.compare.external.loss import ENERGY_LOSS
from rockwobble.compare.external.trajectory import SUPPORT as EXTERNAL
from rockwobble.compare.external.verdict import mistakes_of
from rockwobble.compare.metrics.pair import make_pair
from rockwobble.compare.runs.choice import REDUCED
from rockwobble.models import AGREEMENT, Run
from rockwobble.models.diagnostic import codes_in
from rockwobble.models.support import FLAT, RECESS, SUPPORTS

from ..figures.case_view import CaseView, SummaryRow, own_rows, rows_of
from .diagnostics import code_counts, failure, remarks
from .sentences import lines, sentence, the

WORDS = "comparison/findings.md.j2"
_LISTED = 10
# why a run diverges from its reference, as a table says it
CAUSES: Mapping[str, str] = {
    "support": "support",
    "walls": "walls",
    "mistake": "likely mistake",
    "loss": "loss of energy",
    "pass": "unresolved pass",
    "near passes": "near passes",
    "method": "method",
    "failed": "failure",
}


def cause_of(view: CaseView, row: SummaryRow) -> str:
    """Return the cause of a row of a case."""
    if "failed" in (row.outcome, row.reference_outcome):
        return "failed"
    touched = any(fact.code == "wall_contact" for fact in view.facts[row.run])
    return cause(row, view.case.length, touched=touched, models_differ=_models_differ(view, row))


def cause(row: SummaryRow, length: float, *, touched: bool = False, models_differ: bool = True) -> str:
    """Return why a run diverges from its reference: one of `CAUSES`.

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

    Returns
    -------
    str
        "support" or "walls", a difference of support, not of accuracy; "mistake" of an external
        trajectory, or "loss" of its energy;
        "pass", one that contact does not resolve; "near passes", which amplify what small difference there
        is; "method", without a pass, so that it is not chance.
    """
    support, reference = SUPPORTS.get(row.support), SUPPORTS.get(row.reference_support)
    guided = reference is not None and reference.guided
    if support and support.walls:
        if not (reference and reference.walls) and (guided or touched):
            return "walls"
    elif support and not support.guided and guided and models_differ:
        return "support"
    if row.support == EXTERNAL and explains_divergence(row):
        return "loss" if _loses(row) else "mistake"
    by_pass = row.predicted_by == "pass" and row.support != EXTERNAL and row.predicted_until < length
    start = row.reference_uplift_time
    agreed, predicted = row.within_tolerance_until - start, row.predicted_until - start
    if by_pass and predicted <= agreed <= BEATEN * predicted:  # one that was survived for longer left nothing
        return "pass"
    return "near passes" if math.isfinite(row.closest_pass) else "method"


def explains_divergence(row: SummaryRow) -> bool:
    """Whether a likely mistake is a reason for the tilts to diverge: a turn of the axes is none."""
    return any(mistake.changes_tilt for mistake in mistakes_of(row))


def _models_differ(view: CaseView, row: SummaryRow) -> bool:
    """Whether half of what ends an agreement lies between the models of recess and flat ground by then."""
    recess, flat = (view.traces.get(str(Run(None, support.name))) for support in (RECESS, FLAT))
    if not row.left_tolerance or row.reference not in view.traces or recess is None or flat is None:
        return True
    pair = make_pair(view.case.cylinder, recess, flat, until=row.within_tolerance_until)
    return bool((abs(pair.tilt_difference) > 0.5 * row.tolerance).any())


def agreement_words(row: SummaryRow) -> str:
    """Return what agreement of the tilts means for a run."""
    noise = row.tilt_bound - AGREEMENT if row.support == EXTERNAL else 0.0
    return sentence(WORDS, "within", row.tolerance, noise, AGREEMENT)


def notes(view: CaseView) -> str:
    """Return the paragraph on a case: failures, causes of divergence, mistakes, budgets and diagnostics."""
    rows = list(rows_of(view.rows))
    sound = [row for row in rows if "failed" not in (row.outcome, row.reference_outcome)]
    runs = dict.fromkeys(row.run for row in sound)
    causes: dict[str, list[SummaryRow]] = {}
    for row in sound:
        if row.left_tolerance:
            causes.setdefault(cause_of(view, row), []).append(row)
    lost = dict.fromkeys(
        label
        for row in rows
        for label, outcome in ((row.run, row.outcome), (row.reference, row.reference_outcome))
        if outcome == "failed"
    )
    values = {
        "failed": {label: failure(view.facts.get(label, ())) for label in lost},
        "still": bool(runs) and not any(math.isfinite(each.uplift_time) for each in view.traces.values()),
        "swings": [label for label, trace in view.traces.items() if trace.peak_time > trace.time[-1]],
        "causes": causes,
        "external": [_mistakes(row) for row in sound if row.support == EXTERNAL],
        "remarks": _together({run: remarks(view.facts[run]) for run in runs}),
    }
    parts = [sentence(WORDS, macro, values) for macro in ("failures", "swings", "parted", "mistakes")]
    parts += [*early_sentences(view.rows), *budget_sentences(view.rows), sentence(WORDS, "remarks", values)]
    return " ".join(filter(None, parts))


def _mistakes(row: SummaryRow) -> dict[str, object]:
    """Return the likely mistakes of an external trajectory in words, and whether they explain it."""
    words = [mistake.words for mistake in mistakes_of(row)]
    loses = _loses(row)
    explained = explains_divergence(row) and (not loses or len(words) > 1)
    return {"row": row, "mistakes": words, "explained": explained, "loses": loses}


def _loses(row: SummaryRow) -> bool:
    """Whether an external trajectory loses energy that its model does not."""
    return ENERGY_LOSS in row.likely_mistake


def _together(words: Mapping[str, str]) -> list[tuple[list[str], str]]:
    """Return each text once, with the names that have it; of empty ones nothing."""
    return [
        ([name for name in words if words[name] == text], text)
        for text in dict.fromkeys(words.values())
        if text
    ]


def counted_remarks(summary: pd.DataFrame) -> list[str]:
    """Return one sentence on how many runs of many cases have which diagnostic; none if no run has any."""
    runs = summary[(summary["outcome"] != "failed") & (summary["reference_outcome"] != "failed")]
    runs = runs.drop_duplicates(["case", "run"])
    counts = code_counts(map(codes_in, runs["diagnostics"]))
    return [sentence(WORDS, "counts", counts)] if counts else []


def headline(rows: pd.DataFrame, length: float) -> str:
    """Return the headline above the rows of a case: how long runs of each support follow their own model."""
    rows = own_rows(rows[rows["outcome"] != "failed"])
    groups: list[pd.DataFrame] = []
    for support in rows["support"].unique():
        of_support = rows[rows["support"] == support]
        # external trajectories have little in common
        groups += (
            [row for _, row in of_support.groupby("run", sort=False)] if support == EXTERNAL else [of_support]
        )
    if not groups:
        return "No run could be compared."
    return " ".join(sentence(WORDS, "followed", _group(group, length)) for group in groups)


def _group(rows: pd.DataFrame, length: float) -> dict[str, object]:
    """Headline on the runs of one support, compared with their own model."""
    first = next(iter(rows_of(rows)))
    external, support = first.support == EXTERNAL, SUPPORTS.get(first.support)
    names = {the(row.run, REDUCED) if row.engine == REDUCED else row.engine: None for row in rows_of(rows)}
    ends = rows["within_tolerance_until"]
    last = float(ends.max())
    return {
        "support": support.words if support else "external trajectory" if external else str(first.support),
        "names": list(names),
        "references": list({the(row.reference, row.reference_engine): None for row in rows_of(rows)}),
        "bound": agreement_words(first),
        "diverged": bool(rows["left_tolerance"].any()),
        "first": float(ends.min()),
        "last": last,
        # the file of an external trajectory may end before the run does
        "short": external and last < length * (1.0 - 1e-9),
        "differs": [part for part in first.differs_in if part != "tilt"] if external else [],
        "not_compared": list(first.not_compared) if external else [],
        "mistakes": [mistake.words for mistake in mistakes_of(first)] if external else [],
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
        "small": len(known) - len(large),
        "not_split": large.loc[large["not_split"] != "", "not_split"].value_counts().to_dict(),
        "missing": len(summary) - len(known),
        "largest": LARGEST_SHARE,
        "bound": WORTH_EXPLAINING,
    }
    return [*lines, *filter(None, [sentence(WORDS, "budgets", counts)])]


def early_sentences(summary: pd.DataFrame) -> list[str]:
    """Return a sentence on each row whose traces diverged earlier than predicted.

    Of external trajectories nobody can predict that: the prediction rests on the errors of an engine.
    """
    early = (summary["divergence"] == "earlier") & (summary["support"] != EXTERNAL)
    return [sentence(WORDS, "early", row) for row in rows_of(summary[early])]


def divergence_counts(summary: pd.DataFrame) -> list[str]:
    """Return one sentence on how many rows diverged as predicted; none if of none it is known."""
    counts = summary.loc[summary["support"] != EXTERNAL, "divergence"].value_counts()
    said = [f"{count} {verdict}" for verdict, count in counts.items() if verdict]
    return [sentence(WORDS, "in_time", said)] if said else []


_PARTS = ("model_form", "numerics", "unexplained")


def budget_of_run(case: rw.Case, run: rw.Run, reference: rw.Run) -> list[str]:
    """Return the lines; they rest on runs at finer time steps, made here."""
    comparison = rw.comparison(case, runs=[run], budget=True)
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
