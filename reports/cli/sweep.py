"""`rockwobble sweep`: grids of reduced runs, or cases and runs of a suite, kept chunk by chunk."""

from __future__ import annotations

import math
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

import rockwobble as rw
import rockwobble.compare as rc

from ..console.progress import shown_progress
from ..console.terminal import command_line, interruptible, user_input
from .inputs import options
from .inputs.estimate import require_sweep
from .inputs.grid import grid_of
from .inputs.problem import refuse

if TYPE_CHECKING:
    from rockwobble.compare.storage.manifest import Manifest

    from ..pages.page import Page

_grid = options.panel("Grid: each a number, a list 1,2,6 or a range FROM:TO:COUNT")
# what states a grid: the file of a suite states its own
_STATED = {
    *(
        "semidiagonal",
        "tan_alpha",
        "scale",
        "record_x",
        "record_y",
        "record_z",
        "units",
        "resample",
        "gravity",
    ),
    *("plane", "restitution"),
}

SuiteFile = Annotated[
    str | None,
    typer.Argument(
        metavar="[SUITE]",
        help="A suite instead of a grid: a TOML file, or the name of a shipped one.",
        show_default=False,
    ),
]
Sizes = Annotated[str, _grid("R, in m.")]
Slendernesses = Annotated[str, _grid("Slenderness b/h.")]
Scales = Annotated[str, _grid("Factors on the records.")]
Models = Annotated[
    list[str] | None,
    _grid("recess, flat or planar; may be repeated. Default: recess; with a suite, none but its runs."),
]
RecordsX = Annotated[
    list[Path] | None,
    _grid("East-west component, or zero; may be repeated for several records. Default: El Centro 1940."),
]
RecordsY = Annotated[list[Path] | None, _grid("North-south component of each, or zero.")]
RecordsZ = Annotated[list[Path] | None, _grid("Vertical component of each, or of none.")]
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


def sweep(
    context: typer.Context,
    suite: SuiteFile = None,
    semidiagonal: Sizes = "0.5:30:100",
    tan_alpha: Slendernesses = "0.2",
    scale: Scales = "0.5:6:100",
    record_x: RecordsX = None,
    record_y: RecordsY = None,
    record_z: RecordsZ = None,
    units: options.Units = None,
    resample: options.Resample = False,
    gravity: options.Gravity = 9.81,
    model: Models = None,
    plane: options.Plane = None,
    restitution: options.Restitution = None,
    workers: options.Workers = None,
    scheduler: Scheduler = None,
    chunk: ChunkSize = None,
    out: options.Out = Path("rockwobble-sweep"),
) -> None:
    """Run every combination, and keep each chunk of runs as soon as it is finished.

    A grid takes every size with every slenderness, scale, record and model, from rest, for its
    peak tilt; friction is assumed to suffice. A suite takes every case with every run.

    Whatever ends the sweep, the same command goes on where it stopped.

    Writes sweep.parquet, one row for each run, sweep.html (open it in a browser), sweep.md and sweep.svg.
    """
    with user_input():
        plan: rc.Grid | rw.Suite
        if suite is None:
            plan = grid_of(
                semidiagonal,
                tan_alpha,
                scale,
                (record_x, record_y, record_z, units, resample),
                model,
                gravity=gravity,
                plane=plane,
                restitution=restitution,
            )
        else:
            refuse(context, _STATED, f"does not go with a suite, got {suite}: the file states the problems")
            plan = _suite(suite, model)
        how_long = require_sweep(plan)
        rc.require_writable(out)
    for line in (*_echo(plan), how_long):
        print(line)
    from ..pages.runs.sweep import sweep_page

    drawn: list[Page] = []

    def pages(found: rc.Sweep, made: Manifest) -> dict[str, bytes]:
        drawn.append(sweep_page(found, made))
        return drawn[0].files()

    with interruptible(out), user_input(), shown_progress("chunks") as tell:
        rw.sweep(
            plan,
            out=out,
            scheduler=scheduler,
            workers=workers,
            chunk_size=chunk,
            progress=tell,
            command=command_line(),
            pages=pages,
        )
    drawn[0].show()
    print(f"\nWritten to {out}: the tables, their manifest and the pages")


def _suite(name: str, models: list[str] | None) -> rw.Suite:
    from rockwobble.compare.studies.sweep.cases import runnable_suite

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
