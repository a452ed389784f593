"""`rockwobble report`: the page of a comparison again, from its stored results."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from .comparison_pages import comparison_pages
from .paper.provenance import command_line
from .terminal import interruptible, user_input

Folder = Annotated[
    Path, typer.Argument(help="Folder that `rockwobble compare` has written.", show_default=False)
]


def report(folder: Folder) -> None:
    """Rebuild the page and the picture of a comparison from its stored results. Nothing runs again.

    Replaces report.html and figure.svg in the folder; the results stay as they are.
    """
    with interruptible():
        with user_input():
            from rockwobble.compare import Comparison, replace_files, require_writable

            comparison = Comparison.load(folder)
            require_writable(folder)
        pages = comparison_pages(comparison, command_line())
        with user_input():
            replace_files(folder, pages)
    print(f"Written to {folder}: {', '.join(pages)}")
