"""From a suite file and the options beside it to what will run."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any

from ...pages.case_words import group_of

if TYPE_CHECKING:
    from rockwobble.models import Case, Run, Suite

# options that state a problem, which a suite does itself
_PROBLEM = (
    "semidiagonal",
    "tan_alpha",
    "record_x",
    "record_y",
    "record_z",
    "units",
    "scale",
    "release_tilt_deg",
    "rolling_rate",
    "duration",
)
_DEFAULT_STEP = 1e-4  # [s] of a cylinder of 6 m: good enough to say how long a suite takes


def refuse_problem_options(context: Any, suite: str) -> None:
    """Refuse options that contradict the file.

    Raises
    ------
    ValueError
        If the user gave an option that states a problem.
    """
    for name in _PROBLEM:
        source = context.get_parameter_source(name)
        if source is not None and source.name == "COMMANDLINE":
            option = "--" + name.replace("_", "-")
            raise ValueError(f"{option} does not go with a suite, got {suite}: the file states the problems")


def chosen_runs(
    suite: Suite, engines: Sequence[str] | None, supports: Sequence[str] | None, time_step: Any
) -> list[Run]:
    """Return the runs of a suite, with those of the options in their place.

    Engines and supports that are named choose among the runs of the file; one that the file does not have
    is added with each of the others. A time step replaces all others.
    """
    from rockwobble.compare import default_runs
    from rockwobble.models import Run

    runs = list(suite.runs)
    if not runs:
        runs = list(default_runs(engines or None, supports or None))
    else:
        if engines:
            places = list(dict.fromkeys(run.support for run in runs))
            known = {run.engine for run in runs}
            runs = [run for run in runs if run.engine in engines]
            runs += [Run(engine, place) for engine in engines if engine not in known for place in places]
        if supports:
            makers = list(dict.fromkeys(run.engine for run in runs))
            known = {run.support for run in runs}
            runs = [run for run in runs if run.support in supports]
            runs += [Run(maker, place) for place in supports if place not in known for maker in makers]
    if time_step is not None:
        runs = [Run(run.engine, run.support, time_step, **run.settings) for run in runs]
    return runs


def without_missing(runs: Sequence[Run], named: Sequence[str] | None) -> tuple[list[Run], list[str]]:
    """Return the runs whose engines are installed or named by the user, and the engines left out.

    Raises
    ------
    ValueError
        If none is left.
    """
    from rockwobble.compare import missing_engines

    missing = [name for name in missing_engines() if name not in (named or ())]
    kept = [run for run in runs if run.engine not in missing]
    left_out = [name for name in missing if any(run.engine == name for run in runs)]
    if not kept:
        raise ValueError(f"no engine of this suite is installed here: {', '.join(left_out)}")
    return kept, left_out


def describe_suite(name: str, cases: Sequence[Case], runs: Sequence[Run]) -> Iterator[str]:
    """Yield the lines that echo what will run, and how long it may take."""
    from rockwobble.compare.runs.choice import run_labels

    groups: dict[str, int] = {}
    for case in cases:
        groups[group_of(case.name)] = groups.get(group_of(case.name), 0) + 1
    yield f"Suite {name}: {len(cases)} cases x {len(runs)} runs = {len(cases) * len(runs)} runs of engines"
    counted = (f"{group} ({count})" if count > 1 else group for group, count in groups.items())
    yield f"Cases: {', '.join(counted)}"
    yield f"Runs: {', '.join(run_labels(runs))}"
    yield f"Computing time: {_time_in_words(_computing_time(cases, runs))}, shared by the cores"


def _computing_time(cases: Sequence[Case], runs: Sequence[Run]) -> float:
    """Rough time on one core [s]."""
    from rockwobble.multibody.engines.registry import engine_facts

    total = 0.0
    for case in cases:
        default = _DEFAULT_STEP * math.sqrt(case.cylinder.semidiagonal / 6.0 * 9.81 / case.gravity)
        for run in runs:
            step = run.time_step if isinstance(run.time_step, float) else default
            total += case.length / step * engine_facts(run.engine).step_time
    return total


def _time_in_words(seconds: float) -> str:
    if seconds < 90.0:
        return f"about {max(10.0, round(seconds, -1)):.0f} s"
    minutes = seconds / 60.0
    return f"about {minutes:.0f} min" if minutes < 90.0 else f"about {minutes / 60.0:.0f} h"
