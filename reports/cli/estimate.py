"""Time and memory that runs take, said before they start; what cannot be is refused."""

from __future__ import annotations

import math
import os
from collections.abc import Iterator, Sequence
from pathlib import Path

import rockwobble as rw
import rockwobble.compare as rc

_SAMPLE_COST = 1e-5  # computing time of a sample of a reduced model [s]: good enough to say how long
_UNIT_COST = 1e-5  # and of one unit of time sqrt(R/g), of which a pass takes some [s]
_CELL_COST = 1e-5  # of a second of a record in a grid of reduced runs [s]
_LONG = 20.0  # [s]
_YEAR = 365.25 * 86400.0  # longer than this nobody waits [s]
# of one sample, in memory while it is written: 24 numbers, as an array, a table, CSV and Parquet, in the
# process that made it and in the one that writes it; 1200 were measured
_BYTES = 24 * 8 * 8
# of one row of a sweep, in chunks, as a table and as a file; 91 were measured for the table alone
_ROW_BYTES = 300
# of one row of a suite that is swept: its texts are longer
_CASE_BYTES = 3000


def time_needed(cases: Sequence[rw.Case], runs: Sequence[rw.Run], *, always: bool = False) -> Iterator[str]:
    """Yield a line that says how long it may take; none for what takes seconds."""
    seconds = _all_seconds(cases, runs)
    if always or seconds > _LONG:
        yield f"Computing time: {_words(seconds)}{', shared by the cores' if always else ''}"


def require_feasible(
    cases: Sequence[rw.Case], runs: Sequence[rw.Run], *, members: int = 1, samples: bool = True
) -> None:
    """Refuse runs that would take years, or whose samples do not fit into the memory of this machine.

    Parameters
    ----------
    cases, runs : sequence
        Every case with every run.
    members : int, optional
        How often each of them runs.
    samples : bool, optional
        Whether the samples of all runs are kept until the end, or of one at a time.

    Raises
    ------
    ValueError
        Saying what they take and what there is.
    """
    from rockwobble.compare.runs.execution import SAMPLE_STEP

    longest = max((case.length for case in cases), default=0.0)
    kept = max(1, len(runs)) if samples else 1
    _require(
        _all_seconds(cases, runs) * members,
        longest / SAMPLE_STEP * _BYTES * kept + members * _CASE_BYTES,
        "give a shorter --duration" + (" or fewer members" if members > 1 else ""),
        "give a shorter --duration, a larger --time-step" + (" or fewer members" if members > 1 else ""),
    )


def require_sweep(plan: rc.Grid | rw.Suite) -> str:
    """Return how long a sweep may take, and refuse one that takes years or does not fit into memory.

    Raises
    ------
    ValueError
        Saying what it takes and what there is.
    """
    from rockwobble.models.cpus import usable_cpus

    if isinstance(plan, rc.Grid):
        lengths = math.fsum(motion.duration for motion in plan.motions) / len(plan.motions)
        seconds, needed = plan.rows * lengths * _CELL_COST, plan.rows * _ROW_BYTES
    else:
        seconds = _all_seconds(plan.cases, plan.runs)
        needed = len(plan.cases) * len(plan.runs) * _CASE_BYTES
    _require(seconds, needed, "sweep fewer runs at a time", "sweep fewer runs")
    cores = usable_cpus()
    return f"Computing time: {_words(seconds)}" + (f", shared by {cores} cores" if cores > 1 else "")


def _require(seconds: float, needed: float, less_memory: str, less_time: str) -> None:
    there = _memory()
    if needed > there:
        much = f"{float(f'{needed / 1e9:.3g}'):,.12g}"  # 154,000, not 1.54e+05
        size = f"some {much} GB of memory, more than the {there / 1e9:.3g} GB that are free"
        raise ValueError(f"the results take {size}: {less_memory}")
    if seconds > _YEAR:
        raise ValueError(f"the runs take some {seconds / _YEAR:.3g} years of computing: {less_time}")


def _all_seconds(cases: Sequence[rw.Case], runs: Sequence[rw.Run]) -> float:
    return math.fsum(_seconds(case, run) for case in cases for run in runs)


def _seconds(case: rw.Case, run: rw.Run) -> float:
    from rockwobble.compare.runs.execution import SAMPLE_STEP, engine_time
    from rockwobble.multibody.scene import froude_scale

    if run.engine is not None:
        return engine_time(case, run)
    unit = froude_scale(case.cylinder.semidiagonal, case.gravity).time
    return case.length * (_SAMPLE_COST / SAMPLE_STEP + _UNIT_COST / unit)


def _memory() -> float:
    """Memory that this process may still take [bytes]; infinite where the system does not say."""
    return min(_available(), _limit_of_group(), _limit_of_process())


def _available() -> float:
    try:
        lines = Path("/proc/meminfo").read_text().splitlines()
        return next(1024.0 * float(line.split()[1]) for line in lines if line.startswith("MemAvailable"))
    except (OSError, StopIteration, ValueError):
        names = getattr(os, "sysconf_names", {})
        if not {"SC_PAGE_SIZE", "SC_PHYS_PAGES"} <= set(names):
            return math.inf
        return float(os.sysconf("SC_PAGE_SIZE")) * os.sysconf("SC_PHYS_PAGES")


def _limit_of_group() -> float:
    """Memory left to the control group of a container."""
    group = Path("/sys/fs/cgroup")
    try:
        most = float((group / "memory.max").read_text())
        return most - float((group / "memory.current").read_text())
    except (OSError, ValueError):  # "max", or none
        return math.inf


def _limit_of_process() -> float:
    try:
        import resource
    except ImportError:  # Windows
        return math.inf
    most = resource.getrlimit(resource.RLIMIT_AS)[0]
    return math.inf if most == resource.RLIM_INFINITY else float(most)


def _words(seconds: float) -> str:
    if seconds < 90.0:
        return f"about {max(10.0, round(seconds, -1)):.0f} s"
    minutes = seconds / 60.0
    if minutes < 90.0:
        return f"about {minutes:.0f} min"
    hours = minutes / 60.0
    return f"about {hours:.0f} h" if hours < 72.0 else f"about {hours / 24.0:,.0f} days"
