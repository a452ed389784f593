"""`rockwobble validity`: where the reduced model may be trusted, and where not."""

from __future__ import annotations

from pathlib import Path

import rockwobble.compare.storage as rs
from rockwobble.compare.studies.plans import ValidityPlan

from ..console.progress import shown_progress
from ..console.results import show_and_save
from ..console.terminal import interruptible, user_input
from .inputs import options
from .inputs.plan_options import takes_options


@takes_options
def validity(
    plan: ValidityPlan,
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
        from rockwobble.compare.studies.validity.study import measure_validity

        with user_input(), shown_progress("tasks") as progress:
            found = measure_validity(out, plan, workers=workers, progress=progress)
        show_and_save(found, out)
