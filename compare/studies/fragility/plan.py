"""Plan of a fragility (cylinders, motions at levels or as they are, methods), and the table of its runs."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial
from pathlib import Path

import numpy as np
import pandas as pd

from rockwobble.models import Case, Cylinder, GroundMotion, Run
from rockwobble.multibody.scene import default_step

from ...runs.choice import require_runnable
from ...runs.execution import all_makers
from ...runs.progress import ProgressCallback
from ...runs.tables import run_tables
from ..plans import FragilityPlan
from .intensity import intensity, measures_of
from .methods import Method, Shaking, Task, run_task
from .samples import CONTACT_LOST

# The reduced runs of a task take about a second together: little is lost with it.
_CHUNK_TIME = 1.0
# of the default levels, as peak resultant over g tan(alpha): from a little above uplift to where a slender
# body of ten metres has fallen under most records
_LOWEST, _HIGHEST, LEVELS = 1.25, 12.0, 20


@dataclass(frozen=True, kw_only=True, eq=False)
class RunPlan:
    """Every cylinder under every motion at every level by every method.

    Parameters
    ----------
    cylinders : mapping of str to Cylinder
    motions : sequence of GroundMotion
        At least two, with different names: they are what is resampled.
    methods : sequence of Method
    options : FragilityPlan
        With levels (stripes: every motion is scaled to each of these intensities), or with scales or neither
        (a cloud: factors on the motions as they are). A step factor is of runs that state no step.

    Raises
    ------
    ValueError
        If an axis is empty, repeats a value or holds one that is out of range, or an engine cannot run.
    """

    cylinders: Mapping[str, Cylinder]
    motions: Sequence[GroundMotion]
    methods: Sequence[Method]
    options: FragilityPlan

    def __post_init__(self) -> None:
        asked = self.options
        if not self.cylinders:
            raise ValueError("a fragility needs at least one cylinder, got none")
        names = [motion.name for motion in self.motions]
        if len(set(names)) < 2 or len(set(names)) < len(names):
            raise ValueError(
                f"a fragility needs at least two ground motions with different names, got {len(names)} "
                f"with {len(set(names))} names"
            )
        if asked.step_factor != 1.0 and not any(map(_has_default_step, self.methods)):
            raise ValueError(
                f"step_factor is for engines at their default time step, got {asked.step_factor!r}"
            )
        for cylinder in self.cylinders.values():
            for motion in self.motions:
                self._intensity(motion, cylinder)
            case = Case(cylinder, self.motions[0], gravity=asked.gravity, friction=asked.friction)
            for method in self.methods:
                if method.run is not None:
                    require_runnable(case, self._stepped(method.run, cylinder))

    def factors(self, cylinder: Cylinder, motion: GroundMotion) -> tuple[float, ...]:
        """Return the factors on a motion, one for each level or those of the cloud."""
        if self.options.levels is None:
            return self.scales
        own = self._intensity(motion, cylinder)
        return tuple(float(level) / own for level in self.options.levels)

    @property
    def scales(self) -> tuple[float, ...]:
        """Factors on the motions of a cloud."""
        return (1.0,) if self.options.scales is None else tuple(map(float, self.options.scales))

    def _intensity(self, motion: GroundMotion, cylinder: Cylinder) -> float:
        asked = self.options
        return intensity(asked.measure, motion, cylinder, gravity=asked.gravity, period=asked.period)

    @cached_property
    def points(self) -> pd.DataFrame:
        """One row for each cylinder, motion and level: its place, the factor, and all intensities."""
        rows, asked = [], self.options
        for name, cylinder in self.cylinders.items():
            own = measures_of(self.motions, cylinder, gravity=asked.gravity, period=asked.period)
            for index, motion in enumerate(self.motions):
                for step, scale in enumerate(self.factors(cylinder, motion)):
                    found = {measure: scale * values[index] for measure, values in own.items()}
                    if asked.levels is not None:  # to the last bit one level for all
                        found[asked.measure] = float(asked.levels[step])
                    rows.append(
                        {"cylinder": name, "motion": motion.name, "step": step, "scale": scale, **found}
                    )
        return pd.DataFrame(rows)

    def tasks(self) -> Iterator[Task]:
        """Yield the runs: engines singly, reduced models some motions together."""
        for name, cylinder in self.cylinders.items():
            shakings = [Shaking(motion=m, scales=self.factors(cylinder, m)) for m in self.motions]
            single = [Shaking(motion=s.motion, scales=(scale,)) for s in shakings for scale in s.scales]
            for method in self.methods:
                if method.run is None:
                    continue
                run = self._stepped(method.run, cylinder)
                singles = [
                    Task(
                        cylinder=cylinder,
                        name=name,
                        label=method.label,
                        run=run,
                        shakings=(shaking,),
                        gravity=self.options.gravity,
                        friction=self.options.friction,
                        contact=CONTACT_LOST in (self.options.limits or ()),
                    )
                    for shaking in (shakings if run.engine is None else single)
                ]
                yield from singles if run.engine else _together(singles)

    def _stepped(self, run: Run, cylinder: Cylinder) -> Run:
        if run.engine is None or run.time_step is not None or self.options.step_factor == 1.0:
            return run
        step = self.options.step_factor * default_step(cylinder.semidiagonal, self.options.gravity)
        return Run(run.engine, run.support, step, **run.settings)


def default_levels(
    cylinders: Mapping[str, Cylinder], motions: Sequence[GroundMotion], asked: FragilityPlan
) -> tuple[float, ...]:
    """Return levels from a little above uplift to where most overturn, each the same factor above the last.

    In another measure than the peak acceleration: what the median motion has at these levels.
    """
    over = [
        intensity(asked.measure, motion, cylinder, gravity=asked.gravity, period=asked.period)
        / intensity("peak_acceleration", motion, cylinder, gravity=asked.gravity)
        for cylinder in cylinders.values()
        for motion in motions
    ]
    middle = float(np.median(over))
    return tuple(float(f"{middle * level:.3g}") for level in np.geomspace(_LOWEST, _HIGHEST, LEVELS))


def _together(singles: Sequence[Task]) -> Iterator[Task]:
    """Join tasks of the same cylinder and method until they take about a second."""
    size = max(1, round(_CHUNK_TIME / max(task.cost for task in singles)))
    for i in range(0, len(singles), size):
        part = singles[i : i + size]
        yield replace(part[0], shakings=tuple(shaking for task in part for shaking in task.shakings))


def _has_default_step(method: Method) -> bool:
    return method.run is not None and method.run.engine is not None and method.run.time_step is None


# a task whose process died is tried this often: the process may have been ended from outside
_TRIES = 2
KEYS = ["cylinder", "motion", "step"]


def run_plan(
    plan: RunPlan,
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
    plan : RunPlan
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


def _labelled(task: Task, table: pd.DataFrame, plan: RunPlan) -> pd.DataFrame:
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
