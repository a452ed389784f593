"""Comparison read back from its files, without running anything."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TypedDict

import pandas as pd

from rockwobble.models import Case, Trace, plain_json
from rockwobble.models.traces.trace_file import case_from_plain, case_to_plain

from ..external.verdict import lists_of_file
from ..metrics.pair import start_of
from ..metrics.turning import first_unresolved_pass
from ..storage.manifest import Results
from .error_budget import ErrorBudget

ABOUT = "comparison.json"
_SEPARATOR = "\n"  # in no name of a case or a run: these are single lines
Key = tuple[str, str]
BudgetKey = tuple[str, str, str]


class ComparisonFields(TypedDict):
    """Parts of a comparison: the arguments of `Comparison`."""

    summary: pd.DataFrame
    cases: Mapping[str, Case]
    traces: Mapping[Key, Trace]
    versions: Mapping[str, str]
    until: float | None
    budgets: Mapping[BudgetKey, ErrorBudget]


class _Motion(TypedDict):
    """A ground motion without its samples, which stand in a table."""

    name: str
    time_step: float
    components: str


class _StoredCase(TypedDict):
    """A case as `case_to_plain` gives it, but for the motion."""

    motion: _Motion | None


class _StoredBudget(TypedDict):
    covered: float
    steps: list[float]
    order: float


def plain_fields(
    cases: Mapping[str, Case],
    traces: Mapping[Key, Trace],
    versions: Mapping[str, str],
    until: float | None,
    budgets: Mapping[BudgetKey, ErrorBudget],
) -> dict[str, object]:
    """Return the fields of a comparison that its tables do not hold, for JSON."""
    return {
        "versions": versions,
        "until": until,
        "cases": {name: case_to_plain(case) | {"motion": _header(case)} for name, case in cases.items()},
        "traces": {_SEPARATOR.join(key): trace.to_plain() for key, trace in traces.items()},
        "budgets": {
            _SEPARATOR.join(key): {"covered": budget.covered, "steps": budget.steps, "order": budget.order}
            for key, budget in budgets.items()
        },
    }


def _header(case: Case) -> _Motion | None:
    motion = case.motion
    if motion is None:
        return None
    components = "xyz"[: motion.acceleration.shape[1]]
    return {"name": motion.name, "time_step": motion.time_step, "components": components}


def load_fields(stored: Results) -> ComparisonFields:
    """Return the fields of the stored comparison; see `Comparison.load`."""
    try:
        rest = plain_json.loads(stored.content(ABOUT))
        excitation = dict(iter(stored.table("excitation").groupby("case", sort=False)))
        cases = {name: _case(given, excitation.get(name)) for name, given in rest["cases"].items()}
        traces = _traces(rest["traces"], stored.table("traces"), cases)
        samples = stored.table("budget") if rest["budgets"] else pd.DataFrame()
        return ComparisonFields(
            summary=lists_of_file(stored.table("summary")),
            cases=cases,
            traces=traces,
            versions=rest["versions"],
            until=rest["until"],
            budgets=_budgets(rest["budgets"], samples, traces),
        )
    except (ValueError, KeyError) as error:
        why = str(error).partition("\n")[0]
        raise ValueError(f"{stored.folder} holds a comparison that cannot be read: {why}") from None


def _case(given: _StoredCase, excitation: pd.DataFrame | None) -> Case:
    header = given["motion"]
    if header is None:
        return case_from_plain(given)
    assert excitation is not None
    samples = excitation[[f"acceleration_{axis}" for axis in header["components"]]].to_numpy()
    motion = {"acceleration": samples, "time_step": header["time_step"], "name": header["name"]}
    return case_from_plain({**given, "motion": motion})


def _traces(
    given: Mapping[str, Mapping[str, object]], samples: pd.DataFrame, cases: Mapping[str, Case]
) -> dict[Key, Trace]:
    tables = dict(iter(samples.groupby(["case", "run"], sort=False)))
    none = samples.iloc[:0]  # of a run whose process died
    traces = {}
    for joined, facts in given.items():
        case, _, label = joined.partition(_SEPARATOR)
        traces[case, label] = Trace.from_plain(facts, tables.get((case, label), none), cases[case])
    return traces


def _budgets(
    given: Mapping[str, _StoredBudget], samples: pd.DataFrame, traces: Mapping[Key, Trace]
) -> dict[BudgetKey, ErrorBudget]:
    budgets = {}
    for joined, rest in given.items():
        case, label, model = joined.split(_SEPARATOR)
        chosen = (samples["case"] == case) & (samples["run"] == label) & (samples["reference"] == model)
        table = {name: column.to_numpy() for name, column in samples[chosen].items()}
        arrays = {name: table[name] for name in ErrorBudget.__dataclass_fields__ if name in table}
        budgets[case, label, model] = ErrorBudget(
            **arrays,
            covered=rest["covered"],
            steps=tuple(rest["steps"]),
            order=rest["order"],
            unresolved=first_unresolved_pass(traces[case, label], start=start_of(traces[case, model])),
        )
    return budgets
