"""What an ensemble found: its tables in the terminal, and its files."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..pages.ensemble.words import LEGEND, WORDS, statements, tables
from .summary_table import MINIMUM_WIDTH

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rich.table import Table

    from rockwobble.compare import Ensemble

# columns of a table with the longest names
_WIDEST = 1000
# what a narrow terminal leaves out, beside the intervals; all of it is in the files
_LEFT_OUT = ("lower", "5 to 95 %", "p (Holm)", "within reach", "neither")


def print_ensemble(found: Ensemble) -> None:
    """Print the tables of methods, of each against each and of overturning, and what they say in words."""
    from rich.console import Console

    console = Console()
    shown: list[tuple[Sequence[str], Sequence[Sequence[str]]]]
    shown = [(headings, rows) for _, headings, rows in tables(found)]
    measure = console.options.update(max_width=_WIDEST)
    needed = max(_table(*table).__rich_measure__(console, measure).maximum for table in shown)
    if not console.is_terminal:
        console.width = max(console.width, MINIMUM_WIDTH, needed)
    elif console.width < needed:
        shown = [_narrow(*table) for table in shown]
    console.print()
    for table in shown:
        console.print(_table(*table))
        console.print()
    console.print(LEGEND, style="dim", highlight=False)
    console.print()
    for i, sentence in enumerate(statements(found)):
        console.print(sentence, style="bold" if i == 0 else "", highlight=False, markup=False)


def _narrow(headings: Sequence[str], rows: Sequence[Sequence[str]]) -> tuple[list[str], list[list[str]]]:
    """Return a table without its intervals and its last details."""
    kept = [(index, name in WORDS) for index, name in enumerate(headings) if name not in _LEFT_OUT]
    return (
        [headings[index] for index, _ in kept],
        [[row[index] if words else row[index].split(" (")[0] for index, words in kept] for row in rows],
    )


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
    from rockwobble.compare.storage.parquet_file import pack
    from rockwobble.models import plain_json

    return {
        "members.csv": found.members.to_csv(index=False).encode(),
        "methods.csv": found.methods.to_csv(index=False).encode(),
        "contrasts.csv": found.contrasts.to_csv(index=False).encode(),
        "members.parquet": pack(found.members, found.about),
        "ensemble.json": (plain_json.dumps(found.about, indent=2) + "\n").encode(),
    } | ensemble_pages(found)


def ensemble_pages(found: Ensemble) -> dict[str, bytes]:
    """Return name and content of each page and picture."""
    from ..figures.ensemble_figure import ensemble_figure
    from ..pages.ensemble.document import ensemble_document
    from ..pages.ensemble.page import ensemble_page

    return {
        "ensemble.md": ensemble_document(found).encode(),
        "ensemble.svg": ensemble_figure(found),
        "ensemble.html": ensemble_page(found).encode(),
    }
