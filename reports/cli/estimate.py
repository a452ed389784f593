"""Time that runs take, said before they start; what memory cannot hold is refused."""

from __future__ import annotations

import math
import os
from collections.abc import Iterator, Sequence

import rockwobble as rw
import rockwobble.compare as rc

_SAMPLE_COST = 1e-5  # computing time of a sample of a reduced model [s]: good enough to say how long
_UNIT_COST = 1e-5  # and of one unit of time sqrt(R/g), of which a pass takes some [s]
_CELL_COST = 1e-5  # of a second of a record in a grid of reduced runs [s]
_LONG = 20.0  # [s]
# of one sample, in memory while it is written: 24 numbers, as an array, a table, CSV and Parquet, in the
# process that made it and in the one that writes it; 1200 were measured
_BYTES = 24 * 8 * 8
# of one row of a sweep, in chunks, as a table and as a file; 91 were measured for the table alone
_ROW_BYTES = 300


def time_needed(cases: Sequence[rw.Case], runs: Sequence[rw.Run], *, always: bool = False) -> Iterator[str]:
    """Yield a line that says how long it may take; none for what takes seconds."""
    seconds = _all_seconds(cases, runs)
    if always or seconds > _LONG:
        yield f"Computing time: {_words(seconds)}{', shared by the cores' if always else ''}"


def require_memory(cases: Sequence[rw.Case], runs: Sequence[rw.Run]) -> None:
    """Refuse runs, every case with every run, whose samples do not fit into the memory of this machine.

    Raises
    ------
    ValueError
        Saying what they take and what there is.
    """
    from rockwobble.compare.runs.execution import SAMPLE_STEP

    longest = max((case.length for case in cases), default=0.0)
    _require_memory(longest / SAMPLE_STEP * _BYTES * max(1, len(runs)), "give a shorter --duration")


def sweep_time(plan: rc.Grid | rw.Suite) -> str:
    """Return how long a sweep may take, and refuse one that does not fit into memory.

    Raises
    ------
    ValueError
        Saying what it takes and what there is.
    """
    from rockwobble.models.cpus import usable_cpus

    if isinstance(plan, rc.Grid):
        _require_memory(plan.rows * _ROW_BYTES, "sweep fewer runs at a time")
        lengths = math.fsum(motion.duration for motion in plan.motions) / len(plan.motions)
        seconds = plan.rows * lengths * _CELL_COST
    else:
        seconds = _all_seconds(plan.cases, plan.runs)
    cores = usable_cpus()
    return f"Computing time: {_words(seconds)}" + (f", shared by {cores} cores" if cores > 1 else "")


def _require_memory(needed: float, less: str) -> None:
    there = math.inf
    if hasattr(os, "sysconf"):
        there = float(os.sysconf("SC_PAGE_SIZE")) * os.sysconf("SC_PHYS_PAGES")
    if needed > there:
        much = f"{float(f'{needed / 1e9:.3g}'):,.12g}"  # 154,000, not 1.54e+05
        size = f"some {much} GB of memory, more than the {there / 1e9:.3g} GB of this machine"
        raise ValueError(f"the results take {size}: {less}")


def _all_seconds(cases: Sequence[rw.Case], runs: Sequence[rw.Run]) -> float:
    return math.fsum(_seconds(case, run) for case in cases for run in runs)


def _seconds(case: rw.Case, run: rw.Run) -> float:
    from rockwobble.compare.runs.execution import SAMPLE_STEP, engine_time
    from rockwobble.multibody.scene import froude_scale

    if run.engine is not None:
        return engine_time(case, run)
    unit = froude_scale(case.cylinder.semidiagonal, case.gravity).time
    return case.length * (_SAMPLE_COST / SAMPLE_STEP + _UNIT_COST / unit)


def _words(seconds: float) -> str:
    if seconds < 90.0:
        return f"about {max(10.0, round(seconds, -1)):.0f} s"
    minutes = seconds / 60.0
    if minutes < 90.0:
        return f"about {minutes:.0f} min"
    hours = minutes / 60.0
    return f"about {hours:.0f} h" if hours < 72.0 else f"about {hours / 24.0:,.0f} days"
