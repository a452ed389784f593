"""`rockwobble extremes`: every method under extreme conditions, with a verdict on each run."""

from __future__ import annotations

from pathlib import Path

import typer

import rockwobble.compare.storage as rs
from rockwobble.compare.studies.plans import ExtremesPlan

from ..console.progress import shown_progress
from ..console.results import show_and_save
from ..console.terminal import FAILED, interruptible, user_input
from .inputs import options
from .inputs.plan_options import takes_options


@takes_options
def extremes(
    plan: ExtremesPlan,
    workers: options.Workers = None,
    out: options.Out = Path("rockwobble-extremes"),
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
        from rockwobble.compare.studies.extremes import measure_extremes

        with user_input(), shown_progress() as progress:
            found = measure_extremes(out, plan, workers=workers, progress=progress)
        show_and_save(found, out)
    if (found.extremes["verdict"] == "silent").any():
        raise typer.Exit(FAILED)
