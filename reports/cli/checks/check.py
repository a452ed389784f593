"""`rockwobble check`: consistency checks of the reduced models and of the engines."""

from __future__ import annotations

import time
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

import rockwobble as rw
import rockwobble.compare as rc

from ...console.progress import shown_progress
from ...console.terminal import FAILED, interruptible, user_input
from ..inputs import options
from ..inputs.suite_choice import chosen_runs, without_missing
from .check_outside import (
    Model,
    Support,
    Tolerance,
    Trajectory,
    outside_findings,
    print_outside,
    require_used,
)

if TYPE_CHECKING:
    from rockwobble.compare.check import Bench, Finding

_output = options.panel("Output for programs")
Suite = Annotated[
    str | None,
    typer.Option(
        help="Suite for the agreement with the engines: a TOML file, or one that ships. Default: quick."
    ),
]
Only = Annotated[
    list[str] | None,
    typer.Option(
        metavar="LAYER",
        help="Run one layer; may be repeated: records, equations, conserved, exact, rest, invariance, "
        "properties, order, residual, metrics, studies, traces, agreement, baseline. Default: all.",
    ),
]
Json = Annotated[Path | None, _output("Write all findings as JSON.")]
Junit = Annotated[Path | None, _output("Write a JUnit report (XML).")]
Markdown = Annotated[Path | None, _output("Append a page for a CI job, such as $GITHUB_STEP_SUMMARY.")]
Update = Annotated[
    bool,
    typer.Option(
        "--update-baseline", help="Show what new baselines would change, and write them if a reason is given."
    ),
]
Reason = Annotated[
    str | None, typer.Option(help="Why the baselines change; kept in their file. Without it you are asked.")
]


def check(
    suite: Suite = None,
    only: Only = None,
    json: Json = None,
    junit: Junit = None,
    markdown: Markdown = None,
    workers: options.Workers = None,
    update_baseline: Update = False,
    reason: Reason = None,
    model: Model = None,
    trajectory: Trajectory = None,
    support: Support = None,
    tolerance: Tolerance = None,
) -> None:
    """Check that the reduced model stays the same model, and stays in agreement with the engines.

    Tightest first: files of records; equations against the energies, term by term, and against
    accelerations in the engines; conserved quantities; exact solutions; rest, landings and the end of a
    record; invariances; one motion stated in several ways; order; zero residual displacement; metrics on
    made-up traces; suites, sweeps and grids against single runs; every field of an engine's trace; agreement
    with the engines on a suite; stored baselines. Each check says what it measured, what it may be, why, and
    what is wrong if it is more.

    A suite of your own is held against the bounds that it states. One that states none is held against what
    the time step of each run leaves, which is measured by a second run of twice that step.

    With --model or --trajectory the same is asked of what somebody else made, as far as its outputs allow;
    each check that cannot run is listed.

    Exit code 0 if all checks hold, 1 if one does not, 2 for bad input.
    """
    with interruptible():
        with user_input():
            from rockwobble.compare.check import LAYERS
            from rockwobble.compare.storage.files import require_file
            from rockwobble.models.number_checks import require_one_of

            if reason is not None and not update_baseline:
                raise ValueError("--reason belongs to --update-baseline, got it alone")
            for layer in only or ():
                require_one_of("--only", layer, LAYERS)
            of_suite = not only or not {"agreement", "baseline"}.isdisjoint(only)
            if suite is not None and not of_suite:
                raise ValueError(f"--suite is for the layer agreement, got --only {' '.join(only or ())}")
            for path in (json, junit, markdown):
                if path is not None:
                    require_file("a report", path)
            require_used(model, trajectory, suite, support, tolerance, workers)
            begun, outside, bench = time.monotonic(), None, None
            if model is None and trajectory is None:
                if update_baseline and (suite not in (None, "quick") or only):
                    raise ValueError(
                        "--update-baseline goes with neither --suite nor --only: it measures all of quick"
                    )
                bench = _bench(suite or "quick", workers, runs=of_suite)
            elif only or update_baseline:
                raise ValueError("--only and --update-baseline do not go with --model or --trajectory")
            else:
                outside = outside_findings(
                    model,
                    trajectory,
                    suite or "quick",
                    support or "recess",
                    1e-3 if tolerance is None else tolerance,
                )
        if bench is not None and update_baseline:
            from ...console.check_update import update

            with user_input():
                update(bench, reason)
            return
        if bench is not None:
            findings, seconds = _run(bench, [layer for layer in LAYERS if not only or layer in only])
        else:
            findings, seconds = outside or [], time.monotonic() - begun
            print_outside(findings)
        with user_input():
            _write(findings, seconds, json, junit, markdown)
    if any(finding.failed for finding in findings):
        raise typer.Exit(FAILED)


def _bench(suite: str, workers: int | None, *, runs: bool) -> Bench:
    """Return the bench of a suite, with its engine runs or without."""
    from rockwobble.compare.check import Bench

    read = rw.read_suite(suite)
    chosen = without_missing(chosen_runs(read, None, None, None), None) if runs else []
    for case in read.cases:
        for run in chosen:
            rc.require_runnable(case, run)
    cases = rw.Suite(read.cases, chosen, read.bounds)
    return Bench(reduced=rw.reduced, suite=cases, shipped=suite == "quick", workers=workers)


def _run(bench: Bench, layers: list[str]) -> tuple[list[Finding], float]:
    """Run the layers, and print each when it is done."""
    from rich.console import Console

    from rockwobble.compare.check import run_checks

    from ...pages.check import print_layer

    console = Console()
    begun = time.monotonic()
    findings: list[Finding] = []
    for layer in layers:
        with shown_progress("engine runs", heading=f"checking {layer}") as bench.progress:
            of_layer = list(run_checks(bench, [layer]))
        print_layer(console, layer, of_layer)
        findings += of_layer
    return findings, time.monotonic() - begun


def _write(
    findings: list[Finding], seconds: float, json: Path | None, junit: Path | None, markdown: Path | None
) -> None:
    from rockwobble.compare.storage.provenance import package_versions

    from ...pages.check import as_json, as_junit, check_page, headline

    print(f"\n{headline(findings, seconds)}")
    versions = package_versions()
    if json is not None:
        rc.replace_files(json.parent, {json.name: as_json(findings, versions, seconds).encode()})
    if junit is not None:
        rc.replace_files(junit.parent, {junit.name: as_junit(findings, seconds).encode()})
    if markdown is not None:
        try:  # the summary of a CI job may hold pages of other steps
            with markdown.open("a", encoding="utf-8") as file:
                file.write(check_page(findings, versions, seconds).markdown())
        except OSError as error:
            raise ValueError(f"{markdown} cannot be written: {error.strerror or error}") from None
