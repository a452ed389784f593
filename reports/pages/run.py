"""Page of a single run: outcome in words, and the numbers of its method."""

from __future__ import annotations

from rockwobble.models import Diagnostic, Trace
from rockwobble.models.finding import Finding, Findings
from rockwobble.studies.advice.demands import overturning_time
from rockwobble.studies.single_run import SingleRun

from ..figures.trace import pictures
from .cases import case_lines
from .page import Page
from .wording import sentence, statement

_DOUBT = "run.not_reproducible"
_DETAILS = ("quantity.closest", "quantity.computing_time")  # quantities left to the page by a terminal


def page_of(run: SingleRun) -> Page:
    """Page of a run."""
    trace, findings = run.trace, run.findings()
    said = " ".join(statement(each.finding()) for each in _limits(trace))
    sizes = findings.of("quantity")
    doubts = [each for each in findings if each.key == _DOUBT]
    answers = [each for each in findings if each not in (*sizes, *doubts)]
    values = {
        "title": f"{trace.case.name}, {run.facts['run']}: {trace.outcome}",
        "label": f"{run.facts['run'][0].upper()}{run.facts['run'][1:]}",
        "statements": list(map(statement, answers)),
        "answers": [statement(each) for each in answers if each.key != "mode.rocks"],
        "said": said,
        "warnings": [*map(statement, doubts)],
        "answer": run.facts.get("single_trace", {}).get("answer", ""),
        "rows": _rows(sizes),
        "rows_short": _rows([each for each in sizes if each.key not in _DETAILS]),
        "lines": case_lines(trace.case),
        "about": run.manifest,
    }
    return Page(name="run", template="runs/run", values=values, pictures=pictures(trace))


def _rows(sizes: Findings | list[Finding]) -> list[dict[str, str]]:
    return [dict(zip(("name", "value"), sentence(each).split(": ", 1), strict=True)) for each in sizes]


def _limits(trace: Trace) -> list[Diagnostic]:
    """Diagnostics of a run up to its overturning time; contact loss and slip follow it."""
    held = trace.assumptions_until(overturning_time(trace))
    return [*trace.facts, *(held.breaches if held else ())]
