"""Extremes: every method under extreme conditions, with a verdict on each run and its evidence.

The references of a run, by their codes:

* exact_turn: the angle of turn of the recess model by quadrature, where a pass falls into the run;
* energy: that of a reduced model in free response is kept, which shares nothing with its steps;
* tight: the same model at a tolerance ten thousand times tighter;
* model: for an engine the reduced model of its support, until its own assumptions cease to hold;
* half_step: for an engine between walls, which no reduced model has, the same run at half the step.

The verdicts are

* fine: the error is at most `FINE`;
* flagged: it is more, or the model leaves its assumptions, and a diagnostic says so: one of a kind that
  explains the error, and that begins no later than the error does;
* no reference: the reference has ceased to hold before the error begins;
* refused: bad input, of which a ValueError says so before anything runs;
* caught: the run ended as failed, with a diagnostic;
* silent: wrong, and nothing explains it. There must be none;
* n/a: the method has nothing of the kind.
"""

from __future__ import annotations

import dataclasses
import math
from collections import Counter
from collections.abc import Iterable, Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, replace

import numpy as np
import pandas as pd

import rockwobble as rw
from rockwobble import multibody, reduced
from rockwobble.compare import Results
from rockwobble.models import AGREEMENT, Case, Cylinder, Diagnostic, GroundMotion, InitialState, Run, Trace

_PLANAR_MODEL = Run(None, "flat", plane=0.0)

FINE = AGREEMENT  # of alpha, or of the angle of turn
# relative to the energy that balances the cylinder on its rim
_ENERGY = 1e-5
_TIGHT, _REFERENCE = 1e-12, 1e-10  # tolerances of a model: to check it, and as reference of engines
# what makes an engine leave its reference: no wall, which the reference at half the step meets as well; a
# reduced model errs only where the side of a pass is undetermined
_EXPLAINS = frozenset(
    {
        "slip",
        "lift_off",
        "tension",
        "friction_needed",
        "energy",
        "early_uplift",
        "unresolved_pass",
        "undecided",
    }
)
_EXPLAINS_REDUCED = frozenset({"side"})
# diagnostics of a run that failed
_FAILURES = frozenset(
    {
        "not_finite",
        "energy_gain",
        "penetration",
        "wall_penetration",
        "guide",
        "warning",
        "step_budget",
        "tolerance",
    }
)

_TAN_ALPHA, _SIZE, _GRAVITY = 0.2, 6.0, 9.81
_RATE = 0.5  # [rad/s] at 6 m
# [s] at 6 m: more than a period of the tilt, so that an angle of turn can be compared with the exact one
_LENGTH = 2.6


@dataclass(frozen=True, slots=True, kw_only=True)
class Condition:
    """One extreme at one value.

    Parameters
    ----------
    extreme, value : str
        What is extreme, and how much, with its unit.
    case : Case
    time_step : float
        Over that of the default; 1 is the default. Reduced models have none.
    contact : float
        Contact time constant over the step; NaN is the default.
    sample_step : float
        Time between samples of the run [s].
    only_engines : bool
        Whether a reduced model has nothing of the kind.
    """

    extreme: str
    value: str
    case: Case
    time_step: float = 1.0
    contact: float = math.nan
    sample_step: float = 0.01
    only_engines: bool = False


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
        Its codes, see the module; that of the worst alone where it is not fine.
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


Task = tuple[Condition, Run]


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class Extremes(Results, kind="extremes"):
    """Verdicts of a scan of the extremes.

    Attributes
    ----------
    extremes : DataFrame
        One row for each condition and method: extreme, value, method, and the attributes of `Verdict`.
    """

    def headline(self) -> dict[str, int]:
        """Number of runs, and of those with each verdict."""
        return {"runs": len(self.extremes), **Counter(map(str, self.extremes["verdict"]))}


def measure() -> Extremes:
    """Verdicts on every condition by every method that is installed."""
    tasks = [(condition, run) for condition in conditions() for run in methods()]
    with ProcessPoolExecutor() as workers:
        rows = list(workers.map(measure_task, tasks))
    return Extremes(tables={"extremes": pd.DataFrame(rows)}, facts={})


def measure_task(task: Task) -> dict[str, object]:
    """Row of one condition and method."""
    condition, run = task
    named = {"extreme": condition.extreme, "value": condition.value, "method": str(run)}
    return named | dataclasses.asdict(judge(condition, run))


def methods() -> tuple[Run, ...]:
    """Reduced models, and each support of each of our engines that is installed."""
    models = (Run(None, support) for support in reduced.SUPPORTS)
    engines = (
        Run(name, support)
        for name in multibody.available_engines()
        for support in multibody.find_engine(name).supports
    )
    return (_PLANAR_MODEL, *models, *engines)


def conditions() -> Iterator[Condition]:
    """Yield the conditions, those of each extreme one after another from far too small to far too large."""
    for spin, length in ((0.0, 2.0), (1e-9, 2.0), (1e-3, 2.0), (3.0, 2.0), (10.0, 1.0), (1e3, 0.05)):
        yield Condition(extreme="spin", value=f"{spin:g} rad/s", case=_release(rate=spin, length=length))
    for tan_alpha in (1e-3, 0.01, 0.05, 1.0, 3.0, 10.0, 100.0):
        case = _release(tan_alpha=tan_alpha)
        yield Condition(extreme="slenderness", value=f"tan α = {tan_alpha:g}", case=case)
    for size in (1e-3, 0.01, 100.0, 1e4):
        yield Condition(extreme="size", value=f"R = {size:g} m", case=_release(size=size))
    for gravity in (1e-3, 1.62, 1e3):
        yield Condition(extreme="gravity", value=f"{gravity:g} m/s²", case=_release(gravity=gravity))
    for peak in (0.0, 0.199, 0.205, 1.0, 10.0, 100.0):
        yield Condition(extreme="intensity", value=f"{peak:g} g", case=_shaken(peak))
    for spacing in (1e-4, 0.02, 0.5):
        case = _shaken(0.5, spacing=spacing)
        yield Condition(extreme="sample spacing", value=f"record {spacing:g} s", case=case)
    for step in (1e-4, 1.0, 100.0):
        yield Condition(
            extreme="sample spacing", value=f"output {step:g} s", case=_release(), sample_step=step
        )
    for length in (1e-6, 1e-3, 20.0, 60.0):
        yield Condition(extreme="duration", value=f"{length:g} s", case=_release(length=length))
    for part, length in ((0.01, 0.05), (0.1, 0.5), (5.0, 2.0), (10.0, 2.0), (100.0, 2.0)):
        yield Condition(
            extreme="time step", value=f"{part:g} times the default", case=_release(length=length),
            time_step=part, only_engines=True,
        )  # fmt: skip
    for contact in (0.1, 1.0, 10.0, 1e3, 1e5):
        yield Condition(
            extreme="contact stiffness", value=f"time constant {contact:g} steps", case=_release(),
            contact=contact, only_engines=True,
        )  # fmt: skip
    for friction in (0.0, 0.01, 0.15, 0.25, 10.0):
        yield Condition(extreme="friction", value=f"{friction:g}", case=_release(friction=friction))


def _release(
    *,
    tan_alpha: float = _TAN_ALPHA,
    size: float = _SIZE,
    gravity: float = _GRAVITY,
    rate: float = _RATE,
    length: float = _LENGTH,
    friction: float = 5.0,
) -> Case:
    """Release at alpha/2, with rate and length scaled by size and gravity (Froude)."""
    unit = _time_scale(size, gravity)
    cylinder = Cylinder(semidiagonal=size, tan_alpha=tan_alpha)
    release = InitialState(0.5 * cylinder.alpha, rolling_rate=rate / unit)
    return Case(
        cylinder, initial=release, duration=length * unit, gravity=gravity, friction=friction, name="release"
    )


def _shaken(peak: float, *, spacing: float = 0.01) -> Case:
    """Two seconds of two sines with a peak [g]."""
    time = np.arange(0.0, _LENGTH + 0.5 * spacing, spacing)
    wave = np.column_stack([np.sin(6.0 * time), 0.6 * np.cos(5.0 * time) * np.minimum(1.0, 4.0 * time)])
    motion = GroundMotion(wave, spacing)
    scaled = motion.scaled(_GRAVITY * peak / motion.peak)
    cylinder = Cylinder(semidiagonal=_SIZE, tan_alpha=_TAN_ALPHA)
    return Case(cylinder, scaled, duration=_LENGTH, friction=5.0, name="shaken")


def judge(condition: Condition, run: Run) -> Verdict:
    """Run a condition by a method, and return what is found."""
    sets_contact = math.isfinite(condition.contact)
    if (run.is_model and condition.only_engines) or (sets_contact and not _contact_time(run)):
        return Verdict(verdict="n/a")
    case, run = _request(condition, run)
    try:
        trace = _simulate(case, run, condition)
    except ValueError as refusal:
        return Verdict(verdict="refused", refusal=str(refusal))
    if trace.outcome == "failed":
        codes = [fact.code for fact in trace.facts if fact.code in _FAILURES]
        return Verdict(verdict="caught" if codes else "silent", limit=", ".join(dict.fromkeys(codes)))
    return (_model_verdict if run.is_model else _engine)(condition, run, trace)


def _simulate(case: Case, run: Run, condition: Condition) -> Trace:
    options = {"support": run.support, "engine": run.engine, "time_step": run.time_step, **run.settings}
    return rw.simulate(case, sample_step=condition.sample_step, **options)


def _request(condition: Condition, run: Run) -> tuple[Case, Run]:
    """Case (in one vertical plane where needed) and run of a condition by a method."""
    case = condition.case
    if run.is_model:
        if run.is_planar and condition.extreme != "spin" and case.initial is not None:
            case = replace(case, initial=replace(case.initial, rolling_rate=0.0))
        return case, run
    step = _step(condition)
    settings = {} if math.isnan(condition.contact) else {_contact_time(run): condition.contact * step}
    plain = condition.time_step == 1.0 and not settings
    return case, Run(run.engine, run.support, None if plain else step, **settings)


def _step(condition: Condition) -> float:
    case = condition.case
    return 1e-4 * condition.time_step * _time_scale(case.cylinder.semidiagonal, case.gravity)


def _time_scale(size: float, gravity: float) -> float:
    """Time at a size and gravity over that of 6 m on Earth, in Froude's sense."""
    return math.sqrt(size / _SIZE * _GRAVITY / gravity)


def _contact_time(run: Run) -> str:
    """Setting that is the contact time constant of a run; "" without one."""
    return "" if run.is_model else multibody.find_engine(run.engine_name).facts.contact_time


def _tighter(run: Run, rtol: float) -> Run:
    return Run(None, run.support, **{**run.settings, "rtol": rtol})


def _model_verdict(condition: Condition, run: Run, trace: Trace) -> Verdict:
    case = trace.case
    tight = _simulate(case, _tighter(run, _TIGHT), condition)
    error, begins = (math.inf, 0.0) if tight.outcome == "failed" else _tilt_error(tight, trace)
    errors = {"tight": error}
    turns = trace.passes["angle_of_turn"].to_numpy(float)
    if run.support.guided and case.initial is not None and case.initial.rolling_rate > 0.0 and len(turns):
        exact = reduced.angle_of_turn(case.cylinder, case.initial, gravity=case.gravity)
        errors["exact_turn"] = abs(float(turns[0]) / exact - 1.0)
    if case.motion is None and trace.outcome == "stands" and not trace.rests:
        errors["energy"] = _energy_error(trace) * FINE / _ENERGY
    worst = max(errors, key=lambda each: errors[each])
    if errors[worst] > FINE:
        begins = begins if worst == "tight" else 0.0
        limit, reference, otherwise = _explanation(trace.facts, _EXPLAINS_REDUCED, begins), worst, "silent"
    else:
        assert trace.assumptions is not None
        limit = ", ".join(dict.fromkeys(fact.code for fact in trace.assumptions.breaches))
        begins, reference, otherwise = math.inf, ", ".join(errors), "fine"
    return Verdict(
        verdict="flagged" if limit else otherwise,
        error=errors[worst],
        reference=reference,
        begins=begins,
        limit=limit,
    )


def _engine(condition: Condition, run: Run, trace: Trace) -> Verdict:
    case = condition.case
    if run.support.walls:
        name, other = "half_step", Run(run.engine, run.support, 0.5 * _step(condition), **run.settings)
    else:
        name, other = "model", _tighter(run.own_model, _REFERENCE)
    reference = _simulate(case, other, condition)
    if reference.outcome == "failed":
        return Verdict(verdict="no reference", reference=name, until=0.0)
    # a fall after the end of the case counts by its outcome alone
    held = reference.assumptions_until(case.length) if name == "model" else None
    until = min((fact.time for fact in held.breaches), default=math.inf) if held else math.inf
    error, begins = _tilt_error(reference, trace)
    if error <= FINE:  # agreement to the end, whatever the model assumes
        return Verdict(verdict="fine", error=error, reference=name)
    limit = _explanation(trace.diagnostics, _EXPLAINS, begins)
    verdict = "flagged" if limit else "silent"
    if math.isfinite(until):
        error = _tilt_error(reference, trace, until)[0]
    if until <= reference.time[1]:
        verdict, error = "no reference", math.nan
    elif error <= FINE and not limit:
        verdict = "no reference"
    return Verdict(verdict=verdict, error=error, reference=name, until=until, begins=begins, limit=limit)


def _explanation(facts: Iterable[Diagnostic], kinds: frozenset[str], begins: float) -> str:
    """Code of the first diagnostic of these kinds no later than an error; "" if none."""
    able = [fact for fact in facts if fact.code in kinds and fact.time <= begins]
    return min(able, key=lambda fact: fact.time).code if able else ""


def _energy_error(trace: Trace) -> float:
    case = trace.case
    top = case.gravity * case.cylinder.semidiagonal * (1.0 - math.cos(case.cylinder.alpha))
    largest = max(top, float(np.abs(trace.energy).max()))
    return float(np.abs(trace.energy - trace.energy[0]).max()) / largest


def _tilt_error(reference: Trace, trial: Trace, until: float = math.inf) -> tuple[float, float]:
    """Largest tilt difference up to a time [alpha], and the first time it exceeds `FINE` [s]."""
    case = trial.case
    time = reference.time[reference.time <= min(until, case.length, trial.time[-1] + 1e-9)]
    off = np.abs(np.interp(time, trial.time, trial.tilt) - reference.tilt[: len(time)]) / case.cylinder.alpha
    error = float(off.max(initial=0.0))
    begins = float(time[off > FINE].min(initial=math.inf))
    if reference.outcome != trial.outcome and math.isinf(until):
        apart = abs(reference.peak_tilt - trial.peak_tilt) / case.cylinder.alpha
        if apart > error:
            error, begins = apart, min(begins, case.length if apart > FINE else math.inf)
    return error, begins
