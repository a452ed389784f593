"""`rockwobble view`: one case in three dimensions."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ..console.terminal import complain, interruptible, user_input
from ..pages.provenance import command_line
from .inputs import options
from .inputs.method_values import settings

if TYPE_CHECKING:
    from rockwobble.compare import Comparison

Stored = Annotated[
    Path | None,
    typer.Argument(
        help="Folder of a comparison, to play what is stored there. Without it the case is run.",
        show_default=False,
    ),
]
CaseName = Annotated[
    str | None, typer.Option("--case", help="Which case of the folder, where it has several.")
]
Engine = Annotated[
    str, typer.Option("--engine", help="mujoco, pybullet or exudyn.", rich_help_panel="Method")
]
Support = Annotated[
    str,
    typer.Option(
        "--support",
        help="recess (ideal recess), flat (flat ground) or ring (real recess).",
        rich_help_panel="Method",
    ),
]
Open = Annotated[
    bool | None,
    typer.Option("--open/--no-open", help="Show it in the browser. Default: where there is a terminal."),
]


def view(
    context: typer.Context,
    folder: Stored = None,
    case_name: CaseName = None,
    semidiagonal: options.Semidiagonal = 6.0,
    tan_alpha: options.TanAlpha = 0.2,
    record_x: options.RecordX = None,
    record_y: options.RecordY = None,
    record_z: options.RecordZ = None,
    units: options.Units = None,
    scale: options.Scale = 1.0,
    release_tilt_deg: options.ReleaseTilt = None,
    rolling_rate: options.RollingRate = 0.0,
    duration: options.Duration = None,
    engine: Engine = "mujoco",
    support: Support = "recess",
    time_step: options.TimeStep = None,
    setting: options.Settings = None,
    out: options.Out = Path("rockwobble-out"),
    opened: Open = None,
) -> None:
    """Play one case in three dimensions: the engine's cylinder, and the reduced model translucent over it.

    Without options: MuJoCo recess under the 1940 El Centro record, R = 6 m, tan alpha = 0.2.

    Writes view.html, which needs nothing else and works offline.
    """
    from ..pages.case_words import describe
    from .inputs.problem import case_from_options

    with interruptible():
        with user_input():
            from rockwobble.compare import (
                Comparison,
                replace_files,
                require_runnable,
                require_writable,
                with_settings,
            )
            from rockwobble.models import Run

            if folder is not None:
                _refuse_other_options(context)
                comparison = Comparison.load(folder)
                name = _chosen_case(comparison, case_name)
            elif case_name is not None:
                raise ValueError("--case chooses from a folder, give the folder of a comparison as well")
            else:
                case = case_from_options(
                    semidiagonal=semidiagonal,
                    tan_alpha=tan_alpha,
                    record_x=record_x,
                    record_y=record_y,
                    record_z=record_z,
                    units=units,
                    scale=scale,
                    release_tilt_deg=release_tilt_deg,
                    rolling_rate=rolling_rate,
                    duration=duration,
                )
                (run,) = with_settings(case, [Run(engine, support, time_step)], settings(setting))
                require_runnable(case, run)
                name = case.name
            require_writable(out)
        if folder is None:
            from ..console.progress import shown_progress
            from .compare import run_comparison

            for line in describe(case):
                print(line)
            with user_input(), shown_progress() as tell:
                comparison = run_comparison([case], runs=[run], progress=tell)
        page = view_page(comparison, name)
        with user_input():
            if page is None:
                raise ValueError(f"there is nothing to play in {name!r}: the cylinder never uplifts")
            replace_files(out, {"view.html": page.encode()})
    print(f"\nWritten to {out}: view.html")
    if sys.stdout.isatty() if opened is None else opened:
        import webbrowser

        webbrowser.open((out / "view.html").resolve().as_uri())


def view_page(comparison: Comparison, name: str) -> str | None:
    """Return the page of one case of a comparison, None where nothing moves."""
    from ..figures.case_view import case_views
    from ..figures.playback import playback
    from ..pages.case_words import describe
    from ..pages.comparison.findings import finding
    from ..pages.comparison.run_remarks import remark_lines
    from ..pages.template import render

    chosen = next(each for each in case_views(comparison) if each.case.name == name)
    spec = playback(chosen)
    if spec is None:
        return None
    return render(
        "view.html.j2",
        name=name,
        spec=spec,
        lines=describe(chosen.case),
        findings=[
            *(finding(row, chosen.case.length) for _, row in chosen.rows.iterrows()),
            *remark_lines(chosen.rows),
        ],
        command=command_line(),
        versions=comparison.versions,
    )


def _chosen_case(comparison: Comparison, name: str | None) -> str:
    names = list(comparison.cases)
    if name is None and len(names) > 1:
        complain(f"{len(names)} cases, the first is shown; --case chooses: {'; '.join(names[:6])} ...")
    if name is not None and name not in names:
        raise ValueError(f"--case must be one of {'; '.join(names)}, got {name!r}")
    return names[0] if name is None else name


def _refuse_other_options(context: typer.Context) -> None:
    allowed = ("folder", "case_name", "out", "opened")
    for name in context.params:
        source = context.get_parameter_source(name)
        if name not in allowed and source is not None and source.name == "COMMANDLINE":
            raise ValueError(f"--{name.replace('_', '-')} states a run and does not go with a stored one")
