"""`rockwobble sweep`: grids of reduced runs, or cases and runs of a suite, kept chunk by chunk."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ..console.terminal import FAILED, INTERRUPTED, complain, user_input
from .inputs import options
from .results.show import show

if TYPE_CHECKING:
    from rockwobble.compare import CaseSweep, Grid
    from rockwobble.models import GroundMotion

_GRID, _WORK = "Grid: each a number, a list 1,2,6 or a range FROM:TO:COUNT", "Work"
_MOST_VALUES = 100_000

SuiteFile = Annotated[
    str | None,
    typer.Argument(
        metavar="[SUITE]",
        help="A suite instead of a grid: a TOML file, or the name of a shipped one.",
        show_default=False,
    ),
]
Sizes = Annotated[str, typer.Option("--semidiagonal", help="R, in m.", rich_help_panel=_GRID)]
Slendernesses = Annotated[str, typer.Option("--tan-alpha", help="Slenderness b/h.", rich_help_panel=_GRID)]
Scales = Annotated[str, typer.Option("--scale", help="Factors on the records.", rich_help_panel=_GRID)]
Models = Annotated[
    list[str] | None,
    typer.Option(
        "--model",
        help="recess, flat or planar; may be repeated. Default: recess; with a suite, none but its runs.",
        rich_help_panel=_GRID,
    ),
]
RecordsX = Annotated[
    list[Path] | None,
    typer.Option(
        "--record-x",
        help="East-west component; may be repeated for several records. Default: El Centro 1940.",
        rich_help_panel=_GRID,
    ),
]
RecordsY = Annotated[
    list[Path] | None,
    typer.Option("--record-y", help="North-south component of each.", rich_help_panel=_GRID),
]
RecordsZ = Annotated[
    list[Path] | None,
    typer.Option("--record-z", help="Vertical component of each, or of none.", rich_help_panel=_GRID),
]
Workers = Annotated[
    int | None,
    typer.Option(
        "--workers", min=1, help="Processes on this machine. Default: one a core.", rich_help_panel=_WORK
    ),
]
Scheduler = Annotated[
    str | None,
    typer.Option(
        "--scheduler",
        help="Dask scheduler that has the work done, such as tcp://10.0.0.1:8786.",
        rich_help_panel=_WORK,
    ),
]
ChunkSize = Annotated[
    int | None,
    typer.Option(
        "--chunk", min=1, help="Runs in a chunk. Default: about a second of work.", rich_help_panel=_WORK
    ),
]


def sweep(
    suite: SuiteFile = None,
    semidiagonal: Sizes = "0.5:30:100",
    tan_alpha: Slendernesses = "0.2",
    scale: Scales = "0.5:6:100",
    record_x: RecordsX = None,
    record_y: RecordsY = None,
    record_z: RecordsZ = None,
    units: options.Units = None,
    model: Models = None,
    workers: Workers = None,
    scheduler: Scheduler = None,
    chunk: ChunkSize = None,
    out: options.Out = Path("rockwobble-sweep"),
) -> None:
    """Run every combination, and keep each chunk of runs as soon as it is finished.

    A grid takes every size with every slenderness, scale, record and model, from rest, for its
    peak tilt. A suite takes every case with every run.

    Whatever ends the sweep, the same command goes on where it stopped.

    Writes sweep.parquet, one row for each run; rockwobble show prints what it holds.
    """
    with user_input():
        from rockwobble.compare import require_writable

        if suite is None:
            plan: Grid | CaseSweep = _grid(
                semidiagonal, tan_alpha, scale, _motions(record_x, record_y, record_z, units), model
            )
        else:
            if record_x or record_y or record_z or units:
                raise ValueError(f"the records of a suite stand in its file, got options besides {suite}")
            plan = _suite(suite, model)
        require_writable(out)
    for line in _echo(plan):
        print(line)
    _run(plan, out, scheduler, workers, chunk)
    print()
    show(out)


def _run(
    plan: Grid | CaseSweep, out: Path, scheduler: str | None, workers: int | None, chunk: int | None
) -> None:
    from rockwobble.compare import SweepIncompleteError
    from rockwobble.compare import sweep as run

    from ..console.progress import shown_progress
    from ..pages.provenance import command_line

    try:
        with user_input(), shown_progress("chunks") as tell:
            run(
                plan,
                out=out,
                scheduler=scheduler,
                workers=workers,
                chunk_size=chunk,
                progress=tell,
                command=command_line(),
            )
    except SweepIncompleteError as error:
        complain(str(error))
        raise typer.Exit(FAILED) from None
    except KeyboardInterrupt:
        complain(f"interrupted; the finished chunks are kept in {out}, and the same command goes on")
        raise typer.Exit(INTERRUPTED) from None


def _grid(
    sizes: str, slendernesses: str, scales: str, motions: list[GroundMotion], models: list[str] | None
) -> Grid:
    from rockwobble.compare import Grid

    return Grid(
        semidiagonals=values("--semidiagonal", sizes),
        tan_alphas=values("--tan-alpha", slendernesses),
        scales=values("--scale", scales),
        motions=motions,
        models=models or ("recess",),
    )


def _suite(name: str, models: list[str] | None) -> CaseSweep:
    from rockwobble import reduced
    from rockwobble.compare import CaseSweep, default_runs
    from rockwobble.models import Run, read_suite

    for model in models or ():
        if model not in reduced.MODELS:
            raise ValueError(f"--model must be of {', '.join(reduced.MODELS)}, got {model!r}")
    suite = read_suite(name)
    chosen = [Run(None, **{"support": "recess", **reduced.MODELS[model]}) for model in models or ()]
    return CaseSweep(suite.cases, (*chosen, *(suite.runs or (() if models else default_runs()))))


def values(option: str, text: str) -> list[float]:
    """Return the numbers of "6", "1,2,6" or "0.5:30:100".

    Raises
    ------
    ValueError
        If the text is none of these.
    """
    try:
        if ":" not in text:
            return [float(part) for part in text.split(",")]
        first, last, count = text.split(":")
        number = int(count)
        if not (2 <= number <= _MOST_VALUES and math.isfinite(float(first) - float(last))):
            raise ValueError  # noqa: TRY301 - the same answer as for what is no number
        import numpy as np

        return [float(value) for value in np.linspace(float(first), float(last), number)]
    except ValueError:
        raise ValueError(
            f"{option} must be a number, a list such as 1,2,6 or a range FROM:TO:COUNT, got {text!r}"
        ) from None


def _motions(
    x: list[Path] | None, y: list[Path] | None, z: list[Path] | None, units: str | None
) -> list[GroundMotion]:
    from rockwobble.models import el_centro_1940, read_record

    x, y, z = x or [], y or [], z or []
    if not x and not y:
        if z or units:
            raise ValueError(
                "--record-z and --units belong to a record, give --record-x and --record-y as well"
            )
        return [el_centro_1940()]
    if len(x) != len(y) or len(z) not in (0, len(x)):
        raise ValueError(
            f"each record needs both horizontal components, and all a vertical one or none: "
            f"got {len(x)}, {len(y)} and {len(z)} files"
        )
    ups: list[Path | None] = list(z) if z else [None] * len(x)
    return [read_record(east, north, up, units=units) for east, north, up in zip(x, y, ups, strict=True)]


def _echo(plan: Grid | CaseSweep) -> list[str]:
    from rockwobble.compare import Grid
    from rockwobble.models import Cylinder

    if isinstance(plan, Grid):
        ends = [
            Cylinder(semidiagonal=size, tan_alpha=tan_alpha)
            for size in (min(plan.semidiagonals), max(plan.semidiagonals))
            for tan_alpha in (min(plan.tan_alphas), max(plan.tan_alphas))
        ]
        what = (
            f"{len(plan.semidiagonals)} sizes, {len(plan.tan_alphas)} slendernesses, "
            f"{len(plan.scales)} scales, {len(plan.motions)} records, models {', '.join(plan.models)}"
        )
    else:
        ends = [case.cylinder for case in plan.cases]
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
        f"Runs: {plan.rows:,} ({what})",
    ]


def _span(numbers: list[float]) -> str:
    low, high = min(numbers), max(numbers)
    return f"{low:.4g}" if low == high else f"{low:.4g} to {high:.4g}"
