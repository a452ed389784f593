"""Command of a published study that people make for bodies of their own: `rockwobble validity`."""

from __future__ import annotations

from pathlib import Path

import typer

from rockwobble.studies.plans import ValidityPlan

from ..console import show_and_save, user_input
from . import options
from .command import takes_options
from .outputs import results_in


@takes_options
def validity(
    context: typer.Context,
    plan: ValidityPlan,
    workers: options.Workers = None,
    out: options.Out = Path("rockwobble-validity"),
    overwrite: options.Overwrite = False,
) -> None:
    """Limits of the reduced model: conditions, expected errors, and where they matter.

    Peak tilts of records by the reduced models and by MuJoCo (ideal recess, recess with clearance, flat
    ground), beside a perturbed copy of the model; friction, contact and moment demands of a recess; effects
    of clearance, softer contact and less friction. Takes about 40 minutes on two idle cores; an interrupted
    run resumes.

    With a slab: the same for a frame of one column, without the recess with clearance. With a tendon: shaking
    raised by the factor by which the prestress raises uplift, without the flat-ground model.

    Writes validity.html, and as Parquet the tables of all parts and every
    number of the report (limits).

    Example: rockwobble validity --quick --out validity
    """
    with user_input(), results_in(context, "tasks") as progress:
        from rockwobble.studies.validity.study import measure_validity

        found = measure_validity(out, plan, workers=workers, progress=progress)
    show_and_save(found, out)
