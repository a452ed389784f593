"""Layer baseline, second part: engines give the numbers that their versions gave.

Results differ between versions of an engine, and in the last digits between machines. A version without
a baseline is held against the last known one with loose bounds, and that is said; it is no failure.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from rockwobble.models import Case, Run

from ..baseline_file import Baseline, Values, read_baseline
from ..bench import Bench, crashed
from ..finding import NO_BASELINE, Finding, at_most
from .agreement import tilt_bound

LAYER = "baseline"
FILE = "engines"
INSTANTS = 8  # evenly over the run
# of the bound of the agreement: rounding of another machine, which grows as the error of the contact does
SHARE = 0.3
# beyond the first touch of a wall, where an impact comes a step earlier or later [alpha]
RING = 5e-3
LOOSE = 20.0  # times as much for a version that has no baseline


def check(bench: Bench) -> Iterator[Finding]:
    """Yield the findings of this part, one for each engine run of the suite."""
    kept = read_baseline(FILE)
    for case, run, label, trajectory in bench.rows():
        if crashed(trajectory):
            continue  # said by the layer before
        yield _finding(kept, case, run, label, trajectory)


def measure(bench: Bench) -> dict[str, dict[str, float]]:
    """Return the numbers that are kept, by engine with its version."""
    found: dict[str, dict[str, float]] = {}
    for case, _, label, trajectory in bench.rows():
        if not crashed(trajectory):
            values = _tilts(case, trajectory)
            group = found.setdefault(version_of(trajectory), {})
            group |= {f"{case.name}, {label}: {name}": value for name, value in values.items()}
    return found


def version_of(trajectory: Any) -> str:
    """Return the name of the group of a trajectory: engine and version."""
    return f"{trajectory.run.engine} {trajectory.version}"


def _finding(kept: Baseline, case: Case, run: Run, label: str, trajectory: Any) -> Finding:
    group = version_of(trajectory)
    known = _known(kept, trajectory.run.engine, group)
    name = f"{case.name}, {label}"
    bound = RING if run.support == "ring" else SHARE * tilt_bound(case, trajectory.time_step)
    if known != group:
        bound *= LOOSE
    before: Values = kept.values.get(known, {})
    apart = [
        abs(value - before.get(f"{name}: {what}", math.nan))
        for what, value in _tilts(case, trajectory).items()
    ]
    finding = at_most(
        LAYER,
        name,
        max(apart) if all(map(math.isfinite, apart)) else math.nan,
        bound,
        unit="alpha",
        reason=f"tilts at {INSTANTS} instants; rounding of another machine",
        part=f"{run.engine} ({run.support}) or its settings give other numbers than they did",
    )
    if known == group:
        return finding
    against = f"held against {known} with loose bounds: {finding.outcome}" if known else "none of any version"
    return dataclasses.replace(finding, outcome=NO_BASELINE, note=f"no baseline for {group}; {against}")


def _known(kept: Baseline, engine: str, group: str) -> str:
    """Return the group to hold a version against: its own, else the last of its engine, else none."""
    if group in kept.values:
        return group
    return next((name for name in reversed(list(kept.values)) if name.rsplit(" ", 1)[0] == engine), "")


def _tilts(case: Case, trajectory: Any) -> Mapping[str, float]:
    times = case.length * np.arange(1, INSTANTS + 1) / INSTANTS
    tilts = np.interp(times, trajectory.time, trajectory.tilt) / case.cylinder.alpha
    return {f"tilt at {time:g} s [alpha]": float(tilt) for time, tilt in zip(times, tilts, strict=True)}
