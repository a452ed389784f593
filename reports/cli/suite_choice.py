"""Runs of a suite file, as changed by options."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING

import typer

import rockwobble as rw
import rockwobble.compare as rc

from ..console import complain
from ..pages.cases import case_warnings, group_of, record_lines
from ..pages.wording import written
from .problem import PROBLEM, refuse

if TYPE_CHECKING:
    from rockwobble.models.case import TimeStep
    from rockwobble.models.finding import Value


def refuse_problem_options(context: typer.Context, suite: str) -> None:
    """Refuse options that contradict the suite file.

    Raises
    ------
    ValueError
        If the user gave an option that states a problem.
    """
    refuse(context, set(PROBLEM), f"does not go with a suite, got {suite}: the file states the problems")


def chosen_runs(
    suite: rw.Suite, engines: Sequence[str] | None, supports: Sequence[str] | None, time_step: TimeStep
) -> list[rw.Run]:
    """Runs of a suite, as changed by the options of the command line.

    Engines and supports that are named choose among the runs of the file; one that the file does not have
    is added with each of the others. A time step replaces all others.
    """
    runs = list(suite.runs)
    if not runs:
        runs = list(rc.default_runs(engines or None, supports or None, cases=suite.cases))
    else:
        for field, other, named in (("engine", "support", engines), ("support", "engine", supports)):
            if named:
                known, others = (dict.fromkeys(getattr(run, name) for run in runs) for name in (field, other))
                added = [name for name in named if name not in known]
                runs = [run for run in runs if getattr(run, field) in named]
                runs += [rw.Run(**{field: name, other: each}) for name in added for each in others]
    if time_step is not None:
        from rockwobble.compare.runs.choice import at_step

        runs = [at_step(run, time_step) for run in runs]
    return runs


def without_missing(runs: Sequence[rw.Run], named: Sequence[str] | None) -> list[rw.Run]:
    """Runs that are possible here; replaced and skipped engines are reported.

    Raises
    ------
    ValueError
        If none is left.
    """
    from rockwobble.compare.runs.choice import runs_here

    kept, said = runs_here(runs, named or ())
    if not kept:
        raise ValueError(f"no engine of this suite is installed here: {'; '.join(said)}")
    for line in said:
        complain(line)
    return kept


def report_skipped_engines(supports: Sequence[str] = ()) -> None:
    """Report the engines that a default run skips, and why: not runnable here, or without a support."""
    from rockwobble.compare.runs.choice import left_out, missing_engines, omissions

    for name in missing_engines():
        complain(left_out(name))
    for reason in omissions(supports):
        complain(reason)


def suite_lines(name: str, cases: Sequence[rw.Case], runs: Sequence[rw.Run]) -> Iterator[str]:
    """Yield the lines that describe the runs."""
    from rockwobble.compare.runs.choice import run_labels

    groups = Counter(group_of(case.name) for case in cases)
    yield f"Suite {name}: {len(cases)} cases x {len(runs)} runs = {len(cases) * len(runs)} runs of engines"
    counted: Iterator[Mapping[str, Value]] = (
        {"name": group, "count": count if count > 1 else None} for group, count in groups.items()
    )
    yield f"Cases: {', '.join(written('motions.group', each, {}) for each in counted)}"
    yield f"Runs: {', '.join(run_labels(runs))}"
    yield from record_lines(case.motion for case in cases)
    yield from case_warnings(cases)
