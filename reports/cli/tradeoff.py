"""`rockwobble tradeoff`: error against computing time of reduced models, other solvers and engines."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ..console.terminal import interruptible, user_input
from .inputs import options

if TYPE_CHECKING:
    from rockwobble.compare.studies.tradeoff import Tradeoff

Quick = Annotated[
    bool, typer.Option("--quick", help="Fewer points and fewer members: under two minutes on two idle cores.")
]


def tradeoff(
    quick: Quick = False,
    out: options.Out = Path("rockwobble-out"),
) -> None:
    """Measure what accuracy costs: the reduced models, scipy's solvers and the engines on three problems.

    The angle of turn in free response, two times El Centro until ten seconds
    after uplift, and the distribution of peak tilt over synthetic motions;
    then the cost of each part of an engine's scene.

    Writes tradeoff.html (open it in a browser), tradeoff.md and tradeoff.svg,
    the tables as points, problems and scenes (Parquet), and tradeoff.json, which
    says what they were measured with. `rockwobble report` draws the pages again.
    """
    with interruptible():
        with user_input():
            from rockwobble.compare import replace_files, require_writable

            require_writable(out)
        from rockwobble.compare.studies.tradeoff import tradeoff_tables

        from ..pages.tradeoff.page import tradeoff_pages

        found = _measured(quick)
        _show(found)
        contents = tradeoff_pages(found) | tradeoff_tables(found)
        with user_input():
            replace_files(out, contents)
    print(f"\nWritten to {out}: {', '.join(contents)}")


def _measured(quick: bool) -> Tradeoff:
    from rockwobble.compare.studies.tradeoff import STAGES, measure_tradeoff
    from rockwobble.compare.studies.tradeoff.problem import PIER
    from rockwobble.models import Case

    from ..console.spectrum_progress import shown_fraction
    from ..pages.case_words import describe
    from ..pages.provenance import command_line

    print(describe(Case(PIER, duration=1.0, name=""))[0])
    with shown_fraction(STAGES) as tell:
        return measure_tradeoff(quick=quick, command=command_line(), tell=tell)


def _show(found: Tradeoff) -> None:
    from rich import box
    from rich.console import Console
    from rich.table import Table

    from ..console.summary_table import MINIMUM_WIDTH
    from ..pages.tradeoff.words import COST_HEADINGS, cost_rows, headline, statements

    table = Table(box=box.SIMPLE_HEAD, padding=(0, 1, 0, 0), pad_edge=False)
    for heading in COST_HEADINGS:
        table.add_column(heading, overflow="fold")
    rows = cost_rows(found)
    for place, cells in enumerate(rows):
        same = place > 0 and rows[place - 1][0] == cells[0]
        table.add_row("" if same else cells[0], *cells[1:], end_section=False)
    console = Console()
    if not console.is_terminal:
        console.width = max(console.width, MINIMUM_WIDTH, 140)
    console.print(headline(found), style="bold", highlight=False)
    console.print(table)
    for line in statements(found):
        console.print(f"- {line}", highlight=False, markup=False)
