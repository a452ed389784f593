"""`rockwobble report`: the pages of results again, from what is stored."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

import rockwobble.compare.storage as rs

from ...console.terminal import interruptible, user_input
from ...pages.registry import KINDS, stored_page

Folder = Annotated[Path, typer.Argument(help="Folder that a command has written.", show_default=False)]
Out = Annotated[
    Path | None,
    typer.Option(help="Where the pages go. Default: into the folder of the results.", show_default=False),
]


def report(folder: Folder, out: Out = None) -> None:
    """Draw the pages and pictures again of results that are stored. Nothing runs again.

    They say what they said: which engines and records are installed here has no part in it. The results
    stay as they are.

    Example: rockwobble report rockwobble-compare --out pages
    """
    place = folder if out is None else out
    with interruptible(), user_input():
        from rockwobble.compare.storage.manifest import read_manifests, write_pages

        rs.require_writable(place)
        kinds = [made.kind for made in read_manifests(folder) if made.kind in KINDS]
        if not kinds:
            raise ValueError(f"pages are drawn of {', '.join(KINDS)}; {folder} holds none of them")
        drawn = {kind: stored_page(kind, folder).files() for kind in kinds}
        for kind, pages in drawn.items():
            write_pages(place, kind, pages)
    names = dict.fromkeys(name for pages in drawn.values() for name in pages)
    print(f"Written to {place}: {', '.join(names)}")
