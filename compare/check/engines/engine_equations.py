"""Layer equations, second half: accelerations measured in the engines on sampled states.

Engine and reduced model start from one state, on ground that accelerates evenly. By how much their
tilts differ after a short time, over half of its square, is the difference of their accelerations.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from rockwobble.models import Case, Cylinder, GroundMotion, InitialState, Run

from ..bench import Bench, crashed, engines_here, not_here
from ..finding import Finding, at_most

LAYER = "equations"
CYLINDERS = (Cylinder(semidiagonal=6.0, tan_alpha=0.2), Cylinder(semidiagonal=6.0, tan_alpha=1.0))
STATES = 4  # of each cylinder
_SEED = 19
_TIME = 0.1  # [s] a tenth of 1/p, a thousand steps
# contact that starts, and the creep of the rim: first order in the step, 1e-4 s over the time measured
ACCELERATION = 1e-3


def check(bench: Bench) -> Iterator[Finding]:
    """Yield the findings of this half."""
    cases = list(_cases())
    yield from not_here(LAYER, "accelerations")
    engines = engines_here()
    wanted = [
        (case, bench.adjust(Run(engine, "recess")), f"{engine} guided")
        for engine in engines
        for case in cases
    ]
    found = bench.engine_runs(wanted)
    models = [bench.response(case, "recess", rtol=1e-12) for case in cases]
    for index, engine in enumerate(engines):
        runs = found[index * len(cases) : (index + 1) * len(cases)]
        errors = [
            _apart(case, *pair) for case, pair in zip(cases, zip(runs, models, strict=True), strict=True)
        ]
        for angle, values in zip(("tilt", "rolling angle"), zip(*errors, strict=True), strict=True):
            worst = max(range(len(cases)), key=lambda i: values[i] if math.isfinite(values[i]) else math.inf)
            yield at_most(
                LAYER,
                f"acceleration of the {angle}, {engine} on {len(cases)} states",
                values[worst],
                ACCELERATION,
                unit="g/R",
                reason=f"contact of steps of 1e-4 s, over {_TIME:g} s",
                part=f"equations of motion, or contact and guide of {engine}",
                note=f"worst: {cases[worst].name}",
            )


def _cases() -> Iterator[Case]:
    random = np.random.default_rng(_SEED)
    for cylinder in CYLINDERS:
        p = math.sqrt(9.81 / cylinder.semidiagonal)
        for index in range(STATES):
            release = InitialState(
                tilt=random.uniform(0.3, 1.0) * cylinder.alpha,
                tilt_rate=random.uniform(-0.1, 0.1) * cylinder.alpha * p,
                rolling_angle=random.uniform(-math.pi, math.pi),
                rolling_rate=random.choice([-1.0, 1.0]) * random.uniform(0.4, 1.0) * p,
            )
            ground = 9.81 * cylinder.tan_alpha * random.uniform(-0.5, 0.5, 2)
            motion = GroundMotion(np.tile(ground, (3, 1)), _TIME)
            yield Case(
                cylinder,
                motion,
                initial=release,
                duration=_TIME,
                name=f"state {index + 1}, tan alpha = {cylinder.tan_alpha:g}",
            )


def _apart(case: Case, run: Any, model: Any) -> tuple[float, float]:
    """Return by how much the accelerations of tilt and rolling angle differ, in g/R."""
    if crashed(run):
        return math.nan, math.nan
    size = case.gravity / case.cylinder.semidiagonal
    count = int(np.count_nonzero(model.time <= case.length))  # what overturns later goes on for longer
    time = model.time[:count]
    return tuple(
        abs(float(2.0 * ((own[:count] - other[:count]) * time**2).sum() / (time**4).sum())) / size
        for own, other in ((run.tilt, model.tilt), (run.rolling_angle, model.rolling_angle))
    )  # type: ignore[return-value]
