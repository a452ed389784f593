"""How the engines converge to the reduced models: free response, angle of turn, sizes.

`python tests/benchmarks convergence` prints three tables.

1. In the recess against the recess model and on flat ground against the flat-ground model over 8 s, released
   at 0.3, 0.5 and 0.8 alpha with 0.5 rad/s at 6 m, for tan(alpha) from 0.1 to 3: error at each step, and the
   order. A release in which the model itself loses contact is left out, and said below the table.
2. The angle of turn from tilt maximum to tilt maximum, b = 1 m, h = 2 b, released at alpha/2 with 0.1 rad/s,
   against exact quadrature (recess) and against the flat-ground model; Exudyn, which has no recess, as well.
3. The first table's release at 0.5 alpha for cylinders of 1 cm, 6 m and 100 m.

With 2.5e-5 s MuJoCo and Bullet stay within 5.3e-5 alpha of their models in all releases, at the default step
within 1e-4 but for tan(alpha) 3 from 0.8 alpha on flat ground, 2.1e-4; of first order. The angle of turn at
the default step is 5e-4 deg off in MuJoCo, 6e-4 in Bullet and 2e-5 in Exudyn; sizes make no difference.
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
from rockwobble.multibody.engines.registry import find_engine

from .console import options_of, show, tell

if TYPE_CHECKING:
    import pandas as pd

SLENDERNESS = (0.1, 0.2, 0.5, 1.0, 3.0)
RELEASES = (0.3, 0.5, 0.8)  # of alpha
STEPS = (2e-4, 1e-4, 5e-5, 2.5e-5)  # [s] at 6 m; the second is the default
TURN_STEPS = (4e-4, 2e-4, 1e-4, 5e-5)
SIZES = (0.01, 6.0, 100.0)  # [m]
TABLES = ("free_response", "turn", "size")
_LENGTH = 8.0  # [s] at 6 m
_RATE = 0.5  # [rad/s] at 6 m
_MODEL_TOLERANCE = 1e-11  # of the reduced models: their error is nothing against that of an engine


def engines_here() -> tuple[str, ...]:
    """Return the engines that have both supports and are installed."""
    return tuple(name for name in ("mujoco", "pybullet") if name in multibody.available_engines())


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


def loses_contact(case: Case) -> str:
    """Return which reduced model says that the cylinder leaves the ground, and when; empty if none does."""
    for support in MODELLED:
        lost = reference(case, support).first("tension")
        if math.isfinite(lost):
            return f"{case.name}: the {Run(None, support)} loses contact at {lost:.3g} s"
    return ""


def convergence(
    cases: Sequence[Case],
    *,
    engines: Sequence[str] | None = None,
    steps: Sequence[float] = STEPS,
    workers: int | None = None,
    progress: ProgressCallback | None = None,
) -> pd.DataFrame:
    """Measure the tilt error of each case, support and engine at each step.

    Parameters
    ----------
    cases : sequence of Case
        Releases.
    engines : sequence of str, optional
        Default: those that are installed.
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

    engines = engines_here() if engines is None else engines
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


def angle_of_turn(
    *,
    engines: Sequence[str] | None = None,
    steps: Sequence[float] = TURN_STEPS,
    workers: int | None = None,
    progress: ProgressCallback | None = None,
) -> pd.DataFrame:
    """Measure the angle of turn for b = 1 m, h = 2 b, alpha/2 and 0.1 rad/s.

    Returns
    -------
    DataFrame
        support, engine, exact [deg], and the differences error_1, ... at `steps` [deg at the size of 6 m].
    """
    import pandas as pd

    engines = multibody.available_engines() if engines is None else engines
    cylinder = Cylinder.from_dimensions(base_radius=1.0, height=4.0)
    release = InitialState(tilt=0.5 * cylinder.alpha, rolling_rate=0.1)
    case = Case(cylinder, initial=release, duration=2.0, friction=5.0, name="b 1 m, h 2 b")
    unit_time = math.sqrt(cylinder.semidiagonal / 6.0)
    keys = [
        (support, engine)
        for support in MODELLED
        for engine in engines
        if support in find_engine(engine).supports
    ]
    jobs = [
        Job(case=case, run=Run(engine, support, step * unit_time), label=f"{engine} {support} {step:g} s")
        for support, engine in keys
        for step in steps
    ]
    trials = iter(simulate_all(jobs, workers=workers, progress=progress))
    rows = []
    for support, engine in keys:
        exact = (
            reduced.angle_of_turn(cylinder, release)
            if support == "recess"
            else float(reference(case, support).passes["angle_of_turn"].iloc[0])
        )
        turns = [float(next(trials).passes["angle_of_turn"].iloc[0]) for _ in steps]
        errors = {f"error_{n + 1}": math.degrees(turn - exact) for n, turn in enumerate(turns)}
        rows.append({"support": support, "engine": engine, "exact": math.degrees(exact), **errors})
    return pd.DataFrame(rows)


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the tables."""
    parser = options_of(
        "convergence",
        "How the engines converge to the reduced models. Example: --table size --engine mujoco --tan-alpha 3",
    )
    parser.add_argument("--table", action="append", choices=TABLES, help="may be repeated (default: all)")
    parser.add_argument(
        "--engine", action="append", choices=multibody.available_engines(), help="may be repeated"
    )
    parser.add_argument(
        "--tan-alpha", action="append", type=float, help="of the first table; may be repeated"
    )
    given = parser.parse_args(arguments)
    engines = [name for name in given.engine or engines_here() if name in engines_here()]
    for table in given.table or TABLES:
        if table == "free_response":
            _print_free(given.tan_alpha or SLENDERNESS, engines)
        elif table == "turn":
            _print_turn(given.engine)
        else:
            cases = [release_case(tan_alpha, 0.5, size) for tan_alpha in (0.2, 1.0) for size in SIZES]
            errors = convergence(cases, engines=engines, progress=tell)
            show(errors, "The same at every size", _FORM, f"{_STEPS_IN_WORDS} at 6 m")
    return 0


_FORM = (
    {"case": "", "support": "", "engine": ""}
    | {f"error_{number + 1}": ".1e" for number in range(len(STEPS))}
    | {"order": ".2f"}
)
_STEPS_IN_WORDS = "largest tilt difference in alpha, at steps of " + ", ".join(f"{h:g} s" for h in STEPS)


def _print_free(slenderness: Sequence[float], engines: Sequence[str]) -> None:
    cases = [release_case(tan_alpha, part) for tan_alpha in slenderness for part in RELEASES]
    lost = {case.name: loses_contact(case) for case in cases}
    kept = [case for case in cases if not lost[case.name]]
    left_out = "".join(f"\nleft out: {line}" for line in lost.values() if line)
    errors = convergence(kept, engines=engines, progress=tell)
    show(errors, "Free response over 8 s", _FORM, _STEPS_IN_WORDS + left_out)


def _print_turn(engines: Sequence[str] | None) -> None:
    errors = {f"error_{number + 1}": ".1e" for number in range(len(TURN_STEPS))}
    show(
        angle_of_turn(engines=engines, progress=tell),
        "Angle of turn, b = 1 m, h = 2 b, alpha/2, 0.1 rad/s",
        {"support": "", "engine": "", "exact": ".4f"} | errors,
        "in degrees; differences at steps of " + ", ".join(f"{step:g} s" for step in TURN_STEPS) + " at 6 m",
    )
