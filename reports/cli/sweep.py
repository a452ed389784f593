"""`rockwobble sweep`: grids of reduced runs, or cases and runs of a suite, kept chunk by chunk."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import fields
from pathlib import Path
from typing import Annotated

import typer

import rockwobble as rw
import rockwobble.compare as rc
import rockwobble.compare.storage as rs

from ..console.progress import shown_progress
from ..console.results import save_with_page
from ..console.terminal import interruptible, user_input
from .inputs import options
from .inputs.estimate import require_sweep
from .inputs.grid import GridOptions
from .inputs.plan_options import takes_options
from .inputs.problem import refuse

SuiteFile = Annotated[
    str | None,
    typer.Argument(
        metavar="[SUITE]",
        help="A suite instead of a grid: a TOML file, or the name of a shipped one.",
        show_default=False,
    ),
]
Models = Annotated[
    list[str] | None,
    options.method(
        "recess, flat or planar; may be repeated. Default: recess; with a suite, none but its runs."
    ),
]
Scheduler = Annotated[
    str | None,
    options.work(
        "Dask scheduler that has the work done, such as tcp://10.0.0.1:8786: started by dask scheduler, "
        "and on each machine dask worker tcp://10.0.0.1:8786. Needs the extra distributed."
    ),
]
ChunkSize = Annotated[
    int | None,
    options.work("Runs in a chunk. Default: about a second of work.", callback=options.whole(1)),
]


@takes_options
def sweep(
    context: typer.Context,
    grid: GridOptions,
    suite: SuiteFile = None,
    model: Models = None,
    workers: options.Workers = None,
    scheduler: Scheduler = None,
    chunk: ChunkSize = None,
    out: options.Out = Path("rockwobble-sweep"),
) -> None:
    """Run every combination, and keep each chunk of runs as soon as it is finished.

    A grid takes every size with every slenderness, scale, record and model, from rest, for its
    peak tilt; friction is assumed to suffice. A suite takes every case with every run.

    Whatever ends the sweep, the same command resumes.

    Writes sweep.parquet, one row for each run, sweep.html (open it in a browser), sweep.md and sweep.svg.
    """
    with user_input():
        plan: rc.Grid | rw.Suite
        if suite is None:
            plan = grid.grid(model)
        else:
            stated = {each.name for each in fields(GridOptions)}
            refuse(context, stated, f"does not go with a suite, got {suite}: the file states the problems")
            plan = _suite(suite, model)
        how_long = require_sweep(plan)
        rs.require_writable(out)
    for line in (*_echo(plan), how_long):
        print(line)
    shows: list[Callable[[], None]] = []
    with interruptible(out), user_input(), shown_progress("chunks") as progress:
        rw.sweep(
            plan,
            out=out,
            scheduler=scheduler,
            workers=workers,
            chunk_size=chunk,
            progress=progress,
            save=lambda found: shows.append(save_with_page(found, out)),
        )
    for show in shows:
        show()


def _suite(name: str, models: list[str] | None) -> rw.Suite:
    from rockwobble.compare.studies.sweep import runnable_suite

    for model in models or ():
        if model not in rw.reduced.MODELS:
            raise ValueError(f"--model must be of {', '.join(rw.reduced.MODELS)}, got {model!r}")
    suite = rw.read_suite(name)
    chosen = [rw.Run(None, **{"support": "recess", **rw.reduced.MODELS[model]}) for model in models or ()]
    runs = (*chosen, *(suite.runs or (() if models else rc.default_runs())))
    return runnable_suite(rw.Suite(suite.cases, runs))


def _echo(plan: rc.Grid | rw.Suite) -> list[str]:
    from rockwobble.models.records.plausibility import doubts_of

    from ..pages.words.diagnostics import warnings

    motions: Iterable[rw.GroundMotion | None]
    if isinstance(plan, rc.Grid):
        motions = plan.motions
        ends = [
            rw.Cylinder(semidiagonal=size, tan_alpha=tan_alpha)
            for size in (min(plan.semidiagonals), max(plan.semidiagonals))
            for tan_alpha in (min(plan.tan_alphas), max(plan.tan_alphas))
        ]
        runs = plan.rows
        what = (
            f"{len(plan.semidiagonals)} sizes, {len(plan.tan_alphas)} slendernesses, "
            f"{len(plan.scales)} scales, {len(plan.motions)} records, models {', '.join(plan.models)}"
        )
    else:
        motions = [case.motion for case in plan.cases]
        ends = [case.cylinder for case in plan.cases]
        runs = len(plan.cases) * len(plan.runs)
        what = f"{len(plan.cases)} cases, {len(plan.runs)} runs of each"
    return [
        "Cylinders: "
        + ", ".join(
            (
                f"b = {_span([c.base_radius for c in ends])} m",
                f"2h = {_span([2.0 * c.half_height for c in ends])} m",
                f"alpha = {_span([math.degrees(c.alpha) for c in ends])} deg",
            )
        ),
        f"Runs: {runs:,} ({what})",
        *warnings(doubts_of(motions)),
    ]


def _span(numbers: list[float]) -> str:
    low, high = min(numbers), max(numbers)
    return f"{low:.4g}" if low == high else f"{low:.4g} to {high:.4g}"
