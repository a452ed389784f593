"""`rockwobble validity`: where the reduced model may be trusted, and where not."""

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
    bool, typer.Option("--quick", help="Coarse maps and few runs: some two minutes on two cores.")
]


def validity(
    quick: Quick = False,
    workers: options.Workers = None,
    out: options.Out = Path("rockwobble-validity"),
) -> None:
    """Report the limits of the reduced model: what must hold, what error to expect, where it matters.

    Peaks over records by the reduced models, and by MuJoCo in an ideal recess, in a recess with clearance
    and on flat ground, beside a perturbed copy of the model; what friction, contact and moment a recess
    needs; clearances, softer contact and less friction. Takes about 40 minutes on two idle cores. What is
    measured is kept in the folder: a second run repeats nothing.

    Writes validity.html, validity.md with its pictures as SVG, as Parquet the tables of all parts and every
    number of the report (limits). `rockwobble report` draws the pages again.
    """
    with interruptible(out):
        with user_input():
            rs.require_writable(out)
        from rockwobble.compare.studies.validity.plan import FULL, QUICK
        from rockwobble.compare.studies.validity.study import measure_all, validity_of

        extent = QUICK if quick else FULL
        with user_input(), shown_progress("tasks") as progress:
            tables = measure_all(extent, out, workers=workers, progress=progress)
        show_and_save(validity_of(tables, extent), out)
