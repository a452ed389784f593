"""`rockwobble ensemble`: peak tilts of many members by several methods, compared as distributions."""

from __future__ import annotations

import dataclasses
import math
from pathlib import Path
from typing import Annotated, Any

import typer

import rockwobble as rw
import rockwobble.compare as rc

from ..console.progress import shown_progress
from ..console.results import show_and_write
from ..console.terminal import command_line, interruptible, user_input
from ..pages.words.cases import describe
from .inputs import options
from .inputs.estimate import require_feasible
from .inputs.problem import Problem, refuse, refuse_options_of_engines, states_problem
from .inputs.suite_choice import chosen_runs, refuse_problem_options, without_missing

_MEMBERS = {"members", "perturbation", "synthetic", "p695"}  # options that state them

Members = Annotated[
    int, typer.Option(help="Number of members, where no suite gives them.", callback=options.whole(2))
]
Perturbation = Annotated[
    float,
    typer.Option(
        help="Relative standard deviation of tilt and rolling rate at release, or of the two components "
        "of the ground motion; at most 0.1."
    ),
]
Synthetic = Annotated[
    float | None,
    typer.Option(
        help="Made-up ground motions instead of perturbed copies, with a peak of so many times g tan alpha."
    ),
]
FarField = Annotated[
    float | None,
    typer.Option(
        help="The 22 far-field pairs of FEMA P-695 (extra records) instead of perturbed copies, each scaled "
        "to a peak of so many times g tan alpha.",
    ),
]


@states_problem
def ensemble(
    context: typer.Context,
    problem: Problem,
    suite: options.SuiteName = None,
    members: Members = 20,
    perturbation: Perturbation = 0.01,
    synthetic: Synthetic = None,
    p695: FarField = None,
    seed: options.Seed = 0,
    engine: options.Engines = None,
    support: options.Supports = None,
    time_step: options.TimeStep = None,
    out: options.Out = Path("rockwobble-ensemble"),
) -> None:
    """Hold the peak tilts of many members by each method against each other, member by member.

    Without options: El Centro on R = 6 m, tan alpha = 0.2, with 20 slightly perturbed copies. With
    --synthetic or --p695 the members are ground motions, with a SUITE its cases, by its runs, among which
    --engine and --support choose. --engine none runs the reduced models alone.

    Whatever ends it, the same command goes on where it stopped.

    Writes ensemble.html, the same as ensemble.md with ensemble.svg, and members, methods and contrasts as
    Parquet and CSV.
    """
    with interruptible(out):
        with user_input():
            from rockwobble.compare.studies.ensemble.members import require_perturbation
            from rockwobble.models.records.plausibility import doubts_of

            from ..pages.words.diagnostics import warnings

            rc.require_writable(out)
            refuse_options_of_engines(context, engine)
            stated: rw.Case | rw.Suite | list[rw.Case]
            if suite is not None:
                refuse(context, _MEMBERS, f"does not go with a suite, got {suite}: its cases are the members")
                refuse_problem_options(context, suite)
                stated = rw.read_suite(suite)
                runs = _runs(engine, support, time_step, stated)
                print(f"Suite {suite}: {len(stated.cases)} members")
                for line in warnings(doubts_of(each.motion for each in stated.cases)):
                    print(line)
            else:
                _refuse_ignored(context, synthetic, p695)
                case = problem.case()
                runs = _runs(engine, support, time_step, None)
                # each engine and its own model, and a perturbed copy of that
                require_feasible([case], [rw.Run(None, "recess"), *runs], members=members, samples=False)
                motions = _motions(case, members, synthetic, p695, seed)
                if not motions:
                    require_perturbation(perturbation)
                # named by the motion alone: the others are all the same
                each = [dataclasses.replace(case, name=motion.name, motion=motion) for motion in motions]
                stated = each or case
                for line in describe(case)[:1] if motions else describe(case):
                    print(line)
                print(f"Members: {len(motions) or members}, {_source(synthetic, p695, perturbation)}")
        from rockwobble.compare.studies.ensemble.study import manifest_of

        from ..pages.ensemble import ensemble_page

        with user_input(), shown_progress() as tell:
            found = rw.ensemble(
                stated,
                runs=runs,
                size=members,
                perturbation=perturbation,
                seed=seed,
                progress=tell,
                resume=out,
                source=_source(synthetic, p695, perturbation) if suite is None else f"cases of {suite}",
            )
        manifest = manifest_of(found, command_line())
        tables = found.tables
        sheets = {f"{name}.csv": table.to_csv(index=False).encode() for name, table in tables.items()}
        show_and_write(out, ensemble_page(found, manifest), manifest, tables, sheets)


def _refuse_ignored(context: typer.Context, synthetic: float | None, far_field: float | None) -> None:
    """Refuse what the members are not made of."""
    ignored = {"perturbation", "record", "record_x", "record_y", "record_z", "units", "resample", "scale"}
    for option, peak, more in (("--synthetic", synthetic, set()), ("--p695", far_field, {"members", "seed"})):
        if peak is None:
            continue
        if not 0.0 < peak < math.inf:
            raise ValueError(f"{option} must be positive and finite [g tan alpha], got {peak:g}")
        refuse(context, ignored | more, f"does not go with {option}: its motions are the members")


def _motions(
    case: rw.Case, members: int, synthetic: float | None, far_field: float | None, seed: int
) -> list[rw.GroundMotion]:
    """Return the ground motions that are the members; none where the members are perturbed copies."""
    if synthetic is not None and far_field is not None:
        raise ValueError("the members are made-up ground motions or those of FEMA P-695, got both options")
    uplift = case.gravity * case.cylinder.tan_alpha
    if far_field is not None:
        return rc.far_field_motions(peak=far_field * uplift)
    if synthetic is not None:
        return rc.synthetic_motions(members, peak=synthetic * uplift, seed=seed)
    return []


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


def _source(synthetic: float | None, far_field: float | None, perturbation: float) -> str:
    """Return the source of the members, in words."""
    if far_field is not None:
        return f"far-field pairs of FEMA P-695, with peaks of {far_field:g} g tan alpha"
    if synthetic is not None:
        return f"made-up ground motions, with peaks of {synthetic:g} g tan alpha"
    return f"perturbed copies, {100.0 * perturbation:g} %"
