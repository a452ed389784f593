"""View of one case of a comparison, in drawing order."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field

import pandas as pd

from rockwobble.compare import Comparison, ErrorBudget
from rockwobble.compare.comparison.summary import SummaryRow, rows_of
from rockwobble.compare.metrics.pair import start_of
from rockwobble.models import Case, Diagnostic, Trace
from rockwobble.models.support import Support

from .palette import Style, label_styles


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class CaseView:
    """One case: its traces and its rows of the summary.

    Parameters
    ----------
    case : Case
    runs, references : dict
        Trace of each run, and of what only serves as a reference, by label; those without samples left out.
    facts : dict
        Diagnostics of every label, also of a run without samples.
    rows : DataFrame
        Rows of the summary, see `Comparison.rows`.
    styles : dict
        Style of each label.
    budgets : dict
        Error budget for each label of a run and its reference, where there is one.
    """

    case: Case
    runs: Mapping[str, Trace]
    references: Mapping[str, Trace]
    facts: Mapping[str, tuple[Diagnostic, ...]]
    rows: pd.DataFrame
    styles: Mapping[str, Style]
    budgets: Mapping[tuple[str, str], ErrorBudget] = field(default_factory=dict)

    @property
    def traces(self) -> Mapping[str, Trace]:
        """All traces in drawing order: runs first, references on top."""
        return {**self.runs, **self.references}

    @property
    def supports(self) -> tuple[Support, ...]:
        """The supports of the runs."""
        return tuple(dict.fromkeys(trace.run.support for trace in self.runs.values()))

    def partner(self, label: str) -> str:
        """Partner of a run in figures: model of its support, else its first reference."""
        own = str(self.runs[label].run.own_model)
        return own if own in self.references else next(iter(self.references), label)

    def pairs(self) -> Iterator[tuple[SummaryRow, Trace, Trace]]:
        """Yield the drawable rows of the summary, each with reference and run."""
        traces = self.traces
        for row in rows_of(self.rows):
            if row.run in traces and row.reference in traces:
                yield row, traces[row.reference], traces[row.run]

    def divergence(self, row: SummaryRow) -> float:
        """Divergence time of a run from its reference, on the time axis of the run [s]; inf if never."""
        return start_of(self.traces[row.reference]) + row.agreement_time if row.diverged else math.inf


def case_views(comparison: Comparison) -> list[CaseView]:
    """View of each case of a comparison."""
    views = []
    for name, case in comparison.cases.items():
        rows = comparison.rows(name)
        whole = {label: trace for (of, label), trace in comparison.traces.items() if of == name}
        traces = {label: trace for label, trace in whole.items() if len(trace.time)}
        runs = {label: trace for label, trace in traces.items() if label in set(rows["run"])}
        references = {label: trace for label, trace in traces.items() if label not in runs}
        views.append(
            CaseView(
                case=case,
                runs=runs,
                references=references,
                facts={label: trace.facts for label, trace in whole.items()},
                rows=rows,
                styles=label_styles(
                    list(traces), [label for label, trace in traces.items() if trace.run.is_model]
                ),
                budgets={
                    (run, reference): budget
                    for (of, run, reference), budget in comparison.budgets.items()
                    if of == name
                },
            )
        )
    return views
