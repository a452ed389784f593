"""`rockwobble simulate`: one run of a reduced model or of an engine."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

import rockwobble as rw
import rockwobble.compare as rc

from ..console.progress import shown_progress
from ..console.results import show_and_write
from ..console.terminal import FAILED, command_line, complain, interruptible, user_input
from ..pages.words.cases import describe
from .inputs import options
from .inputs.estimate import require_feasible, time_needed
from .inputs.method_values import settings
from .inputs.plan_options import takes_options
from .inputs.problem import Problem, restated

if TYPE_CHECKING:
    from rockwobble.compare.storage.manifest import Manifest

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
        with user_input():
            case = problem.case()
            if plane is not None and case.initial is not None:  # it leans in the plane that holds it
                case = replace(case, initial=replace(case.initial, rolling_angle=plane))
            rc.require_writable(out)
            model = {"plane": plane, "restitution": restitution, "rest_tilt": rest_tilt}
            run = _with_settings(case, rw.Run(engine, support, time_step), setting, model)
            require_feasible([case], [run])
            rc.require_runnable(case, run)
        for line in (*describe(case), *time_needed([case], [run])):
            print(line)
        job = rc.Job(case=case, run=run)
        trace, until = _run(job)
        from ..pages.runs.run import run_page

        answer = restated(context, "advise", also=("support",))
        made, files = _results(job, trace, {"until": until, "answer": answer})
        show_and_write(out, run_page(trace, made), made, {}, files)
    if trace.outcome == "failed":
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
    (whole,) = rc.with_settings(case, [run], settings(setting) | model)
    return whole


def _run(job: rc.Job) -> tuple[rw.Trace, float]:
    """Return the trace, and until when it is reproducible [s], by copies of its reduced model."""
    from rockwobble.compare.comparison.prediction import nudged, reproducible_until

    from ..pages.words.diagnostics import remarks

    model = job.run if job.run.engine is None else rc.own_model(job.run)
    cases = [*([job.case] if model != job.run else []), *nudged(job.case)]
    beside = [rc.Job(case=case, run=model, label=f"copy of the {model}") for case in cases]
    with user_input(), shown_progress() as tell:
        # in a process of its own, so that Ctrl-C also stops an engine in the middle of a long call
        trace, *others = rc.simulate_all([job, *beside], workers=2, progress=tell)
    if not len(trace.time):
        complain(f"{job.label} left no result: {remarks(trace.facts)}")
        raise typer.Exit(FAILED)
    *own, first, second = [*([trace] if model == job.run else []), *others]
    known = all(len(each.time) for each in (*own, first, second))
    return trace, reproducible_until(own[0], (first, second)) if known else math.inf


def _results(job: rc.Job, trace: rw.Trace, single: dict[str, Any]) -> tuple[Manifest, dict[str, bytes]]:
    """Return what made a run, and its files of data."""
    from rockwobble.compare.runs.execution import job_fingerprint
    from rockwobble.compare.storage.manifest import made_now
    from rockwobble.models.traces.trace_file import COLUMNS, PASS_COLUMNS, case_to_plain, packed

    case, found = case_to_plain(job.case), trace.to_plain()
    motion = job.case.motion
    about = {
        "run": job.label,
        "case": case | {"motion": motion and {"name": motion.name, "time_step": motion.time_step}},
        "result": {
            key: value for key, value in found.items() if key not in ("rest_intervals", "extrema", "passes")
        },
        "single_trace": single,
        "columns": {"run.csv": COLUMNS, "passes.csv": PASS_COLUMNS},
    }
    headline: dict[str, float | int | str | None] = {
        "outcome": trace.outcome,
        "peak tilt [alpha]": trace.peak_tilt / trace.case.cylinder.alpha,
        "uplift [s]": trace.uplift_time,
        "passes": len(trace.passes),
    }
    files = {
        "run.parquet": packed(trace.to_frame(), trace.to_plain(), trace.case),
        "run.csv": trace.to_frame().to_csv(index=False).encode(),
        "passes.csv": trace.passes.to_csv(index=False).encode(),
    }
    made = made_now(
        "run", inputs=job_fingerprint(job), command=command_line(), headline=headline, about=about
    )
    return made, files
