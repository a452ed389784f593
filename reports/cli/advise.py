"""`rockwobble advise`: outcome, trust and demands on the support for one cylinder and one record."""

from __future__ import annotations

import dataclasses
from pathlib import Path
from typing import Annotated

import typer

import rockwobble as rw
import rockwobble.compare.runs as rr
import rockwobble.compare.storage as rs
from rockwobble.compare.studies.plans import AdvicePlan

from ..console.progress import shown_progress
from ..console.results import show_and_save
from ..console.terminal import FAILED, complain, interruptible, user_input
from .inputs import options
from .inputs.estimate import require_feasible
from .inputs.plan_options import takes_options
from .inputs.problem import Problem, given_options

Engine = Annotated[
    str | None,
    options.method(
        f"{options.ENGINES}. Its one run verifies the prediction; none leaves it out. "
        "Default: the first of them."
    ),
]
Details = Annotated[bool, typer.Option("--details", help="Print what is folded on the page, too.")]


@takes_options
def advise(
    context: typer.Context,
    problem: Problem,
    plan: AdvicePlan,
    engine: Engine = None,
    time_step: options.TimeStep = None,
    details: Details = False,
    out: options.Out = Path("rockwobble-advise"),
) -> None:
    """Say how one case ends, how far its results can be trusted, and what its support must supply.

    A verdict, a grade with its reason for each check, the largest tilt, the displacement of the top and the
    probability of overturning, over copies of the record and over other records as strong; the design
    demands on ground and recess; and what to do next.

    Without options: the 1940 El Centro record on R = 6 m, tan alpha = 0.2, in a recess.

    Writes advice.html, one page that needs nothing else, the same as advice.md with advice.svg, and
    the runs as Parquet.
    """
    with interruptible():
        with user_input():
            case = problem.case()
            run = _run(case, engine, plan.support, time_step)
            require_feasible([case], [rw.Run(None, "recess"), *([] if run is None else [run])])
            rs.require_writable(out)
        with shown_progress("stages") as progress:
            found = rw.advise(
                case,
                run,
                friction_given="friction" in given_options(context),
                progress=progress,
                **dataclasses.asdict(plan),
            )
        show_and_save(found, out, details=details)
    if found.response["outcome"] == "failed":
        raise typer.Exit(FAILED)


def _run(case: rw.Case, engine: str | None, support: str, time_step: float | None) -> rw.Run | None:
    """Return the run of the engine that verifies; None without one."""
    if engine == options.NO_ENGINE and time_step is not None:
        raise ValueError("--time-step belongs to an engine, got it with --engine none")
    default = rw.multibody.DEFAULT_ENGINE
    missing = engine is None and default not in rw.multibody.available_engines()
    if missing:
        complain(f"{default} is not installed here: the prediction stays unverified")
    if missing or engine == options.NO_ENGINE:
        return None
    run = rw.Run(engine or default, support, time_step)
    rr.require_runnable(case, run)
    return run
