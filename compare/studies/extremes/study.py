"""Scan of every extreme by every method: one row each."""

from __future__ import annotations

import dataclasses
from collections import Counter
from dataclasses import dataclass
from pathlib import Path
from typing import ClassVar

import pandas as pd

from rockwobble.models import Run
from rockwobble.models.shown import Shown
from rockwobble.multibody.engines.registry import find_engine, own_engines

from ...runs.progress import ProgressCallback
from ...runs.tables import run_tables
from ...storage.fingerprint import fingerprint
from ...storage.manifest import Manifest, Results, made_now
from ...storage.provenance import code_digests, package_versions
from .conditions import conditions
from .verdict import Verdict, judge

KIND = "extremes"
MODELS = (Run(None, "flat", plane=0.0), Run(None, "recess"), Run(None, "flat"))
Task = tuple[str, str, int]  # extreme and value of a condition, and the place of a method


def methods() -> tuple[Run, ...]:
    """Return the reduced models, and each support of each of our engines that is installed."""
    engines = (Run(name, support) for name in own_engines() for support in find_engine(name).supports)
    return (*MODELS, *engines)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False, repr=False)
class Extremes(Shown):
    """Verdicts of a scan of the extremes.

    Attributes
    ----------
    table : DataFrame
        One row for each condition and method: extreme, value, method, and the attributes of `Verdict`.
    """

    _figures: ClassVar[str] = "extremes"
    table: pd.DataFrame

    @property
    def counts(self) -> dict[str, int]:
        """How many runs have each verdict."""
        return dict(Counter(map(str, self.table["verdict"])))

    def _said(self) -> dict[str, str]:
        return {"runs": str(len(self.table)), **{verdict: str(n) for verdict, n in self.counts.items()}}


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
    tried = methods()
    tasks = [
        (condition.extreme, condition.value, place)
        for condition in conditions(quick=quick)
        for place in range(len(tried))
    ]
    # an engine may read whatever of the package, and what is looked at takes minutes: any change repeats all
    made_with = fingerprint({"code": code_digests(), "versions": package_versions()})

    def key(task: Task) -> str:
        return fingerprint({"task": list(task), "made with": made_with})

    with run_tables(
        measure_task,
        tasks,
        kind=KIND,
        key=key,
        label=lambda task: f"{task[0]} {task[1]}, {tried[task[2]]}",
        folder=folder,
        lost=lambda task: row(task, Verdict(verdict="silent", limit="died")),
        workers=workers,
        progress=progress,
    ) as found:
        return Extremes(table=pd.concat(found, ignore_index=True))


def manifest_of(found: Extremes, command: str = "") -> Manifest:
    """Return what made a scan, with the number of runs of each verdict as headline."""
    return made_now(KIND, command=command, headline=found.counts)


def stored_extremes(results: Results) -> Extremes:
    """Return a scan that was stored."""
    return Extremes(table=results.table(KIND))


def measure_task(task: Task) -> pd.DataFrame:
    """Return the row of one condition and method."""
    condition = next(each for each in conditions() if (each.extreme, each.value) == task[:2])
    return row(task, judge(condition, methods()[task[2]]))


def row(task: Task, found: Verdict) -> pd.DataFrame:
    """Return a verdict as a table of one row."""
    extreme, value, place = task
    named = {"extreme": extreme, "value": value, "method": str(methods()[place])}
    return pd.DataFrame([named | dataclasses.asdict(found)])
