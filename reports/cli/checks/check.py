"""`rockwobble check`: physical checks of models, engines, trajectories and suites."""

from __future__ import annotations

import time
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

import rockwobble as rw
import rockwobble.compare as rc
import rockwobble.compare.storage as rs

from ...console.progress import shown_progress
from ...console.terminal import FAILED, interruptible, user_input
from ..inputs import options

if TYPE_CHECKING:
    from rockwobble.compare.check import Checks

_subject = options.panel("Subject (default: the reduced models, and the engines that are installed)")
_output = options.panel("Output for programs")
Engine = Annotated[str | None, _subject("Check one engine, the protocol of an engine included.")]
TimeStep = Annotated[float | None, _subject("Time step of the engine, in s. Default: its own choice.")]
Model = Annotated[
    str | None,
    _subject(
        "Check a model: a function of a rockwobble.Case and a support that returns time, tilt, azimuth.",
        metavar="MODULE:FUNCTION",
    ),
]
Trajectory = Annotated[
    Path | None,
    _subject("Check a trajectory (CSV with time, tilt, azimuth) of the one case of --suite."),
]
Suite = Annotated[
    str | None,
    _subject("Compare the engine runs of a suite with the models: a TOML file, or one that ships."),
]
Support = Annotated[str | None, _subject("What model or trajectory is of: recess or flat. Default: recess.")]
Tolerance = Annotated[float | None, _subject("How exact model or trajectory claims to be. Default: 0.001.")]
Only = Annotated[
    list[str] | None,
    typer.Option(
        metavar="GROUP",
        help="Run one group of checks; may be repeated: equations, exact, conserved, rest, invariance, "
        "order, trace, agreement, protocol, baseline. Default: all.",
    ),
]
Json = Annotated[Path | None, _output("Write all results as JSON.")]
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
    engine: Engine = None,
    time_step: TimeStep = None,
    model: Model = None,
    trajectory: Trajectory = None,
    suite: Suite = None,
    support: Support = None,
    tolerance: Tolerance = None,
    only: Only = None,
    workers: options.Workers = None,
    json: Json = None,
    junit: Junit = None,
    markdown: Markdown = None,
    update_baseline: Update = False,
    reason: Reason = None,
) -> None:
    """Check by physics that reduced models and engines are right, and still do what they did.

    One list of checks, tightest first: residuals in the equations of motion, exact solutions, conserved
    quantities, rest and uplift, invariance, order of convergence, consistency of a trace, agreement with the
    independent model, the protocol of an engine, stored numbers. Printed are failures, with value and bound,
    and one line for each group.

    A suite is compared with the bounds that it states; one that states none, with what the time step of each
    run leaves, measured by a second run of twice that step.

    Exit code 0 if all checks hold, 1 if one does not, 2 for bad input.
    """
    with interruptible():
        begun = time.monotonic()
        with user_input():
            from rockwobble.compare.storage.files import require_file

            if reason is not None and not update_baseline:
                raise ValueError("--reason belongs to --update-baseline, got it alone")
            for path in (json, junit, markdown):
                if path is not None:
                    require_file("a report", path)
            subject = _subject_of(engine, time_step, model, trajectory, suite, support, tolerance, workers)
            if update_baseline:
                if subject or only:
                    raise ValueError("--update-baseline goes with no subject and not with --only")
                from ...console.check_update import update

                update(reason)
                return
            found = _run(subject, only)
            _write(found, time.monotonic() - begun, json, junit, markdown)
    if not found.passed:
        raise typer.Exit(FAILED)


def _subject_of(
    engine: str | None,
    time_step: float | None,
    model: str | None,
    trajectory: Path | None,
    suite: str | None,
    support: str | None,
    tolerance: float | None,
    workers: int | None,
) -> dict[str, Any]:
    """Return the options of `rockwobble.check` that name the subject.

    Raises
    ------
    ValueError
        If two are given, or an option that another leaves without a meaning.
    """
    from rockwobble.compare.check.subject import load_model
    from rockwobble.multibody.engines.registry import find_engine

    external = model is not None or trajectory is not None
    named = {"--engine": engine, "--model": model, "--trajectory": trajectory}
    named |= {} if trajectory is not None else {"--suite": suite}
    given = [name for name, value in named.items() if value is not None]
    if len(given) > 1:
        raise ValueError(f"one subject may be given, got {' and '.join(given)}")
    for name, value in (("--support", support), ("--tolerance", tolerance)):
        if value is not None and not external:
            raise ValueError(f"{name} belongs to --model or --trajectory, got it without either")
    if time_step is not None and engine is None:
        raise ValueError("--time-step belongs to --engine, got it alone")
    if workers is not None and (suite is None or trajectory is not None):
        raise ValueError("--workers belongs to the runs of a --suite, got it without one")
    if engine is not None:
        find_engine(engine)  # what is wrong with it is said before anything runs
    found: dict[str, Any] = {"engine": engine, "time_step": time_step, "workers": workers}
    found |= {"support": support, "tolerance": tolerance}
    if model is not None:
        found["model"] = load_model(model)
    elif trajectory is not None:
        cases = rw.read_suite(suite or "quick").cases
        if len(cases) != 1:
            raise ValueError(f"--trajectory needs a --suite with one case, got {len(cases)}")
        found["trajectory"] = rc.read_trajectory(trajectory, cases[0])
    elif suite is not None:
        found["suite"] = rw.read_suite(suite)
    return {name: value for name, value in found.items() if value is not None}


def _run(subject: dict[str, Any], only: list[str] | None) -> Checks:
    """Run the checks, and print them."""
    from rich.console import Console

    from rockwobble.compare.check import GROUPS, check
    from rockwobble.models.number_checks import require_one_of

    from ...pages.check import print_checks

    for group in only or ():
        require_one_of("--only", group, tuple(GROUPS))
    with shown_progress("engine runs", heading="checking") as progress:
        found = check(**subject, only=only, progress=progress)
    print_checks(Console(), found)
    return found


def _write(
    found: Checks, seconds: float, json: Path | None, junit: Path | None, markdown: Path | None
) -> None:
    from ...pages.check import as_json, as_junit, check_page, headline

    print(headline(found, seconds))
    if json is not None:
        rs.replace_files(json.parent, {json.name: as_json(found, seconds).encode()})
    if junit is not None:
        rs.replace_files(junit.parent, {junit.name: as_junit(found, seconds).encode()})
    if markdown is not None:
        try:  # the summary of a CI job may hold pages of other steps
            with markdown.open("a", encoding="utf-8") as file:
                file.write(check_page(found, seconds).markdown())
        except OSError as error:
            raise ValueError(f"{markdown} cannot be written: {error.strerror or error}") from None
