"""Prediction of the agreement time, from the reduced models alone.

Three things end an agreement, and the first of them is the prediction:

* model form: the reduced model of the engine's support leaves the model that is asked about, as the
  flat-ground one leaves the recess;
* pass: a pass closer to upright than the engine's contact resolves, which leaves the side to chance;
* growth: a perturbed copy of the reduced run, off by as much as the engine errs, leaves it. Near passes
  multiply whatever difference there is, and the copy goes through the same passes.

The copy is perturbed through its gravity, which acts all the time as the error of a step does, and which
shifts the uplift as a base does that stands on corners. The size of the perturbation is set so that the
copy is as far off after the first second as the engine is.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from rockwobble.models import AGREEMENT, Case, Run, Trace
from rockwobble.models.members import perturbed_in_gravity
from rockwobble.multibody.engines.registry import engine_facts
from rockwobble.multibody.scene import REFERENCE_TIME_STEP, froude_scale

from ..metrics.pair import (
    FloatArray,
    agreement_of,
    landings,
    make_pair,
    rms,
    start_of,
)
from .budget import ErrorBudget

# a prediction is in time if the measured agreement time is within this factor of it, either way
IN_TIME = 2.0
# factor beyond which a prediction was too pessimistic to test the run
BEATEN = 10.0
# verdict, and reason why an agreement has not tested the model
UNTESTED = ("much later", "too little motion")
# [s] at a semidiagonal of 6 m and 9.81 m/s^2, and in proportion to the time scale of the cylinder
FIRST_STRETCH = 1.0
# relative change of gravity of the copy whose distance sets the scale; far above rounding, far below 1
_TRIAL = 1e-6
# largest relative change that is still a copy
_LARGEST = 1e-2
_SMALLEST_ERROR = 1e-9  # [alpha] smallest error of an engine, that of its contact

Simulate = Callable[[Case, Run], Trace]


@dataclass(frozen=True, slots=True, kw_only=True)
class Prediction:
    """Predicted end of an agreement.

    Parameters
    ----------
    length : float
        From uplift or release [s]; the length of the run where nothing ends it.
    reason : {"", "pass", "growth", "model form"}
        What ends it; empty where nothing does.
    """

    length: float
    reason: str


def estimated_error(case: Case, run: Run, time_step: float) -> float:
    """Tilt error of an engine in the first second of motion, estimated without a run [alpha].

    Parameters
    ----------
    case : Case
    run : Run
        An engine that nothing is known of counts as one of the better, see `EngineFacts`; a reduced model has
        no more than the smallest.
    time_step : float
        [s]
    """
    if run.is_model:
        return _SMALLEST_ERROR
    facts = engine_facts(run.engine_name)
    step = time_step / time_scale(case) / REFERENCE_TIME_STEP
    error = facts.release_error * case.cylinder.tan_alpha**2 if case.is_release else facts.uplift_error
    return max(error * math.pow(step, facts.order), _SMALLEST_ERROR)


def measured_error(case: Case, budget: ErrorBudget) -> float:
    """Tilt error of an engine in the first second, as measured by halving its step [alpha]."""
    start = float(budget.time[0]) if len(budget.time) else 0.0
    return max(early_rms(case, budget.time, budget.numerics, start), _SMALLEST_ERROR)


def close_pass(reference: Trace, contact_resolution: float, length: float) -> Prediction:
    """Prediction for a trajectory of unknown error: its first close pass alone."""
    return _first_of({"pass": _close_pass(reference, contact_resolution, length)}, reference, length)


def predict(
    case: Case,
    *,
    reference: Trace,
    own: Trace,
    contact_resolution: float,
    error: float,
    simulate: Simulate,
    tolerance: float = AGREEMENT,
) -> Prediction:
    """Predicted agreement time of engine and `reference`.

    Parameters
    ----------
    case : Case
    reference : Trace
        Response of the reduced model that is asked about.
    own : Trace
        Response of the reduced model of the engine's support; may be the reference itself.
    contact_resolution : float
        Smallest minimum tilt of a pass that the engine resolves [rad].
    error : float
        RMS error of the engine's tilt in the first second of motion [alpha].
    simulate : callable
        Runs a reduced model on a case; for the perturbed copy.
    tolerance : float, optional
        Tilt difference that ends the agreement [alpha].
    """
    length = case.length
    ends = {
        "model form": length if own is reference else _divergence(case, reference, own, tolerance),
        "pass": _close_pass(own, contact_resolution, length),
        "growth": _divergence_of_copy(case, own, error, simulate, tolerance),
    }
    return _first_of(ends, reference, length)


def _first_of(ends: Mapping[str, float], reference: Trace, length: float) -> Prediction:
    """Prediction of the first cause that ends the agreement, by time of the run [s]."""
    reason = min(ends, key=ends.__getitem__)
    if ends[reason] >= length:
        return Prediction(length=length, reason="")
    return Prediction(length=max(0.0, ends[reason] - start_of(reference)), reason=reason)


def verdict(measured: float, diverged: bool, predicted: float, reason: str) -> str:
    """Verdict on an agreement time and its prediction.

    Returns
    -------
    {"in time", "later", "much later", "earlier", "never, as predicted"}
        "later": they agree for more than twice as long as predicted, or to the end of the run;
        "much later": for more than ten times as long, so that the prediction is refuted;
        "earlier": for less than half as long, which is a finding.
    """
    if not diverged and not reason:
        return "never, as predicted"
    if diverged and measured * IN_TIME < predicted:
        return "earlier"
    if reason and measured > predicted * BEATEN:
        return "much later"
    if reason and measured > predicted * IN_TIME:
        return "later"
    return "in time"


def early_rms(case: Case, time: FloatArray, difference: FloatArray, start: float) -> float:
    """RMS of a difference in the first second after `start`, scaled with the time scale of the cylinder."""
    first = (time >= start) & (time <= start + FIRST_STRETCH * time_scale(case))
    return rms(difference[first]) if first.any() else 0.0


def time_scale(case: Case) -> float:
    """Time scale of a cylinder over that of one with R = 6 m at 9.81 m/s^2."""
    return froude_scale(case.cylinder.semidiagonal, case.gravity).time


def _divergence(case: Case, reference: Trace, other: Trace, tolerance: float) -> float:
    """Time at which two responses diverge [s]; the length of the run where they do not."""
    agreement = agreement_of(reference, other, until=case.length, tolerance=tolerance)
    return agreement.end if agreement.diverged else case.length


def _close_pass(own: Trace, contact_resolution: float, length: float) -> float:
    if own.run.loses_at_impact:
        return length  # the model closes its base as an engine does
    close = np.asarray(own.passes["minimum_tilt"], dtype=np.float64) < contact_resolution
    times = np.asarray(own.passes["time"], dtype=np.float64)[close]
    return float(min([*times[:1], *landings(own)[:1], length]))


def _divergence_of_copy(case: Case, own: Trace, error: float, simulate: Simulate, tolerance: float) -> float:
    for copy in copies_off_by(case, own, error, simulate)[:1]:
        # a perturbation below the reduced model's tolerance makes no copy
        return _divergence(case, own, simulate(copy, own.run), tolerance)
    return case.length


def copies_off_by(case: Case, own: Trace, error: float, simulate: Simulate) -> list[Case]:
    """Copies with gravity perturbed up and down until their early error equals the engine's.

    Parameters
    ----------
    case : Case
    own : Trace
        Response of the reduced model.
    error : float
        RMS error of the engine's tilt in the first second of motion [alpha].
    simulate : callable
        Runs a reduced model on a case.

    Returns
    -------
    list of Case
        Empty where nothing moves.
    """
    if not math.isfinite(own.uplift_time):
        return []
    trial = simulate(perturbed_in_gravity(case, _TRIAL), own.run)
    pair = make_pair(case.cylinder, own, trial, until=case.length)
    distance = early_rms(case, pair.time, pair.tilt_difference, start_of(own))
    relative = min(_TRIAL * error / distance, _LARGEST) if distance else 0.0
    return [perturbed_in_gravity(case, share) for share in (relative, -relative)] if relative else []
