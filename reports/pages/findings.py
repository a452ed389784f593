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
from rockwobble.compare.external.verdict import mistakes_of
from rockwobble.compare.metrics.pair import make_pair
from rockwobble.models import AGREEMENT
from rockwobble.models.case import FLAT_MODEL, RECESS_MODEL, REDUCED
from rockwobble.models.diagnostic import codes_in
from rockwobble.models.support import EXTERNAL, SUPPORTS

from ..figures.case_view import CaseView, SummaryRow, own_rows, rows_of
from .diagnostics import code_counts, failure, remarks
from .sentences import seconds, small, the
from .table import enumeration

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
_DIFFERENCES: Mapping[str, str] = {
    "azimuth": "azimuth",
    "path": "path of the mass centre",
    "uplift_time": "time of uplift",
    "uplift_direction": "direction of uplift",
}
_NOT_SPLIT: Mapping[str, str] = {
    "unresolved_pass": "a near-upright pass that contact does not resolve leaves it to chance",
    "order": "runs at smaller time steps do not converge",
    "error": "the limit of small time steps is too uncertain",
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
        Row of the summary.
    length : float
        Length of the run [s].
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
    support, reference = (SUPPORTS.get(each, EXTERNAL) for each in (row.support, row.reference_support))
    if support == EXTERNAL:
        if explains_divergence(row):
            return "loss" if _loses(row) else "mistake"
    elif support.walls:
        if not reference.walls and (reference.guided or touched):
            return "walls"
    elif not support.guided and reference.guided and models_differ:
        return "support"
    by_pass = row.predicted_by == "pass" and support != EXTERNAL and row.predicted_until < length
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
    recess, flat = (view.traces.get(str(model)) for model in (RECESS_MODEL, FLAT_MODEL))
    if not row.left_tolerance or row.reference not in view.traces or recess is None or flat is None:
        return True
    pair = make_pair(view.case.cylinder, recess, flat, until=row.within_tolerance_until)
    return bool((abs(pair.tilt_difference) > 0.5 * row.tolerance).any())


def agreement_words(row: SummaryRow) -> str:
    """Return what agreement of the tilts means for a run."""
    noise = row.tilt_bound - AGREEMENT if row.support == EXTERNAL else 0.0
    share = "1 %" if row.tolerance >= AGREEMENT else "a tenth of the peak"
    if noise > 0:
        return f"{100 * (row.tolerance + noise):.2g} % of alpha ({share} and the noise)"
    return f"{share} of alpha" if row.tolerance >= AGREEMENT else f"{share} ({small(row.tolerance)} alpha)"


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
    said = [f"{label} failed: {failure(view.facts.get(label, ()))}." for label in lost]
    if runs and not any(math.isfinite(each.uplift_time) for each in view.traces.values()):
        said.append("All stay at rest: this excitation does not uplift the cylinder.")
    if swings := [label for label, trace in view.traces.items() if trace.peak_time > trace.time[-1]]:
        said.append(
            f"The peak of {enumeration(swings)} comes after the end of the run, which the curves do not show."
        )
    said += [*_causes_in_words(causes), *(_mistakes(row) for row in sound if row.support == EXTERNAL)]
    said += [*early_sentences(view.rows), *budget_sentences(view.rows)]
    if told := _together({run: remarks(view.facts[run]) for run in runs}):
        said.append(f"Diagnostics: {'; '.join(f'{enumeration(names)}: {text}' for names, text in told)}.")
    return " ".join(filter(None, said))


def _causes_in_words(causes: Mapping[str, list[SummaryRow]]) -> list[str]:
    """Return a sentence on each cause of divergence, and what they mean together."""
    runs = {cause: _parted_runs(rows) for cause, rows in causes.items()}
    meanings = {
        "support": "Diverging because of the support: {}. On flat ground the cylinder may roll out of its "
        "place, which a recess prevents.",
        "walls": "Diverging because of the walls: {}. They stop the cylinder only after it has rolled out by "
        "their clearance, and each impact dissipates energy, which the models neglect.",
        "of support": "This is a difference of support, not of accuracy.",
        "pass": "Diverging after near-upright passes that contact does not resolve, so that the side is left "
        "to chance: {}.",
        "near passes": "Diverging after near-upright passes, which amplify small differences: {}.",
        "method": "Diverging without a near-upright pass, by an error of the method or of its input: {}.",
    }
    runs |= {"of support": ""} if {"support", "walls"} & {*causes} else {}
    said = [words.format(runs[cause]) for cause, words in meanings.items() if cause in runs]
    if {*causes} - {"mistake", "loss"}:
        said.append("Once traces have diverged, compare distributions.")
    return said


def _parted_runs(rows: list[SummaryRow]) -> str:
    """Return which runs diverge from which references."""
    references = {
        the(row.reference, row.reference_engine): None for row in sorted(rows, key=lambda row: row.reference)
    }
    runs = {
        name: [row.run for row in rows if the(row.reference, row.reference_engine) == name]
        for name in references
    }
    return ", ".join(f"{enumeration(names)} from {reference}" for reference, names in runs.items())


def _mistakes(row: SummaryRow) -> str:
    """Return the likely mistakes of an external trajectory, and whether they explain it."""
    words = [mistake.words for mistake in mistakes_of(row)]
    loses = _loses(row)
    if not words:
        unexplained_turn = {"azimuth", "path"} & {*row.differs_in}
        said = "no mistake of axes, units, clock or origin explains the difference"
        return f"{row.run}: {said}." if unexplained_turn else ""
    said = f"likely cause: {', '.join(words)}" if loses else f"likely mistake: {'; '.join(words)}"
    explained = explains_divergence(row) and (not loses or len(words) > 1)
    if loses and not explained:
        rest = "No rolling resistance explains it alone: impacts, slip or the air may take it"
    elif "tilt" in row.differs_in and not explained:
        rest = "It is no reason for the tilts to diverge"
    else:
        until = row.reference_uplift_time + row.agreement_without_mistake
        left = [_DIFFERENCES[name] for name in row.differs_without_mistake if name != "tilt"]
        cured = "With that resistance" if loses else "Without it"
        rest = f"{cured} the tilt follows the model until {until:.1f} s"
        rest += f", but it differs in {enumeration(left)}" if left else ""
    return f"{row.run}: {said}. {rest}."


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
    said = f"Diagnostics: of the runs {', '.join(counts)}; see the column diagnostics of summary.csv."
    return [said] if counts else []


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
    return " ".join(_agreement(group, length) for group in groups)


def _agreement(rows: pd.DataFrame, length: float) -> str:
    """Return the headline on the runs of one support, compared with their own model."""
    first = next(iter(rows_of(rows)))
    support = SUPPORTS.get(first.support, EXTERNAL)
    external, words = support == EXTERNAL, support.words
    names = {the(row.run, REDUCED) if row.engine == REDUCED else row.engine: None for row in rows_of(rows)}
    ends = rows["within_tolerance_until"]
    begun, last = (seconds(float(end)) for end in (ends.min(), ends.max()))
    if not rows["left_tolerance"].any():
        # the file of an external trajectory may end before the run does
        short = external and float(ends.max()) < length * (1.0 - 1e-9)
        until = f"to {'its' if short else 'the'} end at {last}"
    else:
        until = f"until {last}" if begun == last else f"until {begun} to {last}"
    references = {the(row.reference, row.reference_engine): None for row in rows_of(rows)}
    said = (
        f"{words[0].upper()}{words[1:]}: {enumeration(list(names))} within {agreement_words(first)} of "
        f"{enumeration(list(references))} {until}"
    )
    return f"{said}{_of_external(first) if external else ''}."


def _of_external(row: SummaryRow) -> str:
    """Return in what else an external trajectory differs, in what it is not compared, and likely mistakes."""
    differs = [_DIFFERENCES[part] for part in row.differs_in if part != "tilt"]
    left_out = [_DIFFERENCES[part] for part in row.not_compared]
    mistakes = [mistake.words for mistake in mistakes_of(row)]
    return "".join(
        [
            f", but not in {enumeration(differs)}" if differs else "",
            f" (not compared: {enumeration(left_out)})" if left_out else "",
            f". Likely mistake: {'; '.join(mistakes)}" if mistakes else "",
        ]
    )


def budget_sentences(summary: pd.DataFrame) -> list[str]:
    """Return the sentences on the budgets: the findings first; empty where there are no budgets."""
    known = summary[summary["whole_rms"].notna()]
    if not len(known):
        return []
    large = known[known["whole_rms"] > WORTH_EXPLAINING]
    worth, found = large[large["not_split"] == ""], unexplained(known)
    said = [
        f"{_pair(row)}: {100 * row.unexplained_share:.0f} % of the difference of {small(row.whole_rms)} "
        f"alpha remain unexplained (error of the extrapolation: {small(row.limit_error)} alpha)."
        for row in rows_of(found.head(_LISTED))
    ]
    if (more := len(found) - _LISTED) > 0:
        said.append(f"The same holds for {more} more row{'s' if more > 1 else ''} of the summary.")
    not_split = large.loc[large["not_split"] != "", "not_split"].value_counts().to_dict()
    bound = small(WORTH_EXPLAINING)
    if len(worth):
        said.append(
            f"Model form and numerics explain all but {100 * LARGEST_SHARE:.0f} % of the difference in "
            f"{len(worth) - len(found)} of the {len(worth)} rows that differ by more than {bound} alpha; "
            f"{len(known) - len(large)} rows differ by less."
        )
    elif not not_split:
        said.append(f"No row differs by more than {bound} alpha.")
    for reason, count in not_split.items():
        rows = f"{count} row{'s' if count > 1 else ''}"
        why = _NOT_SPLIT[str(reason)]
        said.append(f"The difference of {rows} is not split into numerics and unexplained: {why}.")
    if missing := len(summary) - len(known):
        said.append(f"{missing} rows have no budget: their runs failed, never moved, or have no finer step.")
    return said


def _pair(row: SummaryRow) -> str:
    return f"{row.case}, {row.run} compared with {the(row.reference, row.reference_engine)}"


def early_sentences(summary: pd.DataFrame) -> list[str]:
    """Return a sentence on each row whose traces diverged earlier than predicted.

    Of external trajectories nobody can predict that: the prediction rests on the errors of an engine.
    """
    early = (summary["divergence"] == "earlier") & (summary["support"] != EXTERNAL)
    return [
        f"{_pair(row)}: they diverge earlier than predicted, which needs an explanation."
        for row in rows_of(summary[early])
    ]


def divergence_counts(summary: pd.DataFrame) -> list[str]:
    """Return one sentence on how many rows diverged as predicted; none if of none it is known."""
    counts = summary.loc[summary["support"] != EXTERNAL, "divergence"].value_counts()
    said = [f"{count} {verdict}" for verdict, count in counts.items() if verdict]
    in_time = f"Divergence and its prediction, in time within a factor of 2: {', '.join(said)}."
    return [in_time] if said else []


_PARTS = ("model_form", "numerics", "unexplained")
# by the largest part, or why there is none
_ADVICE: Mapping[str, str] = {
    "model_form": "Most of it is model form: the support follows another model, which no time step changes.",
    "numerics": "Most of it is numerics: a smaller time step removes it.",
    "unexplained": "Most of it is unexplained: contact, settings or support of the engine, or the model.",
    "unresolved_pass": "It is not split: a pass comes closer to upright than contact resolves, which leaves "
    "it to chance at any time step.",
    "order": "It is not split: runs at smaller time steps do not converge.",
    "error": "It is not split: the limit of small time steps is too uncertain.",
}


def budget_of_run(case: rw.Case, run: rw.Run, reference: rw.Run) -> list[str]:
    """Return the lines; they rest on runs at finer time steps, made here."""
    comparison = rw.comparison(case, runs=[run], budget=True)
    label = next((label for (_, label), trace in comparison.traces.items() if trace.run == reference), None)
    rows = comparison.summary[comparison.summary["reference"] == label]
    budget = next((found for key, found in comparison.budgets.items() if key[2] == label), None)
    row = next(rows_of(rows), None)
    if budget is None or row is None:  # a reference that is not its own has none
        return ["There is no budget of the difference: traces diverge at once, or there is no finer step."]
    parts = {
        "whole": ("whole", f"engine minus the {row.reference}"),
        "model_form": ("model form", "the model of the support minus the one asked about"),
        "numerics": ("numerics", "the engine minus the engine at a time step of zero"),
        "unexplained": ("unexplained", "the engine at a time step of zero minus the model of its support"),
    }
    if budget.not_split:
        del parts["numerics"], parts["unexplained"]
    steps = ", ".join(f"{step:g}" for step in budget.steps)
    order = f"; measured order {budget.order:.1f}" if math.isfinite(budget.order) else ""
    said = [
        f"What the difference is made of (RMS in alpha until {budget.covered:.3g} s, {100.0 * COVERED:.0f} % "
        "of the agreement):",
        *(f"  {name:<12} {budget.rms(part):8.1e}  {meaning}" for part, (name, meaning) in parts.items()),
        f"  known to {budget.rms('limit_error'):.1e}, from time steps of {steps} s{order}",
    ]
    if row.left_tolerance:
        said.append(
            f"  traces diverge at {row.within_tolerance_until:.3g} s, {row.predicted_until:.3g} s were "
            f"predicted: {row.divergence}"
        )
    return [*said, _ADVICE[budget.not_split or max(_PARTS, key=budget.rms)]]
