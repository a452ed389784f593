"""`rockwobble compare`: reduced model and engines on one problem."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

from ..console.terminal import complain, interruptible, user_input
from ..pages.comparison.files import SINGLY, comparison_pages
from ..pages.provenance import command_line
from .inputs import options
from .inputs.method_values import settings
from .inputs.suite_choice import chosen_runs, describe_suite, refuse_problem_options, without_missing

if TYPE_CHECKING:
    from rich.console import Console

    from rockwobble.compare import Comparison, External
    from rockwobble.models import Case, Run, Suite

    from ..console.progress import Tell


def compare(
    context: typer.Context,
    suite: options.SuiteName = None,
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
    engine: options.Engines = None,
    support: options.Supports = None,
    time_step: options.TimeStep = None,
    setting: options.Settings = None,
    trajectory: options.Trajectories = None,
    trajectory_angles: options.TrajectoryAngles = None,
    trajectory_offset: options.TrajectoryOffset = 0.0,
    trajectory_noise_deg: options.TrajectoryNoise = None,
    budget: options.Budget = False,
    out: options.Out = Path("rockwobble-out"),
) -> None:
    """Run the reduced model and the engines on one problem, and report how long they agree.

    Without options: the 1940 El Centro record on R = 6 m, tan alpha = 0.2, every installed engine,
    guided (in an ideal recess) and free (on open ground).

    With a SUITE: its cases and runs, among which --engine and --support choose. A suite that was ended
    before its end goes on where it was when it is started again with the same folder.

    With --trajectory: that of a shake table or of another code is one more run. With --engine none it is
    held against the reduced model alone.

    Writes summary.csv, the samples as Parquet, report.html and figure.svg.
    """
    from ..pages.case_words import describe
    from .inputs.problem import case_from_options

    with interruptible(_kept(out) if suite else "nothing was written"):
        with user_input():
            from rockwobble.compare import require_runnable, require_writable, with_settings

            if suite is not None:
                refuse_problem_options(context, suite)
                read, runs = _suite(suite, engine, support, time_step)
                cases = list(read.cases)
            else:
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
                cases, runs = [case], _runs(engine, support, time_step, alone=bool(trajectory))
            if setting:
                runs = list(with_settings(cases[0], runs, settings(setting)))
            require_writable(out)
            for each in cases:
                for run in runs:
                    require_runnable(each, run)
            external = _external(
                trajectory, cases, trajectory_angles, trajectory_offset, trajectory_noise_deg
            )
        lines = describe_suite(suite, cases, runs) if suite is not None else describe(cases[0])
        for line in lines:
            print(line)
        if not engine and suite is None:
            _say_what_is_left_out(support or [])
        from ..console.progress import shown_progress

        with user_input(), shown_progress(many=len(cases) > 1) as tell:
            comparison = run_comparison(
                cases,
                runs=runs,
                progress=tell,
                external=external,
                resume=None if suite is None else out,
                budget=budget,
            )
        print_comparison(comparison)
        pages = comparison_pages(comparison, command_line())
        with user_input():
            comparison.save(out, command=command_line(), pages=pages)
    print(f"\nWritten to {out}: manifest.json, {', '.join(pages)} and the tables")


def run_comparison(
    cases: Sequence[Case],
    runs: list[Run],
    progress: Tell,
    external: Sequence[External] = (),
    resume: Path | None = None,
    budget: bool = False,
) -> Comparison:
    """Run engines and models; imported here, because --help must not wait for it."""
    from rockwobble.compare import compare as run
    from rockwobble.models import Suite

    return run(
        Suite(cases, runs), runs=runs, progress=progress, external=external, resume=resume, budget=budget
    )


def _kept(out: Path) -> str:
    return f"the finished runs are kept in {out}, the same command goes on"


def _suite(
    name: str, engines: list[str] | None, supports: list[str] | None, time_step: Any
) -> tuple[Suite, list[Run]]:
    from rockwobble.models import read_suite

    suite = read_suite(name)
    runs, missing = without_missing(chosen_runs(suite, engines, supports, time_step), engines)
    for engine in missing:
        complain(f"{engine} is not installed here and is left out")
    return suite, runs


def _runs(engines: list[str] | None, supports: list[str] | None, time_step: Any, *, alone: bool) -> list[Run]:
    from rockwobble.compare import default_runs
    from rockwobble.models import Run

    if engines == ["none"] and alone:
        return []
    return [
        Run(run.engine, run.support, time_step) for run in default_runs(engines or None, supports or None)
    ]


def _external(
    paths: list[Path] | None,
    cases: Sequence[Case],
    angles: str | None,
    offset: float,
    noise_deg: float | None,
) -> list[External]:
    from rockwobble.compare import External, read_trajectory

    if not paths:
        if angles is not None or offset or noise_deg is not None:
            raise ValueError("--trajectory-angles, -offset and -noise-deg need a --trajectory")
        return []
    if len(cases) > 1:
        raise ValueError(f"--trajectory belongs to one case, got a suite of {len(cases)}")
    noise = None if noise_deg is None else math.radians(noise_deg)
    external = [External(path=path, angle_unit=angles, time_offset=offset, noise=noise) for path in paths]
    for each in external:  # whatever is wrong with a file is said before anything runs
        read_trajectory(each, cases[0])
    return external


def _say_what_is_left_out(supports: list[str]) -> None:
    from rockwobble.compare import missing_engines
    from rockwobble.compare.runs.choice import unsupported

    for name in missing_engines():
        complain(f"{name} is not installed here and is left out")
    for reason in unsupported(supports):
        complain(reason)


def print_comparison(comparison: Comparison) -> None:
    """Print the main columns of the summary, and what they say."""
    from rich.console import Console

    from ..console.summary_table import LEGEND, MINIMUM_WIDTH, summary_table
    from ..pages.comparison.budget_words import budget_lines, parting_lines
    from ..pages.comparison.external_words import LEGEND as EXTERNAL_LEGEND
    from ..pages.comparison.external_words import external_table
    from ..pages.comparison.findings import finding, headline
    from ..pages.comparison.run_remarks import counted_remarks, remark_lines

    console = Console()
    if not console.is_terminal:
        console.width = max(console.width, MINIMUM_WIDTH)
    if len(comparison.cases) > SINGLY:
        _print_groups(comparison, console)
        lines = [*budget_lines(comparison.summary), *parting_lines(comparison.summary)]
        _print_lines([*lines, *counted_remarks(comparison.summary)], console)
        return
    for name, case in comparison.cases.items():
        rows = comparison.summary[comparison.summary["case"] == name]
        console.print()
        console.print(summary_table(rows, console.width))
        console.print(LEGEND, style="dim", highlight=False)
        if (external := external_table(rows)) is not None:
            console.print()
            console.print(external)
            console.print(EXTERNAL_LEGEND, style="dim", highlight=False)
        console.print()
        console.print(headline(rows, case.length), style="bold", highlight=False)
        for _, row in rows.iterrows():
            sentence = textwrap.fill(
                finding(row, case.length), console.width, initial_indent="- ", subsequent_indent="  "
            )
            console.print(sentence, highlight=False, markup=False)
        _print_lines([*remark_lines(rows), *budget_lines(rows), *parting_lines(rows)], console)


def _print_lines(lines: Sequence[str], console: Console) -> None:
    for line in lines:
        words = textwrap.fill(line, console.width, initial_indent="- ", subsequent_indent="  ")
        console.print(words, highlight=False, markup=False)


def _print_groups(comparison: Comparison, console: Console) -> None:
    """Print what many cases say together, and which are the worst."""
    from ..pages.comparison.suite_table import LEGEND, group_table, suite_headline, worst_cases

    lengths = {name: case.length for name, case in comparison.cases.items()}
    console.print()
    console.print(group_table(comparison.summary, lengths))
    console.print(LEGEND, style="dim", highlight=False)
    console.print()
    console.print(suite_headline(comparison.summary), style="bold", highlight=False)
    for line in worst_cases(comparison.summary, lengths):
        sentence = textwrap.fill(line, console.width, initial_indent="- ", subsequent_indent="  ")
        console.print(sentence, highlight=False, markup=False)
