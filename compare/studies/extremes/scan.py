"""Every extreme by every method: whether the answer is right, how wrong it is, and whether the run says so.

What backs a verdict:

* an exact answer: the angle of turn of the recess model by quadrature, where a pass falls into the run;
* an invariant: the energy of a reduced model in free response, which shares nothing with its steps;
* a converged reference: the same model, ten thousand times tighter; for an engine the reduced model of its
  support, as far as its own assumptions hold.

The verdicts are

* fine: the error is at most `FINE`;
* inaccurate: it is more, or the model ceases to hold, and the run says so in its message;
* refused: a ValueError of one line before anything runs;
* caught: the run ended as failed, with a message;
* silent: wrong, and nothing is said. There must be none.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from rockwobble import multibody, reduced
from rockwobble.models import Run
from rockwobble.multibody.engines.registry import engine_facts, engine_packages, find_engine

from ...runs.choice import own_model
from ...runs.execution import run_engine
from ...runs.process_pool import ProcessPool, WorkerDiedError
from ...traces.pair import make_pair
from .table import Condition, conditions, planar_twin, unit_time

if TYPE_CHECKING:
    import pandas as pd

FINE = 0.01  # of alpha, or of the angle of turn: what ends an agreement everywhere else
# relative to the energy that balances the cylinder on its rim
_ENERGY = 1e-5
_TIGHT = 1e-12
_STEP = 1e-4  # [s] the default at 6 m

_MODELS = (
    ("reduced planar", "planar", ""),
    ("reduced recess", "recess", ""),
    ("reduced rolling", "flat", ""),
)
STAGES = ("extremes",)


def methods() -> tuple[tuple[str, str, str], ...]:
    """Return name, kind and support of each reduced model, and of our engines that are installed."""
    installed = multibody.available_engines()
    engines = (
        (f"{engine_facts(name).title} {support}", name, support)
        for name in engine_packages()
        if name in installed
        for support in find_engine(name).supports
    )
    return (*_MODELS, *engines)


@dataclass(frozen=True, slots=True, kw_only=True)
class _Verdict:
    verdict: str
    error: float = math.nan
    backed_by: str = ""
    message: str = ""


def measure_extremes(
    *, quick: bool = False, workers: int | None = None, tell: Callable[[str, float], None] | None = None
) -> pd.DataFrame:
    """Run every condition by every method that is installed.

    Parameters
    ----------
    quick : bool, optional
        Only the first and the last condition of each extreme.
    workers : int, optional
        Processes; default one for each core.
    tell : callable, optional
        Called with the stage and the fraction of it done.

    Returns
    -------
    DataFrame
        One row for each condition and method: extreme, value, method, verdict, error, backed_by, message.
    """
    import os

    import pandas as pd

    known = methods()
    tasks = [(condition, method) for condition in conditions(quick=quick) for method in known]
    rows = []
    with ProcessPool(workers or os.cpu_count() or 1) as pool:
        futures = [pool.submit(run, *task) for task in tasks]
        for done, ((condition, method), future) in enumerate(zip(tasks, futures, strict=True), 1):
            try:
                row = future.result()
            except WorkerDiedError as error:
                row = _row(condition, method, _Verdict(verdict="silent", message=f"crashed: {error}"))
            rows.append(row)
            if tell is not None:
                tell(STAGES[0], done / len(tasks))
    return pd.DataFrame(rows)


def run(condition: Condition, method: tuple[str, str, str]) -> dict[str, Any]:
    """Run one condition by one method; return its row, see `measure_extremes`."""
    _, kind, support = method
    if not support and condition.only_engines:
        return _row(condition, method, _Verdict(verdict="n/a"))
    if math.isfinite(condition.contact) and not (support and engine_facts(kind).contact_time):
        return _row(condition, method, _Verdict(verdict="n/a"))
    try:
        found = _engine(condition, kind, support) if support else _reduced(condition, kind)
    except ValueError as refusal:
        text = str(refusal)
        found = _Verdict(verdict="refused" if text and "\n" not in text else "silent", message=text)
    return _row(condition, method, found)


def _row(condition: Condition, method: tuple[str, str, str], found: _Verdict) -> dict[str, Any]:
    return {
        "extreme": condition.extreme,
        "value": condition.value,
        "method": method[0],
        "verdict": found.verdict,
        "error": found.error,
        "backed_by": found.backed_by,
        "message": found.message,
    }


def _solve(condition: Condition, model: str, rtol: float) -> reduced.Response:
    case = planar_twin(condition.case) if model == "planar" else condition.case
    return reduced.simulate(
        case.cylinder,
        case.motion,
        initial=case.initial,
        duration=case.duration,
        gravity=case.gravity,
        friction=case.friction,
        model=model,
        rtol=rtol,
        sample_step=condition.sample_step,
    )


def _reduced(condition: Condition, model: str) -> _Verdict:
    response = _solve(condition, model, 1e-8)
    if response.outcome == "failed":
        return _Verdict(verdict="caught", message=response.message)
    tight = _solve(condition, model, _TIGHT)
    errors = {"a reference of tolerance 1e-12": math.inf}
    if tight.outcome != "failed":
        errors = {"a reference of tolerance 1e-12": _tilt_error(condition, tight, response)}
    case = condition.case
    if case.initial is not None and model == "recess" and case.initial.rolling_rate > 0.0:
        turns = response.passes["angle_of_turn"].to_numpy(float)
        if len(turns):
            exact = reduced.angle_of_turn(case.cylinder, case.initial, gravity=case.gravity)
            errors["the exact angle of turn"] = abs(float(turns[0]) / exact - 1.0)
    if case.motion is None and response.outcome == "completed":
        errors["the energy kept"] = _energy_error(condition, response) * FINE / _ENERGY
    worst = max(errors, key=lambda each: errors[each])
    backing = ", ".join(errors)
    # what the model assumes and its own solution contradicts is said in words of its own
    said = "; ".join(str(breach) for breach in response.assumptions.breaches)
    if errors[worst] <= FINE:
        if said:
            return _Verdict(verdict="inaccurate", error=errors[worst], backed_by=backing, message=said)
        return _Verdict(verdict="fine", error=errors[worst], backed_by=backing)
    return _Verdict(
        verdict="inaccurate" if said else "silent", error=errors[worst], backed_by=worst, message=said
    )


def _energy_error(condition: Condition, response: reduced.Response) -> float:
    case = condition.case
    top = case.gravity * case.cylinder.semidiagonal * (1.0 - math.cos(case.cylinder.alpha))
    energy = np.asarray(response.energy)
    largest = max(top, float(np.abs(energy).max()))
    return float(np.abs(energy - energy[0]).max()) / largest


def _tilt_error(condition: Condition, reference: Any, trial: Any, until: float = math.inf) -> float:
    pair = make_pair(condition.case.cylinder, reference, trial)
    within = np.abs(pair.tilt_difference)[pair.time <= min(until, condition.case.length)]
    error = float(within.max(initial=0.0))
    if reference.outcome != trial.outcome and math.isinf(until):
        apart = abs(float(reference.peak_tilt) - float(trial.peak_tilt))
        return max(error, apart / condition.case.cylinder.alpha)
    return error


def _engine(condition: Condition, engine: str, support: str) -> _Verdict:
    case = condition.case
    step = _STEP * condition.time_step * unit_time(case)
    settings: dict[str, Any] = (
        {} if math.isnan(condition.contact) else {engine_facts(engine).contact_time: condition.contact * step}
    )
    run = Run(engine, support, None if condition.time_step == 1.0 and not settings else step, **settings)
    result = run_engine(case, run, sample_step=condition.sample_step)
    if result.outcome == "failed":
        return _Verdict(verdict="caught" if result.message else "silent", message=result.message)
    model = _solve(condition, own_model(support), 1e-10)
    if model.outcome == "failed":
        return _Verdict(
            verdict="inaccurate" if result.message else "silent",
            backed_by="nothing: the reduced model failed",
            message=result.message or model.message,
        )
    # a fall after the run is no concern of it but for its outcome: it multiplies every difference
    breaches = [breach.first_time for breach in model.assumptions_until(case.length).breaches]
    until = min(breaches, default=math.inf)
    error = _tilt_error(condition, model, result)
    if error <= FINE:  # whatever the model assumes, the engine agrees with it to the end
        until = math.inf
    else:
        error = _tilt_error(condition, model, result, until)
    backing = f"the {own_model(support)} model at a tolerance of 1e-10"
    whole = math.isinf(until)
    if not whole:
        backing += f", which holds until {until:.3g} s"
    if error <= FINE and whole:
        return _Verdict(verdict="fine", error=error, backed_by=backing, message=result.message)
    verdict = "inaccurate" if result.message else "silent"
    return _Verdict(verdict=verdict, error=error, backed_by=backing, message=result.message)


def silent(table: pd.DataFrame) -> Sequence[dict[str, Any]]:
    """Return the rows that are wrong and do not say so."""
    chosen = table.loc[table["verdict"] == "silent"]
    return [{str(key): value for key, value in row.items()} for row in chosen.to_dict("records")]
