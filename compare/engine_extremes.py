"""Whether a run at an extreme of its engine says so where it goes wrong.

`python -m rockwobble.compare.engine_extremes` prints the table. Each trial takes one thing to its extreme
(step, contact, friction, slenderness, spin, excitation, guide) and is held against the reduced model of
its support, solved to 1e-10. The verdict is

* agrees: the tilt is within `AGREES` of alpha as far as the model holds;
* failed: the guard ended the run, with a message;
* said: it does not agree, and its message says what limits it;
* refused: a ValueError with one line, before anything ran;
* wrong: it does not agree and says nothing. There must be none.

The model holds as long as the friction given and the contact suffice by its own account; beyond that a
trial only has to say that it slips or flies.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from rockwobble import multibody, reduced
from rockwobble.models import Cylinder, GroundMotion, InitialState

from .console import parse_plain, show
from .traces import make_pair

if TYPE_CHECKING:
    import pandas as pd

AGREES = 0.01  # of alpha: what ends an agreement everywhere else
_MODELS = {"guided": "recess", "free": "rolling"}
_LENGTH = 2.0  # [s]


@dataclass(frozen=True, slots=True, kw_only=True)
class Trial:
    """One run at an extreme; arguments of `multibody.simulate` that are not its defaults.

    Parameters
    ----------
    extreme, value : str
        What is extreme, and how much.
    engine, support : str
    tan_alpha, tilt, rate, length : float
        Of the release: tilt in alpha, rolling rate [rad/s], duration [s]; tilt 0 stands.
    motion : GroundMotion, optional
    arguments : dict
        Friction, time step and settings.
    """

    extreme: str
    value: str
    engine: str
    support: str
    tan_alpha: float = 0.2
    tilt: float = 0.5
    rate: float = 0.5
    length: float = _LENGTH
    motion: GroundMotion | None = None
    arguments: dict[str, Any] = field(default_factory=dict)


def trials(engines: Sequence[str] | None = None) -> list[Trial]:
    """Return all trials of the engines that are installed, both supports."""
    known = ("mujoco", "pybullet") if engines is None else engines
    return [
        trial
        for engine in known
        if engine in multibody.available_engines()
        for support in _MODELS
        for trial in _of(engine, support)
    ]


def _of(engine: str, support: str) -> list[Trial]:
    def trial(extreme: str, value: Any, **given: Any) -> Trial:
        text = value if isinstance(value, str) else f"{value:g}"
        return Trial(extreme=extreme, value=text, engine=engine, support=support, **given)

    found = [
        trial("time step [s]", step, length=length, arguments={"time_step": step})
        for step, length in (
            (1e-6, 0.1), (1e-5, 1.0), (2e-4, 2.0), (5e-4, 2.0), (1e-3, 4.0), (2e-3, 4.0), (1e-2, 4.0),
        )
    ]  # fmt: skip
    found += [
        trial("friction", mu, tan_alpha=tan_alpha, arguments={"friction": mu})
        for mu in (0.0, 1e-3, 0.05, 0.2, 1.0, 10.0)
        for tan_alpha in (0.2, 3.0)
    ]
    found += [trial("tan alpha", each, tan_alpha=each) for each in (0.05, 0.5, 1.5, 3.0, 10.0)]
    found += [trial("tan alpha, spinning", each, tan_alpha=each, rate=3.0) for each in (0.05, 1.0, 10.0)]
    found += [
        trial("spin [rad/s]", rate, rate=rate, length=length)
        for rate, length in (
            (0.0, 2.0), (1e-9, 2.0), (1e-4, 2.0), (3.0, 2.0), (10.0, 1.0), (100.0, 0.2), (1e3, 0.1),
        )
    ]  # fmt: skip
    found += [trial("tilt [alpha]", tilt, tilt=tilt, length=4.0) for tilt in (1e-4, 0.01, 0.95, 1.0, 1.5)]
    found += [trial("shaking [g]", peak, tilt=0.0, motion=_shaking(peak)) for peak in (0.21, 1.0, 10.0)]
    steep = [(0.2, 10.0), (3.0, 10.0)]
    found += [
        trial("shaking [g], squat", peak, tan_alpha=tan_alpha, tilt=0.0, motion=_shaking(peak),
              arguments={"friction": 5.0})
        for tan_alpha, peak in steep
    ]  # fmt: skip
    if support == "guided":
        # h sqrt(2 k) of the twist, over its limit of stability from about 1 on
        found += [
            trial("guide, h sqrt(k)", part, tan_alpha=tan_alpha,
                  arguments={"guide_stiffness": (part / 1e-4) ** 2})
            for part in (1e-6, 1e-4, 1e-2, 0.1, 0.3, 0.5, 0.7, 1.0, 3.0, 1e3)
            for tan_alpha in (0.2, 3.0)
        ]  # fmt: skip
    return found + (_mujoco(trial) if engine == "mujoco" else _pybullet(trial))


def _mujoco(trial: Callable[..., Trial]) -> list[Trial]:
    found = [
        trial("contact time constant [h]", part, tan_alpha=tan_alpha,
              arguments={"contact_time_constant": part * 1e-4})
        for part in (0.1, 0.5, 1.0, 10.0, 100.0, 1e3, 1e4)
        for tan_alpha in (0.2, 3.0)
    ]  # fmt: skip
    found += [
        trial("contact damping ratio", ratio, rate=rate, arguments={"contact_damping_ratio": ratio})
        for ratio in (1e-3, 0.01, 0.1, 0.3, 3.0, 30.0)
        for rate in (0.01, 0.5)
    ]
    settings: list[tuple[str, str, Any]] = [
        *(("impedance", "impedance", value) for value in (0.01, 0.5, 0.9)),
        *(("friction damping", "friction_damping", value) for value in (1e-3, 0.1, 0.5, 2.0)),
        *(("integrator", "integrator", value) for value in ("implicitfast", "implicit", "RK4", "discrete")),
        *(("iterations", "iterations", value) for value in (1, 2)),
        ("solver tolerance", "tolerance", 1e-3),
        ("cone", "cone", "pyramidal"),
    ]
    found += [
        trial(what, value, tan_alpha=tan_alpha, arguments={name: value})
        for what, name, value in settings
        for tan_alpha in (0.2, 1.0)
    ]
    corners = [
        trial("standing corners", n, tilt=0.0, motion=_shaking(0.5), arguments={"standing_corners": n})
        for n in (0, 4, 8)
    ]
    return found + corners


def _pybullet(trial: Callable[..., Trial]) -> list[Trial]:
    settings = [
        *(("contact erp", "contact_erp", value) for value in (1e-4, 0.01, 1.0)),
        *(("contact slop", "contact_slop", value) for value in (1e-4, 1e-2)),
        *(("collision margin", "collision_margin", value) for value in (1e-3, 0.04)),
        *(("solver residual", "solver_residual", value) for value in (1e-7, 1e-3, 1.0)),
        *(("iterations", "iterations", value) for value in (1, 2, 5)),
        *(("friction damping", "friction_damping", value) for value in (1e-3, 0.5, 2.0)),
    ]
    return [
        trial(what, value, tan_alpha=tan_alpha, arguments={name: value})
        for what, name, value in settings
        for tan_alpha in (0.2, 1.0)
    ]


def _shaking(peak: float) -> GroundMotion:
    """Two seconds of two sines, of `peak` times 9.81 m/s^2."""
    time = np.arange(0.0, 2.0001, 0.01)
    wave = np.column_stack([np.sin(6.0 * time), 0.6 * np.cos(5.0 * time) * np.minimum(1.0, 4.0 * time)])
    motion = GroundMotion(wave, 0.01)
    return motion.scaled(9.81 * peak / motion.peak)


def run(trial: Trial) -> dict[str, Any]:
    """Run one trial; return its row.

    Returns
    -------
    dict
        extreme, value, tan_alpha, engine, support, verdict, error (the largest tilt difference in alpha as
        far as the model holds; NaN if it failed) and message.
    """
    cylinder = Cylinder(semidiagonal=6.0, tan_alpha=trial.tan_alpha)
    release = InitialState(trial.tilt * cylinder.alpha, rolling_rate=trial.rate) if trial.tilt else None
    row: dict[str, Any] = {
        "extreme": trial.extreme,
        "value": trial.value,
        "tan_alpha": trial.tan_alpha,
        "engine": trial.engine,
        "support": trial.support,
        "error": math.nan,
    }
    try:
        result = multibody.simulate(
            cylinder,
            trial.motion,
            initial=release,
            duration=trial.length,
            engine=trial.engine,
            support=trial.support,
            **trial.arguments,
        )
    except ValueError as refusal:
        return row | {"verdict": "refused", "message": str(refusal)}
    if result.outcome == "failed":
        return row | {"verdict": "failed", "message": result.message}
    model = reduced.simulate(
        cylinder,
        trial.motion,
        initial=release,
        duration=trial.length,
        model=_MODELS[trial.support],
        rtol=1e-10,
        friction=trial.arguments.get("friction", 1.0),
    )
    error, whole = _difference(cylinder, model, result)
    agrees = error <= AGREES and (whole or bool(result.message))
    verdict = "agrees" if agrees else "said" if result.message else "wrong"
    return row | {"verdict": verdict, "error": error, "message": result.message}


def _difference(cylinder: Cylinder, model: Any, result: Any) -> tuple[float, bool]:
    """Largest tilt difference as long as the model holds [alpha], and whether that is the whole run."""
    pair = make_pair(cylinder, model, result)
    breaches = [breach.first_time for breach in model.assumptions.breaches]
    until = min(breaches, default=math.inf)
    within = np.abs(pair.tilt_difference)[pair.time <= until]
    whole = math.isinf(until) and model.outcome != "failed"
    return float(within.max(initial=0.0)), whole


def measure(
    chosen: Sequence[Trial] | None = None,
    *,
    workers: int | None = None,
    say: Callable[[str], None] | None = None,
) -> pd.DataFrame:
    """Run the trials; return their rows in the same order, see `run`.

    Parameters
    ----------
    chosen : sequence of Trial, optional
        Default: all.
    workers : int, optional
        Processes; default one for each core.
    say : callable, optional
        Called with a line of progress.
    """
    import os

    import pandas as pd

    from .process_pool import ProcessPool

    chosen = trials() if chosen is None else chosen
    rows = []
    with ProcessPool(workers or os.cpu_count() or 1) as pool:
        for done, row in enumerate(pool.map(run, chosen), 1):
            rows.append(row)
            if say is not None:
                say(f"{done}/{len(chosen)} {row['engine']} {row['extreme']} {row['value']}: {row['verdict']}")
    return pd.DataFrame(rows)


def main() -> None:
    """Print the table; end with code 1 if a run is silently wrong."""
    import sys

    parse_plain("engine_extremes", "The engines at their own extremes: does a run that goes wrong say so?")
    table = measure(say=lambda line: print(line, file=sys.stderr, flush=True))
    formats = {"extreme": "", "value": "", "tan_alpha": "g", "engine": "", "support": ""}
    counts = ", ".join(f"{count} {verdict}" for verdict, count in table["verdict"].value_counts().items())
    show(table, "Engines at their extremes", formats | {"verdict": "", "error": ".1e", "message": ""}, counts)
    sys.exit(1 if (table["verdict"] == "wrong").any() else 0)


if __name__ == "__main__":
    main()
