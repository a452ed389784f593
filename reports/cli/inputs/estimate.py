"""Time and memory that runs take, before they start."""

from __future__ import annotations

import math
import os
from collections.abc import Iterator, Sequence

import rockwobble as rw

_SAMPLE_COST = 1e-5  # computing time of a sample of a reduced model [s]: good enough to say how long
_WORTH_A_WORD = 20.0  # [s]
# of one sample, in memory while it is written: 24 numbers, as an array, a table, CSV and Parquet
_BYTES = 24 * 8 * 5


def time_needed(cases: Sequence[rw.Case], runs: Sequence[rw.Run], *, always: bool = False) -> Iterator[str]:
    """Yield a line that says how long it may take; none where that is not worth a word."""
    seconds = sum(_seconds(case, run) for case in cases for run in runs)
    if always or seconds > _WORTH_A_WORD:
        yield f"Computing time: {_words(seconds)}{', shared by the cores' if always else ''}"


def require_memory(cases: Sequence[rw.Case], runs: Sequence[rw.Run]) -> None:
    """Refuse runs whose samples do not fit into the memory of this machine.

    Raises
    ------
    ValueError
        Saying what they take and what there is.
    """
    from rockwobble.compare.runs.execution import SAMPLE_STEP

    needed = max((case.length for case in cases), default=0.0) / SAMPLE_STEP * _BYTES * max(1, len(runs))
    there = _memory()
    if needed > there:
        raise ValueError(
            f"the samples take some {needed / 1e9:.3g} GB of the {there / 1e9:.3g} there are: give a shorter "
            "--duration"
        )


def _seconds(case: rw.Case, run: rw.Run) -> float:
    from rockwobble.compare.runs.execution import SAMPLE_STEP, equal_step
    from rockwobble.multibody.engines.registry import engine_facts

    if run.engine is None:
        return case.length / SAMPLE_STEP * _SAMPLE_COST
    return case.length / equal_step(case, run) * engine_facts(run.engine).step_time


def _memory() -> float:
    """Memory of this machine [bytes]; infinite where the system does not say."""
    names = getattr(os, "sysconf_names", {})
    if not {"SC_PAGE_SIZE", "SC_PHYS_PAGES"} <= set(names):
        return math.inf
    return float(os.sysconf("SC_PAGE_SIZE")) * os.sysconf("SC_PHYS_PAGES")


def _words(seconds: float) -> str:
    if seconds < 90.0:
        return f"about {max(10.0, round(seconds, -1)):.0f} s"
    minutes = seconds / 60.0
    return f"about {minutes:.0f} min" if minutes < 90.0 else f"about {minutes / 60.0:.0f} h"
