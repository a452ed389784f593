"""Tables and progress of the commands of this folder."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from rockwobble.compare.runs.progress import Progress

if TYPE_CHECKING:
    import pandas as pd


def options_of(name: str, description: str) -> argparse.ArgumentParser:
    """Parser of a script of this folder, to which it adds its options."""
    return argparse.ArgumentParser(prog=f"python tests/benchmarks {name}", description=description)


def tell(event: Progress) -> None:
    """Report a finished run on standard error."""
    if event.state == "finished":
        print(f"{event.done}/{event.total} {event.label}", file=sys.stderr, flush=True)


def show(table: pd.DataFrame, title: str, formats: Mapping[str, str], note: str = "") -> None:
    """Print a table with rich.

    Parameters
    ----------
    table : DataFrame
    title : str
    formats : mapping
        For each column that is shown, in this order, how its values are printed, such as ".1e"; "" for
        text. What is not finite is shown as a dash.
    note : str, optional
        Below the table.
    """
    from rich.console import Console
    from rich.table import Table

    shown = Table(title=title, caption=note or None, title_justify="left", caption_justify="left")
    for name, form in formats.items():
        fold = name == "diagnostics"
        heading, side = name.replace("_", " "), "right" if form else "left"
        shown.add_column(heading, justify=side, overflow="fold", no_wrap=not fold)  # type: ignore[arg-type]
    for row in table.to_dict("records"):
        shown.add_row(*(_text(row[name], form) for name, form in formats.items()))
    # unfolded output for programs and files
    console = Console(width=None if sys.stdout.isatty() else 200)
    console.print(shown)


def _text(value: Any, form: str) -> str:
    if not form:
        return str(value)
    return f"{value:{form}}" if abs(value) < float("inf") else "-"
