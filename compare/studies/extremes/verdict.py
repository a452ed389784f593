"""Verdict on a run: its error, and whether one of its diagnostics explains it.

What a run is held against:

* exact_turn: the angle of turn of the recess model by quadrature, where a pass falls into the run;
* energy: that of a reduced model in free response is kept, which shares nothing with its steps;
* tight: the same model at a tolerance ten thousand times tighter;
* model: for an engine the reduced model of its support, until its own assumptions cease to hold;
* half_step: for an engine in a ring, which no reduced model knows, the same ring at half the step.

The verdicts are

* fine: the error is at most `FINE`;
* flagged: it is more, or the model leaves its assumptions, and a diagnostic says so: one of a kind that
  explains the error, and that begins no later than the error does;
* no reference: what it is held against has ceased to hold before the error begins;
* refused: bad input, of which `require_runnable` says so before anything runs;
* caught: the run ended as failed, with a diagnostic;
* silent: wrong, and nothing explains it. There must be none;
* n/a: the method has nothing of the kind.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np

from rockwobble import reduced
from rockwobble.models import AGREEMENT, Case, Diagnostic, Run, Trace
from rockwobble.models.diagnostic import FAILURES, joined
from rockwobble.multibody.engines.registry import engine_facts
from rockwobble.multibody.scene import REFERENCE_TIME_STEP

from ...comparison.prediction import time_scale
from ...metrics.pair import make_pair
from ...runs.choice import own_model, require_runnable
from ...runs.execution import simulate_run
from .conditions import Condition, without_spin

FINE = AGREEMENT  # of alpha, or of the angle of turn
# relative to the energy that balances the cylinder on its rim
_ENERGY = 1e-5
_TIGHT, _REFERENCE = 1e-12, 1e-10  # tolerances
# what makes an engine leave its reference: no wall, which the ring at half the step meets as well; a reduced
# model errs only where the side of a pass is undetermined
_EXPLAINS = frozenset(
    {"slip", "lift_off", "tension", "friction_needed", "energy", "unresolved_pass", "undecided"}
)
_EXPLAINS_REDUCED = frozenset({"side"})


@dataclass(frozen=True, slots=True, kw_only=True)
class Verdict:
    """Verdict on one run.

    Attributes
    ----------
    verdict : str
        See the module.
    error : float
        Largest, as far as the reference holds [alpha], or relative of an angle of turn; NaN if not known.
    reference : str
        What it was held against, codes of the module; the worst alone where it is not fine.
    until : float
        When the reference ceases to hold [s]; infinite if it does not.
    begins : float
        When the tilt is off by more than `FINE` [s]; infinite if it never is.
    limit : str
        Codes of the diagnostics that explain it.
    refusal : str
        The line of a refusal.
    """

    verdict: str
    error: float = math.nan
    reference: str = ""
    until: float = math.inf
    begins: float = math.inf
    limit: str = ""
    refusal: str = ""


def judge(condition: Condition, run: Run) -> Verdict:
    """Run a condition by a method, and return what is found."""
    if run.engine is None and condition.only_engines:
        return Verdict(verdict="n/a")
    if math.isfinite(condition.contact) and not _contact_time(run):
        return Verdict(verdict="n/a")
    case, run = _asked(condition, run)
    try:
        require_runnable(case, run)
    except ValueError as refusal:
        return Verdict(verdict="refused", refusal=str(refusal))
    trace = simulate_run(case, run, sample_step=condition.sample_step)
    if trace.outcome == "failed":
        return _failed(trace)
    return (_reduced if run.engine is None else _engine)(condition, run, trace)


def _asked(condition: Condition, run: Run) -> tuple[Case, Run]:
    """The case and the run that a condition asks of a method."""
    case = condition.case
    if run.engine is None:
        return without_spin(case) if "plane" in run.settings and condition.extreme != "spin" else case, run
    step = _step(condition)
    settings = {} if math.isnan(condition.contact) else {_contact_time(run): condition.contact * step}
    plain = condition.time_step == 1.0 and not settings
    return case, Run(run.engine, run.support, None if plain else step, **settings)


def _step(condition: Condition) -> float:
    return REFERENCE_TIME_STEP * condition.time_step * time_scale(condition.case)


def _reduced(condition: Condition, run: Run, trace: Trace) -> Verdict:
    case = trace.case
    tight = simulate_run(case, _tighter(run, _TIGHT), sample_step=condition.sample_step)
    error, begins = (math.inf, 0.0) if tight.outcome == "failed" else _tilt_error(tight, trace)
    errors = {"tight": error}
    if case.initial is not None and run == Run(None, "recess") and case.initial.rolling_rate > 0.0:
        turns = trace.passes["angle_of_turn"].to_numpy(float)
        if len(turns):
            exact = reduced.angle_of_turn(case.cylinder, case.initial, gravity=case.gravity)
            errors["exact_turn"] = abs(float(turns[0]) / exact - 1.0)
    if case.motion is None and trace.outcome == "stands" and not trace.rests:
        errors["energy"] = _energy_error(trace) * FINE / _ENERGY
    worst = max(errors, key=lambda each: errors[each])
    if errors[worst] > FINE:
        begins = begins if worst == "tight" else 0.0
        limit = _explanation(trace.facts, _EXPLAINS_REDUCED, begins)
        return Verdict(
            verdict="flagged" if limit else "silent",
            error=errors[worst],
            reference=worst,
            begins=begins,
            limit=limit,
        )
    assert trace.assumptions is not None
    limit = joined(fact.code for fact in trace.assumptions.breaches)
    return Verdict(
        verdict="flagged" if limit else "fine",
        error=errors[worst],
        reference=joined(errors),
        limit=limit,
    )


def _engine(condition: Condition, run: Run, trace: Trace) -> Verdict:
    case = condition.case
    if run.support == "ring":
        name, other = "half_step", Run(run.engine, run.support, 0.5 * _step(condition), **run.settings)
    else:
        name, other = "model", _tighter(own_model(run), _REFERENCE)
    reference = simulate_run(case, other, sample_step=condition.sample_step)
    if reference.outcome == "failed":
        return Verdict(verdict="no reference", reference=name, until=0.0)
    # a fall after the run is no concern of it but for its outcome: it multiplies every difference
    held = reference.assumptions_until(case.length) if name == "model" else None
    until = min((fact.time for fact in held.breaches), default=math.inf) if held else math.inf
    error, begins = _tilt_error(reference, trace)
    if error <= FINE:  # whatever the model assumes, the engine agrees with it to the end
        return Verdict(verdict="fine", error=error, reference=name)
    limit = _explanation(trace.diagnostics, _EXPLAINS, begins)
    if math.isfinite(until):
        error = _tilt_error(reference, trace, until)[0]
    found = Verdict(
        verdict="flagged" if limit else "silent",
        error=error,
        reference=name,
        until=until,
        begins=begins,
        limit=limit,
    )
    if until <= reference.time[1]:
        return replace(found, verdict="no reference", error=math.nan)
    return replace(found, verdict="no reference") if error <= FINE and not limit else found


def _contact_time(run: Run) -> str:
    """The setting that is the time of a run's contact; "" without one."""
    return "" if run.engine is None else engine_facts(run.engine).contact_time


def _tighter(run: Run, rtol: float) -> Run:
    return Run(None, run.support, **{**run.settings, "rtol": rtol})


def _failed(trace: Trace) -> Verdict:
    codes = [fact.code for fact in trace.facts if fact.code in FAILURES]
    return Verdict(verdict="caught" if codes else "silent", limit=joined(codes))


def _explanation(facts: Iterable[Diagnostic], kinds: frozenset[str], begins: float) -> str:
    """The code of the first diagnostic of these kinds that begins no later than an error; "" without."""
    able = [fact for fact in facts if fact.code in kinds and fact.time <= begins]
    return min(able, key=lambda fact: fact.time).code if able else ""


def _energy_error(trace: Trace) -> float:
    case = trace.case
    top = case.gravity * case.cylinder.semidiagonal * (1.0 - math.cos(case.cylinder.alpha))
    largest = max(top, float(np.abs(trace.energy).max()))
    return float(np.abs(trace.energy - trace.energy[0]).max()) / largest


def _tilt_error(reference: Trace, trial: Trace, until: float = math.inf) -> tuple[float, float]:
    """Largest difference of the tilt up to a time [alpha], and when it exceeds `FINE` [s]."""
    case = trial.case
    pair = make_pair(case.cylinder, reference, trial)
    within = pair.time <= min(until, case.length)
    off = np.abs(pair.tilt_difference)[within]
    error = float(off.max(initial=0.0))
    begins = float(pair.time[within][off > FINE].min(initial=math.inf))
    if reference.outcome != trial.outcome and math.isinf(until):
        apart = abs(reference.peak_tilt - trial.peak_tilt) / case.cylinder.alpha
        if apart > error:
            error, begins = apart, min(begins, case.length if apart > FINE else math.inf)
    return error, begins
