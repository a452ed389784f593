"""`rockwobble extremes`: what breaks first, and whether it says so."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ..console.terminal import FAILED, interruptible, user_input
from .inputs import options

if TYPE_CHECKING:
    import pandas as pd

Quick = Annotated[
    bool,
    typer.Option("--quick", help="Only the two ends of each extreme: under two minutes on two idle cores."),
]
Workers = Annotated[
    int | None, typer.Option("--workers", min=1, help="Processes. Default: one for each core.")
]


def extremes(
    quick: Quick = False,
    workers: Workers = None,
    out: options.Out = Path("rockwobble-out"),
) -> None:
    """Take one thing at a time to its extreme: is the answer right, and if not, does the run say so.

    Spin, slenderness, size, gravity, intensity, sample spacing, duration, time
    step, contact stiffness, friction. Each verdict is backed by an exact answer,
    an invariant or a converged reference.

    Writes extremes.html (open it in a browser), extremes.md, extremes.svg, the
    table as extremes.parquet, and extremes.json, which says what made it.
    `rockwobble report` draws the pages again. Exit code 1 if anything is wrong
    and does not say so.
    """
    with interruptible():
        with user_input():
            from rockwobble.compare import replace_files, require_writable

            require_writable(out)
        from rockwobble.compare.storage.origin import origin_now
        from rockwobble.compare.studies.extremes import STAGES, Extremes, extremes_tables, measure_extremes

        from ..console.spectrum_progress import shown_fraction
        from ..pages.extremes.page import extremes_pages
        from ..pages.provenance import command_line

        print("Cylinder: R = 6 m, tan alpha = 0.2, one thing at a time at its extreme")
        with shown_fraction(STAGES) as tell:
            table = measure_extremes(quick=quick, workers=workers, tell=tell)
        _show(table)
        found = Extremes(table=table, origin=origin_now(command_line()))
        contents = extremes_pages(found) | extremes_tables(found)
        with user_input():
            replace_files(out, contents)
    print(f"\nWritten to {out}: {', '.join(contents)}")
    if (table["verdict"] == "silent").any():
        raise typer.Exit(FAILED)


def _show(table: pd.DataFrame) -> None:
    from rich import box
    from rich.console import Console
    from rich.table import Table

    from ..pages.extremes.words import LEGEND, cell, headline, matrix, statements

    methods, conditions = matrix(table)
    shown = Table(box=box.SIMPLE_HEAD, padding=(0, 1, 0, 0), pad_edge=False)
    for heading in ("extreme", *methods):
        shown.add_column(heading.replace(" ", "\n"), no_wrap=True)
    for name, rows in conditions:
        shown.add_row(name, *(cell(row) for row in rows))
    console = Console()
    if not console.is_terminal:
        console.width = max(console.width, 180)
    console.print(shown)
    console.print(LEGEND, style="dim", highlight=False)
    console.print(headline(table), style="bold", highlight=False)
    for line in statements(table):
        console.print(f"- {line}", highlight=False, markup=False)
