"""Commands on many problems: `rockwobble fragility`, `spectrum`, `ensemble` and `sweep`."""

from __future__ import annotations

import dataclasses
import math
from dataclasses import fields
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

import rockwobble as rw
import rockwobble.compare as rc
from rockwobble.studies.plans import Copies, FragilityPlan, SpectrumPlan

from ..pages.cases import case_lines, case_warnings, record_lines, warnings_about
from ..pages.table import span
from ..pages.wording import written
from . import options
from .command import Work, saves_results
from .problem import (
    BODY,
    Body,
    Problem,
    Record,
    Steel,
    refuse,
    refuse_options_of_engines,
    under_slab,
    unread,
    with_steel,
)
from .shared_options import GridOptions, Hazard, ManyMethods, ManyMotions, cylinders_of
from .suite_choice import chosen_runs, refuse_problem_options, report_skipped_engines, without_missing

if TYPE_CHECKING:
    from rockwobble.compare.runs.progress import ProgressCallback
    from rockwobble.models import RockingBody
    from rockwobble.models.case import TimeStep
    from rockwobble.models.finding import Value
    from rockwobble.studies import Fragility, Sweep

Cylinders = Annotated[
    list[str] | None,
    options.body("Named cylinder, such as pier=6,0.2; may be repeated.", metavar="NAME=R,TAN_ALPHA"),
]


@saves_results
def fragility(
    context: typer.Context,
    many: ManyMotions,
    body: Body,
    methods: ManyMethods,
    plan: FragilityPlan,
    steel: Steel,
    hazard: Hazard,
    cylinder: Cylinders = None,
    workers: options.Workers = None,
    scheduler: options.Scheduler = None,
) -> Work:
    """Fragility curves: probability of overturning against intensity, by several methods.

    Every motion is scaled to the same intensities and run on every cylinder by every method: methods are
    compared motion by motion. Lognormal curves by maximum likelihood, with bootstrap bands over the motions.

    Without options: the five reduced models of R = 6 m, tan alpha = 0.2 under 100 synthetic motions.

    An interrupted run resumes with the same command.

    With --hazard: annual frequency of overturning at the site by each method, with the counted and the
    lognormal curve.

    Writes fragility.html, the tables as Parquet, and the counts for other tools (counts.csv, counts.json).

    Example: rockwobble fragility --p695 --cylinder pier=6,0.2 --engine mujoco
    """
    from rockwobble.studies.fragility.runs import default_models, methods_of
    from rockwobble.studies.fragility.study import limits_of

    if cylinder:
        of_body = BODY - {"slab_mass_ratio", "columns"}
        refuse(context, of_body, "does not go with --cylinder, which states the cylinder")
    bodies = cylinders_of(cylinder, body)
    plan = with_steel(context, plan, steel, list(bodies.values()), plan.gravity)
    chosen = methods.methods(next(iter(bodies.values())), default_models(plan))
    methods_of(chosen, restitution=plan.restitution)  # before motions are read
    site = hazard.curve(plan.period, limits_of(plan))
    if stripes := many.by_level():
        refuse(context, {"levels", "scales"}, "does not go with the column level of records.csv")
        motions = list({each.name: each for own in stripes.values() for each in own}.values())
        source = many.source
    else:
        motions, source = many.read(plan.seed)

    def run(**work: Any) -> Fragility:
        stated = {"workers": workers, "scheduler": scheduler, "source": source, **dataclasses.asdict(plan)}
        results = rw.fragility(bodies, stripes or motions, methods=chosen, **stated, **work)
        return results if site is None else hazard.with_risk(results, site)

    lines = [*record_lines(motions), *warnings_about(motions, bodies.values(), plan.gravity)]
    return Work(run, lines, resumes=True)


@saves_results
def spectrum(
    context: typer.Context,
    record: Record,
    plan: SpectrumPlan,
    steel: Steel,
    tan_alpha: Annotated[float | None, options.body(f"{options.SLENDERNESS} Default: 0.1.")] = None,
    diameter: Annotated[
        float | None, options.body("Diameter 2b, in m; with --height, instead of --tan-alpha.")
    ] = None,
    height: Annotated[
        float | None, options.body("Height 2h, in m; with --diameter, only their ratio counts.")
    ] = None,
    workers: options.Workers = None,
) -> Work:
    """Overturning spectrum: peak tilt over size and intensity, in 3D and by planar analysis.

    The record is scaled to each intensity by its peak horizontal resultant. A planar run takes one
    horizontal component of the same scaled record.

    Without options: figure 6 of the paper, the 1940 El Centro record on cylinders of tan alpha = 0.1.

    The overturning boundary (lowest intensity that overturns each size) is also searched between and below
    the intensities of the grid; the share that the search misses is estimated.

    An interrupted run resumes with the same command.

    Writes spectrum.html, and as Parquet the cells (spectrum), the overturning
    boundary (lowest), the gaps in the overturning region (gaps), the shares by size (contrast), and cells
    repeated to a tighter tolerance (checked).

    Example: rockwobble spectrum --tan-alpha 0.2 --semidiagonal 1:20:50 --intensity 1:9:50
    """
    from rockwobble.studies.spectrum.parts import runs_of

    sized = diameter is not None or height is not None
    slenderness = 0.1 if tan_alpha is None and not sized else tan_alpha  # that of figure 6 of the paper
    shape = Body(tan_alpha=slenderness, diameter=diameter, height=height)
    tan_alpha = shape.cylinder().tan_alpha
    motion = record.motion()
    assert motion is not None  # a case without a release has a motion
    sizes = runs_of(tan_alpha, motion, plan).semidiagonals
    bodies = [rw.Cylinder(semidiagonal=size, tan_alpha=tan_alpha) for size in sizes]
    plan = with_steel(context, plan, steel, bodies, plan.gravity)
    body = under_slab(bodies[0], plan.slab_mass_ratio or None, None)
    slender = rw.Case(body, motion, gravity=plan.gravity, tendon=plan.tendon)
    alpha = math.degrees(slender.cylinder.alpha)
    # the ground: the threshold of uplift is that of all sizes
    lines = [f"Cylinders: tan alpha = {tan_alpha:g} (alpha = {alpha:.4g} deg)", *case_lines(slender)[1:]]
    run = partial(rw.spectrum, tan_alpha, motion, workers=workers, **dataclasses.asdict(plan))
    return Work(run, lines, what="parts", resumes=True)


_COPIES = {"copies", "perturbation"}
_MOTIONS = {"p695", "records", "synthetic", "peak"}

Peak = Annotated[
    float | None,
    typer.Option(
        help="Peak horizontal resultant to which each motion is scaled, in g tan alpha. Default: 3.",
        rich_help_panel="Many ground motions",
    ),
]


@saves_results
def ensemble(
    context: typer.Context,
    problem: Problem,
    copies: Copies,
    motions: ManyMotions,
    suite: options.SuiteName = None,
    peak: Peak = None,
    engine: options.Engines = None,
    support: options.Supports = None,
    time_step: options.TimeStep = None,
) -> Work:
    """Distributions of peak tilt by several methods, and their contrasts.

    Without options: 20 perturbed copies of El Centro 1940 on R = 6 m, tan alpha = 0.2. With --synthetic,
    --p695 or --records the members are ground motions; with a SUITE, its cases with its runs, among which
    --engine and --support select. With --engine none: the reduced models only.

    An interrupted run resumes with the same command.

    Writes ensemble.html, and members, methods and contrasts (Parquet, CSV).

    Example: rockwobble ensemble --synthetic 40 --peak 3 --engine mujoco
    """
    refuse_options_of_engines(context, engine)
    stated: rw.Case | rw.Suite | list[rw.Case]
    given: rw.Suite | None = None
    if suite is not None:
        ignored = _COPIES | _MOTIONS
        refuse(context, ignored, f"does not go with a suite, got {suite}: its cases are the members")
        refuse_problem_options(context, suite)
        stated = given = rw.read_suite(suite)
        source, members = written("motions.suite", {"name": str(suite)}, {}), list(given.cases)
        lines = [f"Suite {suite}: {len(members)} members"]
    else:
        stated, source = _members(context, problem, copies, motions, peak)
        # notes on one case apply to its copies; with different motions only the first line does
        members = [] if isinstance(stated, rw.Case) else stated
        lines = case_lines(stated) if isinstance(stated, rw.Case) else case_lines(members[0])[:1]
        lines += [f"Members: {len(members) or copies.copies}, {source}"]
    runs = _runs(engine, support, time_step, given, [stated] if isinstance(stated, rw.Case) else members)
    lines += [*record_lines(each.motion for each in members), *case_warnings(members)]
    run = partial(rw.ensemble, stated, runs=runs, source=source, **dataclasses.asdict(copies))
    return Work(run, lines, resumes=True)


def _members(
    context: typer.Context, problem: Problem, copies: Copies, motions: ManyMotions, peak: float | None
) -> tuple[rw.Case | list[rw.Case], str]:
    """The case whose copies are the members, or the member cases, with a description."""
    if not motions.option:
        refuse(context, {"peak"}, "scales many motions, give --synthetic, --p695 or --records as well")
        return problem.case(), written("motions.copies", {"share": copies.perturbation}, {"share": "share"})
    ignored = {"record", "record_x", "record_y", "record_z", "scale", *_COPIES}
    refuse(context, ignored, f"does not go with {motions.option}: its motions are the members")
    case = unread(problem).case()
    level = 3.0 if peak is None else peak
    ensemble, source = motions.read(copies.seed)
    target = level * case.gravity * case.cylinder.tan_alpha
    if not target > 0.0:
        raise ValueError(f"--peak must be positive [g tan alpha], got {level:g}")
    # named by the motion only, as all else is equal
    scaled = [motion.scaled(target / motion.peak) for motion in ensemble]
    members = [dataclasses.replace(case, name=motion.name, motion=motion) for motion in scaled]
    return members, f"{source}, with peaks of {level:g} g tan alpha"


def _runs(
    engines: list[str] | None,
    supports: list[str] | None,
    time_step: TimeStep,
    suite: rw.Suite | None,
    cases: list[rw.Case],
) -> list[rw.Run]:
    """Runs from the options for some cases, selected from those of a suite."""
    if engines == [options.NO_ENGINE]:
        return []
    if suite is not None:
        return without_missing(chosen_runs(suite, engines, supports, time_step), engines)
    if not engines:
        report_skipped_engines(supports or ())
    chosen = rc.default_runs(engines or None, supports or None, cases=cases)
    return [rw.Run(run.engine, run.support, time_step) for run in chosen]


SuiteFile = Annotated[
    str | None,
    typer.Argument(metavar="[SUITE]", help=f"Suite instead of a grid: {options.SUITES}.", show_default=False),
]
Models = Annotated[
    list[str] | None,
    options.method(
        "Reduced model: recess, flat or planar; may be repeated. Default: recess; with a suite, the "
        "runs of the suite."
    ),
]
ChunkSize = Annotated[
    int | None, options.work("Number of runs in a chunk. Default: about one second of work.", min=1)
]


@saves_results
def sweep(
    context: typer.Context,
    grid: GridOptions,
    steel: Steel,
    suite: SuiteFile = None,
    model: Models = None,
    workers: options.Workers = None,
    scheduler: options.Scheduler = None,
    chunk: ChunkSize = None,
) -> Work:
    """Peak tilt over a grid of sizes, slendernesses and scales.

    A grid combines every size, slenderness, scale, record and model, from rest, without sliding. A suite
    combines its cases and runs.

    An interrupted run resumes with the same command.

    Writes sweep.parquet (one row per run), and sweep.html.

    Example: rockwobble sweep --semidiagonal 0.5:30:100 --scale 1,2,4 --out grid
    """
    plan: rw.Grid | rw.Suite
    if suite is None:
        made = grid.grid(model)
        bodies = [
            rw.Cylinder(semidiagonal=size, tan_alpha=tan_alpha)
            for size in made.semidiagonals
            for tan_alpha in made.tan_alphas
        ]
        plan = with_steel(context, made, steel, bodies, made.gravity)
    else:
        stated = {each.name for each in (*fields(GridOptions), *fields(Steel))}
        refuse(context, stated, f"does not go with a suite, got {suite}: the file states the problems")
        plan = _suite(suite, model)

    def run(resume: Path, progress: ProgressCallback) -> Sweep:
        return rw.sweep(
            plan, out=resume, scheduler=scheduler, workers=workers, chunk_size=chunk, progress=progress
        )

    return Work(run, _echo(plan), what="chunks", resumes=True)


def _suite(name: str, models: list[str] | None) -> rw.Suite:
    from rockwobble.models.number_checks import require_one_of
    from rockwobble.models.support import RECESS
    from rockwobble.studies.sweep import runnable_suite

    for model in models or ():
        require_one_of("--model", model, rw.reduced.MODELS)
    suite = rw.read_suite(name)
    chosen = [rw.Run(None, **{"support": RECESS, **rw.reduced.MODELS[model]}) for model in models or ()]
    added = suite.runs
    if not added and not models:
        report_skipped_engines()
        added = rc.default_runs(cases=suite.cases)
    runs = (*chosen, *added)
    return runnable_suite(rw.Suite(suite.cases, runs))


def _echo(plan: rw.Grid | rw.Suite) -> list[str]:
    from rockwobble.models.doubts import doubts_of_cases

    from ..pages.diagnostics import warnings

    if isinstance(plan, rw.Grid):
        doubts = plan.doubts()
        ends: list[RockingBody] = [*plan.corners()]
        runs = plan.rows
        axes = {"length": plan.semidiagonals, "ratio": plan.tan_alphas, "factor": plan.scales}
        counts = {f"count_{name}": len(axis) for name, axis in axes.items()}
        values: dict[str, Value] = {**counts, "count_motions": len(plan.motions), "names": tuple(plan.models)}
        what = written("motions.of_grid", values, dict.fromkeys(values, "count"))
    else:
        doubts = doubts_of_cases(plan.cases)
        ends = [case.cylinder for case in plan.cases]
        runs = len(plan.cases) * len(plan.runs)
        each = {"count": len(plan.cases), "count_of_each": len(plan.runs)}
        what = written("motions.of_suite", each, dict.fromkeys(each, "count"))
    return [
        "Cylinders: "
        + ", ".join(
            (
                f"b = {span([c.base_radius for c in ends], '.4g')} m",
                f"2h = {span([2.0 * c.half_height for c in ends], '.4g')} m",
                f"alpha = {span([math.degrees(c.alpha) for c in ends], '.4g')} deg",
            )
        ),
        f"Runs: {runs:,} ({what})",
        *record_lines(plan.motions if isinstance(plan, rw.Grid) else [case.motion for case in plan.cases]),
        *warnings(doubts),
    ]
