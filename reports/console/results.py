"""The end of a command: its files are written, and its report or the facts of a result are printed."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from .terminal import user_input

if TYPE_CHECKING:
    import pandas as pd
    from rich.text import Text

    from rockwobble.compare.storage.manifest import Manifest
    from rockwobble.compare.storage.results import Results

    from ..pages.page import Page


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


def show_and_write(
    out: Path,
    page: Page,
    manifest: Manifest,
    tables: Mapping[str, pd.DataFrame],
    files: Mapping[str, bytes] | None = None,
) -> None:
    """Write a page with its tables, other files of data and the manifest; then print it."""
    from rockwobble.compare.storage.manifest import MANIFEST, write_results

    pages = page.files()
    with user_input():
        write_results(out, manifest, tables, files=files, pages=pages)
    page.show()
    names = [MANIFEST, *(f"{name}.parquet" for name in tables), *(files or ()), *pages]
    print(f"\nWritten to {out}: {', '.join(dict.fromkeys(names))}")


def show_and_save(found: Results, out: Path, *, details: bool = False) -> None:
    """Write results with their page; then print the page, with what is folded where `details` are wanted."""
    from ..pages.registry import page_of
    from .terminal import command_line

    found = found.made_by(command_line())
    page = page_of(found)
    pages = page.files()
    with user_input():
        found.save(out, pages=pages)
    page.show(details=details)
    names = ["manifest.json", *(f"{name}.parquet" for name in found.tables), *found.sheets(), *pages]
    print(f"\nWritten to {out}: {', '.join(dict.fromkeys(names))}")
