"""`rockwobble validity`: where the reduced model may be trusted, and where not."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ..console.terminal import interruptible, user_input
from .inputs import options

Quick = Annotated[
    bool, typer.Option("--quick", help="Coarse maps and few runs: under two minutes on two cores.")
]
Workers = Annotated[
    int | None, typer.Option("--workers", help="Processes that measure side by side; default: one a core.")
]


def validity(
    quick: Quick = False,
    workers: Workers = None,
    out: options.Out = Path("rockwobble-validity"),
) -> None:
    """Report the limits of the reduced model: where to use it, what error to expect, where not to.

    Maps over slenderness, release, spin, size and intensity how recess and
    rolling differ and what friction, contact and couple a recess needs, and
    runs MuJoCo on points of these maps, with less friction, in real recesses,
    with softer contact, and over many records. Takes under half an hour on two
    cores. What is measured is kept in the folder: a second run repeats nothing.

    Writes validity.html, validity.md with its pictures as SVG, as Parquet the
    tables of all parts and the limits (limits), and validity.json, which says
    what they were measured from. `rockwobble report` draws the pages again.
    """
    with interruptible("what was measured so far is kept, and the next run goes on from there"):
        with user_input():
            from rockwobble.compare import replace_files, require_writable

            if workers is not None and workers < 1:
                raise ValueError(f"--workers must be at least 1, got {workers}")
            require_writable(out)
        from rockwobble.compare.studies.validity import (
            FULL,
            QUICK,
            measure_all,
            planned,
            validity_now,
            validity_tables,
        )

        from ..pages.provenance import command_line
        from ..pages.validity.about import about
        from ..pages.validity.output import print_limits, validity_pages
        from ..pages.validity.progress import shown_campaign

        extent = QUICK if quick else FULL
        for line in about(**planned(extent)):
            print(line, flush=True)
        with user_input(), shown_campaign() as tell:
            tables = measure_all(extent, out, workers=workers, progress=tell)
        found = validity_now(tables, extent, command_line())
        print_limits(found)
        contents = validity_pages(found) | validity_tables(found)
        with user_input():
            replace_files(out, contents)
    print(f"\nWritten to {out}: {', '.join(contents)}")
