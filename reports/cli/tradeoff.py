"""`rockwobble tradeoff`: error against computing time of reduced models, other solvers and engines."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

import rockwobble.compare.storage as rs

from ..console.progress import shown_progress
from ..console.results import show_and_save
from ..console.terminal import interruptible, user_input
from .inputs import options

Quick = Annotated[
    bool, typer.Option("--quick", help="Fewer points and fewer members: some two minutes on two idle cores.")
]


def tradeoff(quick: Quick = False, out: options.Out = Path("rockwobble-tradeoff")) -> None:
    """Measure what accuracy costs: the reduced models, scipy's solvers and the engines on three problems.

    The angle of turn in free response, two times El Centro until ten seconds
    after uplift, and the distribution of peak tilt over synthetic motions;
    then the cost of each part of an engine's scene. All runs are timed in
    turn, one after another in one process.

    Writes tradeoff.html (open it in a browser), tradeoff.md with its pictures
    as SVG, and the tables points, problems and scenes as Parquet. `rockwobble
    report` draws the pages again.
    """
    with interruptible():
        with user_input():
            rs.require_writable(out)
        from rockwobble.compare.studies.tradeoff.study import measure_tradeoff

        with shown_progress("rounds") as tell:
            found = measure_tradeoff(quick=quick, progress=tell)
        show_and_save(found, out)
