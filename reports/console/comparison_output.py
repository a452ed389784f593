"""The result of a comparison in a terminal."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence
from typing import TYPE_CHECKING

from ..figures.case_view import case_views
from ..pages.comparison.budget_words import budget_lines, divergence_lines
from ..pages.comparison.external_words import TITLES as EXTERNAL_TITLES
from ..pages.comparison.external_words import external_cells
from ..pages.comparison.files import SINGLY
from ..pages.comparison.findings import counted_remarks, finding_sentences, headline
from ..pages.comparison.suite_table import LEGEND as GROUPS_LEGEND
from ..pages.comparison.suite_table import group_table, suite_headline, worst_cases
from .summary_table import EXTERNAL_LEGEND, LEGEND, MINIMUM_WIDTH, external_table, summary_table

if TYPE_CHECKING:
    from rich.console import Console

    from rockwobble.compare import Comparison


def print_comparison(comparison: Comparison) -> None:
    """Print the main columns of the summary, and what they say."""
    from rich.console import Console

    console = Console()
    if not console.is_terminal:
        console.width = max(console.width, MINIMUM_WIDTH)
    if len(comparison.cases) > SINGLY:
        _print_groups(comparison, console)
        return
    for view in case_views(comparison):
        rows = view.rows
        console.print()
        console.print(summary_table(rows, console.width))
        console.print(LEGEND, style="dim", highlight=False)
        if cells := external_cells(rows):
            console.print()
            console.print(external_table(EXTERNAL_TITLES, cells))
            console.print(EXTERNAL_LEGEND, style="dim", highlight=False)
        console.print()
        console.print(headline(rows, view.case.length), style="bold", highlight=False)
        _print_lines([*finding_sentences(view), *budget_lines(rows), *divergence_lines(rows)], console)


def _print_groups(comparison: Comparison, console: Console) -> None:
    """Print what many cases say together, and which are the worst."""
    lengths = {name: case.length for name, case in comparison.cases.items()}
    summary = comparison.summary
    console.print()
    console.print(group_table(summary, lengths))
    console.print(GROUPS_LEGEND, style="dim", highlight=False)
    console.print()
    console.print(suite_headline(summary), style="bold", highlight=False)
    lines = [*worst_cases(summary, lengths), *budget_lines(summary), *divergence_lines(summary)]
    _print_lines([*lines, *counted_remarks(summary)], console)


def _print_lines(lines: Sequence[str], console: Console) -> None:
    for line in lines:
        words = textwrap.fill(line, console.width, initial_indent="- ", subsequent_indent="  ")
        console.print(words, highlight=False, markup=False)
