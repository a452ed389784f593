"""Whether an engine has moved as it must: in the mode that mechanics proves, as far as Coulomb's law says.

What slides from rest on flat ground with friction below b/h is a point with friction on the moving ground:
x'' = -a - mu (g + az) v/|v|. Solved here by a step of its own, in which friction takes of the velocity what
it can, all of it where that is enough.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from rockwobble.models import Case, Diagnostic, Trace
from rockwobble.models.mode import REST, SLIDES, expected_mode
from rockwobble.models.trace import NO_PEAK

from .excitation import StepMeans
from .scene import Array, Scale, default_step

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
