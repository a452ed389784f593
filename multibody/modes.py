"""Diagnostics of an engine's run in cases with an exact mode, slide or planar impact.

What slides from rest on flat ground with friction below b/h is a point with friction on the moving ground:
x'' = -a - mu (g + az) v/|v|. Solved here by a step of its own, in which friction takes of the velocity what
it can, all of it where that is enough.

The energy kept in a planar impact of the base follows from the moment of momentum (Housner). About the corner
over which the body goes on, the tilt rate is r times what it was, and the energy r^2 times:
r = (I1 + k (h^2 - b^2))/(I1 + k (h^2 + b^2)), with k the mass that a slab adds to. An engine has no such law;
where its contact arrives at it, that energy is not lost by error, and upright is no pass left to chance.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from rockwobble.models import Case, Diagnostic, Trace
from rockwobble.models.mode import REST, ROCKS_IN_PLANE, SLIDES, expected_mode
from rockwobble.models.trace import NO_PEAK

from .excitation import StepMeans
from .guard import DRIFT
from .scene import Array, Scale, default_step, scaled_body

TOLERANCE = 0.05  # share of the peak displacement
TURN = 0.01  # [rad] of a slide, whose friction has no moment about the axis


def mode_facts(trace: Trace) -> Iterator[Diagnostic]:
    """Deviations of an engine's run from mechanics: another mode, or a slide that turns or ends elsewhere."""
    case = trace.case
    expected = expected_mode(case, trace.run.support)
    allowed = {REST: (REST,), SLIDES: (REST, SLIDES)}.get(expected)
    if allowed is None or case.is_release or trace.outcome == "failed":
        return
    if trace.mode not in allowed:
        yield Diagnostic(code="mode", detail=trace.mode)
    if expected == SLIDES and trace.outcome not in NO_PEAK:
        twist = np.abs(trace.twist)
        if twist.max() > TURN:
            first = float(trace.time[int(np.argmax(twist > TURN))])
            yield Diagnostic(code="turning_slide", time=first, size=float(twist.max()), bound=TURN)
        path = path_of_slide(case, trace.time)
        away = np.hypot(*(trace.displacement - path).T)
        size = float(away.max()) / float(np.hypot(*path.T).max())
        if size > TOLERANCE:
            first = int(np.argmax(away > TOLERANCE * np.hypot(*path.T).max()))
            yield Diagnostic(
                code="unresolved_slide", time=float(trace.time[first]), size=size, bound=TOLERANCE
            )


def path_of_slide(case: Case, times: Array) -> Array:
    """Return the displacement (n, 2) [m] at `times` [s] of a body that slides from rest."""
    step = default_step(case.cylinder.semidiagonal, case.gravity)
    count = math.ceil(times[-1] / step) + 1
    push = StepMeans(case.motion, Scale(1.0, 1.0), step)(0, count)
    x = y = u = v = 0.0
    path = [(0.0, 0.0)]
    for ax, ay, az in push.tolist():
        u, v = u - step * ax, v - step * ay
        speed = math.hypot(u, v)
        lost = step * case.friction * max(case.gravity + az, 0.0)
        kept = 1.0 - lost / speed if speed > lost else 0.0
        u, v = kept * u, kept * v
        x, y = x + step * u, y + step * v
        path.append((x, y))
    at = np.array(path)
    return np.column_stack([np.interp(times, step * np.arange(count + 1), column) for column in at.T])


_KEPT_TOLERANCE = 0.01  # share of the energy with which the base closes
_LEAST = 0.01  # share of the largest energy: an impact with less decides no motion
_STEPS = 3.0  # largest duration of an impact in steps of the engine, to either side


def compare_impacts(trace: Trace) -> Trace:
    """The run with its diagnostics of impacts, if it is to rock in one plane.

    "impact_loss" names the first that keeps another share than momentum says. Where none does, upright is a
    resolved pass, and "energy" is what contact took besides.
    """
    case, largest = trace.case, float(trace.energy.max())
    if expected_mode(case, trace.run.support) != ROCKS_IN_PLANE or case.rolling_resistance > 0.0:
        return trace
    body = scaled_body(case.cylinder, 1.0)
    b2, h2 = body.base_radius**2, body.mass_centre_height**2
    inertia, mass = body.transverse_inertia, body.moved_mass
    share = max((inertia + mass * (h2 - b2)) / (inertia + mass * (h2 + b2)), 0.0) ** 2
    impacts, left = _impacts(trace, largest)
    for time, arrives, kept in impacts:
        if abs(kept - share * arrives) > _KEPT_TOLERANCE * arrives:
            fact = Diagnostic(code="impact_loss", time=time, size=1.0 - kept / arrives, bound=1.0 - share)
            return replace(trace, facts=(*trace.facts, fact))
    if not impacts or trace.mode != ROCKS_IN_PLANE:
        return trace
    facts = [fact for fact in trace.facts if fact.code not in ("energy", "unresolved_pass")]
    drifts = np.abs(left) > DRIFT * largest
    if drifts.any():
        time, size = float(trace.time[int(drifts.argmax()) + 1]), float(left[np.abs(left).argmax()]) / largest
        facts.append(Diagnostic(code="energy", time=time, size=size, bound=DRIFT))
    return replace(trace, facts=tuple(facts), passes=trace.passes.assign(resolved=True))


def _impacts(trace: Trace, largest: float) -> tuple[list[tuple[float, float, float]], Array]:
    """Time [s] and energy before and after of each impact that decides a motion, and the error without them.

    None where two of them lie between two samples.
    """
    time, error = trace.time, trace.energy_error
    # energy supplied by the start and the ground, continuous at an impact
    supplied = trace.energy - error
    change = np.diff(error)
    impacts: list[tuple[float, float, float]] = []
    end = 0
    for at in trace.extrema[trace.extrema[:, 3] < 0.0, 0].tolist():
        before = int(np.searchsorted(time, at - _STEPS * trace.time_step)) - 1
        after = int(np.searchsorted(time, at + _STEPS * trace.time_step))
        if before < 1 or after >= len(time):
            continue
        change[before:after] = 0.0
        slope = (supplied[before] - supplied[before - 1]) / (time[before] - time[before - 1])
        drive = supplied[before] + slope * (at - time[before])
        arrives, kept = float(drive + error[before]), float(drive + error[after])
        if arrives < _LEAST * largest:
            continue
        if before < end:
            return [], change
        impacts.append((at, arrives, kept))
        end = after
    return impacts, np.cumsum(change)
