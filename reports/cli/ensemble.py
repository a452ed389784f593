"""`rockwobble ensemble`: peak tilts of many members by several methods, compared as distributions."""

from __future__ import annotations

import dataclasses
from pathlib import Path
from typing import Annotated, Any

import typer

import rockwobble as rw
import rockwobble.compare as rc
import rockwobble.compare.storage as rs
from rockwobble.compare.studies.plans import Copies

from ..console.progress import shown_progress
from ..console.results import show_and_save
from ..console.terminal import interruptible, user_input
from ..pages.words.cases import describe
from .inputs import options
from .inputs.estimate import require_feasible
from .inputs.plan_options import takes_options
from .inputs.problem import Problem, refuse, refuse_options_of_engines
from .inputs.several import ManyMotions
from .inputs.suite_choice import chosen_runs, refuse_problem_options, without_missing

_COPIES = {"copies", "perturbation"}
_MOTIONS = {"p695", "records", "synthetic", "peak"}

Peak = Annotated[
    float | None,
    typer.Option(
        help="Peak horizontal resultant to which each of many motions is scaled, in g tan alpha. Default: 3.",
        rich_help_panel="Ground motions",
    ),
]


@takes_options
def ensemble(
    context: typer.Context,
    problem: Problem,
    copies: Copies,
    motions: ManyMotions,
    suite: options.SuiteName = None,
    peak: Peak = None,
    engine: options.Engines = None,
    support: options.Supports = None,
    time_step: options.TimeStep = None,
    out: options.Out = Path("rockwobble-ensemble"),
) -> None:
    """Compare the peak tilts of many members by each method, member by member.

    Without options: El Centro on R = 6 m, tan alpha = 0.2, with 20 slightly perturbed copies. With
    --synthetic, --p695 or --records the members are ground motions, with a SUITE its cases, by its runs,
    among which --engine and --support choose. --engine none runs the reduced models alone.

    Whatever ends it, the same command resumes.

    Writes ensemble.html, the same as ensemble.md with ensemble.svg, and members, methods and contrasts as
    Parquet and CSV.
    """
    with interruptible(out):
        with user_input():
            from rockwobble.models.records.units import doubts_of

            from ..pages.words.diagnostics import warnings

            rs.require_writable(out)
            refuse_options_of_engines(context, engine)
            stated: rw.Case | rw.Suite | list[rw.Case]
            if suite is not None:
                ignored = _COPIES | _MOTIONS
                refuse(context, ignored, f"does not go with a suite, got {suite}: its cases are the members")
                refuse_problem_options(context, suite)
                stated, source = rw.read_suite(suite), f"cases of {suite}"
                runs = _runs(engine, support, time_step, stated)
                print(f"Suite {suite}: {len(stated.cases)} members")
                shaking = [each.motion for each in stated.cases]
            else:
                stated, source = _members(context, problem, copies, motions, peak)
                shown = stated if isinstance(stated, rw.Case) else stated[0]
                count = copies.copies if isinstance(stated, rw.Case) else len(stated)
                runs = _runs(engine, support, time_step, None)
                # each engine and its own model, and a perturbed copy of that
                require_feasible([shown], [rw.Run(None, "recess"), *runs], members=count, samples=False)
                for line in describe(shown) if isinstance(stated, rw.Case) else describe(shown)[:1]:
                    print(line)
                print(f"Members: {count}, {source}")
                shaking = [] if isinstance(stated, rw.Case) else [each.motion for each in stated]
            for line in warnings(doubts_of(shaking)):
                print(line)
        with user_input(), shown_progress() as tell:
            found = rw.ensemble(
                stated, runs=runs, progress=tell, resume=out, source=source, **dataclasses.asdict(copies)
            )
        show_and_save(found, out)


def _members(
    context: typer.Context, problem: Problem, copies: Copies, motions: ManyMotions, peak: float | None
) -> tuple[rw.Case | list[rw.Case], str]:
    """Return the case whose copies are the members, or the members, and what they are."""
    if not motions.given:
        refuse(context, {"peak"}, "scales many motions, give --synthetic, --p695 or --records as well")
        return problem.case(), f"perturbed copies, {100.0 * copies.perturbation:g} %"
    ignored = {"record", "record_x", "record_y", "record_z", "scale", *_COPIES}
    refuse(context, ignored, f"does not go with {motions.given}: its motions are the members")
    case = dataclasses.replace(problem, units=None, resample=False).case()
    level = 3.0 if peak is None else peak
    found, source = motions.read(copies.seed)
    target = level * case.gravity * case.cylinder.tan_alpha
    if not target > 0.0:
        raise ValueError(f"--peak must be positive [g tan alpha], got {level:g}")
    # named by the motion alone: the others are all the same
    scaled = [motion.scaled(target / motion.peak) for motion in found]
    members = [dataclasses.replace(case, name=motion.name, motion=motion) for motion in scaled]
    return members, f"{source}, with peaks of {level:g} g tan alpha"


def _runs(
    engines: list[str] | None, supports: list[str] | None, time_step: Any, suite: rw.Suite | None
) -> list[rw.Run]:
    """Return the runs of the options, chosen among those of a suite."""
    if engines == [options.NO_ENGINE]:
        return []
    if suite is not None:
        return without_missing(chosen_runs(suite, engines, supports, time_step), engines)
    chosen = rc.default_runs(engines or None, supports or None)
    return [rw.Run(run.engine, run.support, time_step) for run in chosen]
