"""Commands on one problem: `rockwobble compare`, `simulate` and `advise`."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

import rockwobble as rw
import rockwobble.compare as rc
from rockwobble.compare.runs.plan import OptionsIn, Plan
from rockwobble.studies.plans import AdvicePlan, ModelPlan

from ..console import FAILED, complain
from ..pages.cases import case_lines, case_warnings, record_lines
from . import options
from .command import Work, saves_results
from .options import settings
from .problem import Problem, given_options, needs, next_command, refuse_options_of_engines, stated_options
from .suite_choice import (
    chosen_runs,
    refuse_problem_options,
    report_skipped_engines,
    suite_lines,
    without_missing,
)

if TYPE_CHECKING:
    from rockwobble.compare.runs.progress import ProgressCallback
    from rockwobble.models.case import TimeStep
    from rockwobble.studies import Advice
    from rockwobble.studies.single_run import SingleRun

_external = OptionsIn("Trajectory of a shake table or another code")


@dataclass(frozen=True, kw_only=True)
class Trajectories(Plan):
    """Options that name external trajectories."""

    trajectory: list[Path] | None = _external(
        None,
        "Trajectory of a shake table or another code, as CSV: time with tilt and azimuth, with qw, qx, "
        "qy, qz, or with x, y, z of the mass centre. Quantities that are missing are not compared. May "
        "be repeated.",
    )
    trajectory_angles: str | None = _external(
        None, "Unit of its angles if the header does not state it: deg or rad."
    )
    trajectory_columns: str | None = _external(
        None,
        "Its columns by name or number, in this order: time, tilt[, azimuth]; time, x, y, z; time, qw, "
        "qx, qy, qz; or time, qw, qx, qy, qz, x, y, z. A unit may follow: 2,7 [mm],8 [mm],9 [mm].",
    )
    trajectory_offset: float = _external(
        0.0, "Offset added to its times, in s, so that 0 is the start of the run."
    )
    trajectory_noise_deg: float | None = _external(
        None,
        "Tilt below which it counts as at rest, in deg. Default: from the scatter, at least 1e-4 alpha.",
        above=0.0,
        below=90.0,
    )

    def read(self, cases: Sequence[rw.Case]) -> list[rw.External]:
        """External trajectories; each is read once here, for the only case.

        Raises
        ------
        ValueError
            If an option is out of range or alone, there are more cases, or a file cannot be read.
        """
        needs(self, [each.name for each in dataclasses.fields(self)], "trajectory")
        if self.trajectory and len(cases) > 1:
            raise ValueError(f"--trajectory belongs to one case, got a suite of {len(cases)}")
        noise = self.trajectory_noise_deg
        stated: dict[str, Any] = {
            "angle_unit": self.trajectory_angles,
            "columns": self.trajectory_columns.split(",") if self.trajectory_columns else (),
            "time_offset": self.trajectory_offset,
            "noise": None if noise is None else math.radians(noise),
        }
        trajectories = [rw.External(path=path, **stated) for path in self.trajectory or ()]
        for each in trajectories:  # errors in trajectory files are reported before anything runs
            rc.read_trajectory(each, cases[0])
        return trajectories


@saves_results
def compare(
    context: typer.Context,
    problem: Problem,
    external: Trajectories,
    suite: options.SuiteName = None,
    engine: options.EnginesOrAll = None,
    support: options.Supports = None,
    time_step: options.TimeStep = None,
    setting: options.Settings = None,
    budget: Annotated[
        bool,
        options.method(
            "Split each difference into model form, numerics and a rest, by finer steps (7 times as long).",
            "--budget",
        ),
    ] = False,
) -> Work:
    """Agreement of the reduced model with multibody engines on one problem, and why they diverge.

    Without options: the 1940 El Centro record on R = 6 m, tan alpha = 0.2, the default engines, in an ideal
    recess and on flat ground.

    With a SUITE: its cases and runs; --engine and --support select among the runs. An interrupted suite
    resumes with the same command.

    With --engine all: every installed engine that can run the problem, and their agreement matrix.

    With --trajectory: the trajectory of a shake table or another code is compared too; with --engine none,
    with the reduced model only.

    Writes summary.csv, the samples as Parquet, report.html and figure.svg.

    Example: rockwobble compare --semidiagonal 10 --tan-alpha 0.1 --engine mujoco
    """
    from rockwobble.compare.runs.choice import require_runnable, unable_engines, with_settings

    refuse_options_of_engines(context, engine)
    if suite is not None:
        refuse_problem_options(context, suite)
        cases, runs = _suite(suite, engine, support, time_step)
    else:
        cases = [problem.case()]
        runs = _runs(cases[0], engine, support, time_step, alone=bool(external.trajectory))
    if setting:
        runs = list(with_settings(cases[0], runs, settings(setting)))
    for each in cases:
        for run in runs:
            require_runnable(each, run)
    trajectories = external.read(cases)
    if engine == [options.ALL]:
        for reason in unable_engines(cases):
            complain(reason)
    elif not engine and suite is None:
        report_skipped_engines(support or [])
    return Work(
        partial(rw.comparison, rw.Suite(cases, runs), runs=runs, external=trajectories, budget=budget),
        case_lines(cases[0], problem.mass, record=problem.names_record)
        if suite is None
        else suite_lines(suite, cases, runs),
        resumes=suite is not None,
        failed=lambda results: (results.summary["outcome"] == "failed").any(),
    )


def _suite(
    name: str, engines: list[str] | None, supports: list[str] | None, time_step: TimeStep
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
    case: rw.Case, engines: list[str] | None, supports: list[str] | None, time_step: TimeStep, *, alone: bool
) -> list[rw.Run]:
    from rockwobble.compare.runs.choice import all_runs

    if engines == [options.NO_ENGINE]:
        if not alone:
            raise ValueError("--engine none leaves nothing to compare, give a --trajectory as well")
        return []
    if engines == [options.ALL]:
        runs = all_runs([case], supports or None)
    else:
        runs = rc.default_runs(engines or None, supports or None, cases=[case])
    return [rw.Run(run.engine, run.support, time_step) for run in runs]


@saves_results
def simulate(
    context: typer.Context,
    problem: Problem,
    model: ModelPlan,
    engine: Annotated[
        str | None, options.method(f"{options.ENGINE}. Default: the reduced model instead of an engine.")
    ] = None,
    support: options.Support = "recess",
    time_step: options.TimeStep = None,
    setting: options.Settings = None,
) -> Work:
    """Motion of one case by the reduced model or one engine: traces, forces and diagnostics.

    Without options: the recess model under the 1940 El Centro record, R = 6 m, tan alpha = 0.2.

    Writes the samples (run.csv), the near-upright passes (passes.csv), both for Trace.load (run.parquet),
    units and meaning of each column (manifest.json), and the page (run.html); `rockwobble report` draws it as
    a document, too (run.md, trace.svg). SI units and radians.

    Example: rockwobble simulate --release-tilt-deg 5 --rolling-rate 0.5 --duration 8
    """
    from rockwobble.compare.runs.choice import require_runnable
    from rockwobble.studies.single_run import single_run

    from ..pages.diagnostics import remarks

    case = problem.case()
    if model.plane is not None and problem.release_azimuth_deg:
        raise ValueError("--plane is the azimuth of the lean, got --release-azimuth-deg beside it")
    if model.plane is not None and case.initial is not None:  # the release lies in the plane of the model
        case = replace(case, initial=replace(case.initial, rolling_angle=model.plane))
    named = None if engine == options.NO_ENGINE else engine
    chosen = _with_settings(case, rw.Run(named, support, time_step), setting, dataclasses.asdict(model))
    require_runnable(case, chosen)
    answer = next_command(context, "advise", also=("support",))

    def run(progress: ProgressCallback) -> SingleRun:
        results = single_run(case, chosen, answer=answer, progress=progress)
        if not len(results.trace.time):
            complain(f"{chosen} left no result: {remarks(results.trace.facts)}")
            raise typer.Exit(FAILED)
        return results

    lines = case_lines(case, problem.mass, record=problem.names_record)
    return Work(run, lines, failed=lambda results: results.trace.outcome == "failed")


def _with_settings(case: rw.Case, run: rw.Run, setting: list[str] | None, model: dict[str, Any]) -> rw.Run:
    """Run with the options of its method; options of other methods are refused."""
    from rockwobble.compare.runs.choice import with_settings

    model = {name: value for name, value in model.items() if value is not None}
    if run.is_model and run.time_step is not None:
        raise ValueError("--time-step belongs to an engine, give --engine as well")
    if not run.is_model and model:
        option = "--" + next(iter(model)).replace("_", "-")
        raise ValueError(f"{option} belongs to the reduced models, got --engine {run.engine}")
    if twice := model.keys() & settings(setting).keys():
        raise ValueError(f"{min(twice)} is given twice, by an option and by --set")
    (whole,) = with_settings(case, [run], settings(setting) | model)
    return whole


Engine = Annotated[
    str | None,
    options.method(f"{options.ENGINE}; checks the model by one run. none: no check. Default: mujoco."),
]
Details = Annotated[bool, options.output("Also print the details of the page.", "--details")]


@saves_results
def advise(
    context: typer.Context,
    problem: Problem,
    plan: AdvicePlan,
    engine: Engine = None,
    time_step: options.TimeStep = None,
    details: Details = False,
) -> Work:
    """Verdict on one case: does it overturn, how reliable is the answer, what must the support carry.

    Gives a verdict; a grade with its reason for each check; peak tilt, top displacement and overturning
    probability for the record, its perturbed copies and other records of the same intensity; the design
    demands on ground and recess; and next steps.

    Without options: the 1940 El Centro record on R = 6 m, tan alpha = 0.2, in a recess.

    Writes advice.html (one page, works offline) and the runs as Parquet; `report` draws a document, too
    (advice.md, advice.svg).

    Example: rockwobble advise --record-x EW.AT2 --record-y NS.AT2 --friction 0.5
    """
    from rockwobble.studies.advice.advice import require_judged
    from rockwobble.studies.advice.slides import usual_support

    case, given = problem.case(), given_options(context)
    if "support" not in given:
        plan = replace(plan, support=usual_support(case, friction_given="friction" in given))
    require_judged(case, plan.support, plan.gap)
    checked = _run(case, engine, plan.support, time_step)
    options_given = stated_options(context, also=[field.name for field in dataclasses.fields(plan)])

    def run(progress: ProgressCallback) -> Advice:
        stated = {"friction_given": "friction" in given, **dataclasses.asdict(plan)}
        results = rw.advise(case, checked, progress=progress, **stated)
        return replace(results, facts={**results.facts, "options": options_given})

    # rest of the input is listed by the advice
    records = record_lines([case.motion]) if problem.names_record else []
    return Work(
        run,
        [*records, *case_warnings([case], plan.mass)],
        what="stages",
        details=details,
        failed=lambda results: results.response["outcome"] == "failed",
    )


def _run(case: rw.Case, engine: str | None, support: str, time_step: float | None) -> rw.Run | None:
    """Run of the verifying engine; None without one."""
    from rockwobble.compare.runs.choice import require_runnable

    if engine == options.NO_ENGINE and time_step is not None:
        raise ValueError("--time-step belongs to an engine, got it with --engine none")
    from rockwobble.multibody.engines.registry import engine_fault

    default = rw.multibody.DEFAULT_ENGINE
    fault = "" if engine else engine_fault(default)
    if fault:
        complain(f"{default} {fault}; the prediction stays unverified")
    if fault or engine == options.NO_ENGINE:
        return None
    run = rw.Run(engine or default, support, time_step)
    require_runnable(case, run)
    return run
