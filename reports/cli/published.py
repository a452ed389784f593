"""Commands of the published studies: `rockwobble validity`, `tradeoff`, `extremes` and `figures`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from rockwobble.studies.plans import QuickPlan, ValidityPlan

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
    """Limits of the reduced model: conditions, expected errors, and where they matter.

    Peak tilts of records by the reduced models and by MuJoCo (ideal recess, recess with clearance, flat
    ground), beside a perturbed copy of the model; friction, contact and moment demands of a recess; effects
    of clearance, softer contact and less friction. Takes about 40 minutes on two idle cores; an interrupted
    run resumes.

    With a slab: the same for a frame of one column, without the recess with clearance. With a tendon: shaking
    raised by the factor by which the prestress raises uplift, without the flat-ground model.

    Writes validity.html, validity.md with SVG figures, and as Parquet the tables of all parts and every
    number of the report (limits).

    Example: rockwobble validity --quick --out validity
    """
    with user_input(), results_in(context, "tasks") as progress:
        from rockwobble.studies.validity.study import measure_validity

        found = measure_validity(out, plan, workers=workers, progress=progress)
    show_and_save(found, out)


@takes_options
def tradeoff(
    context: typer.Context,
    plan: QuickPlan,
    out: options.Out = Path("rockwobble-tradeoff"),
    overwrite: options.Overwrite = False,
) -> None:
    """Accuracy against computing time: reduced models, SciPy's solvers and engines on three problems.

    The problems: azimuth jump in a near-upright pass of the free response, 2 x El Centro until ten seconds
    after uplift, and the distribution of peak tilt over synthetic motions. Then the computing time of each
    part of an engine's scene. All runs are timed one after another in one process.

    Writes tradeoff.html, tradeoff.md with SVG figures, and the tables points, problems and scenes as Parquet.

    Example: rockwobble tradeoff --quick --out tradeoff
    """
    with results_in(context, "rounds", resumes=False) as progress:
        from rockwobble.studies.tradeoff.study import measure_tradeoff

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

    Writes extremes.html, extremes.md and extremes.parquet. Exit code 1 if a wrong answer is not flagged.

    Example: rockwobble extremes --quick --out extremes
    """
    with user_input(), results_in(context) as progress:
        from rockwobble.studies.extremes import measure_extremes

        found = measure_extremes(out, plan, workers=workers, progress=progress)
    show_and_save(found, out)
    if (found.extremes["verdict"] == "silent").any():
        raise typer.Exit(FAILED)


def figures(
    context: typer.Context,
    grid: Annotated[
        int,
        typer.Option(
            help="Number of sizes and of intensities in the maps of figure 6.",
            callback=options.whole(3, 1000),  # three sizes make bands to compare, and a map
        ),
    ] = 100,
    out: options.Out = Path("rockwobble-figures"),
    overwrite: options.Overwrite = False,
) -> None:
    """Figures 3 to 6 of the paper, computed again, with a verdict on each of its statements.

    An interrupted run resumes with the same command.

    Writes paper.md and paper.html, the figures as SVG, and the data of figures and statements as Parquet.

    Example: rockwobble figures --out paper
    """
    with user_input(), results_in(context, "parts") as progress:
        from ..paper.page import compute

        found = compute(grid, progress, out)
    show_and_save(found, out)
