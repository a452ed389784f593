"""Commands of the published studies: `rockwobble validity`, `tradeoff`, `extremes` and `figures`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from rockwobble.compare.studies.plans import QuickPlan, ValidityPlan

from ..console import FAILED, show_and_save, user_input
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
    """Report the limits of the reduced model: what must hold, what error to expect, where it matters.

    Peaks over records by the reduced models, and by MuJoCo in an ideal recess, in a recess with clearance
    and on flat ground, beside a perturbed copy of the model; what friction, contact and moment a recess
    needs; clearances, softer contact and less friction. Takes about 40 minutes on two idle cores. What is
    measured is kept in the folder: a second run repeats nothing.

    With a slab the same of a frame of one column. A recess with clearance, which takes no slab, is left out.

    Writes validity.html, validity.md with its pictures as SVG, as Parquet the tables of all parts and every
    number of the report (limits). `rockwobble report` draws the pages again.

    Example: rockwobble validity --quick --out validity
    """
    with user_input(), results_in(context, "tasks") as progress:
        from rockwobble.compare.studies.validity.study import measure_validity

        found = measure_validity(out, plan, workers=workers, progress=progress)
    show_and_save(found, out)


@takes_options
def tradeoff(
    context: typer.Context,
    plan: QuickPlan,
    out: options.Out = Path("rockwobble-tradeoff"),
    overwrite: options.Overwrite = False,
) -> None:
    """Measure what accuracy costs: the reduced models, scipy's solvers and the engines on three problems.

    The angle of turn in free response, two times El Centro until ten seconds after uplift, and the
    distribution of peak tilt over synthetic ground motions; then the cost of each part of an engine's scene.
    All runs are timed in turn, one after another in one process.

    Writes tradeoff.html (open it in a browser), tradeoff.md with its pictures as SVG, and the tables points,
    problems and scenes as Parquet. `rockwobble report` draws the pages again.

    Example: rockwobble tradeoff --quick --out tradeoff
    """
    with results_in(context, "rounds", resumes=False) as progress:
        from rockwobble.compare.studies.tradeoff.study import measure_tradeoff

        found = measure_tradeoff(plan, progress=progress)
    show_and_save(found, out)


@takes_options
def extremes(
    context: typer.Context,
    plan: QuickPlan,
    workers: options.Workers = None,
    out: options.Out = Path("rockwobble-extremes"),
    overwrite: options.Overwrite = False,
) -> None:
    """Stress tests: one parameter at its extreme, and whether wrong answers are flagged.

    Spin, slenderness, size, gravity, intensity, sample spacing, duration, time step, contact stiffness,
    friction. Each verdict is backed by an exact answer, an invariant or a converged reference; a wrong run
    counts as flagged only if one of its diagnostics explains the error.

    Writes extremes.html (open it in a browser), extremes.md and the table as extremes.parquet. `rockwobble
    report` draws the pages again. Exit code 1 if anything is wrong and nothing explains it.

    Example: rockwobble extremes --quick --out extremes
    """
    with user_input(), results_in(context) as progress:
        from rockwobble.compare.studies.extremes import measure_extremes

        found = measure_extremes(out, plan, workers=workers, progress=progress)
    show_and_save(found, out)
    if (found.extremes["verdict"] == "silent").any():
        raise typer.Exit(FAILED)


def figures(
    context: typer.Context,
    grid: Annotated[
        int,
        typer.Option(
            help="Sizes, and intensities, of the maps of figure 6.",
            callback=options.whole(3, 1000),  # three sizes make bands to compare, and a map
        ),
    ] = 100,
    out: options.Out = Path("rockwobble-figures"),
    overwrite: options.Overwrite = False,
) -> None:
    """Compute figures 3 to 6 of the paper again, and compare its statements with the numbers.

    Whatever ends it, the same command resumes.

    Writes paper.md and paper.html with a verdict on each statement, the figures as SVG, and the data of each
    and the numbers of the statements as Parquet.

    Example: rockwobble figures --out paper
    """
    with user_input(), results_in(context, "parts") as progress:
        from ..paper.page import compute

        found = compute(grid, progress, out)
    show_and_save(found, out)
