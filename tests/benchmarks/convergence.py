"""How the engines converge to the reduced models, at every size.

`python tests/benchmarks convergence` releases cylinders of 1 cm, 6 m and 100 m at 0.5 alpha for 8 s
(0.5 rad/s at 6 m, the others in Froude's sense), in the recess against the recess model and on flat ground
against the flat-ground model, and prints the error at each step and the order: sizes make no difference.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from rockwobble import multibody, reduced
from rockwobble.compare.metrics.pair import make_pair
from rockwobble.compare.runs.execution import Job, simulate_all
from rockwobble.compare.runs.progress import ProgressCallback
from rockwobble.models import Case, Cylinder, InitialState, Run, Trace
from rockwobble.models.support import MODELLED

from .console import options_of, show, tell

if TYPE_CHECKING:
    import pandas as pd

STEPS = (2e-4, 1e-4, 5e-5, 2.5e-5)  # [s] at 6 m; the second is the default
SIZES = (0.01, 6.0, 100.0)  # [m]
_LENGTH = 8.0  # [s] at 6 m
_RATE = 0.5  # [rad/s] at 6 m
_MODEL_TOLERANCE = 1e-11  # of the reduced models: their error is nothing against that of an engine


def release_case(tan_alpha: float, part: float, size: float = 6.0) -> Case:
    """Return the release at `part` of alpha, the same for all sizes in Froude's sense."""
    cylinder = Cylinder(semidiagonal=size, tan_alpha=tan_alpha)
    time = math.sqrt(size / 6.0)
    release = InitialState(tilt=part * cylinder.alpha, rolling_rate=_RATE / time)
    name = f"R {size:g} m, tan alpha {tan_alpha:g}, {part:g} alpha"
    return Case(cylinder, initial=release, duration=_LENGTH * time, name=name)


def reference(case: Case, support: str) -> Trace:
    """Return the response of the reduced model of a support."""
    return reduced.simulate(
        Case(case.cylinder, initial=case.initial, duration=case.duration, friction=case.friction),
        **reduced.MODELS[support],
        rtol=_MODEL_TOLERANCE,
    )


def convergence(
    cases: Sequence[Case],
    *,
    engines: Sequence[str],
    steps: Sequence[float] = STEPS,
    workers: int | None = None,
    progress: ProgressCallback | None = None,
) -> pd.DataFrame:
    """Measure the tilt error of each case, support and engine at each step.

    Parameters
    ----------
    cases : sequence of Case
        Releases.
    engines : sequence of str
    steps : sequence of float
        From large to small [s] at the reference size of 6 m.
    workers : int, optional
        Processes.
    progress : callable, optional

    Returns
    -------
    DataFrame
        case, support, engine, the errors error_1, error_2, ... [alpha] (NaN where the run failed), order
        (slope of log error over log step) and diagnostics (codes, of the smallest step).
    """
    import pandas as pd

    keys = [(case, support, engine) for case in cases for support in MODELLED for engine in engines]
    jobs = [
        Job(
            case=_frictional(case),
            run=Run(engine, support, step * math.sqrt(case.cylinder.semidiagonal / 6.0)),
            label=f"{engine} {support} {step:g} s",
        )
        for case, support, engine in keys
        for step in steps
    ]
    trials = simulate_all(jobs, workers=workers, progress=progress)
    references = {(case.name, support): reference(case, support) for case in cases for support in MODELLED}
    rows = []
    for index, (case, support, engine) in enumerate(keys):
        mine = trials[len(steps) * index : len(steps) * (index + 1)]
        errors = [tilt_error(case, references[case.name, support], trial) for trial in mine]
        rows.append(
            {
                "case": case.name,
                "support": support,
                "engine": engine,
                **{f"error_{number + 1}": error for number, error in enumerate(errors)},
                "order": order(steps, errors),
                "diagnostics": ", ".join(fact.code for fact in mine[-1].facts),
            }
        )
    return pd.DataFrame(rows)


def _frictional(case: Case) -> Case:
    """The case with more than enough friction: the models assume that it suffices."""
    return Case(
        case.cylinder,
        case.motion,
        initial=case.initial,
        duration=case.duration,
        gravity=case.gravity,
        friction=5.0,
        name=case.name,
    )


def tilt_error(case: Case, model: Any, trial: Any) -> float:
    """Return the largest tilt difference in alpha; NaN where the run failed."""
    if getattr(trial, "outcome", "failed") == "failed":
        return math.nan
    return float(np.abs(make_pair(case.cylinder, model, trial).tilt_difference).max())


def order(steps: Sequence[float], errors: Sequence[float]) -> float:
    """Return the slope of log error over log step; NaN without two errors."""
    known = np.isfinite(errors) & (np.asarray(errors) > 0.0)
    if known.sum() < 2:
        return math.nan
    slope = np.polyfit(np.log(np.asarray(steps)[known]), np.log(np.asarray(errors)[known]), 1)[0]
    return float(slope)


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the table."""
    options_of("convergence", "How the engines converge to the reduced models, at every size.").parse_args(
        arguments
    )
    engines = [name for name in ("mujoco", "pybullet") if name in multibody.available_engines()]
    cases = [release_case(tan_alpha, 0.5, size) for tan_alpha in (0.2, 1.0) for size in SIZES]
    forms = {"case": "", "support": "", "engine": ""}
    forms |= {f"error_{number + 1}": ".1e" for number in range(len(STEPS))} | {"order": ".2f"}
    steps = ", ".join(f"{step:g} s" for step in STEPS)
    show(
        convergence(cases, engines=engines, progress=tell),
        "The same at every size",
        forms,
        f"largest tilt difference in alpha, at steps of {steps} at 6 m",
    )
    return 0
