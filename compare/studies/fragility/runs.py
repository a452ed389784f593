"""Runs of a fragility: its methods, its plan, and the tasks of which each can be kept and repeated singly."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial
from pathlib import Path

import numpy as np
import pandas as pd

from rockwobble.models import Case, Cylinder, GroundMotion, Run, Trace
from rockwobble.models.number_checks import require_one_of
from rockwobble.multibody.scene import default_step

from ...metrics.pair import outcome_of, outcome_of_peak
from ...runs.choice import require_runnable, run_labels
from ...runs.execution import all_makers, engine_time, makers_of, run_tables, simulate_run
from ...runs.progress import ProgressCallback
from ...storage.provenance import fingerprint
from ..plans import FragilityPlan
from .intensity import intensity, measures_of
from .tables import CONTACT_LOST

Row = dict[str, float | str]  # of a run
# The worse plane is no run of its own: of both planes, for each motion, the one that tilts more.
WORSE_PLANE = "worse-plane"
_PLANES = {"planar-x": 0.0, "planar-y": 0.5 * math.pi}
MODELS: Mapping[str, str] = {
    "recess": "recess model",
    "flat": "flat-ground model",
    "planar-x": "planar x",
    "planar-y": "planar y",
    WORSE_PLANE: "worse plane",
}


@dataclass(frozen=True, slots=True, kw_only=True)
class Method:
    """One method.

    Attributes
    ----------
    label : str
        Different for each method.
    run : Run or None
        None for what is made of others.
    of : tuple of str
        Labels of the methods of which it is the worse, motion by motion.
    """

    label: str
    run: Run | None
    of: tuple[str, ...] = ()

    @property
    def support(self) -> str:
        """What holds the cylinder: "recess", "flat", "ring" or "planar"."""
        if self.run is None or self.run.settings.get("plane") is not None:
            return "planar"
        return self.run.support


def methods_of(given: Iterable[str | Run], *, restitution: float | str = 1.0) -> tuple[Method, ...]:
    """Return the methods, in their order; both planes besides where the worse of them is asked for.

    Parameters
    ----------
    given : iterable of str or Run
        Names in `MODELS`, and runs of engines or of reduced models with settings.
    restitution : float or "momentum", optional
        Of the planar models, see `reduced.simulate`.

    Raises
    ------
    ValueError
        If a name is unknown, two methods are alike, there is none, or no planar one for a restitution.
    """
    chosen: list[str | Run] = []
    for method in given:
        if isinstance(method, str):
            require_one_of("a reduced model", method, MODELS)
        chosen += [plane for plane in _PLANES if method == WORSE_PLANE and plane not in chosen]
        if method not in chosen or not isinstance(method, str):
            chosen.append(method)
    if not chosen:
        raise ValueError("a fragility needs at least one method, got none")
    labels = iter(run_labels([method for method in chosen if isinstance(method, Run)]))
    found = [_method(method, restitution, labels) for method in chosen]
    if restitution != 1.0 and not any(method in _PLANES for method in chosen):
        raise ValueError(f"restitution is of planar models, got {restitution!r} without one")
    names = [method.label for method in found]
    for name in names:
        if names.count(name) > 1:
            raise ValueError(f"the methods must differ, got {name!r} twice")
    return tuple(found)


def _method(given: str | Run, restitution: float | str, labels: Iterable[str]) -> Method:
    if isinstance(given, Run):
        return Method(label=next(iter(labels)), run=given)
    if given == WORSE_PLANE:
        return Method(label=MODELS[given], run=None, of=tuple(MODELS[plane] for plane in _PLANES))
    if given in _PLANES:
        loss = {} if restitution == 1.0 else {"restitution": restitution}
        return Method(label=MODELS[given], run=Run(None, "recess", None, plane=_PLANES[given], **loss))
    return Method(label=MODELS[given], run=Run(None, given))


def own_model(method: Method, methods: Sequence[Method]) -> str:
    """Return the label of the reduced model of the support of an engine, if there is one among the methods.

    No reduced model knows the walls of a ring.
    """
    if method.run is None or method.run.engine is None:
        return ""
    return next(
        (
            other.label
            for other in methods
            if other.run is not None and other.run.engine is None and other.support == method.support
        ),
        "",
    )


# Computing time of a reduced run for each second of its motion, forces included or not, on one core [s]: a
# rough mean of the models.
_KERNEL_TIME, _SOLUTION_TIME = 3e-5, 1e-3
# facts of a run that mean that the ground would have to pull, or did not touch the cylinder
_LOST = ("tension", "lift_off")
_RTOL = 1e-7


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Shaking:
    """A ground motion and the factors on it."""

    motion: GroundMotion
    scales: tuple[float, ...]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Task:
    """One cylinder by one method under some motions, each with some factors.

    Attributes
    ----------
    cylinder : Cylinder
    name, label : str
        Of the cylinder and of the method.
    run : Run
    shakings : tuple of Shaking
    gravity, friction, rolling_resistance : float
    contact : bool
        Whether it is asked if a reduced model keeps its contact: that takes its forces.
    """

    cylinder: Cylinder
    name: str
    label: str
    run: Run
    shakings: tuple[Shaking, ...]
    gravity: float
    friction: float
    rolling_resistance: float
    contact: bool

    @property
    def title(self) -> str:
        """Description of the task, for the progress callback."""
        more = f" and {len(self.shakings) - 1} more" if len(self.shakings) > 1 else ""
        first = self.shakings[0]
        scale = f" × {first.scales[0]:.3g}" if len(first.scales) == 1 else ""
        return f"{self.name}, {self.label}, {first.motion.name}{scale}{more}"

    @property
    def cost(self) -> float:
        """Rough computing time [s]."""
        if self.run.engine is not None:
            return sum(
                engine_time(Case(self.cylinder, each.motion, gravity=self.gravity), self.run)
                * len(each.scales)
                for each in self.shakings
            )
        length = sum(shaking.motion.duration * len(shaking.scales) for shaking in self.shakings)
        return length * (_KERNEL_TIME if self._of_peaks else _SOLUTION_TIME)

    def key(self) -> str:
        """Return the hash of all that the results depend on; names are no part of it."""
        own = {"contact": self.contact, "rtol": _RTOL} if self.run.engine is None else {}
        if self.rolling_resistance:
            own["rolling_resistance"] = self.rolling_resistance
        return fingerprint(
            {
                "cylinder": self.cylinder,
                "shakings": [(s.motion.acceleration, s.motion.time_step, s.scales) for s in self.shakings],
                "run": self.run,
                "gravity": self.gravity,
                "friction": self.friction,
                "made with": makers_of(self.run),
                **own,
            }
        )

    @property
    def _of_peaks(self) -> bool:
        """Whether the batch kernel does, which knows homogeneous cylinders, a slab, and peaks alone."""
        own = self.cylinder
        homogeneous = (own.height, own.transverse_inertia, own.axial_inertia) == (None, None, None)
        return self.run.engine is None and homogeneous and not self.contact

    def rows(self) -> list[Row]:
        """Return a row for each motion and factor, in their order."""
        if self._of_peaks:
            return [row for shaking in self.shakings for row in self._peaks(shaking)]
        return [self._row(s.motion, scale) for s in self.shakings for scale in s.scales]

    def _peaks(self, shaking: Shaking) -> list[Row]:
        from rockwobble import reduced

        peaks = reduced.peak_tilts(
            [self.cylinder.semidiagonal],
            self.cylinder.tan_alpha,
            shaking.motion,
            shaking.scales,
            workers=1,  # the processes share the cores already
            gravity=self.gravity,
            slab_mass_ratio=self.cylinder.slab_mass_ratio,
            rolling_resistance=self.rolling_resistance,
            support=self.run.support,
            **{"rtol": _RTOL, **self.run.settings},
        )[0]
        return [
            {
                "peak_tilt": float(peak) / self.cylinder.alpha,
                "outcome": outcome_of_peak(float(peak)),
                "contact_lost": math.nan,
            }
            for peak in peaks
        ]

    def _row(self, motion: GroundMotion, scale: float) -> Row:
        case = Case(
            self.cylinder,
            motion.scaled(scale),
            gravity=self.gravity,
            friction=self.friction,
            rolling_resistance=self.rolling_resistance,
        )
        run = self.run
        if run.engine is None:
            run = Run(None, run.support, **{"rtol": _RTOL, **run.settings})
        trace = simulate_run(case, run)
        return {
            "peak_tilt": trace.peak_tilt / self.cylinder.alpha,
            "outcome": outcome_of(trace),
            "contact_lost": self._lost(trace),
        }

    def _lost(self, trace: Trace) -> float:
        """1 where contact was lost, 0 where it was not; NaN where nobody asked or the run failed."""
        if trace.outcome == "failed" or not (self.contact or self.run.engine):
            return math.nan
        return float(any(fact.code in _LOST for fact in trace.diagnostics))


def run_task(task: Task) -> pd.DataFrame:
    """Return the table of a task: peak_tilt [alpha], outcome, contact_lost."""
    return pd.DataFrame(task.rows())


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
            case = Case(
                cylinder,
                self.motions[0],
                gravity=asked.gravity,
                friction=asked.friction,
                rolling_resistance=asked.rolling_resistance,
            )
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
                        rolling_resistance=self.options.rolling_resistance,
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
    of = {name: pd.concat([part[name] for part in parts], axis=1) for name in parts[0]}
    ends = [(of["outcome"] == name).any(axis=1) for name in ("failed", "overturned")]
    return (
        parts[0]
        .assign(
            method=method.label,
            peak_tilt=of["peak_tilt"].max(axis=1, skipna=False),  # NaN where one failed
            outcome=np.select(ends, ["failed", "overturned"], parts[0]["outcome"]),
            contact_lost=of["contact_lost"].max(axis=1, skipna=False),
        )
        .reset_index()
    )


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
