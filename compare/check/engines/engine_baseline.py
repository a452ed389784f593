"""Layer baseline, second part: engines give the numbers that their versions gave.

Results differ between versions of an engine, and in the last digits between machines. A version without
a baseline is held against the last known one with loose bounds, and that is said; it is no failure.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterator, Mapping

import numpy as np

from rockwobble.models import Trace

from ...runs.execution import Job
from ..baseline_file import Baseline, Values, read_baseline
from ..bench import Bench
from ..finding import NO_BASELINE, Bound, Finding, at_most
from .agreement import tilt_bound

FILE = "engines"
INSTANTS = 8  # evenly over the run
# of the bound of the agreement: rounding of another machine, which grows as the error of the contact does
SHARE = 0.3
# beyond the first touch of a wall, where an impact comes a step earlier or later [alpha]
RING = 5e-3
LOOSE = 20.0  # times as much for a version that has no baseline


def check(bench: Bench) -> Iterator[Finding]:
    """Yield the findings of this part, one for each engine run of the suite that ships."""
    if not bench.shipped:
        return
    kept = read_baseline(FILE)
    for job, trace in _finished(bench):
        yield _finding(kept, job, trace)


def measure(bench: Bench) -> dict[str, dict[str, float]]:
    """Return the numbers that are kept, by engine with its version."""
    found: dict[str, dict[str, float]] = {}
    for job, trace in _finished(bench):
        group = found.setdefault(_group(trace), {})
        group |= {f"{job.case.name}, {job.label}: {name}": value for name, value in _tilts(trace).items()}
    return found


def _finished(bench: Bench) -> Iterator[tuple[Job, Trace]]:
    """Yield the runs that reached their end; of the others the layer before has said so."""
    jobs = bench.jobs()
    for job, trace in zip(jobs, bench.traces(jobs), strict=True):
        if trace.outcome != "failed":
            yield job, trace


def _group(trace: Trace) -> str:
    return f"{trace.run.engine} {trace.version}"


def _finding(kept: Baseline, job: Job, trace: Trace) -> Finding:
    group, engine = _group(trace), trace.run.engine
    # its own version, else the last of its engine, else none
    others = (name for name in reversed(list(kept.values)) if name.rsplit(" ", 1)[0] == engine)
    known = group if group in kept.values else next(others, "")
    name = f"{job.case.name}, {job.label}"
    most = RING if job.run.support == "ring" else SHARE * tilt_bound(job.case, trace.time_step)
    most *= 1.0 if known == group else LOOSE
    before: Values = kept.values.get(known, {})
    apart = [abs(tilt - before.get(f"{name}: {what}", math.nan)) for what, tilt in _tilts(trace).items()]
    finding = at_most(
        name,
        max(apart) if all(map(math.isfinite, apart)) else math.nan,
        Bound(most, f"tilts at {INSTANTS} instants; rounding of another machine", "alpha"),
        f"{engine} ({job.run.support}) or its settings give other numbers than they did",
    )
    if known == group:
        return finding
    against = f"held against {known} with loose bounds: {finding.outcome}" if known else "none of any version"
    return dataclasses.replace(finding, outcome=NO_BASELINE, note=f"no baseline for {group}; {against}")


def _tilts(trace: Trace) -> Mapping[str, float]:
    times = trace.case.length * np.arange(1, INSTANTS + 1) / INSTANTS
    tilts = np.interp(times, trace.time, trace.tilt) / trace.case.cylinder.alpha
    return {f"tilt at {time:g} s [alpha]": float(tilt) for time, tilt in zip(times, tilts, strict=True)}
