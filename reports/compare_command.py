"""`rockwobble compare`: reduced model and engines on one problem."""

from __future__ import annotations

import shlex
import sys
import textwrap
from pathlib import Path
from typing import TYPE_CHECKING

from . import options
from .terminal import complain, interruptible, user_input

if TYPE_CHECKING:
    from rockwobble.compare import Comparison
    from rockwobble.models import Case, Run

    from .progress import Tell


def compare(
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
    out: options.Out = Path("rockwobble-out"),
) -> None:
    """Run the reduced model and the engines on one problem, and report how long they agree.

    Without options: the 1940 El Centro record on R = 6 m, tan alpha = 0.2, every installed engine,
    guided (in an ideal recess) and free (on open ground).

    Writes summary.csv, the samples as Parquet, report.html and figure.svg.
    """
    from .problem import case_from_options, describe

    with interruptible():
        with user_input():
            from rockwobble.compare import replace_files, require_runnable, require_writable

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
            runs = _runs(engine, support, time_step)
            for run in runs:
                require_runnable(case, run)
        for line in describe(case):
            print(line)
        if not engine:
            _say_what_is_left_out()
        from .progress import shown_progress

        with user_input(), shown_progress() as tell:
            comparison = run_comparison(case, runs=runs, progress=tell)
        print_comparison(comparison)
        contents = _contents(comparison)
        with user_input():
            replace_files(out, contents)
    print(f"\nWritten to {out}: {', '.join(contents)}")


def run_comparison(case: Case, runs: list[Run], progress: Tell) -> Comparison:
    """Run engines and models; imported here, because --help must not wait for it."""
    from rockwobble.compare import compare as run

    return run(case, runs=runs, progress=progress)


def _runs(engines: list[str] | None, supports: list[str] | None, time_step: float | None) -> list[Run]:
    from rockwobble.compare import default_runs
    from rockwobble.models import Run

    return [
        Run(run.engine, run.support, time_step) for run in default_runs(engines or None, supports or None)
    ]


def _say_what_is_left_out() -> None:
    from rockwobble.compare import missing_engines, reserved_engines

    for name in missing_engines():
        complain(f"{name} is not installed here and is left out")
    for name, reason in reserved_engines().items():
        complain(f"{reason}: left out, --engine {name} asks for it")


def print_comparison(comparison: Comparison) -> None:
    """Print the main columns of the summary, and what they say."""
    from rich.console import Console

    from .findings import finding, headline
    from .summary_table import LEGEND, MINIMUM_WIDTH, summary_table

    console = Console()
    if not console.is_terminal:
        console.width = max(console.width, MINIMUM_WIDTH)
    for name, case in comparison.cases.items():
        rows = comparison.summary[comparison.summary["case"] == name]
        console.print()
        console.print(summary_table(rows, console.width))
        console.print(LEGEND, style="dim", highlight=False)
        console.print()
        console.print(headline(rows, case.length), style="bold", highlight=False)
        for _, row in rows.iterrows():
            sentence = textwrap.fill(
                finding(row, case.length), console.width, initial_indent="- ", subsequent_indent="  "
            )
            console.print(sentence, highlight=False, markup=False)


def _contents(comparison: Comparison) -> dict[str, bytes]:
    from .figure import comparison_figure
    from .page import comparison_page

    command = shlex.join(["rockwobble", *sys.argv[1:]])
    page = comparison_page(comparison, command)
    return {
        **comparison.files(),
        "report.html": page.encode(),
        "figure.svg": comparison_figure(comparison),
    }
