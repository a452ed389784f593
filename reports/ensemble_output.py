"""What an ensemble found: its tables in the terminal, and its files."""

from __future__ import annotations

from typing import TYPE_CHECKING

from .ensemble_words import (
    CONTRASTS,
    LEGEND,
    METHODS,
    OVERTURNING,
    WORDS,
    contrast_rows,
    method_rows,
    overturning_rows,
    statements,
)
from .summary_table import MINIMUM_WIDTH

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rich.table import Table

    from rockwobble.compare import Ensemble

# columns of a table with the longest names
_WIDEST = 1000


def print_ensemble(found: Ensemble) -> None:
    """Print the tables of methods, of each against each and of overturning, and what they say in words."""
    from rich.console import Console

    console = Console()
    contrasts = _table(CONTRASTS, contrast_rows(found))
    needed = contrasts.__rich_measure__(console, console.options.update(max_width=_WIDEST)).maximum
    if not console.is_terminal:
        console.width = max(console.width, MINIMUM_WIDTH, needed)
    elif console.width < needed:
        contrasts = _table(CONTRASTS, contrast_rows(found, intervals=False))
    console.print()
    falls = _table(OVERTURNING, overturning_rows(found))
    for table in (_table(METHODS, method_rows(found)), contrasts, falls):
        if table.row_count:
            console.print(table)
            console.print()
    console.print(LEGEND, style="dim", highlight=False)
    console.print()
    for i, sentence in enumerate(statements(found)):
        console.print(sentence, style="bold" if i == 0 else "", highlight=False, markup=False)


def _table(headings: Sequence[str], rows: Sequence[Sequence[str]]) -> Table:
    from rich import box
    from rich.table import Table
    from rich.text import Text

    table = Table(box=box.SIMPLE_HEAD, padding=(0, 1, 0, 0), pad_edge=False, show_edge=False)
    for heading in headings:
        # a narrow terminal has room for one word of a heading; as a text, because brackets are markup
        name = heading if heading in WORDS else "\n".join(heading.rsplit(" ", 1))
        table.add_column(Text(name), justify="left" if heading in WORDS else "right", no_wrap=True)
    for row in rows:
        table.add_row(*map(Text, row))
    return table


def ensemble_files(found: Ensemble) -> dict[str, bytes]:
    """Return name and content of each file: the numbers, and the pages that are drawn from them."""
    from rockwobble.compare import plain_json
    from rockwobble.compare.parquet_file import pack

    return {
        "members.csv": found.members.to_csv(index=False).encode(),
        "methods.csv": found.methods.to_csv(index=False).encode(),
        "contrasts.csv": found.contrasts.to_csv(index=False).encode(),
        "members.parquet": pack(found.members, found.about),
        "ensemble.json": (plain_json.dumps(found.about, indent=2) + "\n").encode(),
    } | ensemble_pages(found)


def ensemble_pages(found: Ensemble) -> dict[str, bytes]:
    """Return name and content of each page and picture."""
    from .ensemble_document import ensemble_document
    from .ensemble_figure import ensemble_figure
    from .ensemble_page import ensemble_page

    return {
        "ensemble.md": ensemble_document(found).encode(),
        "ensemble.svg": ensemble_figure(found),
        "ensemble.html": ensemble_page(found).encode(),
    }
