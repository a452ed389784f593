"""One run of a reduced model."""

from __future__ import annotations

import importlib.metadata
import math
import time
from collections.abc import Iterator
from functools import cache, partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rockwobble.models import Case, Diagnostic, Run, Trace
from rockwobble.models.bounds import OVERTURNED_TILT
from rockwobble.models.number_checks import require_sample_step
from rockwobble.models.support import RECESS
from rockwobble.models.trace import NO_PEAK

from . import kernels, sliding
from ._compile import announce, in_memory, on_disk
from .integration.result import COMPLETED, OVER_BUDGET, OVERTURNED, REST, UNDECIDED, IntegrationResult
from .problem import REST_TILT, Problem, sample_times
from .solution import Solution, six_columns

_OUTCOMES = {REST: "stands", COMPLETED: "stands", OVERTURNED: "overturned", UNDECIDED: "undecided"}


def simulate(
    case: Case,
    *,
    support: str = RECESS,
    plane: float | None = None,
    restitution: float | str = 1.0,
    rtol: float = 1e-8,
    rest_tilt: float = REST_TILT,
    sample_step: float = 0.01,
) -> Trace:
    """Simulate the motion of a cylinder that may uplift, rock and wobble.

    Parameters
    ----------
    case : Case
        Cylinder, ground motion, initial state, length, gravity, and the friction with which the friction
        demand is compared.
    support : {"recess", "flat"}, optional
        "recess": no slip, no roll-out, the paper's two degrees of freedom, (18) and (19); "flat": no slip,
        free to roll out, but where friction is below b/h: from rest a cylinder slides there, exactly, and
        neither uplifts nor turns. Friction 0 leaves it where it is while the ground moves below.
    plane : float, optional
        Azimuth of a vertical plane that holds the motion [rad]: planar motion, on either support. The
        component of the record across the plane is left out.
    restitution : float or "momentum", optional
        Ratio of tilt rates at an impact (planar motion only); 1 as in the paper's 2D spectra,
        "momentum" from the moment of momentum about the new pivot.
    rtol : float, optional
        Relative tolerance of one step.
    rest_tilt : float, optional
        Rest threshold: the cylinder is at rest again when its energy is below that of a standstill at the
        tilt ``rest_tilt * alpha``, less the share of the load that would uplift it; 0 leaves the rule out, as
        in the paper.
    sample_step : float, optional
        Spacing of the samples returned [s], at most 10 million of them; does not influence the solution.

    Returns
    -------
    Trace
        A numerical failure is an outcome with its diagnostics, not an exception. A run that ends while the
        cylinder moves is followed over still ground to the next maximum of the tilt, which counts for the
        peak; one that overturns, or slides to rest, ends there, later than asked for. What stays on its
        balance is "undecided".

    Raises
    ------
    ValueError
        If an option is out of range.

    Examples
    --------
    >>> from rockwobble.models import Case, Cylinder, InitialState
    >>> pier = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    >>> release = InitialState(tilt=0.5 * pier.alpha, rolling_rate=1e-3)
    >>> trace = simulate(Case(pier, initial=release, duration=10.0), rtol=1e-10)
    >>> trace.outcome, round(float(np.degrees(trace.passes.angle_of_turn[0])), 2)
    ('stands', 182.98)
    """
    problem = Problem(
        case, support=support, plane=plane, restitution=restitution, rtol=rtol, rest_tilt=rest_tilt
    )
    sample_step = require_sample_step(sample_step, case.length)
    if problem.slides:
        return sliding.simulate(case, sample_step, _version())
    make_ready(problem.kernel)
    times = sample_times(case.length, sample_step)
    started = time.perf_counter()
    result, azimuth = problem.solve(times)
    if result.end > case.length:  # overturned after the duration
        times = sample_times(result.end, sample_step)
        result, azimuth = problem.solve(times)
    return _trace(problem, result, azimuth, times, time.perf_counter() - started)


def is_compiled(model: str) -> bool:
    """Whether the code of `model` is in memory or on disk."""
    entry = kernels.INTEGRATORS[model]
    return in_memory(entry) or on_disk(entry)


def make_ready(model: str) -> None:
    """Load the compiled code of `model`, or compile it and say so on standard error: that takes seconds."""
    announce(kernels.INTEGRATORS[model], model, lambda: kernels.load(model))


def _trace(
    problem: Problem,
    result: IntegrationResult,
    azimuth: float,
    times: NDArray[np.float64],
    wall_time: float,
) -> Trace:
    case = problem.case
    given: dict[str, Any] = {} if problem.plane is None else {"plane": problem.plane}
    given |= {} if problem.restitution == 1.0 else {"restitution": problem.restitution}
    reached = result.reached
    times, states, moving = times[:reached], result.samples[:reached], result.moving[:reached]
    overturned = result.status == OVERTURNED
    if overturned and (not reached or times[-1] < result.end):
        times = np.append(times, result.end)
        states = np.vstack([states, result.final])
        moving = np.append(moving, True)
    full = six_columns(states, azimuth)
    if overturned:
        full[-1, 0] = OVERTURNED_TILT  # last tilt exactly pi/2, which Newton's iteration reaches to rounding
    outcome = _OUTCOMES.get(result.status, "failed")
    extrema = result.extrema
    extrema[:, 2] += azimuth
    solution = Solution(
        problem=problem,
        time=times,
        states=full,
        roll_out=states[:, 6:8] if states.shape[1] >= 8 else np.zeros((len(states), 2)),
        energy_lost=states[:, -1] if case.rolling_resistance else None,
        uplift_time=result.uplift_time,
        extrema=extrema,
        rest_intervals=result.rests,
    )
    return Trace(
        case=case,
        run=Run(None, problem.support, **given),
        version=_version(),
        time=times,
        tilt=full[:, 0],
        tilt_rate=full[:, 1],
        rolling_angle=np.where(moving, full[:, 2], math.nan),
        twist=full[:, 4],
        contact_point=partial(solution.contact_point, moving),
        centre_of_mass=solution.centre_of_mass,
        peak_tilt=OVERTURNED_TILT if overturned else math.nan if outcome in NO_PEAK else result.peak,
        outcome=outcome,
        uplift_time=result.uplift_time,
        uplift_direction=result.uplift_direction + azimuth,
        followed_until=result.followed_until,
        source=solution,
        passes=solution.passes,
        facts=tuple(_facts(problem, result)),
        rests=result.status == REST,
        rest_intervals=result.rests,
        extrema=extrema,
        settings={
            "rtol": problem.rtol,
            "rest_tilt": problem.rest_tilt,
            "plane": problem.plane,
            "restitution": problem.rebound,
        },
        wall_time=wall_time,
        step_count=result.step_count,
    )


def _facts(problem: Problem, result: IntegrationResult) -> Iterator[Diagnostic]:
    """Diagnostics of a run: its ending, and the quantities that it leaves undetermined."""
    if result.status == OVER_BUDGET:
        yield Diagnostic(code="step_budget", time=result.end, size=result.step_count - 1.0)
    elif result.status not in _OUTCOMES:
        yield Diagnostic(code="tolerance", time=result.end, bound=problem.rtol)
    if result.status == UNDECIDED:
        yield Diagnostic(code="undecided", time=min(result.end, problem.case.length))
    yield from _yield(problem, result)
    straight = result.extrema[result.extrema[:, 1] == 0.0, 0]
    if len(straight) and not problem.is_planar():
        yield Diagnostic(code="side", time=float(straight[0]))


_DIVISIONS, _ROUNDS = 64, 5  # search for the time at which a tendon yields: to 1e-9 of a swing


def _yield(problem: Problem, result: IntegrationResult) -> Iterator[Diagnostic]:
    """First time at which the tension of a tendon reaches its yield force, which a known tilt has."""
    case = problem.case
    tendon = case.tendon
    if tendon is None or tendon.yield_force is None or result.status not in _OUTCOMES:
        return
    largest = tendon.tension(case.cylinder, OVERTURNED_TILT if result.status == OVERTURNED else result.peak)
    if largest <= tendon.yield_force:
        return
    turns = result.extrema[result.extrema[:, 1] > 0.0]
    over = [tendon.tension(case.cylinder, tilt) > tendon.yield_force for tilt in turns[:, 1]]
    after = turns[int(np.argmax(over)), 0] if any(over) else result.end
    before = turns[turns[:, 0] < after, 0].max(initial=0.0)
    for _ in range(_ROUNDS):
        times = np.linspace(before, min(after, result.end), _DIVISIONS + 1)
        solution, _azimuth = problem.solve(times)
        tilts = solution.samples[: solution.reached, 0]
        first = [tendon.tension(case.cylinder, tilt) > tendon.yield_force for tilt in tilts]
        place = int(np.argmax(first)) if any(first) else len(tilts) - 1
        before, after = times[max(place - 1, 0)], times[place]
    yield Diagnostic(code="tendon_yield", time=float(after), size=largest, bound=tendon.yield_force)


@cache
def _version() -> str:
    return importlib.metadata.version("rockwobble")
