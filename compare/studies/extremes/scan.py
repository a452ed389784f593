"""Every extreme by every method: one row each."""

from __future__ import annotations

import dataclasses
import os
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from rockwobble import multibody
from rockwobble.models import Run

from ...runs.process_pool import ProcessPool, WorkerDiedError
from .conditions import Condition, conditions
from .verdict import Verdict, judge

if TYPE_CHECKING:
    import pandas as pd

METHODS = (
    Run(None, "flat", plane=0.0),
    Run(None, "recess"),
    Run(None, "flat"),
    Run("mujoco", "recess"),
    Run("mujoco", "flat"),
    Run("mujoco", "ring"),
    Run("pybullet", "recess"),
    Run("pybullet", "flat"),
    Run("exudyn", "flat"),
)
STAGES = ("extremes",)


def measure_extremes(
    *, quick: bool = False, workers: int | None = None, tell: Callable[[str, float], None] | None = None
) -> pd.DataFrame:
    """Run every condition by every method that is installed.

    Parameters
    ----------
    quick : bool, optional
        Only the first and the last condition of each extreme.
    workers : int, optional
        Processes; default one for each core.
    tell : callable, optional
        Called with the stage and the fraction of it done.

    Returns
    -------
    DataFrame
        One row for each condition and method: extreme, value, method, and the attributes of `Verdict`.
    """
    import pandas as pd

    known = multibody.available_engines()
    tasks = [
        (condition, run)
        for condition in conditions(quick=quick)
        for run in METHODS
        if run.engine is None or run.engine in known
    ]
    rows = []
    with ProcessPool(workers or os.cpu_count() or 1) as pool:
        futures = [pool.submit(judge, *task) for task in tasks]
        for done, ((condition, run), future) in enumerate(zip(tasks, futures, strict=True), 1):
            try:
                found = future.result()
            except WorkerDiedError:
                found = Verdict(verdict="silent", limit="died")
            rows.append(row(condition, run, found))
            if tell is not None:
                tell(STAGES[0], done / len(tasks))
    return pd.DataFrame(rows)


def row(condition: Condition, run: Run, found: Verdict) -> dict[str, Any]:
    """Return the row of a verdict."""
    named = {"extreme": condition.extreme, "value": condition.value, "method": str(run)}
    return named | dataclasses.asdict(found)
