"""time_step="auto": the step is halved until the tilt no longer depends on it.

Runs of successive steps are held against each other, each against the one of twice its step. Two traces
that near passes of upright tell apart are compared only up to the last pass before they diverge, for
beyond it no step is small enough: they diverge where they differ by 1 % of alpha. The tilt has settled when

* the two agree within the tolerance to the end of the run; or
* they agree within the tolerance until they diverge, and a further halving does not put that off.

Halving ends without that where it no longer brings the traces closer, which engines know (a smaller step
is not always better), or at the smallest step. The run that is kept is the last that was an improvement.

The estimate of the remaining error is Richardson's: with differences d1 and then d2 of successive
halvings, the order is p = log2(d1/d2), and what is left of the finer one d2/(2^p - 1). Near passes mix the
orders, so p counts as 1 at most. Only a run that has settled states an error; one with a pass that is not
resolved, or in which contact makes or takes energy, has not.
"""

from __future__ import annotations

import math
from dataclasses import replace

from rockwobble.models import Diagnostic, Trace

from ..scene.guard import LARGEST_STEP
from .attempts import Attempt, Closeness, Progress, closeness, part_of, shares, unknown_from

AUTO = "auto"
COARSEST = 4e-4  # [s] at the reference size: four times the default, so that easy cases cost a fourth
SMALLEST = 6.25e-6  # [s] at the reference size: six halvings; below it rounding and cost grow, not accuracy
STEP_TOLERANCE = 1e-3  # of alpha; the default, a tenth of the difference at which traces diverge
_PUT_OFF = 1.05  # a divergence later by less is no gain
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
        Of the cylinder [rad].
    tolerance : float
        In alpha.
    progress : callable, optional
        Called with the fraction done, as if all steps down to the smallest had to be tried.
    """
    steps = [COARSEST * unit_time]
    while steps[-1] > SMALLEST * unit_time * 1.5:
        steps.append(0.5 * steps[-1])
    parts = shares(steps)
    best, coarser = None, None  # the run to keep, and the last one
    found: list[Closeness] = []  # of the run to keep and all before it
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
            trial = [*found, closeness(coarser, run, alpha)]
            end, gain = _judge(trial, tolerance * alpha)
            if gain:
                best, found = run, trial
            if end is not None:
                verdict = end
                break
        coarser = run
    if progress is not None:
        progress(1.0)
    assert best is not None
    return replace(_reported(best, found, verdict, alpha), wall_time=spent)


def _judge(found: list[Closeness], tolerance: float) -> tuple[str | None, bool]:
    """Return why to stop, "" where the tilt has settled and None to go on, and whether the last is a gain."""
    last = found[-1]
    close = last.difference <= tolerance
    if math.isinf(last.divergence) and close:
        return "", True
    if len(found) < 2:
        return None, True
    before = found[-2]
    if last.divergence > before.divergence * _PUT_OFF:
        return None, True
    if math.isfinite(last.divergence):
        # the one before diverged later: the smaller step is the worse one
        gain = last.divergence >= before.divergence / _PUT_OFF
        return ("" if close and gain else "no_later"), gain
    if last.difference > _CLOSER * before.difference:
        return "no_closer", last.difference <= before.difference
    return None, True


def _estimate(found: list[Closeness]) -> tuple[float, float]:
    """Return Richardson's estimate of the error that is left [rad], and the order that it rests on."""
    last = found[-1]
    order = 1.0
    if len(found) > 1 and last.difference > 0.0 and found[-2].until >= last.until / _PUT_OFF:
        order = math.log2(max(found[-2].difference, 1e-300) / last.difference)
    order = min(max(order, _ORDERS[0]), _ORDERS[1])
    return last.difference / (2.0**order - 1.0), order


def _reported(run: Trace, found: list[Closeness], verdict: str, alpha: float) -> Trace:
    """The run with what halving found; `verdict` says why it has not settled, and is empty if it has."""
    if not found:
        fact = Diagnostic(code="unsettled", detail=verdict)
        return run if run.outcome == "failed" else replace(run, facts=(*run.facts, fact))
    last = found[-1]
    unknown, code = unknown_from(run)
    verdict = verdict or (code if math.isfinite(unknown) else "")
    if verdict:
        error = math.nan
        fact = Diagnostic(code="unsettled", duration=last.until, size=last.difference / alpha, detail=verdict)
    else:
        error, order = _estimate(found)
        fact = Diagnostic(code="settled", duration=last.until, size=error / alpha, bound=order)
    return replace(run, error_estimate=error, settled_until=last.until, facts=(*run.facts, fact))
