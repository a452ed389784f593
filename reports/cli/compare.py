"""`rockwobble compare`: reduced model and engines on one problem."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import typer

import rockwobble as rw
import rockwobble.compare as rc
import rockwobble.compare.runs as rr
import rockwobble.compare.storage as rs

from ..console.progress import shown_progress
from ..console.results import show_and_save
from ..console.terminal import FAILED, complain, interruptible, user_input
from ..pages.words.cases import describe
from .inputs import options
from .inputs.estimate import require_feasible, time_needed
from .inputs.method_values import settings
from .inputs.plan_options import takes_options
from .inputs.problem import Problem, refuse_options_of_engines
from .inputs.suite_choice import chosen_runs, describe_suite, refuse_problem_options, without_missing


@takes_options
def compare(
    context: typer.Context,
    problem: Problem,
    suite: options.SuiteName = None,
    engine: options.EnginesOrAll = None,
    support: options.Supports = None,
    time_step: options.TimeStep = None,
    setting: options.Settings = None,
    trajectory: options.Trajectories = None,
    trajectory_angles: options.TrajectoryAngles = None,
    trajectory_offset: options.TrajectoryOffset = 0.0,
    trajectory_noise_deg: options.TrajectoryNoise = None,
    budget: options.Budget = False,
    out: options.Out = Path("rockwobble-compare"),
) -> None:
    """Run the reduced model and the engines on one problem, and report how long they agree.

    Without options: the 1940 El Centro record on R = 6 m, tan alpha = 0.2, every installed engine, in an
    ideal recess and on flat ground.

    With a SUITE: its cases and runs, among which --engine and --support choose. A suite that was ended
    before its end resumes when it is started again with the same folder.

    With --engine all: every installed engine that can run the problem, and their agreement matrix.

    With --trajectory: that of a shake table or of another code is one more run. With --engine none it is
    compared with the reduced model alone.

    Writes summary.csv, the samples as Parquet, report.html and figure.svg.
    """
    with interruptible(out if suite else None):
        with user_input():
            from rockwobble.compare.runs.choice import unable_engines

            refuse_options_of_engines(context, engine)
            if suite is not None:
                refuse_problem_options(context, suite)
                cases, runs = _suite(suite, engine, support, time_step)
            else:
                cases = [problem.case()]
                runs = _runs(cases[0], engine, support, time_step, alone=bool(trajectory))
            if setting:
                runs = list(rr.with_settings(cases[0], runs, settings(setting)))
            rs.require_writable(out)
            require_feasible(cases, runs)
            for each in cases:
                for run in runs:
                    rr.require_runnable(each, run)
            external = _external(
                trajectory, cases, trajectory_angles, trajectory_offset, trajectory_noise_deg
            )
        if suite is None:
            print(*describe(cases[0]), *time_needed(cases, runs), sep="\n")
        else:
            print(*describe_suite(suite, cases, runs), sep="\n")
        if engine == [options.ALL]:
            for reason in unable_engines(cases):
                complain(reason)
        elif not engine and suite is None:
            _say_what_is_left_out(support or [])
        with user_input(), shown_progress() as tell:
            found = rw.compare(
                rw.Suite(cases, runs),
                runs=runs,
                progress=tell,
                external=external,
                resume=None if suite is None else out,
                budget=budget,
            )
        show_and_save(found, out)
    if (found.summary["outcome"] == "failed").any():
        raise typer.Exit(FAILED)


def _suite(
    name: str, engines: list[str] | None, supports: list[str] | None, time_step: Any
) -> tuple[list[rw.Case], list[rw.Run]]:
    from rockwobble.compare.runs.choice import all_runs

    if engines == [options.NO_ENGINE]:
        raise ValueError(f"--engine none is for a case given by options, and {name} is a suite with runs")
    suite = rw.read_suite(name)
    if engines == [options.ALL]:
        asked = supports or list(dict.fromkeys(run.support for run in suite.runs)) or None
        return list(suite.cases), [
            rw.Run(run.engine, run.support, time_step) for run in all_runs(suite.cases, asked)
        ]
    return list(suite.cases), without_missing(chosen_runs(suite, engines, supports, time_step), engines)


def _runs(
    case: rw.Case, engines: list[str] | None, supports: list[str] | None, time_step: Any, *, alone: bool
) -> list[rw.Run]:
    from rockwobble.compare.runs.choice import all_runs

    if engines == [options.NO_ENGINE]:
        if not alone:
            raise ValueError("--engine none leaves nothing to compare, give a --trajectory as well")
        return []
    every = engines == [options.ALL]
    runs = all_runs([case], supports or None) if every else rc.default_runs(engines or None, supports or None)
    return [rw.Run(run.engine, run.support, time_step) for run in runs]


def _external(
    paths: list[Path] | None,
    cases: Sequence[rw.Case],
    angles: str | None,
    offset: float,
    noise_deg: float | None,
) -> list[rw.External]:
    if not paths:
        if angles is not None or offset or noise_deg is not None:
            raise ValueError("--trajectory-angles, -offset and -noise-deg need a --trajectory")
        return []
    if len(cases) > 1:
        raise ValueError(f"--trajectory belongs to one case, got a suite of {len(cases)}")
    if noise_deg is not None and not 0.0 < noise_deg < 90.0:
        raise ValueError(f"--trajectory-noise-deg must be above 0 and below 90 [deg], got {noise_deg:g}")
    if not math.isfinite(offset):
        raise ValueError(f"--trajectory-offset must be finite [s], got {offset:g}")
    noise = None if noise_deg is None else math.radians(noise_deg)
    external = [rw.External(path=path, angle_unit=angles, time_offset=offset, noise=noise) for path in paths]
    for each in external:  # whatever is wrong with a file is said before anything runs
        rc.read_trajectory(each, cases[0])
    return external


def _say_what_is_left_out(supports: list[str]) -> None:
    from rockwobble.compare.runs.choice import left_out, unsupported

    for name in rr.missing_engines():
        complain(left_out(name))
    for reason in unsupported(supports):
        complain(reason)
