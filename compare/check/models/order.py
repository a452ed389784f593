"""Layer: errors fall as the methods promise, with the tolerance and with the time step."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rockwobble.models import Case, Cylinder, InitialState, Run, el_centro_1940

from ..bench import Bench, crashed, engines_here, not_here
from ..finding import Finding, at_most

LAYER = "order"
CYLINDER = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
TOLERANCES = 10.0 ** np.arange(-5.0, -10.5, -1.0)
SLOPE = 0.2  # scatter of a slope over five decades
STEPS = (4e-4, 2e-4, 1e-4)


def check(bench: Bench) -> Iterator[Finding]:
    """Yield the findings of this layer."""
    problems: dict[str, dict[str, Any]] = {
        "free motion": {
            "initial": InitialState(tilt=0.5 * CYLINDER.alpha, rolling_rate=0.05),
            "duration": 20.0,
        },
        "El Centro": {"motion": el_centro_1940(), "duration": 12.0},
    }
    for name, problem in problems.items():
        for model in ("recess", "flat"):
            exact = bench.reduced.simulate(
                Case(CYLINDER, **problem), rtol=1e-13, **bench.reduced.MODELS[model]
            )
            errors = [
                np.abs(
                    bench.reduced.simulate(
                        Case(CYLINDER, **problem), rtol=rtol, **bench.reduced.MODELS[model]
                    ).tilt
                    - exact.tilt
                ).max()
                for rtol in TOLERANCES
            ]
            slope = _slope(TOLERANCES, errors)
            yield at_most(
                LAYER,
                f"error in proportion to the tolerance, {name}, {model}",
                abs(slope - 1.0),
                SLOPE,
                reason="tolerances from 1e-5 to 1e-10",
                part="step control",
                note=f"slope {slope:.2f}",
            )
    yield from _engines(bench)


def _engines(bench: Bench) -> Iterator[Finding]:
    squat = Cylinder(semidiagonal=6.0, tan_alpha=1.0)
    release = InitialState(tilt=0.5 * squat.alpha, rolling_rate=0.5)
    case = Case(squat, initial=release, duration=2.0, name="release, tan alpha = 1")
    exact = bench.response(case, "recess")
    # the rim of these creeps by a share of the step where friction only stops the slip: first order
    yield from not_here(LAYER, "first order in the time step")
    engines = engines_here()
    wanted = [
        (case, bench.adjust(Run(engine, "recess", step, friction_damping=1.0)), f"{engine}, step {step:g} s")
        for engine in engines
        for step in STEPS
    ]
    found = bench.engine_runs(wanted)
    for index, engine in enumerate(engines):
        runs = found[index * len(STEPS) : (index + 1) * len(STEPS)]
        errors = [math.nan if crashed(run) else _rms(run.tilt - exact.tilt) / squat.alpha for run in runs]
        slope = _slope(np.array(STEPS), errors)
        yield at_most(
            LAYER,
            f"first order in the time step, {engine} with friction that only stops",
            abs(slope - 1.0),
            SLOPE,
            reason="three steps, from 4e-4 to 1e-4 s",
            part=f"{engine}: stepping or contact",
            note=f"slope {slope:.2f}",
        )


def _slope(sizes: NDArray[np.float64], errors: list[float]) -> float:
    values = np.array(errors)
    if not (np.isfinite(values) & (values > 0.0)).all():
        return math.nan
    return float(np.polyfit(np.log(sizes), np.log(values), 1)[0])


def _rms(values: NDArray[np.float64]) -> float:
    return float(np.sqrt(np.mean(np.square(values))))
