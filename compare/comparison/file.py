"""A comparison back from its files, without running anything."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypedDict

import numpy as np

from rockwobble.models import Case, Cylinder, GroundMotion, InitialState

from ..storage import plain_json
from ..storage.stored_trace import StoredTrace, passes_table, stored
from .error_budget import ErrorBudget, Limit

if TYPE_CHECKING:
    import pandas as pd

RESTORE = "restore.json"
_SEPARATOR = "\n"  # in no name of a case or a run: these are single lines


class ComparisonFields(TypedDict):
    """What a comparison is made of: the arguments of `Comparison`."""

    summary: pd.DataFrame
    cases: Mapping[str, Case]
    responses: Mapping[tuple[str, str], Any]
    trajectories: Mapping[tuple[str, str], Any]
    versions: Mapping[str, str]
    until: float | None
    budgets: Mapping[tuple[str, str, str], ErrorBudget]


def restore_bytes(fields: ComparisonFields) -> bytes:
    """Return the file that holds what the tables of a comparison do not."""
    whole = {
        "versions": fields["versions"],
        "until": fields["until"],
        "cases": {name: _case_fields(case) for name, case in fields["cases"].items()},
        "responses": _trace_fields(fields["responses"]),
        "trajectories": _trace_fields(fields["trajectories"]),
        "budgets": {
            _SEPARATOR.join(key): {
                "covered": budget.covered,
                "steps": budget.limit.steps,
                "order": budget.limit.order,
            }
            for key, budget in fields["budgets"].items()
        },
    }
    return (plain_json.dumps(whole) + "\n").encode()


def load_comparison(folder: str | Path) -> ComparisonFields:
    """Return what the comparison saved in `folder` is made of; see `Comparison.load`."""
    import pandas as pd

    path = Path(folder)
    try:
        rest = plain_json.loads((path / RESTORE).read_bytes())
        summary = pd.read_parquet(path / "summary.parquet")
        excitation = pd.read_parquet(path / "excitation.parquet")
        responses = _traces(rest["responses"], pd.read_parquet(path / "responses.parquet"), "model")
        trajectories = _traces(rest["trajectories"], pd.read_parquet(path / "trajectories.parquet"), "run")
        samples = pd.read_parquet(path / "budget.parquet") if rest["budgets"] else pd.DataFrame()
    except (OSError, ValueError, KeyError) as error:
        why = str(error).partition("\n")[0]
        raise ValueError(f"{path} must be the folder of a comparison, cannot read it as one: {why}") from None
    return ComparisonFields(
        summary=summary,
        cases={name: _case(name, given, excitation) for name, given in rest["cases"].items()},
        responses=responses,
        trajectories=trajectories,
        versions=rest["versions"],
        until=rest["until"],
        budgets=_budgets(rest["budgets"], samples, trajectories, rest["cases"]),
    )


def _case_fields(case: Case) -> dict[str, Any]:
    fields = {field.name: getattr(case, field.name) for field in dataclasses.fields(case)}
    motion = case.motion
    given = None if motion is None else (motion.name, motion.time_step, motion.acceleration.shape[1])
    return fields | {"motion": given}


def _case(name: str, given: Mapping[str, Any], excitation: pd.DataFrame) -> Case:
    motion = None
    if given["motion"] is not None:
        label, time_step, components = given["motion"]
        table = excitation[excitation["case"] == name]
        columns = [f"acceleration_{axis}" for axis in "xyz"[:components]]
        motion = GroundMotion(table[columns].to_numpy(), time_step, label)
    initial = None if given["initial"] is None else InitialState(**given["initial"])
    # a file may be older than a field, or younger than this code
    known = {field.name for field in dataclasses.fields(Case)} & set(given)
    fields = {field: given[field] for field in known}
    fields |= {"cylinder": Cylinder(**given["cylinder"]), "motion": motion, "initial": initial}
    return Case(**fields)


def _trace_fields(traces: Mapping[tuple[str, str], Any]) -> dict[str, Any]:
    kept = {key: stored(trace) for key, trace in traces.items()}
    return {
        _SEPARATOR.join(key): {
            "frame": trace.frame,
            "facts": trace.facts,
            "passes": {name: trace.passes[name].tolist() for name in trace.passes.columns},
        }
        for key, trace in kept.items()
    }


def _traces(
    given: Mapping[str, Any], samples: pd.DataFrame, label: str
) -> dict[tuple[str, str], StoredTrace]:
    tables = dict(iter(samples.groupby(["case", label], sort=False)))
    traces = {}
    for joined, rest in given.items():
        case, _, name = joined.partition(_SEPARATOR)
        table = tables[case, name].drop(columns=["case", label]).reset_index(drop=True)
        # columns that only the others have are empty here
        own = [column for column in table if column in rest["frame"] or table[column].notna().any()]
        traces[case, name] = StoredTrace(
            tuple(rest["frame"]), table[own], passes_table(rest["passes"]), rest["facts"]
        )
    return traces


def _budgets(
    given: Mapping[str, Any],
    samples: pd.DataFrame,
    trajectories: Mapping[tuple[str, str], StoredTrace],
    cases: Mapping[str, Any],
) -> dict[tuple[str, str, str], ErrorBudget]:
    """Return the budgets; the limit of each covers what the budget does, and no more."""
    budgets = {}
    for joined, rest in given.items():
        case, label, model = joined.split(_SEPARATOR)
        chosen = (samples["case"] == case) & (samples["run"] == label) & (samples["reference"] == model)
        table = {name: column.to_numpy() for name, column in samples[chosen].items()}
        arrays = {name: table[name] for name in ErrorBudget.__dataclass_fields__ if name in table}
        engine = trajectories[case, label]
        alpha = np.arctan(cases[case]["cylinder"]["tan_alpha"])
        tilt = engine.tilt[np.isin(engine.time, arrays["time"])] - alpha * arrays["numerics"]
        limit = Limit(
            time=arrays["time"],
            tilt=tilt,
            error=alpha * arrays["limit_error"],
            steps=tuple(rest["steps"]),
            order=rest["order"],
        )
        budgets[case, label, model] = ErrorBudget(**arrays, covered=rest["covered"], limit=limit)
    return budgets
