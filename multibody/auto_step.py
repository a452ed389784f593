"""time_step="auto": the step is halved until the tilt no longer depends on it.

Runs of successive steps are compared, each with the one of twice its step. Two traces that near passes of
upright tell apart are compared only up to the last pass before they diverge, for beyond it no step is small
enough: they diverge where they differ by 1 % of alpha. The tilt has settled when

* the two agree within the tolerance to the end of the run; or
* they agree within the tolerance until they diverge, and a further halving does not put that off.

Halving ends without that where it no longer brings the traces closer, which engines know (a smaller step
is not always better), or at the smallest step. The run that is kept is the last that was an improvement.

The estimate of the remaining error is Richardson's. Of a quantity x at the steps 2 h and h, whose error goes
with the power p of the step,

    what is left of the error at h      (x(h) - x(2 h))/(2^p - 1)
    its limit at step zero              x(h) + (x(h) - x(2 h))/(2^p - 1)
    p, of a third run at 4 h            log2(|x(4 h) - x(2 h)| / |x(2 h) - x(h)|)

Near passes mix the orders, so that p counts as 1 at most. Only a run that has settled states an error; one
with a pass that is not resolved, or in which contact makes or takes energy, has not.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import TypeVar

import numpy as np

from rockwobble.models import AGREEMENT, Diagnostic, Trace
from rockwobble.models.mode import ROCKS_IN_PLANE

from .guard import LARGEST_STEP
from .scene import Array

_SAME_TIME = 1e-9  # share of the length of a run
Difference = TypeVar("Difference", float, Array)


def common_count(times: Sequence[Array]) -> int:
    """Number of leading samples whose times are equal in all traces."""
    count = min(map(len, times))
    # the last sample of a run that overturned is at the end of the fall, off the grid
    near = _SAME_TIME * max(1.0, *(float(time[-1]) for time in times if len(time)))
    different = np.flatnonzero(
        np.any([np.abs(time[:count] - times[0][:count]) > near for time in times], axis=0)
    )
    return int(different[0]) if len(different) else count


def error_left(difference: Difference, order: float) -> Difference:
    """Error of the finer of two runs, from their difference and its order in the step."""
    return difference / (math.pow(2.0, order) - 1.0)


def order_between(coarser: float, finer: float) -> float:
    """Order in the step of the differences of successive halvings, both above 0."""
    return math.log2(coarser / finer)


def measured_order(values: Sequence[Array]) -> float:
    """Order in the step of the last three of `values`.

    NaN of fewer than three, and where two of them are equal.
    """
    if len(values) < 3:
        return math.nan
    first, second = (float(np.linalg.norm(coarse - fine)) for coarse, fine in pairwise(values[-3:]))
    return order_between(first, second) if first > 0.0 and second > 0.0 else math.nan


def to_zero_step(values: Sequence[Array], order: int) -> Array:
    """Limit at step zero of the last two of `values`."""
    coarse, fine = values[-2:]
    return np.asarray(fine + error_left(fine - coarse, order))


def linear_extrapolation(values: Sequence[Array]) -> Array:
    """Limit at step zero of a straight line through all of `values`, by least squares.

    Scatter goes with the step, and one that is off by chance weighs little.
    """
    steps = 0.5 ** np.arange(len(values))
    design = np.column_stack([np.ones_like(steps), steps]) / steps[:, None]
    weights = np.linalg.pinv(design)[0] / steps
    return np.asarray(np.tensordot(weights, np.stack(values), axes=1))


Progress = Callable[[float], None]
#: Runs with a time step [s] and a callback for its fraction done.
Attempt = Callable[[float, Progress], Trace]


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
    """Closeness of two traces in tilt, by their common samples."""
    count = common_count([coarse.time, fine.time])
    distance = np.abs(coarse.tilt[:count] - fine.tilt[:count])
    beyond = np.flatnonzero(distance > AGREEMENT * alpha)
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
    """Time after which the error of a trace cannot be estimated [s], and the code of the reason.

    A pass nearer to upright than contact resolves is left to chance; a base that comes down to less lands,
    with every step alike, where the motion may go on: after the last maximum before that the runs agree, and
    all may be wrong. Or contact drives the motion. What rocks in one plane closes, which is known where every
    impact is of momentum: see `modes`.
    """
    time, tilt, _, kind = trace.extrema.T
    low = np.flatnonzero((kind < 0.0) & (tilt < trace.contact_resolution))[:1]
    landing = time[max(int(low[0]) - 1, 0)] if len(low) and not _closes(trace) else math.inf
    return min((float(landing), "unresolved_pass"), (trace.first("energy"), "energy"))


def _closes(trace: Trace) -> bool:
    """Whether a trace passes upright in one plane, each time by an impact of momentum."""
    passes = trace.passes
    return trace.mode == ROCKS_IN_PLANE and len(passes) > 0 and bool(passes["resolved"].all())


def shares(steps: Sequence[float]) -> list[float]:
    """Fractions of the whole work done before each step and after the last."""
    work = np.cumsum([0.0, *(1.0 / step for step in steps)])
    return [float(value) for value in work / work[-1]]


def part_of(progress: Progress | None, start: float, end: float) -> Progress:
    """Progress callback for one run, which is the work from `start` to `end` of the whole."""

    def tell(fraction: float) -> None:
        if progress is not None:
            progress(start + (end - start) * fraction)

    return tell


AUTO = "auto"
COARSEST = 4e-4  # [s] at the reference size: four times the default, so that easy cases cost a fourth
SMALLEST = 6.25e-6  # [s] at the reference size: six halvings; below it rounding and cost grow, not accuracy
STEP_TOLERANCE = 1e-3  # tilt change over alpha; a tenth of the difference at which traces diverge
_PUT_OFF = 1.05  # a divergence later by a smaller factor is no gain
_CLOSER = 0.9  # a difference reduced by less is no gain
_ORDERS = 0.5, 1.0  # least and largest order that an estimate relies on

assert COARSEST <= LARGEST_STEP


def find_step(
    attempt: Attempt, unit_time: float, alpha: float, tolerance: float, progress: Progress | None
) -> Trace:
    """Return the run whose tilt has settled, or the best one with the reason why it has not.

    Parameters
    ----------
    attempt : callable
        Runs with a time step [s] and a callback for its fraction done.
    unit_time : float
        User seconds in one second of the reference scene.
    alpha : float
        Slenderness angle of the cylinder [rad].
    tolerance : float
        In alpha.
    progress : callable, optional
        Called with the fraction done, as if all steps down to the smallest had to be tried.
    """
    steps = [COARSEST * unit_time]
    while steps[-1] > SMALLEST * unit_time * 1.5:
        steps.append(0.5 * steps[-1])
    parts = shares(steps)
    best, coarser = None, None  # the best run so far, and the last run
    entries: list[Closeness] = []  # closeness of each run up to the best
    verdict, spent = "still_changes", 0.0
    for index, step in enumerate(steps):
        run = attempt(step, part_of(progress, parts[index], parts[index + 1]))
        spent += run.wall_time
        if best is None or best.outcome == "failed":
            best = run
        elif run.outcome == "failed":
            verdict = "fails"
            break
        else:
            assert coarser is not None
            trial = [*entries, closeness(coarser, run, alpha)]
            end, gain = _judge(trial, tolerance * alpha)
            if gain:
                best, entries = run, trial
            if end is not None:
                verdict = end
                break
        coarser = run
    if progress is not None:
        progress(1.0)
    assert best is not None
    return replace(_report(best, entries, verdict, alpha), wall_time=spent)


def _judge(distances: list[Closeness], tolerance: float) -> tuple[str | None, bool]:
    """Reason to stop ("": tilt has settled, None: continue), and whether the last run is better."""
    last = distances[-1]
    close = last.difference <= tolerance
    if math.isinf(last.divergence) and close:
        return "", True
    if len(distances) < 2:
        return None, True
    before = distances[-2]
    if last.divergence > before.divergence * _PUT_OFF:
        return None, True
    if math.isfinite(last.divergence):
        # the run before diverged later, so the smaller step is the worse one
        gain = last.divergence >= before.divergence / _PUT_OFF
        return ("" if close and gain else "no_later"), gain
    if last.difference > _CLOSER * before.difference:
        return "no_closer", last.difference <= before.difference
    return None, True


def _estimate(distances: list[Closeness]) -> tuple[float, float]:
    """Richardson's estimate of the remaining error [rad], and the order on which it rests."""
    last = distances[-1]
    order = 1.0
    if len(distances) > 1 and last.difference > 0.0 and distances[-2].until >= last.until / _PUT_OFF:
        order = order_between(max(distances[-2].difference, 1e-300), last.difference)
    order = min(max(order, _ORDERS[0]), _ORDERS[1])
    return error_left(last.difference, order), order


def _report(run: Trace, distances: list[Closeness], verdict: str, alpha: float) -> Trace:
    """Run with the result of the halving; `verdict` says why it has not settled, and is empty if it has."""
    if not distances:
        fact = Diagnostic(code="unsettled", detail=verdict)
        return run if run.outcome == "failed" else replace(run, facts=(*run.facts, fact))
    last = distances[-1]
    unknown, code = unknown_from(run)
    verdict = verdict or (code if math.isfinite(unknown) else "")
    if verdict:
        error = math.nan
        fact = Diagnostic(code="unsettled", duration=last.until, size=last.difference / alpha, detail=verdict)
    else:
        error, order = _estimate(distances)
        fact = Diagnostic(code="settled", duration=last.until, size=error / alpha, bound=order)
    return replace(run, error_estimate=error, settled_until=last.until, facts=(*run.facts, fact))
