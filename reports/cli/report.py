"""`rockwobble report`: the pages of a study again, from its stored results."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ..console.terminal import interruptible, user_input

Folder = Annotated[
    Path,
    typer.Argument(
        help="Folder that `compare`, `ensemble`, `validity`, `tradeoff` or `extremes` has written.",
        show_default=False,
    ),
]
Out = Annotated[
    Path | None,
    typer.Option(
        "--out", help="Where the pages go. Default: into the folder of the results.", show_default=False
    ),
]


def report(folder: Folder, out: Out = None) -> None:
    """Draw the pages and pictures of a study again from its stored results. Nothing runs again.

    They say what they said: which engines and records are installed here has no part in it. The results
    stay as they are.
    """
    place = folder if out is None else out
    with interruptible():
        with user_input():
            from rockwobble.compare import replace_files, require_writable

            from .studies import read_studies

            studies = read_studies(folder)
            require_writable(place)
        pages = {name: content for draw in studies for name, content in draw().items()}
        with user_input():
            replace_files(place, pages)
    print(f"Written to {place}: {', '.join(pages)}")
