"""Layer properties, third part: what a run says of contact, friction and recess, against its own samples.

The forces at the samples are held against accelerations elsewhere; here it is what is made of them: the
friction needed, when a demand is not met, for how long and by how much, and the extremes of the run.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from rockwobble.models import Case, Cylinder, InitialState, Trace

from ..bench import Bench, largest
from ..finding import Bound, Finding, at_most, worst_of
from ..problems import PIER
from .turning_points import SHAKEN

_SAMPLE = 1e-3  # [s] 1/40 of the shortest pass
ROUNDING = Bound(1e-12, "horizontal over normal force")
# a demand that is not met at a sample was met at the one before
EDGES = Bound(_SAMPLE * 1.01, "the distance of two samples, for each beginning and end", "s")
# a parabola is cut off by 1/8 of its second difference: 3e-5 was measured
EXTREMES = Bound(3e-4, "the largest sample, which is next to the largest value")
PART = "contact and friction: what is made of the forces (reduced/assumptions.py)"


def check(bench: Bench) -> Iterator[Finding]:
    """Yield the findings of this part."""
    squat = Cylinder(semidiagonal=6.0, tan_alpha=1.5)
    release = InitialState(0.6 * squat.alpha, rolling_angle=0.3, rolling_rate=0.2)
    beyond = InitialState(1.5 * PIER.alpha, rolling_angle=0.3, rolling_rate=0.6)  # the ground has to pull
    for name, model, case in (
        ("shaken, recess", "recess", Case(PIER, SHAKEN, duration=5.0, friction=0.19)),
        ("shaken, flat ground", "flat", Case(PIER, SHAKEN, duration=5.0, friction=0.19)),
        ("released squat, recess", "recess", Case(squat, initial=release, duration=5.0, friction=0.6)),
        ("falling, recess", "recess", Case(PIER, initial=beyond, duration=5.0, friction=0.6)),
    ):
        yield from _one(name, bench.solve(case, model, sample_step=_SAMPLE, rtol=1e-10))


def _one(name: str, found: Trace) -> Iterator[Finding]:
    x, y, normal = found.contact_force.T
    moving = np.isfinite(found.rolling_angle)
    pressed = moving & (normal > 0.0)
    needed = np.hypot(x[pressed], y[pressed]) / normal[pressed]
    apart = largest(found.friction_needed[pressed] - needed)
    yield at_most(f"friction needed, {name}", apart, ROUNDING, "friction needed of a trace")
    short = np.zeros(len(moving), dtype=bool)
    short[pressed] = needed > found.case.friction
    edges = {"friction_needed": _edges(found, "friction_needed", short)}
    edges["tension"] = _edges(found, "tension", moving & (normal <= 0.0))
    yield worst_of(f"time and duration of what is not met, {name}", edges, EDGES, PART)
    held = found.assumptions
    if held is None:
        yield at_most(f"extremes of contact, friction and recess, {name}", math.nan, EXTREMES, PART)
        return
    extremes = {
        "least normal force": (normal[moving].min(), held.least_normal_force),
        "largest normal force": (normal[moving].max(), held.largest_normal_force),
        "restraining moment": (np.abs(found.restraining_moment).max(), held.largest_restraining_moment),
    }
    if pressed[moving].all():  # else the need has no bound
        extremes["friction"] = (needed.max(), held.largest_friction_needed)
    off = {what: (of_run - sample) / max(abs(sample), 1e-3) for what, (sample, of_run) in extremes.items()}
    yield worst_of(f"extremes of contact, friction and recess, {name}", off, EXTREMES, PART)


def _edges(found: Trace, code: str, broken: NDArray[np.bool_]) -> float:
    """Return how far begin and duration of a diagnostic differ from the samples [s]; NaN if one lacks."""
    fact = next((fact for fact in found.diagnostics if fact.code == code), None)
    if fact is None or not broken.any():
        return 0.0 if fact is None and not broken.any() else math.nan
    begins = np.flatnonzero(np.diff(broken.astype(int), prepend=0) == 1)
    length = _SAMPLE * np.count_nonzero(broken)
    late = abs(fact.time - found.time[begins[0]])
    return float(max(late, abs(fact.duration - length) / (2 * len(begins))))
