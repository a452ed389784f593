"""Runs of one case at several time steps, and how close two of them are."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from rockwobble.models import Trace

_DIVERGED = 0.01  # of alpha
# diagnostics beside which no estimate of the error is known: a pass is left to chance, or contact drives
UNKNOWN = ("unresolved_pass", "energy")
_SAME_TIME = 1e-9  # of the length of a run

Progress = Callable[[float], None]
Attempt = Callable[[float, Progress], Trace]
"""Runs with a time step [s] and a callback for its fraction done."""


@dataclass(frozen=True, slots=True)
class Closeness:
    """Closeness of two traces of one case.

    Attributes
    ----------
    difference : float
        Largest difference of the tilt until `until` [rad].
    until : float
        The end of the shorter trace, or the last pass before the divergence [s].
    divergence : float
        Where they diverge; infinite if they do not [s].
    """

    difference: float
    until: float
    divergence: float


def closeness(coarse: Trace, fine: Trace, alpha: float) -> Closeness:
    """Return the closeness of two traces in tilt, by their samples."""
    count = common_count([coarse, fine])
    distance = np.abs(coarse.tilt[:count] - fine.tilt[:count])
    beyond = np.flatnonzero(distance > _DIVERGED * alpha)
    if not len(beyond):
        ends_alike = coarse.outcome == fine.outcome or "overturned" not in (coarse.outcome, fine.outcome)
        end = float(fine.time[count - 1])
        return Closeness(float(distance.max(initial=0.0)), end, math.inf if ends_alike else end)
    divergence = float(fine.time[beyond[0]])
    passes = np.asarray(fine.passes["time"], dtype=float)
    earlier = passes[passes < divergence]
    until = float(earlier[-1]) if len(earlier) else 0.0
    within = distance[: int(np.searchsorted(fine.time, until, side="right"))]
    return Closeness(float(within.max(initial=0.0)), until, divergence)


def unknown_from(trace: Trace) -> tuple[float, str]:
    """Return from when on no estimate of the error of a trace is known [s], and the code that says so.

    A base that comes down to less than contact resolves lands, with every step alike, where the motion may
    go on: after the last maximum before that the runs agree, and all may be wrong.
    """
    time, tilt, _, kind = trace.extrema.T
    low = np.flatnonzero((kind < 0.0) & (tilt < trace.contact_resolution))[:1]
    landing = time[max(int(low[0]) - 1, 0)] if len(low) else math.inf
    return min((float(landing), "unresolved_pass"), *((trace.first(code), code) for code in UNKNOWN))


def common_count(traces: Sequence[Trace]) -> int:
    """Return up to which sample all traces have the same times."""
    count = min(len(trace.time) for trace in traces)
    first = traces[0].time[:count]
    # the last sample of a run that overturned stands at its own time
    near = _SAME_TIME * max(*(trace.time[-1] for trace in traces), 1.0)
    different = np.flatnonzero(
        np.any([np.abs(trace.time[:count] - first) > near for trace in traces], axis=0)
    )
    return int(different[0]) if len(different) else count


def shares(steps: Sequence[float]) -> list[float]:
    """Return the fractions of the whole work that are done before each step and after the last."""
    work = np.cumsum([0.0, *(1.0 / step for step in steps)])
    return [float(value) for value in work / work[-1]]


def part_of(progress: Progress | None, start: float, end: float) -> Progress:
    """Return a callback for one run, which is the work from `start` to `end` of the whole."""

    def tell(fraction: float) -> None:
        if progress is not None:
            progress(start + (end - start) * fraction)

    return tell
