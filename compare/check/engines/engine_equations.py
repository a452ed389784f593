"""Layer equations, second half: accelerations measured in the engines on sampled states.

Engine and reduced model start from one state, on ground that accelerates evenly. By how much their
tilts differ after a short time, over half of its square, is the difference of their accelerations.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from rockwobble.models import Case, Cylinder, InitialState, Run, Trace

from ...runs.execution import Job
from ..bench import Array, Bench, engines_here, not_here
from ..finding import Bound, Finding, worst_of
from ..problems import GRAVITY, steady

STATES = 4  # of each cylinder
_SEED = 19
_TIME = 0.1  # [s] a tenth of 1/p, a thousand steps
# contact that starts, and the creep of the rim: first order in the step, 1e-4 s over the time measured
ACCELERATION = Bound(1e-3, "contact of steps of 1e-4 s, over 0.1 s", "g/R")


def check(bench: Bench) -> Iterator[Finding]:
    """Yield the findings of this half."""
    cases = list(_cases())
    yield from not_here("accelerations", bench.engines)
    engines = engines_here(bench.engines)
    jobs = [Job(case=case, run=bench.adjust(Run(engine, "recess"))) for engine in engines for case in cases]
    found = iter(bench.traces(jobs))
    models = {case.name: bench.solve(case, rtol=1e-12) for case in cases}
    for engine in engines:
        traces = {name: next(found) for name in models}
        for angle, field in (("tilt", "tilt"), ("rolling angle", "rolling_angle")):
            yield worst_of(
                f"acceleration of the {angle}, {engine} on {len(cases)} states",
                {name: _apart(field, trace, models[name]) for name, trace in traces.items()},
                ACCELERATION,
                f"equations of motion, or contact and guide of {engine}",
            )


def _cases() -> Iterator[Case]:
    random = np.random.default_rng(_SEED)
    for tan_alpha in (0.2, 1.0):
        cylinder = Cylinder(semidiagonal=6.0, tan_alpha=tan_alpha)
        p = math.sqrt(GRAVITY / cylinder.semidiagonal)
        for index in range(STATES):
            release = InitialState(
                tilt=random.uniform(0.3, 1.0) * cylinder.alpha,
                tilt_rate=random.uniform(-0.1, 0.1) * cylinder.alpha * p,
                rolling_angle=random.uniform(-math.pi, math.pi),
                rolling_rate=random.choice([-1.0, 1.0]) * random.uniform(0.4, 1.0) * p,
            )
            motion = steady(GRAVITY * tan_alpha * random.uniform(-0.5, 0.5, 2), 2.0 * _TIME)
            name = f"state {index + 1}, tan alpha = {tan_alpha:g}"
            yield Case(cylinder, motion, initial=release, duration=_TIME, name=name)


def _apart(field: str, run: Trace, model: Trace) -> float:
    """By how much the accelerations of an angle differ, in g/R."""
    if run.outcome == "failed":
        return math.nan
    size = GRAVITY / run.case.cylinder.semidiagonal
    time: Array = model.time[model.time <= run.case.length]  # what overturns later goes on for longer
    count = len(time)
    apart = getattr(run, field)[:count] - getattr(model, field)[:count]
    return abs(float(2.0 * (apart * time**2).sum() / (time**4).sum())) / size
