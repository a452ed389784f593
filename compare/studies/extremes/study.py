"""Scan of every extreme by every method: one row each."""

from __future__ import annotations

import dataclasses
from collections import Counter
from dataclasses import dataclass
from pathlib import Path

import pandas as pd

from rockwobble.models import Run
from rockwobble.multibody.engines.registry import find_engine, own_engines

from ...runs.execution import run_tables
from ...runs.progress import ProgressCallback
from ...storage.manifest import Number
from ...storage.provenance import code_digests, fingerprint, package_versions
from ...storage.results import Results
from .conditions import Condition, conditions
from .verdict import Verdict, judge

KIND = "extremes"
MODELS = (Run(None, "flat", plane=0.0), Run(None, "recess"), Run(None, "flat"))
Task = tuple[Condition, Run]


def methods() -> tuple[Run, ...]:
    """Return the reduced models, and each support of each of our engines that is installed."""
    engines = (Run(name, support) for name in own_engines() for support in find_engine(name).supports)
    return (*MODELS, *engines)


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class Extremes(Results, kind=KIND):
    """Verdicts of a scan of the extremes.

    Attributes
    ----------
    extremes : DataFrame
        One row for each condition and method: extreme, value, method, and the attributes of `Verdict`.
    """

    def headline(self) -> dict[str, Number]:
        """Return the number of runs, and of those with each verdict."""
        return {"runs": len(self.extremes), **Counter(map(str, self.extremes["verdict"]))}


def measure_extremes(
    folder: str | Path,
    *,
    quick: bool = False,
    workers: int | None = None,
    progress: ProgressCallback | None = None,
) -> Extremes:
    """Run every condition by every method that is installed.

    Parameters
    ----------
    folder : str or Path
        Keeps each finished run: a second call, after whatever ended the first, repeats none that is there.
    quick : bool, optional
        Only the first and the last condition of each extreme.
    workers : int, optional
        Processes; default one for each processor.
    progress : callable, optional
        Called with a `Progress` at the start and the end of each run.
    """
    tasks = [(condition, run) for condition in conditions(quick=quick) for run in methods()]
    # an engine may read whatever of the package, and what is looked at takes minutes: any change repeats all
    made_with = fingerprint({"code": code_digests(), "versions": package_versions()})

    def key(task: Task) -> str:
        return fingerprint({"task": task, "made with": made_with})

    with run_tables(
        measure_task,
        tasks,
        kind=KIND,
        key=key,
        label=lambda task: f"{task[0].extreme} {task[0].value}, {task[1]}",
        folder=folder,
        lost=lambda task: row(task, Verdict(verdict="silent", limit="died")),
        workers=workers,
        progress=progress,
    ) as found:
        return Extremes(tables={KIND: pd.concat(found, ignore_index=True)}, facts={})


def measure_task(task: Task) -> pd.DataFrame:
    """Return the row of one condition and method."""
    return row(task, judge(*task))


def row(task: Task, found: Verdict) -> pd.DataFrame:
    """Return a verdict as a table of one row."""
    condition, run = task
    named = {"extreme": condition.extreme, "value": condition.value, "method": str(run)}
    return pd.DataFrame([named | dataclasses.asdict(found)])
