"""`rockwobble simulate`: one run of a reduced model or of an engine."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ..console.terminal import FAILED, complain, interruptible, user_input
from .inputs import options
from .inputs.method_values import settings

if TYPE_CHECKING:
    from rockwobble.compare import Job
    from rockwobble.models import Case

Model = Annotated[
    str, typer.Option("--model", help="Reduced model: recess, flat or planar.", rich_help_panel="Method")
]
Engine = Annotated[
    str | None,
    typer.Option(
        "--engine", help="mujoco, pybullet or exudyn instead of a reduced model.", rich_help_panel="Method"
    ),
]
Support = Annotated[
    str,
    typer.Option(
        "--support",
        help="Of the engine: recess (ideal recess), flat (flat ground) or ring (walls, MuJoCo only).",
        rich_help_panel="Method",
    ),
]


def simulate(
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
    model: Model = "recess",
    engine: Engine = None,
    support: Support = "recess",
    time_step: options.TimeStep = None,
    setting: options.Settings = None,
    out: options.Out = Path("rockwobble-out"),
) -> None:
    """Run one reduced model, or one engine, on one problem.

    Without options: the recess model under the 1940 El Centro record, R = 6 m, tan alpha = 0.2.

    Writes run.csv and run.parquet with the samples, passes.csv with the passes, and
    run.json with the rest; SI units and radians.
    """
    from ..pages.case_words import describe
    from .inputs.problem import case_from_options

    with interruptible():
        with user_input():
            from rockwobble.compare import (
                Job,
                replace_files,
                require_runnable,
                require_writable,
                with_settings,
            )
            from rockwobble.models import Run

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
            require_writable(out)
            if engine is None and (time_step is not None or setting):
                given = "--time-step" if time_step is not None else "--set"
                raise ValueError(f"{given} belongs to an engine, give --engine as well")
            job = Job(case=case, method=model, label=model)
            if engine is not None:
                (run,) = with_settings(case, [Run(engine, support, time_step)], settings(setting))
                require_runnable(case, run)
                job = Job(case=case, method=run, label=f"{engine} {support}")
        for line in describe(case):
            print(line)
        trace = _run(job)
        _print_result(case, trace, job.label)
        contents = _contents(job, trace)
        with user_input():
            replace_files(out, contents)
    print(f"\nWritten to {out}: {', '.join(contents)}")


def _run(job: Job) -> Any:
    from rockwobble.compare import Crash, simulate_all

    from ..console.progress import shown_progress

    with user_input(), shown_progress() as tell:
        # in a process of its own, so that Ctrl-C also stops an engine in the middle of a long call
        result = simulate_all([job], workers=2, progress=tell)[0]
    if isinstance(result, Crash):
        complain(f"{job.label} left no result: {result.message}")
        raise typer.Exit(FAILED)
    return result


def _print_result(case: Case, trace: Any, label: str) -> None:
    from rich import box
    from rich.console import Console
    from rich.table import Table

    table = Table(box=box.SIMPLE_HEAD, show_header=False, padding=(0, 2, 0, 0), pad_edge=False)
    for name, value in _facts(case, trace).items():
        table.add_row(name, value)
    console = Console()
    console.print(f"\n[bold]{label}[/]: {trace.outcome}. {trace.message}", highlight=False)
    console.print(table)


def _facts(case: Case, trace: Any) -> dict[str, str]:
    alpha, b = case.cylinder.alpha, case.cylinder.base_radius
    facts = {
        "peak tilt": f"{trace.peak_tilt / alpha:.4f} alpha = {math.degrees(trace.peak_tilt):.4f} deg"
        if math.isfinite(trace.peak_tilt)
        else "unknown: the run failed",
        "uplift": f"{trace.uplift_time:.4f} s towards {math.degrees(trace.uplift_direction):.2f} deg"
        if math.isfinite(trace.uplift_time)
        else "none",
        "passes": str(len(trace.passes)),
    }
    if len(trace.passes):
        facts["closest pass"] = f"{trace.passes['minimum_tilt'].min() / alpha:.3g} alpha"
    if hasattr(trace, "assumptions"):
        facts["friction needed"] = _largest_friction(trace)
    else:
        facts["residual displacement"] = f"{trace.residual_displacement / b:.3g} b"
        facts["residual twist"] = f"{math.degrees(trace.residual_twist):.3g} deg"
        if math.isfinite(trace.first_wall_contact):
            facts["wall contact"] = (
                f"{trace.wall_contact[-1]:.3g} s in all, first at {trace.first_wall_contact:.4g} s"
            )
        facts["time step"] = f"{trace.time_step:g} s"
    facts["computing time"] = f"{trace.wall_time:.3g} s"
    return facts


def _largest_friction(trace: Any) -> str:
    largest = float(trace.friction_needed[trace.tilt > 0.0].max(initial=0.0))
    return f"{largest:.3f}" if math.isfinite(largest) else "contact lost"


def _contents(job: Job, trace: Any) -> dict[str, bytes]:
    from rockwobble.compare import describe_case, describe_run
    from rockwobble.compare.runs.execution import job_fingerprint
    from rockwobble.compare.storage.parquet_file import pack
    from rockwobble.compare.storage.provenance import about_results

    from ..pages.provenance import command_line

    case, samples = job.case, trace.to_frame()
    made = about_results("rockwobble run", job_fingerprint(job)) | {"command": command_line()}
    about = made | {"run": job.label, "case": describe_case(case), "result": describe_run(trace)}
    return {
        "run.csv": samples.to_csv(index=False).encode(),
        "run.parquet": pack(samples, about),
        "passes.csv": trace.passes.to_csv(index=False).encode(),
        "run.json": (json.dumps(about, indent=2, allow_nan=False) + "\n").encode(),
    }
