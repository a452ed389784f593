"""`rockwobble simulate`: one run of a reduced model or of an engine."""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path
from typing import Annotated, Any

import typer

import rockwobble as rw
import rockwobble.compare.runs as rr
import rockwobble.compare.storage as rs

from ..console.progress import shown_progress
from ..console.results import show_and_save
from ..console.terminal import FAILED, complain, interruptible, user_input
from .inputs import options
from .inputs.estimate import require_feasible, time_needed
from .inputs.method_values import settings
from .inputs.plan_options import takes_options
from .inputs.problem import Problem, restated

RestTilt = Annotated[
    float | None,
    options.reduced("Rest threshold: tilt over alpha below which the base is closed; 0 leaves the rule out."),
]


@takes_options
def simulate(
    context: typer.Context,
    problem: Problem,
    engine: options.Engine = None,
    support: options.Support = "recess",
    time_step: options.TimeStep = None,
    setting: options.Settings = None,
    plane: options.Plane = None,
    restitution: options.Restitution = None,
    rest_tilt: RestTilt = None,
    out: options.Out = Path("rockwobble-simulate"),
) -> None:
    """Run the reduced model, or one engine, on one problem.

    Without options: the recess model under the 1940 El Centro record, R = 6 m, tan alpha = 0.2.

    Writes the samples to run.csv, the passes to passes.csv, all to run.parquet, which Trace.load reads,
    manifest.json, which says units and meaning of each column, and run.html, run.md and trace.svg; SI units
    and radians.
    """
    with interruptible():
        from rockwobble.compare.studies.single_run import single_run

        from ..pages.words.diagnostics import remarks

        with user_input():
            case = problem.case()
            if plane is not None and case.initial is not None:  # it leans in the plane that holds it
                case = replace(case, initial=replace(case.initial, rolling_angle=plane))
            rs.require_writable(out)
            model = {"plane": plane, "restitution": restitution, "rest_tilt": rest_tilt}
            run = _with_settings(case, rw.Run(engine, support, time_step), setting, model)
            require_feasible([case], [run])
            rr.require_runnable(case, run)
        for line in time_needed([case], [run]):
            print(line, file=sys.stderr)
        with user_input(), shown_progress() as tell:
            found = single_run(
                case, run, answer=restated(context, "advise", also=("support",)), progress=tell
            )
        if not len(found.trace.time):
            complain(f"{run} left no result: {remarks(found.trace.facts)}")
            raise typer.Exit(FAILED)
        show_and_save(found, out)
    if found.trace.outcome == "failed":
        raise typer.Exit(FAILED)


def _with_settings(case: rw.Case, run: rw.Run, setting: list[str] | None, model: dict[str, Any]) -> rw.Run:
    """Return the run with the options that belong to its method; others are refused, not ignored."""
    model = {name: value for name, value in model.items() if value is not None}
    if run.engine is None and run.time_step is not None:
        raise ValueError("--time-step belongs to an engine, give --engine as well")
    if run.engine is not None and model:
        option = "--" + next(iter(model)).replace("_", "-")
        raise ValueError(f"{option} belongs to the reduced models, got --engine {run.engine}")
    if twice := model.keys() & settings(setting).keys():
        raise ValueError(f"{min(twice)} is given twice, by an option and by --set")
    (whole,) = rr.with_settings(case, [run], settings(setting) | model)
    return whole
