"""`rockwobble view`: one case in three dimensions."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import typer

import rockwobble as rw
import rockwobble.compare.runs as rr
import rockwobble.compare.storage as rs

from ...console.progress import shown_progress
from ...console.results import show_and_save
from ...console.terminal import complain, interruptible, user_input
from ...pages.words.cases import describe
from ..inputs import options
from ..inputs.estimate import require_feasible, time_needed
from ..inputs.method_values import settings
from ..inputs.plan_options import takes_options
from ..inputs.problem import Problem, given_options, refuse

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
Engine = Annotated[str | None, options.method(f"{options.ENGINES}. Default: the first of them.")]
Open = Annotated[
    bool | None,
    typer.Option("--open/--no-open", help="Show it in the browser. Default: where there is a terminal."),
]


@takes_options
def view(
    context: typer.Context,
    problem: Problem,
    folder: Stored = None,
    case_name: CaseName = None,
    engine: Engine = None,
    support: options.Support = "recess",
    time_step: options.TimeStep = None,
    setting: options.Settings = None,
    out: options.Out = Path("rockwobble-view"),
    opened: Open = None,
) -> None:
    """Play one case in three dimensions: the engine's cylinder, and the reduced model translucent over it.

    Without options: MuJoCo recess under the 1940 El Centro record, R = 6 m, tan alpha = 0.2.

    Writes view.html, which needs nothing else and works offline, and the comparison that it plays.
    """
    with interruptible():
        with user_input():
            if folder is not None:
                others = set(given_options(context)) - {"folder", "case_name", "out", "opened"}
                refuse(context, others, "states a run and does not go with a stored one")
                comparison = rw.Comparison.load(folder)
                name = _chosen_case(comparison, case_name)
            elif case_name is not None:
                raise ValueError("--case chooses from a folder, give the folder of a comparison as well")
            else:
                case = problem.case()
                asked = rw.Run(engine or rw.multibody.DEFAULT_ENGINE, support, time_step)
                (run,) = rr.with_settings(case, [asked], settings(setting))
                require_feasible([case], [run])
                rr.require_runnable(case, run)
                name = case.name
            rs.require_writable(out)
        if folder is None:
            for line in (*describe(case), *time_needed([case], [run])):
                print(line)
            with user_input(), shown_progress() as tell:
                comparison = rw.compare(case, runs=[run], progress=tell)
        show_and_save(comparison.of_case(name), out)
    if sys.stdout.isatty() if opened is None else opened:
        import webbrowser

        webbrowser.open((out / "view.html").resolve().as_uri())


def _chosen_case(comparison: rw.Comparison, name: str | None) -> str:
    names = list(comparison.cases)
    if name is None and len(names) > 1:
        complain(f"{len(names)} cases, the first is shown; --case chooses: {'; '.join(names[:6])} ...")
    if name is not None and name not in names:
        raise ValueError(f"--case must be one of {'; '.join(names)}, got {name!r}")
    return names[0] if name is None else name
