"""`rockwobble ensemble`: distributions of peak tilt, for what lies beyond the agreement of traces."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from . import options
from .terminal import interruptible, user_input

if TYPE_CHECKING:
    from rockwobble.compare import Ensemble
    from rockwobble.models import Case

Members = Annotated[int, typer.Option("--members", help="Number of members, where no suite gives them.")]
Perturbation = Annotated[
    float,
    typer.Option(
        "--perturbation",
        help="Relative standard deviation of tilt and rolling rate at release, or of the two components "
        "of the ground motion.",
    ),
]
Synthetic = Annotated[
    float | None,
    typer.Option(
        "--synthetic",
        help="Made-up ground motions instead of perturbed starts, with a peak of so many times g tan alpha.",
    ),
]
Seed = Annotated[int, typer.Option("--seed", help="Of everything random.")]


def ensemble(
    suite: options.SuiteName = None,
    semidiagonal: options.Semidiagonal = 6.0,
    tan_alpha: options.TanAlpha = 0.2,
    record_x: options.RecordX = None,
    record_y: options.RecordY = None,
    record_z: options.RecordZ = None,
    units: options.Units = None,
    scale: options.Scale = 1.0,
    release_tilt_deg: options.ReleaseTilt = None,
    rolling_rate: options.RollingRate = 0.0,
    duration: options.Duration = None,
    members: Members = 20,
    perturbation: Perturbation = 0.01,
    synthetic: Synthetic = None,
    seed: Seed = 0,
    engine: options.Engines = None,
    support: options.Supports = None,
    time_step: options.TimeStep = None,
    out: options.Out = Path("rockwobble-ensemble"),
) -> None:
    """Hold the distributions of peak tilt by each method against each other.

    Without options: El Centro on R = 6 m, tan alpha = 0.2, with 20 slightly different starts. With a
    SUITE its cases are the members. --engine none runs the reduced models alone.

    Writes members, methods and contrasts as CSV and members as Parquet, ensemble.json, ensemble.svg and
    ensemble.html.
    """
    from .problem import case_from_options, describe

    with interruptible():
        with user_input():
            from rockwobble import compare
            from rockwobble.models import Run, read_suite

            compare.require_writable(out)
            runs = None
            if engine == ["none"]:
                runs = []
            elif suite is None or engine or support or time_step:
                runs = [
                    Run(run.engine, run.support, time_step)
                    for run in compare.default_runs(engine or None, support or None)
                ]
            problem: Any
            if suite is not None:
                problem = read_suite(suite)
                print(f"Suite {suite}: {len(problem.cases)} members")
            else:
                case = case_from_options(
                    semidiagonal=semidiagonal,
                    tan_alpha=tan_alpha,
                    record_x=record_x,
                    record_y=record_y,
                    record_z=record_z,
                    units=units,
                    scale=scale,
                    release_tilt_deg=release_tilt_deg,
                    rolling_rate=rolling_rate,
                    duration=duration,
                )
                problem = case if synthetic is None else _synthetic(case, members, synthetic, seed)
                for line in describe(case if synthetic is None else problem[0]):
                    print(line)
                print(f"Members: {members}, seed {seed}, {_kind(perturbation, synthetic)}")
        from .progress import shown_progress

        with user_input(), shown_progress(many=True) as tell:
            found = compare.ensemble(
                problem, runs=runs, size=members, perturbation=perturbation, seed=seed, progress=tell
            )
        print_ensemble(found)
        contents = ensemble_files(found)
        with user_input():
            compare.replace_files(out, contents)
    print(f"\nWritten to {out}: {', '.join(contents)}")


def _synthetic(case: Case, members: int, times_uplift: float, seed: int) -> list[Case]:
    from rockwobble.compare import synthetic_motions, with_motions

    peak = times_uplift * case.gravity * case.cylinder.tan_alpha
    return with_motions(case, synthetic_motions(members, peak=peak, seed=seed))


def _kind(perturbation: float, synthetic: float | None) -> str:
    if synthetic is not None:
        return f"made-up ground motions of {synthetic:g} times g tan alpha"
    return f"conditions perturbed by {100.0 * perturbation:g} %"


def print_ensemble(found: Ensemble) -> None:
    """Print the table of methods and that of contrasts."""
    from rich import box
    from rich.console import Console
    from rich.table import Table

    console = Console()
    if not console.is_terminal:
        console.width = max(console.width, 100)
    methods = Table("method", "runs", "overturned", "failed", "median", "16 to 84 %", box=box.SIMPLE_HEAD)
    for _, row in found.methods.iterrows():
        numbers = (str(row[name]) for name in ("runs", "overturned", "failed"))
        spread = f"{row.peak_16:.3f} to {row.peak_84:.3f}"
        methods.add_row(row.method, *numbers, f"{row.peak_median:.3f}", spread)
    contrasts = Table(
        "method", "against", "KS", "p", "Wasserstein", "median ratio", "fall", box=box.SIMPLE_HEAD
    )
    for _, row in found.contrasts.iterrows():
        contrasts.add_row(
            row.method,
            row.against,
            f"{row.ks:.2f}",
            f"{row.ks_p:.2f}",
            f"{row.wasserstein:.3f} ({row.wasserstein_low:.3f} to {row.wasserstein_high:.3f})",
            f"{row.median_ratio:.2f} ({row.median_ratio_low:.2f} to {row.median_ratio_high:.2f})",
            f"{row.overturned} : {row.against_overturned}",
        )
    console.print(methods, contrasts)
    console.print(
        "Peak tilt and Wasserstein distance in alpha; overturned runs count as the largest, and not in the "
        "Wasserstein distance. p: that one distribution gives so large a KS distance. In brackets 95 % "
        "of the bootstrap. fall: overturned runs of both.",
        style="dim",
        highlight=False,
    )
    for _, row in found.methods[found.methods["failed"] > 0].iterrows():
        console.print(
            f"- {row.method} failed in {row.failed_members}: left out", markup=False, highlight=False
        )


def ensemble_files(found: Ensemble) -> dict[str, bytes]:
    """Return name and content of each file."""
    import io

    from .ensemble_figure import ensemble_figure
    from .ensemble_page import ensemble_page

    buffer = io.BytesIO()
    found.members.to_parquet(buffer, index=False)
    return {
        "members.csv": found.members.to_csv(index=False).encode(),
        "methods.csv": found.methods.to_csv(index=False).encode(),
        "contrasts.csv": found.contrasts.to_csv(index=False).encode(),
        "members.parquet": buffer.getvalue(),
        "ensemble.json": (json.dumps(found.about, indent=2) + "\n").encode(),
        "ensemble.svg": ensemble_figure(found),
        "ensemble.html": ensemble_page(found).encode(),
    }
