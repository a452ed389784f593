"""Fragility: how probable it is that shaking of an intensity exceeds a limit, by several methods."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

from rockwobble.models import Cylinder, GroundMotion, Run
from rockwobble.models.number_checks import require_increasing, require_positive
from rockwobble.models.records.plausibility import doubts_of
from rockwobble.models.traces.trace_file import run_to_plain

from ...runs.progress import ProgressCallback
from ...storage.fingerprint import fingerprint
from .intensity import require_measure
from .limits import CONTACT_LOST, DEFAULT_LIMITS, require_limits
from .methods import MODELS, Method, methods_of, own_model
from .plan import Plan, default_levels
from .result import KIND, Fragility, fragility_of
from .runs import run_plan

# two methods are the same for an engineer whose medians differ by less: the motions of one site differ by
# several times as much
MARGIN = 0.1
RESAMPLES = 1000


def fragility(
    cylinders: Cylinder | Mapping[str, Cylinder] | Sequence[Cylinder],
    motions: Sequence[GroundMotion],
    *,
    methods: Iterable[str | Run] = tuple(MODELS),
    measure: str = "peak_acceleration",
    levels: Sequence[float] | None = None,
    scales: Sequence[float] | None = None,
    limits: Iterable[str] = DEFAULT_LIMITS,
    margin: float = MARGIN,
    period: float = 1.0,
    restitution: float | str = 1.0,
    gravity: float = 9.81,
    friction: float = 1.0,
    step_factor: float = 1.0,
    resamples: int = RESAMPLES,
    seed: int = 0,
    workers: int | None = None,
    scheduler: str | None = None,
    progress: ProgressCallback | None = None,
    resume: str | Path | None = None,
    source: str = "ground motions",
) -> Fragility:
    """Fit the probability of exceeding limits by several methods under the same motions.

    Parameters
    ----------
    cylinders : Cylinder, or mapping of names or sequence of them
    motions : sequence of GroundMotion
        At least two, with different names.
    methods : iterable of str or Run, optional
        Reduced models by name, "recess", "flat", "planar-x", "planar-y", "worse-plane" (of the two, motion
        by motion), and runs of engines with any support. Default: all five models. The first is the one
        whose efficient measure is sought. In a ring, whose walls have no top, a cylinder that leans on a
        wall beyond its balance at the end has overturned.
    measure : str, optional
        Intensity of the levels and of the curves, one of `MEASURES`.
    levels : sequence of float, optional
        Intensities to each of which every motion is scaled (stripes). Default: 20, from a little above
        uplift to where most motions overturn.
    scales : sequence of float, optional
        Factors on the motions as they are, in the place of levels (a cloud).
    limits : iterable of str, optional
        Of `LIMITS`; "contact_lost" takes the forces of every run of a reduced model. Default: all others.
    margin : float, optional
        Within which two medians count as equivalent.
    period : float, optional
        Of the spectral accelerations [s].
    restitution : float or "momentum", optional
        Of the planar models.
    gravity, friction : float, optional
        g [m/s^2], coefficient of cylinder and ground.
    step_factor : float, optional
        On the default time step of engines: shares of many runs need less than a trace.
    resamples : int, optional
        Of the motions, for the intervals.
    seed : int, optional
        Of the resamples.
    workers, scheduler, progress : optional
        As in `run_tasks`.
    resume : str or Path, optional
        Folder that keeps each finished run: a second call, after whatever ended the first, repeats none.
    source : str, optional
        What the motions are, for people.

    Returns
    -------
    Fragility
        Failed runs are left out and counted.

    Raises
    ------
    ValueError
        If an argument is out of range, or an engine cannot run.
    IncompleteError
        If the Dask cluster cannot do the runs, as where a worker has another version of an engine.

    Examples
    --------
    >>> from rockwobble.models import synthetic_motions
    >>> column = Cylinder(semidiagonal=3.0, tan_alpha=0.15)
    >>> shaking = synthetic_motions(8, peak=1.0, seed=1)
    >>> found = fragility(column, shaking, methods=["recess"], levels=[1.5, 3, 6], resamples=50, workers=1)
    >>> overturned = found.counts[found.counts["limit"] == "overturned"]
    >>> list(zip(overturned["intensity"], overturned["k"], overturned["n"]))
    [(1.5, 0, 8), (3.0, 6, 8), (6.0, 8, 8)]
    """
    bodies = _named(cylinders)
    chosen, states = require_asked(
        methods=methods,
        measure=measure,
        levels=levels,
        scales=scales,
        limits=limits,
        margin=margin,
        restitution=restitution,
        resamples=resamples,
    )
    if levels is None and scales is None:
        levels = default_levels(bodies, motions, measure, gravity=gravity, period=period)
    plan = Plan(
        cylinders=bodies,
        motions=motions,
        methods=chosen,
        measure=measure,
        levels=levels,
        scales=(1.0,) if scales is None else scales,
        period=period,
        gravity=gravity,
        friction=friction,
        contact=CONTACT_LOST in states,
        step_factor=step_factor,
    )
    about = _about(plan) | {
        "source": source,
        "limits": list(states),
        "margin": margin,
        "resamples": resamples,
        "seed": seed,
        "doubts": doubts_of(motions),
    }
    runs = run_plan(plan, KIND, folder=resume, workers=workers, scheduler=scheduler, progress=progress)
    return fragility_of(runs, plan.points, about)


def require_asked(
    *,
    methods: Iterable[str | Run],
    measure: str,
    levels: Sequence[float] | None,
    scales: Sequence[float] | None,
    limits: Iterable[str],
    margin: float,
    restitution: float | str,
    resamples: int,
) -> tuple[tuple[Method, ...], tuple[str, ...]]:
    """Return the methods and limit states of what is asked; no ground motion is needed for that.

    Parameters
    ----------
    methods, measure, levels, scales, limits, margin, restitution, resamples
        As in `fragility`.

    Raises
    ------
    ValueError
        If one is out of range or unknown, or two do not go together.
    """
    require_measure(measure)
    if levels is not None and scales is not None:
        raise ValueError(
            "levels are of motions that are scaled to them, scales of motions as they are: got both"
        )
    for label, values in (("levels", levels), ("scales", scales)):
        if values is not None:
            require_increasing(label, values)
    require_positive("margin", margin)
    if resamples < 2:
        raise ValueError(f"resamples must be at least 2, got {resamples!r}")
    return methods_of(methods, restitution=restitution), require_limits(limits)


def _about(plan: Plan) -> dict[str, Any]:
    return {
        "cylinders": {
            name: {"semidiagonal": body.semidiagonal, "tan_alpha": body.tan_alpha}
            for name, body in plan.cylinders.items()
        },
        "motions": len(plan.motions),
        "methods": {method.label: _described(method, plan.methods) for method in plan.methods},
        "measure": plan.measure,
        "levels": None if plan.levels is None else list(map(float, plan.levels)),
        "scales": list(map(float, plan.scales)) if plan.levels is None else None,
        "period": plan.period,
        "gravity": plan.gravity,
        "friction": plan.friction,
        "step_factor": plan.step_factor,
        "inputs": fingerprint([(task.name, task.label, task.key()) for task in plan.tasks()]),
    }


def _described(method: Method, methods: Sequence[Method]) -> dict[str, Any]:
    return {
        "support": method.support,
        "engine": method.run.engine if method.run is not None else None,
        "own_model": own_model(method, methods),
        "run": None if method.run is None else run_to_plain(method.run),
        "of": list(method.of),
    }


def _named(cylinders: Cylinder | Mapping[str, Cylinder] | Sequence[Cylinder]) -> dict[str, Cylinder]:
    if isinstance(cylinders, Mapping):
        return dict(cylinders)
    several = [cylinders] if isinstance(cylinders, Cylinder) else list(cylinders)
    found = {f"R = {each.semidiagonal:g} m, tan α = {each.tan_alpha:g}": each for each in several}
    if len(found) < len(several):
        raise ValueError("cylinders of the same size and slenderness need names: give them as a mapping")
    return found
