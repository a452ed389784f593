"""Errors of engine settings in four exact solutions, and uplift of MuJoCo's standing base.

`python tests/benchmarks engine_settings` prints a row for each value of a setting, all others at their
defaults, at the default step. No column rests on the equations that the engines are compared with:

* free: releases at half of alpha with 0.5 rad/s at (6 m, 0.2) and (6 m, 1), four swings in the recess, by
  quadrature: the largest error, at the tilt maxima, of their time [period], tilt [alpha] and azimuth [rad];
* wobble: steady wobble at half of alpha for 4 s, which keeps tilt and rate: the largest distance of the tilt
  vectors [alpha];
* slide: El Centro x 2.5 at friction 0.3 and 0.48 of b/h 0.5, in closed form between samples: the largest
  distance of the bases [peak displacement];
* impact: closings in one plane under a sine of 0.65 g by the moment of momentum: the largest error of the
  three peaks after them [alpha]; the median of five steps, for single ones leave it to chance.

`--uplift` prints MuJoCo's base that nothing steers, on n points, beside the one that follows the load, from
rest under three motions for five bodies.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from itertools import product
from typing import Any

import numpy as np

from rockwobble import multibody, reduced
from rockwobble.compare.metrics.pair import (
    agreement_of,
    direction_difference,
    displacement_difference,
    make_pair,
)
from rockwobble.models import Case, Cylinder, GroundMotion, InitialState, Trace, el_centro_1940
from rockwobble.models.synthetic import synthetic_motions
from rockwobble.reduced.exact import free_response, steady_wobble_rate

from .console import options_of, show

STEP = 1e-4  # [s] at 6 m, the default
G = 9.81
GRIP = 5.0  # friction that suffices
DRAWS = (1.0, 0.98, 0.96, 0.94, 0.92)  # steps of an impact
PIER = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
CAN = Cylinder(semidiagonal=5.0**0.5, tan_alpha=0.5)

# values of each setting, the default among them where it is no matter of the mode
SETTINGS: Mapping[str, Mapping[str, Sequence[Any]]] = {
    "mujoco": {
        "contact_time_constant": (1.0, 2.0, 4.0, 10.0),
        "contact_damping_ratio": (0.5, 1.0, 3.0, 4.0),
        "impedance": (0.99, 0.999, 0.9999),
        "rolling_impedance": (0.98, 0.995, 0.9999),
        "friction_damping": (1.0, 1.6, 1.8, 1.9),
        "noslip_iterations": (0, 20),
        "guide_stiffness": (0.05, 0.1, 0.2, 0.4),
        "integrator": ("Euler", "implicitfast", "implicit", "RK4", "discrete"),
        "cone": ("elliptic", "pyramidal"),
        "tolerance": (1e-12, 1e-6),
        "points": (0, 8, 16, 64),
        "points_softness": (1.0, 10.0, 40.0, 100.0),
        "points_inset": (1e-3, 0.01, 0.05),
    },
    "pybullet": {
        "friction_damping": (1.0, 1.6, 1.8, 1.9),
        "contact_erp": (0.05, 0.2, 0.8),
        "contact_slop": (0.0, 1e-5),
        "collision_margin": (0.0, 0.04),
        "solver_residual": (1e-16, 1e-7),
        "iterations": (10, 100),
        "guide_stiffness": (0.05, 0.1, 0.2, 0.4),
    },
    "dart": {
        "depth": (1e-7, 1e-6, 1e-5),
        "depth_gain": (0.05, 0.3, 1.0),
        "friction_damping": (1.0, 1.6, 1.8, 1.9),
        "tolerance": (1e-12, 1e-6),
        "iterations": (100, 1000),
        "guide_stiffness": (0.05, 0.1, 0.2, 0.4),
    },
    "drake": {
        "approximation": ("lagged", "similar", "tamsi", "sap"),
        "contact_stiffness": (1e8, 1e10, 1e11),
        "dissipation": (0.0, 10.0, 100.0, 1000.0),
        "stiction_tolerance": (1e-6, 1e-4),
        "friction_damping": (1.0, 1.6, 1.8, 1.9),
        "guide_stiffness": (0.05, 0.1, 0.2, 0.4),
    },
    "exudyn": {
        "integrator": ("trapezoidal", "generalized-alpha"),
        "spectral_radius": (0.5, 0.9, 1.0),
        "relative_tolerance": (1e-12, 1e-8),
        "absolute_tolerance": (1e-13, 1e-10),
        "iterations": (3, 25),
    },
    "rapier": {
        "contact_frequency": (0.03, 0.1, 0.3),
        "contact_damping_ratio": (1.0, 10.0, 30.0),
        "depth": (1e-7, 1e-6, 1e-5),
        "depth_gain": (0.05, 0.3, 1.0),
        "substeps": (1, 4),
        "iterations": (1, 4, 16),
        "guide_stiffness": (0.05, 0.1, 0.2, 0.4),
    },
}
# over a step h [s]: time constant/h, frequency times h, 2 h sqrt(stiffness)
SCALED: Mapping[str, Callable[[float, float], float]] = {
    "contact_time_constant": lambda value, h: value * h,
    "contact_frequency": lambda value, h: value / h,
    "guide_stiffness": lambda value, h: (value / h) ** 2 / 4.0,
}
Simulate = Callable[..., Trace]
Used = tuple[float, Mapping[str, Any]]  # step [s] and settings of a run


def simulator(engine: str, name: str = "", value: Any = None, used: list[Used] | None = None) -> Simulate:
    """Runs of an engine at its default step, or a share of it, with one setting changed, if any.

    The settings of each run are appended to `used`.
    """

    def simulate(case: Case, support: str, share: float = 1.0) -> Trace:
        step = share * STEP * math.sqrt(case.cylinder.semidiagonal / 6.0)
        given: dict[str, Any] = {name: SCALED[name](value, step) if name in SCALED else value} if name else {}
        trace = multibody.simulate(case, engine=engine, support=support, time_step=step, **given)
        if used is not None:
            used.append((step, trace.settings))
        if trace.outcome == "failed":
            raise ArithmeticError(f"the run fails: {trace.diagnostics}")
        return trace

    return simulate


def free(simulate: Simulate) -> float:
    """Largest error at the tilt maxima of free responses."""
    errors = []
    for tan_alpha in (0.2, 1.0):
        body = Cylinder(semidiagonal=6.0, tan_alpha=tan_alpha)
        initial = InitialState(0.5 * body.alpha, rolling_rate=0.5)
        exact = free_response(body, initial)
        trace = simulate(Case(body, initial=initial, duration=4.2 * exact.period, friction=GRIP), "recess")
        maxima = trace.extrema[(trace.extrema[:, 3] > 0.0) & (trace.extrema[:, 0] > 0.5 * exact.period)][:4]
        swings = np.arange(1, len(maxima) + 1)
        errors += [
            math.inf if len(maxima) < 4 else 0.0,
            *(maxima[:, 0] / exact.period - swings),
            *((maxima[:, 1] - exact.maximum_tilt) / body.alpha),
            *(maxima[:, 2] - swings * exact.angle_of_turn),
        ]
    return float(np.abs(errors).max())


def wobble(simulate: Simulate) -> float:
    """Largest tilt vector difference in steady wobble over alpha."""
    tilt = 0.5 * PIER.alpha
    rate = float(steady_wobble_rate(PIER, tilt))
    # without friction along the rim, so that it is the same motion in the recess and on flat ground
    trace = simulate(
        Case(PIER, initial=InitialState(tilt, rolling_rate=rate), duration=4.0, friction=GRIP), "flat"
    )
    right = tilt * np.exp(1j * rate * trace.time)
    return float(np.abs(trace.tilt * np.exp(1j * trace.rolling_angle) - right).max() / PIER.alpha)


def slide(simulate: Simulate) -> float:
    """Largest distance of the bases in a slide over its peak displacement."""
    body, errors = Cylinder(semidiagonal=3.0, tan_alpha=0.5), []
    for friction in (0.3, 0.48):
        case = Case(body, el_centro_1940().scaled(2.5), duration=6.0, friction=friction)
        pair = make_pair(body, reduced.simulate(case, support="flat"), simulate(case, "flat"))
        errors.append(displacement_difference(pair))
    return max(errors)


def impact(simulate: Simulate) -> float:
    """Largest peak error after planar impacts, over alpha."""
    times = np.arange(0.0, 0.8001, 0.005)
    motion = GroundMotion(np.column_stack([0.65 * G * np.sin(2.0 * np.pi * times / 0.8), 0.0 * times]), 0.005)
    case = Case(CAN, motion, duration=3.0, friction=GRIP)

    def peaks(trace: Trace) -> np.ndarray[Any, np.dtype[np.float64]]:
        maxima = trace.extrema[(trace.extrema[:, 3] > 0.0) & (trace.extrema[:, 1] > 5e-3), 1][:4] / CAN.alpha
        return np.pad(maxima, (0, 4 - len(maxima)))  # a missing peak counts as 0

    right = peaks(reduced.simulate(case, plane=0.0, restitution="momentum"))
    return float(np.median([np.abs(peaks(simulate(case, "flat", each)) - right)[1:].max() for each in DRAWS]))


SOLUTIONS: Mapping[str, Callable[[Simulate], float]] = {
    each.__name__: each for each in (free, wobble, slide, impact)
}


def error_of(solution: str, simulate: Simulate) -> float:
    """Error of a run; infinite if failed, NaN if the engine refuses setting or problem."""
    try:
        return SOLUTIONS[solution](simulate)
    except ValueError:
        return math.nan
    except ArithmeticError:
        return math.inf


def settings_table(engine: str, names: Sequence[str] = ()) -> Iterator[dict[str, str]]:
    """Rows of an engine, default settings first; values equal to the default are marked and not run."""
    used: dict[str, list[Used]] = {solution: [] for solution in SOLUTIONS}
    defaults = {each: f"{error_of(each, simulator(engine, used=used[each])):.1e}" for each in SOLUTIONS}

    def error(solution: str, name: str, value: Any) -> str:
        for step, settings in used[solution][:1]:
            known, of_step = settings[name], SCALED.get(name)
            if math.isclose(known, of_step(value, step)) if of_step else known == value:
                return f"{defaults[solution]} *"
        return f"{error_of(solution, simulator(engine, name, value)):.1e}"

    yield {"engine": engine, "setting": "default", "value": "", **defaults}
    for name in names or SETTINGS[engine]:
        for value in SETTINGS[engine][name]:
            errors = {solution: error(solution, name, value) for solution in SOLUTIONS}
            yield {"engine": engine, "setting": name, "value": str(value), **errors}


BODIES = ((10.0, 0.1), (6.0, 0.2), (6.0, 0.35), (3.0, 0.5), (3.0, 1.0))  # R [m], tan alpha
POINTS = (16, 32, 64, 128)
LENGTH, EARLY = 6.0, 2.0  # run length, and early part after uplift [s]


def motions_of(body: Cylinder) -> list[GroundMotion]:
    """El Centro and two synthetic motions, with peaks of twice the uplift threshold."""
    peak = 2.0 * G * body.tan_alpha
    record = el_centro_1940()
    return [record.scaled(peak / record.peak), *synthetic_motions(2, peak=peak, seed=59)]


def early_difference(model: Trace, trace: Trace) -> float:
    """Largest tilt difference over alpha in the time `EARLY` after uplift."""
    pair = make_pair(model.case.cylinder, model, trace, until=model.uplift_time + EARLY)
    return float(np.abs(pair.tilt_difference).max())


def uplift_table() -> Iterator[dict[str, Any]]:
    """Rows by support, body and base, for the worst of three motions."""
    for support, (size, tan_alpha) in product(("recess", "flat"), BODIES):
        body = Cylinder(semidiagonal=size, tan_alpha=tan_alpha)
        cases = [Case(body, motion, duration=LENGTH, friction=GRIP) for motion in motions_of(body)]
        models = [reduced.simulate(case, support=support) for case in cases]
        for points in (0, *POINTS):
            given: dict[str, Any] = (
                {"follow_load": False, "points": points} if points else {"follow_load": True}
            )
            traces = [multibody.simulate(case, engine="mujoco", support=support, **given) for case in cases]
            pairs = list(zip(models, traces, strict=True))
            ends = [agreement_of(model, trace) for model, trace in pairs]
            yield {
                "support": support,
                "body": f"{size:g} m, {tan_alpha:g}",
                "base": f"{points} points" if points else "follows",
                "uplift": max(1e3 * abs(trace.uplift_time - model.uplift_time) for model, trace in pairs),
                "direction": max(abs(math.degrees(direction_difference(*pair))) for pair in pairs),
                "tilt": max(early_difference(*pair) for pair in pairs),
                "agrees": min(end.length for end in ends),
                "to_end": sum(not end.diverged for end in ends),
                "step": 1e6 * float(np.mean([t.wall_time * t.time_step / t.time[-1] for t in traces])),
            }


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the table."""
    import pandas as pd

    parser = options_of("engine_settings", "Settings of the engines by their error on four exact solutions.")
    parser.add_argument("--engine", action="append", choices=SETTINGS, help="may be repeated")
    parser.add_argument("--setting", action="append", default=[], help="may be repeated")
    parser.add_argument("--uplift", action="store_true", help="MuJoCo's standing base, by number of points")
    given = parser.parse_args(arguments)
    if given.uplift:
        text, numbers = ("support", "body", "base"), ("uplift", "direction", "tilt")
        forms = dict.fromkeys(text, "") | dict.fromkeys(numbers, ".1e")
        note = (
            "the worst of three motions: time [ms] and direction [deg] of uplift, tilt [alpha] in "
            f"{EARLY:g} s after it; agrees: within 1 % of alpha [s] after it, how many to the end, "
            f"{LENGTH:g} s; step: microseconds"
        )
        forms |= {"agrees": ".2f", "to_end": "d", "step": ".0f"}
        show(
            pd.DataFrame(uplift_table()),
            "Differences from the model by base: n points, or followed",
            forms,
            note,
        )
        return 0
    engines = [each for each in given.engine or SETTINGS if each in multibody.available_engines()]
    rows = [row for engine in engines for row in settings_table(engine, given.setting)]
    forms = dict.fromkeys(("engine", "setting", "value", *SOLUTIONS), "")
    note = (
        "*: default; nan: refused, inf: failed; contact_time_constant in steps, "
        "contact_frequency times a step, guide_stiffness k as 2 h sqrt(k)"
    )
    show(pd.DataFrame(rows), "Error on exact solutions at the default step", forms, note)
    return 0
