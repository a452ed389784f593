"""Plan of a fragility (cylinders, motions at levels or as they are, methods), and the table of its runs."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial
from pathlib import Path

import numpy as np
import pandas as pd

from rockwobble.models import Case, Cylinder, GroundMotion, Run
from rockwobble.models.number_checks import require_increasing, require_positive
from rockwobble.multibody.scene.froude import default_step

from ...runs.choice import require_runnable
from ...runs.execution import all_makers
from ...runs.progress import ProgressCallback
from ...runs.tables import run_tables
from .intensity import intensity, measures_of, require_measure
from .methods import Method, Shaking, Task, run_task

# The reduced runs of a task take about a second together: little is lost with it.
_CHUNK_TIME = 1.0
# of the default levels, as peak resultant over g tan(alpha): from a little above uplift to where a slender
# body of ten metres has fallen under most records
_LOWEST, _HIGHEST, LEVELS = 1.25, 12.0, 20


@dataclass(frozen=True, kw_only=True, eq=False)
class Plan:
    """Every cylinder under every motion at every level by every method.

    Parameters
    ----------
    cylinders : mapping of str to Cylinder
    motions : sequence of GroundMotion
        At least two, with different names: they are what is resampled.
    methods : sequence of Method
    measure : str
        Intensity of the levels, one of `MEASURES`.
    levels : sequence of float or None
        Stripes: every motion is scaled to each of these intensities. None: a cloud.
    scales : sequence of float
        Of a cloud: factors on the motions as they are.
    period : float
        Of "sa" and "sa_mean" [s].
    gravity, friction : float
    contact : bool
        Whether it is asked where reduced models lose contact.
    step_factor : float
        On the default time step of engines: a share of runs needs less than a trace. Runs that state a step
        keep it.

    Raises
    ------
    ValueError
        If an axis is empty, repeats a value or holds one that is out of range, or an engine cannot run.
    """

    cylinders: Mapping[str, Cylinder]
    motions: Sequence[GroundMotion]
    methods: Sequence[Method]
    measure: str = "peak_acceleration"
    levels: Sequence[float] | None = None
    scales: Sequence[float] = (1.0,)
    period: float = 1.0
    gravity: float = 9.81
    friction: float = 1.0
    contact: bool = False
    step_factor: float = 1.0

    def __post_init__(self) -> None:
        require_measure(self.measure)
        if not self.cylinders:
            raise ValueError("a fragility needs at least one cylinder, got none")
        names = [motion.name for motion in self.motions]
        if len(set(names)) < 2 or len(set(names)) < len(names):
            raise ValueError(
                f"a fragility needs at least two ground motions with different names, got {len(names)} "
                f"with {len(set(names))} names"
            )
        for label, values in (("levels", self.levels), ("scales", self.scales)):
            if values is not None:
                require_increasing(label, values)
        require_positive("step_factor", self.step_factor)
        if self.step_factor != 1.0 and not any(map(_has_default_step, self.methods)):
            raise ValueError(
                f"step_factor is for engines at their default time step, got {self.step_factor!r}"
            )
        for cylinder in self.cylinders.values():
            for motion in self.motions:
                intensity(self.measure, motion, cylinder, gravity=self.gravity, period=self.period)
            case = Case(cylinder, self.motions[0], gravity=self.gravity, friction=self.friction)
            for method in self.methods:
                if method.run is not None:
                    require_runnable(case, self._stepped(method.run, cylinder))

    def factors(self, cylinder: Cylinder, motion: GroundMotion) -> tuple[float, ...]:
        """Return the factors on a motion, one for each level or those of the cloud."""
        if self.levels is None:
            return tuple(map(float, self.scales))
        own = intensity(self.measure, motion, cylinder, gravity=self.gravity, period=self.period)
        return tuple(float(level) / own for level in self.levels)

    @cached_property
    def points(self) -> pd.DataFrame:
        """One row for each cylinder, motion and level: its place, the factor, and all intensities."""
        rows = []
        for name, cylinder in self.cylinders.items():
            own = measures_of(self.motions, cylinder, gravity=self.gravity, period=self.period)
            for index, motion in enumerate(self.motions):
                for step, scale in enumerate(self.factors(cylinder, motion)):
                    found = {measure: scale * values[index] for measure, values in own.items()}
                    if self.levels is not None:  # to the last bit one level for all
                        found[self.measure] = float(self.levels[step])
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
                        gravity=self.gravity,
                        friction=self.friction,
                        contact=self.contact,
                    )
                    for shaking in (shakings if run.engine is None else single)
                ]
                yield from singles if run.engine else _together(singles)

    def _stepped(self, run: Run, cylinder: Cylinder) -> Run:
        if run.engine is None or run.time_step is not None or self.step_factor == 1.0:
            return run
        step = self.step_factor * default_step(cylinder.semidiagonal, self.gravity)
        return Run(run.engine, run.support, step, **run.settings)


def default_levels(
    cylinders: Mapping[str, Cylinder],
    motions: Sequence[GroundMotion],
    measure: str,
    *,
    gravity: float = 9.81,
    period: float = 1.0,
) -> tuple[float, ...]:
    """Return levels from a little above uplift to where most overturn, each the same factor above the last.

    In another measure than the peak acceleration: what the median motion has at these levels.
    """
    require_measure(measure)
    over = [
        intensity(measure, motion, cylinder, gravity=gravity, period=period)
        / intensity("peak_acceleration", motion, cylinder, gravity=gravity)
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
