"""`rockwobble advise`: what to make of one cylinder and one record, on one page."""

from __future__ import annotations

import dataclasses
import time
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ..console.terminal import FAILED, complain, interruptible, user_input
from ..pages.provenance import command_line
from .inputs import options

if TYPE_CHECKING:
    from rockwobble.compare.studies.advice import Advice
    from rockwobble.models import Case, Run

_NO_ENGINE = "none"

Friction = Annotated[
    float,
    typer.Option(
        "--friction", help="Coefficient between cylinder and ground or recess.", rich_help_panel="Method"
    ),
]
Engine = Annotated[
    str | None,
    typer.Option(
        "--engine",
        help="mujoco, pybullet or exudyn, whose one run verifies the prediction; none leaves it out. "
        "Default: mujoco.",
        rich_help_panel="Method",
    ),
]
Support = Annotated[
    str,
    typer.Option(
        "--support",
        help="What holds the cylinder: recess (ideal recess), flat (flat ground) or ring (real recess).",
        rich_help_panel="Method",
    ),
]
Starts = Annotated[
    int, typer.Option("--starts", help="Number of perturbed starts.", rich_help_panel="Method")
]
Seed = Annotated[int, typer.Option("--seed", help="Of the perturbed starts.", rich_help_panel="Method")]


def advise(
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
    friction: Friction = 1.0,
    engine: Engine = None,
    support: Support = "recess",
    time_step: options.TimeStep = None,
    starts: Starts = 100,
    seed: Seed = 1,
    out: options.Out = Path("rockwobble-out"),
) -> None:
    """Say how far the results of one case can be trusted, and what its support must supply.

    Friction, couple and contact, the horizon of the trace, the error of the largest tilt, planar
    analysis and overturning: each with its number and the run behind it, and one verdict first.

    Without options: the 1940 El Centro record on R = 6 m, tan alpha = 0.2, in a recess.

    Writes advice.html, one page that needs nothing else, the same as advice.md with advice.svg, and
    advice.json for machines.
    """
    from ..pages.case_words import describe
    from .inputs.problem import case_from_options

    with interruptible():
        with user_input():
            from rockwobble.compare import replace_files, require_writable

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
            case = dataclasses.replace(case, friction=friction)
            run = _run(case, engine, support, time_step)
            _require_numbers(starts, seed)
            require_writable(out)
        for line in describe(case):
            print(line)
        advice = _advise(case, run, support, starts, seed)
        print_advice(advice)
        contents = advice_files(advice, command_line())
        with user_input():
            replace_files(out, contents)
    print(f"\nWritten to {out}: {', '.join(contents)}")
    if advice.response.outcome == "failed":
        raise typer.Exit(FAILED)


def _run(case: Case, engine: str | None, support: str, time_step: float | None) -> Run | None:
    from rockwobble.compare import installed_engines, require_runnable
    from rockwobble.models import Run

    if engine == _NO_ENGINE:
        if time_step is not None:
            raise ValueError("--time-step belongs to an engine, got it with --engine none")
        _require_support(support)
        return None
    if engine is None and "mujoco" not in installed_engines():
        complain("mujoco is not installed here: the prediction stays unverified")
        _require_support(support)
        return None
    run = Run(engine or "mujoco", support, time_step)
    require_runnable(case, run)
    return run


def _require_support(support: str) -> None:
    from rockwobble.compare.studies.advice.drive import SUPPORTS

    if support not in SUPPORTS:
        raise ValueError(f"--support must be one of {', '.join(SUPPORTS)}, got {support!r}")


def _require_numbers(starts: int, seed: int) -> None:
    from rockwobble.compare.studies.advice.drive import FEWEST, MOST

    if not FEWEST <= starts <= MOST:
        raise ValueError(f"--starts must be from {FEWEST} to {MOST}, got {starts}")
    if seed < 0:
        raise ValueError(f"--seed must not be negative, got {seed}")


def _advise(case: Case, run: Run | None, support: str, starts: int, seed: int) -> Advice:
    from rockwobble.compare.studies.advice import advise as ask

    from ..console.progress import shown_progress

    with shown_progress() as tell:
        return ask(case, run, support=support, count=starts, seed=seed, progress=tell)


def print_advice(advice: Advice) -> None:
    """Print the verdict and the statements."""
    from rich import box
    from rich.console import Console
    from rich.table import Table
    from rich.text import Text

    from ..console.summary_table import MINIMUM_WIDTH
    from ..pages.advice.page import problem_line
    from ..pages.advice.statements import GRADE_WORDS, statements, verdict

    colours = {"good": "green", "care": "yellow", "bad": "red", "": ""}
    console = Console()
    if not console.is_terminal:
        console.width = max(console.width, MINIMUM_WIDTH)
    console.print(problem_line(advice), highlight=False, markup=False)
    console.print()
    console.print(verdict(advice), style="bold", highlight=False, markup=False)
    table = Table(box=box.SIMPLE_HEAD, show_header=False, padding=(0, 1, 0, 0), pad_edge=False)
    table.add_column(no_wrap=True)
    table.add_column(no_wrap=True)
    table.add_column(overflow="fold")
    for each in statements(advice):
        words = Text(each.text)
        words.append(f"\n{each.run}", style="dim")
        table.add_row(
            Text(each.topic, style="bold"), Text(GRADE_WORDS[each.grade], style=colours[each.grade]), words
        )
    if table.row_count:
        console.print(table)


def advice_files(advice: Advice, command: str = "") -> dict[str, bytes]:
    """Return name and content of each file of an advice."""
    from rockwobble.models.plain_json import dumps, loads

    from ..figures.advise_figure import advice_figure
    from ..pages.advice.document import advice_document
    from ..pages.advice.page import advice_page

    stored = dumps(advice_record(advice, command), indent=2) + "\n"
    return {
        "advice.html": advice_page(advice, command).encode(),
        "advice.md": advice_document(loads(stored)).encode(),
        "advice.svg": advice_figure(advice),
        "advice.json": stored.encode(),
    }


def advice_record(advice: Advice, command: str = "") -> dict[str, Any]:
    """Return an advice as plain values: what it says, and every number behind it."""
    from rockwobble.compare import describe_case

    from ..pages.advice.page import problem_line
    from ..pages.advice.statements import statements, verdict, verdict_grade
    from ..pages.case_words import describe

    return {
        "kind": "rockwobble advice",
        "name": advice.case.name,
        "problem": [*describe(advice.case), problem_line(advice)],
        "verdict": verdict(advice),
        "grade": verdict_grade(advice),
        "grades": advice.grades,
        "statements": statements(advice),
        "numbers": advice.numbers(),
        "case": describe_case(advice.case),
        "command": command,
        "date": datetime.now(UTC).date().isoformat(),
        # of this process since it began, which is what the command costs
        "seconds": time.process_time(),
        "versions": advice.versions,
    }
