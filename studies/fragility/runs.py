"""Runs of a fragility: its methods, its plan, and its cached tasks."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from numbers import Real
from operator import attrgetter
from typing import Any, ClassVar, cast

import numpy as np
import pandas as pd

from rockwobble.compare.metrics.pair import beyond_yield, outcome_of, outcome_of_peak
from rockwobble.compare.runs.choice import require_runnable, run_labels
from rockwobble.compare.runs.execution import (
    all_makers,
    case_inputs,
    engine_time,
    makers_of,
    simulate_run,
)
from rockwobble.compare.storage.provenance import result_fingerprint
from rockwobble.models import Case, GroundMotion, RockingBody, Run
from rockwobble.models.bounds import OVERTURNED_TILT
from rockwobble.models.case import REDUCED_MODELS, TERMS
from rockwobble.models.number_checks import quoted, require_each, require_increasing, require_one_of
from rockwobble.models.support import FLAT, MODELLED, RECESS, SUPPORTS
from rockwobble.models.trace import NO_PEAK
from rockwobble.multibody.scene import default_step

from ..plans import FragilityPlan
from ..study import Study
from .intensity import intensity, measures_of, uplift_scale
from .tables import CONTACT_LOST, SLIDES, YIELDED

Row = dict[str, float | str]  # row of a run
Shaken = tuple[Case, Mapping[int, float]]  # case, and the factors on its ground motion by their places
# The worse plane is not simulated: for each motion it is the plane with the larger tilt.
WORSE_PLANE = "worse-plane"
_PLANES = {"planar-x": 0.0, "planar-y": 0.5 * math.pi}
MODEL_LABELS: Mapping[str, str] = {
    **{support: support.model for support in MODELLED},
    "planar-x": "planar x",
    "planar-y": "planar y",
    WORSE_PLANE: "worse plane",
}


def default_models(asked: FragilityPlan) -> tuple[str, ...]:
    """Default models: those with an anchor for a tendon, the sliding model for pure sliding."""
    if asked.limits is not None and {*asked.limits} == {SLIDES}:
        return (str(FLAT),)
    guided = asked.tendon is not None
    return tuple(name for name in MODEL_LABELS if not guided or name not in MODELLED or SUPPORTS[name].guided)


@dataclass(frozen=True, slots=True, kw_only=True)
class Method:
    """One method.

    Attributes
    ----------
    label : str
        Different for each method.
    run : Run or None
        None for the worse of both planes.
    """

    label: str
    run: Run | None

    @property
    def support(self) -> str:
        """Support of the cylinder: "recess", "flat", "ring" or "planar"."""
        if self.run is None or self.run.is_planar:
            return "planar"
        return self.run.support


def methods_of(given: Iterable[str | Run], *, restitution: float | str = 1.0) -> tuple[Method, ...]:
    """Methods in their order, with both planes if the worse plane is asked for.

    Parameters
    ----------
    given : iterable of str or Run
        Names in `MODEL_LABELS`, and runs of engines or of reduced models with settings.
    restitution : float or "momentum", optional
        Restitution of the planar models, see `reduced.simulate`.

    Raises
    ------
    ValueError
        If a name is unknown, two methods are alike, there is none, or no planar one for a restitution.
    """
    chosen: list[str | Run] = []
    for method in given:
        if not isinstance(method, Run):
            require_one_of("a reduced model", method, MODEL_LABELS)
        needed = (*_PLANES, method) if method == WORSE_PLANE else (method,)
        chosen += [each for each in needed if isinstance(each, Run) or each not in chosen]
    if not chosen:
        raise ValueError("a fragility needs at least one method, got none")
    if restitution != 1.0 and not any(method in _PLANES for method in chosen):
        raise ValueError(f"restitution is of planar models, got {restitution!r} without one")
    loss = {} if restitution == 1.0 else {"restitution": restitution}
    planar = {name: Run(None, RECESS, None, plane=azimuth, **loss) for name, azimuth in _PLANES.items()}
    models: dict[str, Run] = {**{model.support: model for model in REDUCED_MODELS}, **planar}
    labels = iter(run_labels([method for method in chosen if isinstance(method, Run)]))
    listed = tuple(
        Method(label=next(labels), run=method)
        if isinstance(method, Run)
        else Method(label=MODEL_LABELS[method], run=models.get(method))
        for method in chosen
    )
    for name, count in Counter(method.label for method in listed).items():
        if count > 1:
            raise ValueError(f"the methods must differ, got {name!r} twice")
    return listed


def own_model(method: Method, methods: Sequence[Method]) -> str:
    """Label among the methods of the reduced model of an engine's support, if any.

    No reduced model knows the walls of a ring.
    """
    if method.run is None or method.run.is_model:
        return ""
    reduced = [other for other in methods if other.run is not None and other.run.is_model]
    return next((other.label for other in reduced if other.support == method.support), "")


# Computing time of a reduced run for each second of its motion, forces included or not, on one core [s]: a
# rough mean of the models.
_KERNEL_TIME, _SOLUTION_TIME = 3e-5, 1e-3
# facts of a run that mean that the ground would have to pull, or did not touch the cylinder
_LOST = ("tension", "lift_off")
_RTOL = 1e-7


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Task:
    """One cylinder by one method under some motions, each at some factors.

    Attributes
    ----------
    name, label : str
        Name and label of the cylinder and of the method.
    run : Run
    shakings : tuple of Shaken
        Cases with ground motions as they are, with the factors on each by their places (levels).
    contact : bool
        Whether it is asked if a reduced model keeps its contact: that takes its forces.
    gap : float, optional
        Displacement of which it is asked if it is exceeded [m].
    """

    name: str
    label: str
    run: Run
    shakings: tuple[Shaken, ...]
    contact: bool
    gap: float | None = None

    @property
    def points(self) -> list[tuple[str, int]]:
        """Motion name and level index of each run."""
        return [(case.name, step) for case, factors in self.shakings for step in factors]

    @property
    def title(self) -> str:
        """Description of the task, for the progress callback."""
        case, factors = self.shakings[0]
        scale = f" × {min(factors.values()):.3g}" if len(factors) == 1 else ""
        more = f" and {len(self.shakings) - 1} more" if len(self.shakings) > 1 else ""
        return f"{self.name}, {self.label}, {case.name}{scale}{more}"

    @property
    def cost(self) -> float:
        """Rough computing time [s]."""
        rate = _KERNEL_TIME if self._of_peaks else _SOLUTION_TIME
        return sum(
            (rate * case.length if self.run.is_model else engine_time(case, self.run)) * len(factors)
            for case, factors in self.shakings
        )

    @property
    def _of_peaks(self) -> bool:
        """Whether the batch kernel suffices: peaks of homogeneous cylinders, with or without a slab."""
        own = self.shakings[0][0].cylinder
        homogeneous = own.height is own.transverse_inertia is own.axial_inertia is None
        return self.run.is_model and homogeneous and not self.contact

    def rows(self) -> list[Row]:
        """Row for each motion and factor, in their order."""
        if self._of_peaks:
            return [row for case, factors in self.shakings for row in self._peaks(case, [*factors.values()])]
        return [self._simulate(case, scale) for case, factors in self.shakings for scale in factors.values()]

    def _peaks(self, case: Case, scales: Sequence[float]) -> list[Row]:
        from rockwobble import reduced

        cylinder, motion = case.cylinder, cast("GroundMotion", case.motion)
        # processes share the cores already, so one thread each
        common: dict[str, Any] = {"workers": 1, "gravity": case.gravity}
        if slides_by_model(case, self.run):
            moved = reduced.peak_displacements([case.friction], motion, scales, **common)[0]
            return [
                _row(case, 0.0 * each, "failed" if math.isnan(each) else "stands", slides=self._exceeds(each))
                for each in moved.tolist()
            ]
        common |= {**case.terms, "slab_mass_ratio": cylinder.slab_mass_ratio, "support": self.run.support}
        common |= {"rtol": _RTOL, **self.run.settings}
        peaks = reduced.peak_tilts([cylinder.semidiagonal], cylinder.tan_alpha, motion, scales, **common)[0]
        return [
            # a run without a peak gives its reason
            self._simulate(case, scale) if math.isnan(peak) else _row(case, peak, outcome_of_peak(peak))
            for peak, scale in zip(peaks.tolist(), scales, strict=True)
        ]

    def _simulate(self, case: Case, scale: float) -> Row:
        run, motion = self.run, cast("GroundMotion", case.motion)
        if run.is_model:
            run = Run(None, run.support, **{"rtol": _RTOL, **run.settings})
        trace = simulate_run(replace(case, motion=motion.scaled(scale)), run)
        lost = math.nan
        if trace.outcome not in NO_PEAK and (self.contact or not run.is_model):
            lost = float(any(fact.code in _LOST for fact in trace.diagnostics))
        free = run.support.lets_slide and (not run.is_model or slides_by_model(case, run))
        slides = self._exceeds(trace.peak_displacement) if free else math.nan
        return _row(case, trace.peak_tilt, outcome_of(trace), lost, slides)

    def _exceeds(self, displacement: float) -> float:
        """1 if the displacement exceeds the gap, 0 if not, NaN without a gap or if unknown."""
        return math.nan if self.gap is None or math.isnan(displacement) else float(displacement > self.gap)


def slides_by_model(case: Case, run: Run) -> bool:
    """Whether the model of a run treats a case from rest as sliding."""
    free = run.is_model and not run.is_planar and run.support.lets_slide
    return free and case.friction < case.friction_of_uplift


def _row(
    case: Case, peak_tilt: float, outcome: str, contact_lost: float = math.nan, slides: float = math.nan
) -> Row:
    """Row of a run; contact_lost is 1 or 0, NaN if not asked for, failed or yielded.

    So is slides, whether the gap is used up.

    Of one that is no answer beyond yield the peak tilt is that of yield, which it passes.
    """
    tendon = case.tendon
    if tendon is not None and beyond_yield(peak_tilt, case):
        peak_tilt, outcome, contact_lost = tendon.yield_tilt(case.cylinder), YIELDED, math.nan
    values = (peak_tilt / case.cylinder.alpha, outcome, contact_lost, slides)
    return dict(zip(_OF_RUN, values, strict=True))


# The reduced runs of a task take about a second together: little is lost with it.
_CHUNK_TIME = 1.0
# range of the default levels, as peak resultant over g tan(alpha): from a little above uplift to where a
# slender body of ten metres has fallen under most records
_LOWEST, _HIGHEST, LEVELS = 1.25, 12.0, 20


@dataclass(frozen=True, kw_only=True, eq=False)
class RunPlan(Study[Task, pd.DataFrame]):
    """Plan of a fragility: cylinders, motions, levels and methods.

    `run` yields one row for each: cylinder, motion, step (place of the level), method, peak_tilt [alpha],
    outcome, contact_lost and slides (1, 0, or NaN where nobody asked). A run whose process died failed.

    Parameters
    ----------
    cylinders : mapping of str to Cylinder
    motions : sequence of GroundMotion
        At least two, with different names: they are what is resampled.
    methods : sequence of Method
    options : FragilityPlan
        With levels (stripes: every motion is scaled to each of these intensities), or with scales or neither
        (a cloud: factors on the motions as they are). A step factor is of runs that state no step.
    stripes : mapping of str to tuple of int, optional
        Places of the levels at which each motion is run, by its name. Default: every motion at every level.

    Raises
    ------
    ValueError
        If an axis is empty, repeats a value or holds one that is out of range, or an engine cannot run.
    """

    kind: ClassVar[str] = "fragility"
    tries: ClassVar[int] = 2
    cost: ClassVar[Callable[[Task], float] | None] = attrgetter("cost")
    cylinders: Mapping[str, RockingBody]
    motions: Sequence[GroundMotion]
    methods: Sequence[Method]
    options: FragilityPlan
    stripes: Mapping[str, tuple[int, ...]] | None = None

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
            case = self._case(cylinder, self.motions[0])
            for run in (method.run for method in self.methods if method.run is not None):
                require_runnable(case, self._with_step(run, cylinder))

    def motions_of_levels(self) -> list[int]:
        """Number of motions at each level."""
        places = [step for steps in (self.stripes or {}).values() for step in steps]
        return [places.count(step) for step in range(len(self.options.levels or ()))]

    @property
    def scales(self) -> tuple[float, ...]:
        """Factors on the motions of a cloud."""
        return tuple(map(float, self.options.scales or (1.0,)))

    def factors(self, cylinder: RockingBody, motion: GroundMotion) -> dict[int, float]:
        """Factors on a motion by level index: one per listed level, or those of the cloud."""
        asked = self.options
        if asked.levels is None:
            return dict(enumerate(self.scales))
        own = _intensity_of(asked, motion, cylinder)
        steps = range(len(asked.levels)) if self.stripes is None else self.stripes[motion.name]
        return {step: float(asked.levels[step]) / own for step in steps}

    def _case(self, cylinder: RockingBody, motion: GroundMotion) -> Case:
        asked = self.options
        terms = {name: getattr(asked, name) for name in ("gravity", "friction", *TERMS)}
        return Case(cylinder, motion, name=motion.name, **terms)

    @cached_property
    def points(self) -> pd.DataFrame:
        """One row for each cylinder, motion and listed level.

        Place, factor, factor of uplift, whether the motion is synthetic, all intensities.
        """
        rows, asked = [], self.options
        for name, cylinder in self.cylinders.items():
            own = measures_of(self.motions, cylinder, gravity=asked.gravity, period=asked.period)
            own.setdefault(asked.measure, [_intensity_of(asked, motion, cylinder) for motion in self.motions])
            lifts = [uplift_scale(motion, cylinder, asked.gravity, asked.tendon) for motion in self.motions]
            for index, motion in enumerate(self.motions):
                for step, scale in self.factors(cylinder, motion).items():
                    row: dict[str, object] = {"cylinder": name, "motion": motion.name, "step": step}
                    row |= {"scale": scale, "uplift_scale": lifts[index], "synthetic": motion.synthetic}
                    row |= {measure: scale * values[index] for measure, values in own.items()}
                    if asked.levels is not None:  # common levels, bitwise
                        row[asked.measure] = float(asked.levels[step])
                    rows.append(row)
        return pd.DataFrame(rows)

    def tasks(self) -> list[Task]:
        """Tasks: one per engine run, and groups of motions of about a second for reduced models."""
        contact = CONTACT_LOST in (self.options.limits or ())
        tasks: list[Task] = []
        for name, cylinder in self.cylinders.items():
            whole: list[Shaken] = [(self._case(cylinder, m), self.factors(cylinder, m)) for m in self.motions]
            single: list[Shaken] = [
                (case, {step: by}) for case, scales in whole for step, by in scales.items()
            ]
            for method in self.methods:
                if method.run is None:
                    continue
                run = self._with_step(method.run, cylinder)
                empty = Task(
                    name=name,
                    label=method.label,
                    run=run,
                    shakings=(),
                    contact=contact,
                    gap=self.options.gap,
                )
                own, size = single, 1
                if run.is_model:
                    own = whole
                    longest = max(replace(empty, shakings=(each,)).cost for each in whole)
                    size = max(1, round(_CHUNK_TIME / longest))
                tasks += [
                    replace(empty, shakings=tuple(own[place : place + size]))
                    for place in range(0, len(own), size)
                ]
        return tasks

    @staticmethod
    def row(task: Task) -> pd.DataFrame:
        """Table of a task: peak_tilt [alpha], outcome, contact_lost, slides."""
        return pd.DataFrame(task.rows())

    def key(self, task: Task) -> str:
        """Hash of what the runs of a task depend on."""
        run, own = task.run, {"contact": task.contact, "rtol": _RTOL} if task.run.is_model else {}
        own |= {} if task.gap is None else {"gap": task.gap}
        shakings = [case_inputs(case) | {"scales": (*factors.values(),)} for case, factors in task.shakings]
        return result_fingerprint({"shakings": shakings, "run": run, **own}, makers_of(run))

    def name(self, task: Task) -> str:
        """Title of a task."""
        return task.title

    def lost(self, task: Task, why: str) -> pd.DataFrame:
        """Table of failed runs, for a task whose process died."""
        return pd.DataFrame([_row(task.shakings[0][0], math.nan, "failed")] * len(task.points))

    def makers(self) -> Mapping[str, str]:
        """Versions and code of the methods."""
        return all_makers(method.run for method in self.methods if method.run is not None)

    def results(self, tables: list[pd.DataFrame]) -> pd.DataFrame:
        """Runs of all tasks, with the worse plane if it is asked for."""
        named = []
        for task, own in zip(self.tasks(), tables, strict=True):
            motions, steps = zip(*task.points, strict=True)
            named.append(own.assign(cylinder=task.name, motion=motions, step=steps, method=task.label))
        table = pd.concat(named, ignore_index=True)[[*KEYS, "method", *_OF_RUN]]
        worse = [worse_plane(table)] if any(method.run is None for method in self.methods) else []
        return pd.concat([table, *worse], ignore_index=True)

    def _with_step(self, run: Run, cylinder: RockingBody) -> Run:
        if run.is_model or run.time_step is not None or self.options.step_factor == 1.0:
            return run
        step = self.options.step_factor * default_step(cylinder.semidiagonal, self.options.gravity)
        return Run(run.engine, run.support, step, **run.settings)


def motions_by_level(
    given: Mapping[float, Sequence[GroundMotion]],
) -> tuple[tuple[float, ...], list[GroundMotion], dict[str, tuple[int, ...]]]:
    """Levels, all motions, and by motion name the indices of its levels.

    Raises
    ------
    ValueError
        If a level is none, a name comes twice at a level, or is that of another motion at another.
    """
    if not all(isinstance(level, Real) for level in given):
        raise ValueError(f"motions must be a sequence of GroundMotion, or such by level, got {quoted(given)}")
    levels = tuple(float(level) for level in require_increasing("levels", sorted(given)))
    motions: dict[str, GroundMotion] = {}
    places: dict[str, tuple[int, ...]] = {}
    for place, level in enumerate(sorted(given)):
        require_each(f"motions at {level:g}", given[level], GroundMotion)
        for motion in given[level]:
            known = motions.setdefault(motion.name, motion)
            same = known.time_step == motion.time_step and np.array_equal(
                known.acceleration, motion.acceleration
            )
            if place in places.get(motion.name, ()) or not same:
                raise ValueError(f"motions must have different names, got {motion.name!r} twice")
            places[motion.name] = (*places.get(motion.name, ()), place)
    return levels, list(motions.values()), places


def default_levels(
    cylinders: Mapping[str, RockingBody], motions: Sequence[GroundMotion], asked: FragilityPlan
) -> tuple[float, ...]:
    """Default levels: equal ratios from just above uplift to where most motions overturn.

    A tendon raises the lowest as it raises uplift, and the highest by its way to the balance besides. In
    another measure than the peak acceleration: what the median motion has at these levels.
    """
    from rockwobble import reduced

    over = [
        _intensity_of(asked, motion, cylinder)
        / intensity("peak_acceleration", motion, cylinder, gravity=asked.gravity)
        for cylinder in cylinders.values()
        for motion in motions
    ]
    held = []  # factors by which a tendon raises the couple at uplift and the velocity to reach the balance
    for body in cylinders.values():
        # with a gap it begins to slide where the friction ends
        share = 1.0 if asked.gap is None else min(1.0, asked.friction / body.tan_alpha)
        of, barrier = 1.0, 1.0
        if asked.tendon is not None:
            case = Case(body, duration=1.0, gravity=asked.gravity, tendon=asked.tendon)
            of = asked.tendon.uplift_factor(body)
            barrier = math.sqrt(min(reduced.balance_tilt_of_case(case), OVERTURNED_TILT) / body.alpha)
        held.append((of * share, barrier * share))
    low, high = _LOWEST * min(of for of, _ in held), _HIGHEST * max(of * barrier for of, barrier in held)
    middle = float(np.median(over))
    return tuple(float(f"{middle * level:.3g}") for level in np.geomspace(low, high, LEVELS))


def _intensity_of(asked: FragilityPlan, motion: GroundMotion, cylinder: RockingBody) -> float:
    """Intensity of a motion by the measure of a plan."""
    options = {"gravity": asked.gravity, "period": asked.period, "friction": asked.friction}
    return intensity(asked.measure, motion, cylinder, **options)


def _has_default_step(method: Method) -> bool:
    return method.run is not None and not method.run.is_model and method.run.time_step is None


KEYS = ["cylinder", "motion", "step"]
_OF_RUN = ["peak_tilt", "outcome", CONTACT_LOST, SLIDES]
_ENDS = [*NO_PEAK, "overturned", YIELDED]  # outcomes in order of precedence


def worse_plane(runs: pd.DataFrame) -> pd.DataFrame:
    """Rows of the worse plane: the larger tilt of both, overturned if one is."""
    parts = [runs[runs["method"] == MODEL_LABELS[name]].set_index(KEYS) for name in _PLANES]
    of = {name: pd.concat([part[name] for part in parts], axis=1) for name in parts[0]}
    ends = [(of["outcome"] == name).any(axis=1) for name in _ENDS]
    return (
        parts[0]
        .assign(
            method=MODEL_LABELS[WORSE_PLANE],
            peak_tilt=of["peak_tilt"].max(axis=1, skipna=False),  # NaN if a plane failed
            outcome=np.select(ends, _ENDS, parts[0]["outcome"]),
            contact_lost=of["contact_lost"].max(axis=1, skipna=False),
            slides=math.nan,
        )
        .reset_index()
    )
