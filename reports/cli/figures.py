"""`rockwobble figures`: the figures of the paper, computed again."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

import rockwobble.compare.storage as rs

from ..console.progress import shown_progress
from ..console.results import show_and_save
from ..console.terminal import interruptible, user_input
from .inputs import options

Grid = Annotated[
    int,
    typer.Option(
        help="Sizes, and intensities, of the maps of figure 6.",
        callback=options.whole(3, 1000),  # three sizes make bands to compare, and a map
    ),
]


def figures(grid: Grid = 100, out: options.Out = Path("rockwobble-figures")) -> None:
    """Compute figures 3 to 6 of the paper again, and compare its statements with the numbers.

    Writes paper.md and paper.html with a verdict on each statement, the figures as SVG, and the data of each
    and the numbers of the statements as Parquet.

    Example: rockwobble figures --grid 20 --out paper
    """
    with interruptible():
        with user_input():
            rs.require_writable(out)
        from ..paper.page import compute

        with shown_progress("figures") as progress:
            found = compute(grid, progress)
        show_and_save(found, out)
