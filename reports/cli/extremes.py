"""`rockwobble extremes`: every method under extreme conditions, with a verdict on each run."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

import rockwobble.compare.storage as rs

from ..console.progress import shown_progress
from ..console.results import show_and_save
from ..console.terminal import FAILED, interruptible, user_input
from .inputs import options

Quick = Annotated[
    bool,
    typer.Option("--quick", help="Only the two ends of each extreme: some two minutes on two idle cores."),
]


def extremes(
    quick: Quick = False, workers: options.Workers = None, out: options.Out = Path("rockwobble-extremes")
) -> None:
    """Take one thing at a time to its extreme: is the answer right, and if not, does the run say so.

    Spin, slenderness, size, gravity, intensity, sample spacing, duration, time
    step, contact stiffness, friction. Each verdict is backed by an exact answer,
    an invariant or a converged reference; a wrong run counts as flagged only if
    one of its diagnostics explains the error.

    Writes extremes.html (open it in a browser), extremes.md and the table as
    extremes.parquet. `rockwobble report` draws the pages again. Exit code 1 if
    anything is wrong and nothing explains it.
    """
    with interruptible(out):
        with user_input():
            rs.require_writable(out)
        from rockwobble.compare.studies.extremes.study import measure_extremes

        with user_input(), shown_progress() as tell:
            found = measure_extremes(out, quick=quick, workers=workers, progress=tell)
        show_and_save(found, out)
    if (found.extremes["verdict"] == "silent").any():
        raise typer.Exit(FAILED)
