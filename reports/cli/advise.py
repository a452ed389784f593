"""`rockwobble advise`: outcome, trust and demands on the support for one cylinder and one record."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

import rockwobble as rw
import rockwobble.compare as rc

from ..console.progress import shown_progress
from ..console.results import show_and_write
from ..console.terminal import FAILED, command_line, complain, interruptible, user_input
from ..pages.words.cases import describe
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
Support = Annotated[
    str,
    options.method(
        "What holds the cylinder: recess (ideal), flat (flat ground) or ring (walls with clearance)."
    ),
]
Copies = Annotated[int, options.method("Number of perturbed copies.")]


@takes_options
def advise(
    context: typer.Context,
    problem: Problem,
    engine: Engine = None,
    support: Support = "recess",
    time_step: options.TimeStep = None,
    copies: Copies = 100,
    seed: options.Seed = 1,
    out: options.Out = Path("rockwobble-advise"),
) -> None:
    """Say how one case ends, how far its results can be trusted, and what its support must supply.

    First the probability of overturning and the largest tilt, over copies of the record and over other
    records as strong; then friction, restraining moment and contact, the agreement of methods, planar
    analysis and the vertical component; each grade with its criterion.

    Without options: the 1940 El Centro record on R = 6 m, tan alpha = 0.2, in a recess.

    Writes advice.html, one page that needs nothing else, the same as advice.md with advice.svg, and
    the runs as Parquet.
    """
    with interruptible():
        with user_input():
            from rockwobble.compare.studies.advice.drive import require_count

            case = problem.case()
            friction = case.friction if "friction" in given_options(context) else None
            run = _run(case, engine, support, time_step)
            require_feasible([case], [rw.Run(None, "recess"), *([] if run is None else [run])])
            require_count("--copies", copies)
            rc.require_writable(out)
        from rockwobble.compare.runs.execution import Job, job_fingerprint
        from rockwobble.compare.storage.fingerprint import fingerprint
        from rockwobble.compare.storage.manifest import made_now
        from rockwobble.compare.studies.advice.advice import KIND
        from rockwobble.compare.studies.advice.drive import advise as ask

        from ..pages.advice import advice_page

        with shown_progress("stages") as tell:
            found = ask(
                case,
                run,
                support=support,
                friction_given=friction is not None,
                count=copies,
                seed=seed,
                progress=tell,
            )
        held = f"Support: {support}, friction {'not given' if friction is None else f'{friction:g}'}"
        asked = [*describe(found.case), f"{held}; reduced model: {found.model}"]
        facts = {"problem": asked, **found.facts()}
        jobs = [job_fingerprint(Job(case=case, run=each)) for each in (found.model, run) if each is not None]
        manifest = made_now(
            KIND,
            inputs=fingerprint([*jobs, support, friction, copies, seed]),
            command=command_line(),
            seeds={"copies": seed},
            headline={"case": found.case.name, "outcome as given": facts["outcome"], "grade": facts["grade"]}
            | {f"overturning, {row['group']}": row["chance"] for row in facts["answers"]}
            | {"largest tilt as given [alpha]": facts["peak"]},
            about={"advice": facts},
        )
        show_and_write(out, advice_page(found.tables(), manifest), manifest, found.tables())
    if found.trace.outcome == "failed":
        raise typer.Exit(FAILED)


def _run(case: rw.Case, engine: str | None, support: str, time_step: float | None) -> rw.Run | None:
    from rockwobble.compare.studies.advice.drive import SUPPORTS
    from rockwobble.models.number_checks import require_one_of

    if engine == options.NO_ENGINE and time_step is not None:
        raise ValueError("--time-step belongs to an engine, got it with --engine none")
    default = rw.multibody.DEFAULT_ENGINE
    missing = engine is None and default not in rw.multibody.available_engines()
    if missing:
        complain(f"{default} is not installed here: the prediction stays unverified")
    if missing or engine == options.NO_ENGINE:
        require_one_of("--support", support, SUPPORTS)
        return None
    run = rw.Run(engine or default, support, time_step)
    rc.require_runnable(case, run)
    return run
