"""The runs of a plan, kept as they are finished, and their table."""

from __future__ import annotations

from functools import partial
from pathlib import Path

import numpy as np
import pandas as pd

from ...runs.execution import all_makers
from ...runs.progress import ProgressCallback
from ...runs.tables import run_tables
from .methods import Method
from .plan import Plan
from .tasks import Task, run_task

# a task whose process died is tried this often: the process may have been ended from outside
_TRIES = 2
KEYS = ["cylinder", "motion", "step"]


def run_plan(
    plan: Plan,
    kind: str,
    *,
    folder: str | Path | None = None,
    workers: int | None = None,
    scheduler: str | None = None,
    progress: ProgressCallback | None = None,
) -> pd.DataFrame:
    """Run all that a plan holds.

    Parameters
    ----------
    plan : Plan
    kind : str
        Of the results, for the folder of finished tasks.
    folder : str or Path, optional
        Keeps each finished task: a second call, after whatever ended the first, repeats none.
    workers, scheduler, progress : optional
        As in `run_tasks`.

    Returns
    -------
    DataFrame
        One row for each cylinder, method, motion and level: cylinder, motion, step (place of the level),
        method, peak_tilt [alpha], outcome, contact_lost (1, 0, or NaN where nobody asked). A run whose
        process died failed.
    """
    tasks = list(plan.tasks())
    with run_tables(
        run_task,
        tasks,
        kind=kind,
        key=Task.key,
        label=lambda task: task.title,
        folder=folder,
        lost=_lost,
        cost=lambda task: task.cost,
        tries=_TRIES,
        makers=partial(all_makers, tuple(method.run for method in plan.methods if method.run is not None)),
        workers=workers,
        scheduler=scheduler,
        progress=progress,
    ) as found:
        tables = [_labelled(task, each, plan) for task, each in zip(tasks, found, strict=True)]
    table = pd.concat(tables, ignore_index=True)
    return pd.concat([table, *(worse(table, m) for m in plan.methods if m.of)], ignore_index=True)


def worse(runs: pd.DataFrame, method: Method) -> pd.DataFrame:
    """Return the rows of a method that is the worse of others: the larger tilt, overturned where one is."""
    parts = [runs[runs["method"] == label].set_index(KEYS) for label in method.of]
    first = parts[0]
    others = [part.loc[first.index] for part in parts]
    peaks = np.column_stack([part["peak_tilt"].to_numpy(float) for part in others])
    outcomes = np.column_stack([part["outcome"].to_numpy(str) for part in others])
    lost = np.column_stack([part["contact_lost"].to_numpy(float) for part in others])
    failed = (outcomes == "failed").any(axis=1)
    fell = (outcomes == "overturned").any(axis=1)
    made = first.reset_index()
    made["method"] = method.label
    made["peak_tilt"] = peaks.max(axis=1)  # NaN where one failed
    made["outcome"] = np.where(failed, "failed", np.where(fell, "overturned", outcomes[:, 0]))
    made["contact_lost"] = lost.max(axis=1)
    return made


def _labelled(task: Task, table: pd.DataFrame, plan: Plan) -> pd.DataFrame:
    steps = {shaking.motion.name: plan.factors(task.cylinder, shaking.motion) for shaking in task.shakings}
    places = [(s.motion.name, steps[s.motion.name].index(scale)) for s in task.shakings for scale in s.scales]
    return table.assign(
        cylinder=task.name,
        motion=[name for name, _ in places],
        step=[step for _, step in places],
        method=task.label,
    )[[*KEYS, "method", "peak_tilt", "outcome", "contact_lost"]]


def _lost(task: Task) -> pd.DataFrame:
    count = sum(len(shaking.scales) for shaking in task.shakings)
    return pd.DataFrame(
        {"peak_tilt": [np.nan] * count, "outcome": ["failed"] * count, "contact_lost": [np.nan] * count}
    )
