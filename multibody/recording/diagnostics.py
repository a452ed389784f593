"""Diagnostics of an engine run, in the time of the user."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

from rockwobble.models import Diagnostic

from .recorder import Recorder

if TYPE_CHECKING:
    import pandas as pd


def diagnostics(
    recorder: Recorder, passes: pd.DataFrame, resolution: float, unit_time: float
) -> Iterator[Diagnostic]:
    """Yield the diagnostics of a run, its failure first.

    `passes` and `resolution` [rad] are those of the trace, in the time of the user; `unit_time` is one second
    of the scene there [s]. How the side comes down in a fall that is followed beyond the end asked for
    limits nothing: what happens there is not said.
    """
    end = recorder.asked
    if recorder.ended == "failed":
        yield Diagnostic(
            code=recorder.failure, time=recorder.end_time * unit_time, detail="; ".join(recorder.warnings)
        )
    # what never happened has the time NaN, which is no time before the end
    for code, time in (
        ("slip", recorder.slip_time),
        ("tension", recorder.pull_time),
        ("friction_needed", recorder.grip_time),
        ("lift_off", recorder.flight_time),
        ("wall_contact", recorder.walls.first),
    ):
        if time <= end:
            yield Diagnostic(code=code, time=time * unit_time)
    since, share, bound = recorder.energy.remark(end)
    if not math.isnan(since):
        yield Diagnostic(code="energy", time=since * unit_time, size=share, bound=bound)
    if recorder.undecided:
        yield Diagnostic(code="undecided", time=end * unit_time)
    if recorder.unsolved:
        yield Diagnostic(code="solver", size=recorder.unsolved, bound=recorder.looks)
    close = passes[~passes["resolved"]]
    if len(close):
        yield Diagnostic(
            code="unresolved_pass",
            time=float(close["time"].iloc[0]),
            size=len(close),
            bound=resolution,
        )
