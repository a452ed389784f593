"""Layer order: errors fall as the methods promise, with the tolerance and with the time step."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

import numpy as np

from rockwobble.models import Case, Cylinder, Run, el_centro_1940

from ...metrics.tilt import rms
from ...runs.execution import Job
from ..bench import Bench, engines_here, largest, not_here
from ..finding import Bound, Finding, at_most
from ..problems import PIER, released

TOLERANCES = (1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10)
STEPS = (4e-4, 2e-4, 1e-4)
SQUAT = released(0.5, 0.5, 2.0, Cylinder(semidiagonal=6.0, tan_alpha=1.0), "release, tan alpha = 1")
# scatter of a slope
BY_TOLERANCE = Bound(0.2, "tolerances from 1e-5 to 1e-10")
BY_STEP = Bound(0.2, "three steps, from 4e-4 to 1e-4 s")


def check(bench: Bench) -> Iterator[Finding]:
    """Yield the findings of this layer."""
    problems = {
        "free motion": released(0.5, 0.05, 20.0),
        "El Centro": Case(PIER, el_centro_1940(), duration=12.0),
    }
    for name, case in problems.items():
        for model in ("recess", "flat"):
            exact = bench.solve(case, model, rtol=1e-13)
            errors = [largest(bench.solve(case, model, rtol=r).tilt - exact.tilt) for r in TOLERANCES]
            slope = _slope(TOLERANCES, errors)
            yield at_most(
                f"error in proportion to the tolerance, {name}, {model}",
                abs(slope - 1.0),
                BY_TOLERANCE,
                "step control",
                f"slope {slope:.2f}",
            )
    exact = bench.solve(SQUAT)
    yield from not_here("first order in the time step", bench.engines)
    # the rim creeps by a share of the step where friction only stops the slip: first order
    runs = {
        engine: [bench.adjust(Run(engine, "recess", step, friction_damping=1.0)) for step in STEPS]
        for engine in engines_here(bench.engines)
    }
    found = iter(bench.traces([Job(case=SQUAT, run=run) for each in runs.values() for run in each]))
    for engine in runs:
        traces = [next(found) for _ in STEPS]
        errors = [math.nan if t.outcome == "failed" else rms(t.tilt - exact.tilt) for t in traces]
        slope = _slope(STEPS, errors)
        yield at_most(
            f"first order in the time step, {engine} with friction that only stops",
            abs(slope - 1.0),
            BY_STEP,
            f"{engine}: stepping or contact",
            f"slope {slope:.2f}",
        )


def _slope(sizes: Sequence[float], errors: Sequence[float]) -> float:
    if not all(math.isfinite(error) and error > 0.0 for error in errors):
        return math.nan
    return float(np.polyfit(np.log(sizes), np.log(errors), 1)[0])
