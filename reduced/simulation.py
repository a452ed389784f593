"""One run of a reduced model."""

from __future__ import annotations

import math
import sys
import time

import numpy as np
from numpy.typing import NDArray

from rockwobble.models import Cylinder, GroundMotion, InitialState

from . import kernels
from ._compile import in_memory, on_disk
from .integration.march import COMPLETED, OVER_BUDGET, OVERTURNED, REST, March
from .problem import REST_TILT, Problem, make_problem
from .response import Response

_OUTCOMES = {REST: "rest", COMPLETED: "completed", OVERTURNED: "overturned"}


def simulate(
    cylinder: Cylinder,
    motion: GroundMotion | None = None,
    *,
    initial: InitialState | None = None,
    duration: float | None = None,
    rtol: float = 1e-8,
    sample_step: float = 0.01,
    rest_tilt: float = REST_TILT,
    gravity: float = 9.81,
    friction: float = 1.0,
    model: str = "recess",
    plane: float = 0.0,
    restitution: float | str = 1.0,
) -> Response:
    """Simulate the motion of a cylinder that may uplift, rock and wobble.

    Parameters
    ----------
    cylinder : Cylinder
    motion : GroundMotion, optional
        Default: still ground; then `duration` is required.
    initial : InitialState, optional
        Default: standing at rest.
    duration : float, optional
        Length of the run [s]; default: that of the motion.
    rtol : float, optional
        Relative tolerance of one step.
    sample_step : float, optional
        Spacing of the samples returned [s]; does not influence the solution.
    rest_tilt : float, optional
        The cylinder is at rest again when its energy is below that of a standstill at the tilt
        ``rest_tilt * alpha``; 0 leaves the rule out, as in the paper.
    gravity : float, optional
        g [m/s^2].
    friction : float, optional
        Coefficient that `Response.assumptions` holds the friction needed against.
    model : {"recess", "flat", "planar"}, optional
        "recess": no slip, no roll-out, the paper's two degrees of freedom, (18) and (19);
        "flat": no slip, free to roll out; "planar": one vertical plane.
    plane : float, optional
        Azimuth of that plane [rad] (planar model only).
    restitution : float or "momentum", optional
        Ratio of tilt rates at an impact (planar model only); 1 as in the paper's 2D spectra,
        "momentum" from the moment of momentum about the new pivot.

    Returns
    -------
    Response
        A numerical failure is an outcome with a message, not an exception.

    Raises
    ------
    ValueError
        If an option is out of range.

    Examples
    --------
    >>> from rockwobble.models import Cylinder, InitialState
    >>> pier = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    >>> release = InitialState(tilt=0.5 * pier.alpha, rolling_rate=1e-3)
    >>> response = simulate(pier, initial=release, duration=10.0, rtol=1e-10)
    >>> response.outcome, round(float(np.degrees(response.passes.angle_of_turn[0])), 2)
    ('completed', 182.98)
    """
    problem = make_problem(
        model,
        cylinder,
        motion,
        initial,
        duration,
        gravity=gravity,
        rtol=rtol,
        rest_tilt=rest_tilt,
        plane=plane,
        restitution=restitution,
    )
    if not (math.isfinite(sample_step) and sample_step > 0.0):
        raise ValueError(f"sample_step must be positive and finite [s], got {sample_step!r}")
    if not friction >= 0.0:
        raise ValueError(f"friction must not be negative, got {friction!r}")
    make_ready("planar" if problem.is_planar() else model)
    times = sample_times(problem.duration, sample_step)
    started = time.perf_counter()
    march, azimuth = problem.solve(times)
    if march.end > problem.duration:  # it overturns later
        times = sample_times(march.end, sample_step)
        march, azimuth = problem.solve(times)
    wall_time = time.perf_counter() - started
    return _response(problem, march, azimuth, times, friction, wall_time)


def make_ready(model: str) -> None:
    """Load the march of `model`, or compile it and say so on standard error: that takes seconds."""
    entry = kernels.MARCHES[model]
    if not in_memory(entry):
        if not on_disk(entry):
            print(f"rockwobble: compiling the {model} model, once for this installation ...", file=sys.stderr)
        kernels.load(model)


def sample_times(duration: float, sample_step: float) -> NDArray[np.float64]:
    """Return the multiples of `sample_step` before `duration`, and `duration` itself (n,) [s]."""
    # a multiple within rounding of the end is the end
    count = math.ceil(duration / sample_step * (1.0 - 1e-12))
    times = np.arange(count + 1, dtype=float)
    times *= sample_step
    times[-1] = duration
    return times


def _response(
    problem: Problem,
    march: March,
    azimuth: float,
    times: NDArray[np.float64],
    friction: float,
    wall_time: float,
) -> Response:
    reached = march.reached
    times, states, moving = times[:reached], march.samples[:reached], march.moving[:reached]
    if march.status == OVERTURNED and (not reached or times[-1] < march.end):
        times = np.append(times, march.end)
        states = np.vstack([states, march.final])
        moving = np.append(moving, True)
    overturned = march.status == OVERTURNED
    if overturned:
        states[-1, 0] = 0.5 * math.pi  # the last of a Newton iteration
    none = np.zeros(len(states))
    # planar motion has neither spin nor twist, and only the flat-ground model has the latter
    momentum = states[:, 3] if states.shape[1] > 3 else none
    twist, twist_momentum = (states[:, 4], states[:, 5]) if states.shape[1] > 4 else (none, none)
    outcome = _OUTCOMES.get(march.status, "failed")
    extrema = march.extrema
    extrema[:, 2] += azimuth
    return Response(
        time=times,
        tilt=states[:, 0],
        tilt_rate=states[:, 1],
        rolling_angle=np.where(moving, states[:, 2] + azimuth, math.nan),
        twist=twist,
        peak_tilt=math.nan if outcome == "failed" else 0.5 * math.pi if overturned else march.peak,
        outcome=outcome,
        message=_message(problem, march),
        uplift_time=march.uplift_time,
        uplift_direction=march.uplift_direction + azimuth,
        friction=friction,
        wall_time=wall_time,
        step_count=march.step_count,
        problem=problem,
        momentum=momentum,
        twist_momentum=twist_momentum,
        roll_out=states[:, 6:8] if states.shape[1] == 8 else np.zeros((len(states), 2)),
        extrema=extrema,
        rests=march.rests,
    )


def _message(problem: Problem, march: March) -> str:
    remarks = [_ending(problem, march)]
    count = len(march.rests) - (march.status == REST)
    if count > 0:
        times = "once" if count == 1 else f"{count} times"
        remarks.append(f"came to rest {times} in between, first at {march.rests[0, 0]:.4g} s")
    straight = march.extrema[march.extrema[:, 1] == 0.0]
    if len(straight) and not problem.is_planar():
        remarks.append(
            f"passed straight through the upright position, first at {straight[0, 0]:.4g} s: the ground had "
            "moved in one plane, and the side of such a pass is undetermined"
        )
    return "; ".join(remarks)


def _ending(problem: Problem, march: March) -> str:
    if march.status == OVERTURNED:
        after = ", after the end of the run, on still ground" if march.end > problem.duration else ""
        return f"overturned: the side reached the ground at {march.end:.4g} s{after}"
    if march.status == OVER_BUDGET:
        return (
            f"the step budget of {march.step_count - 1} steps was used up at {march.end:.4g} s: the motion "
            f"chatters near the upright position (a rest threshold above {problem.rest_tilt:g} would end it)"
        )
    if march.status not in _OUTCOMES:
        return f"no step met the tolerance of {problem.rtol:g} at {march.end:.4g} s"
    if math.isnan(march.uplift_time):
        return "did not uplift"
    if march.status == REST:
        return "came to rest upright"
    return "still in motion at the end"
