"""Which settings of an engine give the least error for a given cost.

`python tests/benchmarks engine_settings` prints the table. Each variant differs from the default in
one setting. First the time of a step is measured, in turns, so that a change of the machine's speed meets
all alike; then each runs with the step that its time allows, so that all cost the same. The errors are
those of the tilt, in the recess against the recess model and on flat ground against the flat-ground model:

* shaken: two cases with teeth under El Centro to 15 s, (10 m, 0.1) as recorded and (6 m, 0.2) doubled,
  relative RMS, geometric mean of the two. By chance alone these differ by a factor of two from one azimuth
  of the record to another: --turns 3 averages over three, at 2.4 times the cost;
* released: at half of alpha with 0.5 rad/s for 4 s at tan alpha 0.2, 1 and 3, the largest in alpha.
"""

from __future__ import annotations

import math
import time
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from rockwobble import multibody
from rockwobble.compare.metrics.pair import make_pair, tilt_rms_relative
from rockwobble.compare.runs.execution import Job, simulate_all
from rockwobble.compare.runs.progress import ProgressCallback
from rockwobble.models import Case, Cylinder, InitialState, Run, el_centro_1940
from rockwobble.models.support import MODELLED

from .console import options_of, show, tell

if TYPE_CHECKING:
    import pandas as pd

STEP = 1e-4  # [s] of the default at the reference size
TURNS = (0.0, 0.4, 0.9)  # azimuths of the record [rad]
_PILOT = 0.5  # [s] of motion timed in each turn
_TURNS = 5


@dataclass(frozen=True, slots=True, kw_only=True)
class Variant:
    """An engine and what is not the default.

    Parameters
    ----------
    engine : str
    what : str
        In words.
    settings : dict
        Those that do not depend on the step.
    contact, guide : float, optional
        Contact time constant over the step, and 2 h sqrt(guide stiffness); default that of the engine.
    """

    engine: str
    what: str
    settings: dict[str, Any] = field(default_factory=dict)
    contact: float = math.nan
    guide: float = math.nan

    def run(self, support: str, time_step: float, unit_time: float) -> Run:
        """Return the run with a step [s] at the reference size; `unit_time` scales it to the case."""
        step = time_step * unit_time
        more: dict[str, Any] = {}
        if math.isfinite(self.contact):
            more["contact_time_constant"] = self.contact * step
        if math.isfinite(self.guide):
            more["guide_stiffness"] = (0.5 * self.guide / step) ** 2
        return Run(self.engine, support, step, **self.settings, **more)


def variants(engines: Sequence[str] | None = None) -> list[Variant]:
    """Return the defaults of the engines that are installed, and what differs from them by one setting."""
    dampings = (1.0, 1.6, 1.9)
    found = [
        Variant(engine="mujoco", what="default"),
        *(
            Variant(engine="mujoco", what=f"integrator {name}", settings={"integrator": name})
            for name in ("implicitfast", "implicit", "RK4", "discrete")
        ),
        Variant(
            engine="mujoco", what="discrete, contact 0.2 h", settings={"integrator": "discrete"}, contact=0.2
        ),
        *(
            Variant(engine="mujoco", what=f"contact time constant {contact:g} h", contact=contact)
            for contact in (1.0, 1.5, 4.0, 10.0)
        ),
        *_varied("mujoco", "friction_damping", dampings),
        *_guides("mujoco"),
        Variant(engine="pybullet", what="default"),
        *_varied("pybullet", "friction_damping", dampings),
        *_varied("pybullet", "contact_erp", (0.05, 0.8)),
        *_guides("pybullet"),
    ]
    known = multibody.available_engines() if engines is None else engines
    return [variant for variant in found if variant.engine in known]


def _varied(engine: str, name: str, values: Sequence[float]) -> list[Variant]:
    words = name.replace("_", " ")
    return [Variant(engine=engine, what=f"{words} {value:g}", settings={name: value}) for value in values]


def _guides(engine: str) -> list[Variant]:
    return [
        Variant(engine=engine, what=f"guide 2 h sqrt(k) = {guide:g}", guide=guide)
        for guide in (0.025, 0.05, 0.1, 0.2, 0.4, 0.8)
    ]


def cases(turns: int = 1) -> tuple[Case, ...]:
    """Return the cases, those under El Centro first, the record turned by the first so many azimuths."""
    record = el_centro_1940()
    shaken, released = [], []
    for size, tan_alpha, motion in ((10.0, 0.1, record), (6.0, 0.2, record.scaled(2.0))):
        cylinder = Cylinder(semidiagonal=size, tan_alpha=tan_alpha)
        shaken += [
            Case(
                cylinder,
                motion.rotated(turn),
                duration=15.0,
                name=f"El Centro, R {size:g} m, tan alpha {tan_alpha:g}, {turn:g} rad",
            )
            for turn in TURNS[:turns]
        ]
    for tan_alpha in (0.2, 1.0, 3.0):
        cylinder = Cylinder(semidiagonal=6.0, tan_alpha=tan_alpha)
        release = InitialState(tilt=0.5 * cylinder.alpha, rolling_rate=0.5)
        released.append(
            Case(cylinder, initial=release, duration=4.0, name=f"release, tan alpha {tan_alpha:g}")
        )
    return (*shaken, *released)


def seconds_per_step(chosen: Sequence[Variant]) -> np.ndarray[Any, np.dtype[np.float64]]:
    """Return the time of a step of each variant [s]: the median ratio to the first, times its time."""
    case = cases()[-2]
    steps = _PILOT / STEP
    times = np.empty((_TURNS, len(chosen)))
    for turn in times:
        for index, variant in enumerate(chosen):
            run = variant.run("recess", STEP, 1.0)
            started = time.process_time()
            multibody.simulate(
                Case(case.cylinder, initial=case.initial, duration=_PILOT),
                engine=variant.engine,
                support=run.support,
                time_step=STEP,
                **run.settings,
            )
            turn[index] = (time.process_time() - started) / steps
    ratio: np.ndarray[Any, np.dtype[np.float64]] = np.median(times / times[:, :1], axis=0)
    return ratio * float(np.median(times[:, 0]))


def measure(
    chosen: Sequence[Variant] | None = None,
    *,
    turns: int = 1,
    workers: int | None = None,
    progress: ProgressCallback | None = None,
) -> pd.DataFrame:
    """Run all variants at equal cost.

    Parameters
    ----------
    chosen : sequence of Variant, optional
        Of one engine or several, the default of each first. Default: all of the engines that are installed.
    turns : int
        Azimuths of the record, up to three.
    workers : int, optional
        Processes.
    progress : callable, optional

    Returns
    -------
    DataFrame
        engine, setting, microseconds (a step), time_step [s] (at which it costs what the default of its
        engine costs at 1e-4 s), and the errors shaken_recess, shaken_flat, released_recess and
        released_flat. NaN where a run failed.
    """
    import pandas as pd

    chosen = variants() if chosen is None else chosen
    cost = seconds_per_step(chosen)
    base = {variant.engine: cost[index] for index, variant in reversed(list(enumerate(chosen)))}
    # a tenth more or less is noise of the clock, and a step of its own would make the errors differ by it
    ratio = [value / base[variant.engine] for variant, value in zip(chosen, cost, strict=True)]
    steps = [STEP * (1.0 if abs(each - 1.0) < 0.1 else each) for each in ratio]
    problems = cases(turns)
    jobs = [Job(case=case, run=Run(None, support)) for case in problems for support in MODELLED]
    for variant, step in zip(chosen, steps, strict=True):
        for case in problems:
            unit_time = math.sqrt(case.cylinder.semidiagonal / 6.0)
            jobs += [
                Job(
                    case=case,
                    run=variant.run(support, step, unit_time),
                    label=f"{variant.engine} {variant.what}",
                )
                for support in MODELLED
            ]
    results = simulate_all(jobs, workers=workers, progress=progress)
    count = 2 * len(problems)
    shaken = 2 * sum(case.motion is not None for case in problems)
    rows = []
    for index, (variant, step) in enumerate(zip(chosen, steps, strict=True)):
        block = results[count * (index + 1) : count * (index + 2)]
        errors = [
            _error(job.case, reference, trial)
            for job, reference, trial in zip(jobs[:count], results[:count], block, strict=True)
        ]
        rows.append(
            {
                "engine": variant.engine,
                "setting": variant.what,
                "microseconds": 1e6 * cost[index],
                "time_step": step,
                "shaken_recess": math.exp(float(np.mean(np.log(errors[0:shaken:2])))),
                "shaken_flat": math.exp(float(np.mean(np.log(errors[1:shaken:2])))),
                "released_recess": float(np.max(errors[shaken::2])),
                "released_flat": float(np.max(errors[shaken + 1 :: 2])),
            }
        )
    return pd.DataFrame(rows)


def _error(case: Case, reference: Any, trial: Any) -> float:
    if getattr(trial, "outcome", "failed") == "failed":
        return math.nan
    pair = make_pair(case.cylinder, reference, trial)
    if case.motion is not None:
        return tilt_rms_relative(pair)
    return float(np.abs(pair.tilt_difference).max())


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the table."""
    parser = options_of(
        "engine_settings",
        "Which settings of an engine give the least error for a given cost. "
        "Example: --engine mujoco --turns 3",
    )
    parser.add_argument("--engine", action="append", choices=("mujoco", "pybullet"), help="may be repeated")
    parser.add_argument(
        "--turns",
        type=int,
        choices=range(1, len(TURNS) + 1),
        default=1,
        help="azimuths of the record over which errors are averaged (%(default)s)",
    )
    given = parser.parse_args(arguments)
    errors = ("shaken_recess", "shaken_flat", "released_recess", "released_flat")
    formats = {"engine": "", "setting": "", "microseconds": ".1f", "time_step": ".2e"}
    show(
        measure(variants(given.engine), turns=given.turns, progress=tell),
        "Error of the tilt at equal cost",
        formats | dict.fromkeys(errors, ".1e"),
        "time step at 6 m in s; shaken: RMS over that of the model; released: largest, in alpha; - failed",
    )
    return 0
