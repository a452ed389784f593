"""The end of a command: its files are written, and its report or the facts of a result are printed."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from .terminal import user_input

if TYPE_CHECKING:
    from rich.text import Text

    from rockwobble.compare.storage.results import Results


def print_facts(heading: Sequence[str | Text], facts: Mapping[str, str]) -> None:
    """Print a heading and facts by their names, as text, in which brackets are no markup."""
    from rich import box
    from rich.console import Console
    from rich.table import Table
    from rich.text import Text

    table = Table(box=box.SIMPLE_HEAD, show_header=False, padding=(0, 2, 0, 0), pad_edge=False)
    table.add_column(no_wrap=True)
    table.add_column(overflow="fold")
    for name, fact in facts.items():
        table.add_row(Text(name), Text(fact))
    console = Console()
    console.print(*heading, highlight=False)
    console.print(table)


def show_and_save(found: Results, out: Path, *, details: bool = False) -> None:
    """Write results with their page; then print the page, with what is folded where `details` are wanted."""
    save_with_page(found, out, details=details)()


def save_with_page(found: Results, out: Path, *, details: bool = False) -> Callable[[], None]:
    """Write results with their page, and return what prints the page."""
    from ..pages.registry import page_of
    from .terminal import command_line

    found = found.made_by(command_line())
    page = page_of(found)
    pages = page.files()
    with user_input():
        found.save(out, pages=pages)

    def show() -> None:
        page.show(details=details)
        names = ["manifest.json", *(f"{name}.parquet" for name in found.tables), *found.sheets(), *pages]
        print(f"\nWritten to {out}: {', '.join(dict.fromkeys(names))}")

    return show
