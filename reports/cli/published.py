"""Command of a published study that users run on their own bodies: `rockwobble validity`."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import typer

from rockwobble.studies.plans import ValidityPlan

from . import options
from .command import Work, saves_results

if TYPE_CHECKING:
    from rockwobble.compare.runs.progress import ProgressCallback
    from rockwobble.compare.storage.results import Results


@saves_results
def validity(context: typer.Context, plan: ValidityPlan, workers: options.Workers = None) -> Work:
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
    from rockwobble.studies.validity.study import measure_validity

    def run(resume: Path, progress: ProgressCallback) -> Results:
        return measure_validity(resume, plan, workers=workers, progress=progress)

    return Work(run, what="tasks", resumes=True)
