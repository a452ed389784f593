"""Layer studies, second part: a row of a sweep against a run of its own, and which rows there are."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from rockwobble import reduced
from rockwobble.models import Case, Cylinder, GroundMotion, InitialState, pulse

from ...studies.sweep.cases import CaseSweep
from ...studies.sweep.grid import Grid
from ...studies.sweep.study import sweep
from ..bench import Bench
from ..finding import Finding, at_most

LAYER = "studies"
GRAVITY = 9.81
SIZES, SLENDERNESS, SCALES, MODELS = (3.0, 8.0), (0.1, 0.3), (0.25, 2.0, 8.0), ("recess", "planar")
# what a row of cases holds of the run, but for its words
NUMBERS = ("peak_tilt", "uplift_time", "uplift_direction")


def check(bench: Bench) -> Iterator[Finding]:
    """Yield the findings of this part; the sweep runs the models that are installed."""
    del bench
    yield from _grid()
    yield _cases()


def _grid() -> Iterator[Finding]:
    motions = [_motion("one", 0.7), _motion("two", 1.1)]
    grid = Grid(
        semidiagonals=SIZES,
        tan_alphas=SLENDERNESS,
        scales=SCALES,
        motions=motions,
        models=MODELS,
        rtol=1e-8,
        rest_tilt=1e-4,
    )
    # chunks that cut through the axes, and chunks of several sizes with all scales
    first, table = (sweep(grid, workers=1, chunk_size=size) for size in (2, 6))
    axes = itertools.product(motions, MODELS, SLENDERNESS, SIZES, SCALES)
    wrong: list[str] = [] if first.equals(table) else ["it depends on the chunks"]
    apart, outcomes = 0.0, set()
    for row, (motion, model, tan_alpha, size, scale) in zip(table.to_dict("records"), axes, strict=False):
        stated = tuple(row[key] for key in ("motion", "model", "tan_alpha", "semidiagonal", "scale"))
        if stated != (motion.name, model, tan_alpha, size, scale):
            wrong.append(f"row {len(wrong)}: {stated}")
        cylinder = Cylinder(semidiagonal=size, tan_alpha=tan_alpha)
        alone = reduced.simulate(
            Case(cylinder, motion.scaled(scale)), rtol=1e-8, rest_tilt=0.0001, **reduced.MODELS[model]
        )
        expected = "stood" if alone.peak_tilt == 0.0 else alone.outcome
        expected = "rocked" if expected in ("rest", "completed") else expected
        outcomes.add(expected)
        if row["outcome"] != expected:
            wrong.append(f"{motion.name}, {model}, {tan_alpha:g}, {size:g} m, {scale:g}: {row['outcome']}")
        for name, value in (
            ("peak_tilt", alone.peak_tilt),
            ("peak_tilt_over_alpha", alone.peak_tilt / cylinder.alpha),
        ):
            apart = max(apart, abs(row[name] - value))
    count = len(motions) * len(MODELS) * len(SLENDERNESS) * len(SIZES) * len(SCALES)
    part = "sweep of a grid: its rows, or what is kept of a run"
    yield at_most(
        LAYER,
        f"peaks of a sweep against single runs, {count} rows",
        apart if len(table) == count and len(outcomes) == 3 else math.nan,
        0.0,
        unit="rad, alpha",
        reason="the same runs: scales are powers of two",
        part=part,
        note=f"outcomes: {', '.join(sorted(outcomes))}",
    )
    yield at_most(
        LAYER,
        "rows of a sweep with wrong values or outcomes",
        len(wrong),
        0.0,
        reason="motion, model, slenderness, size, scale: the last fastest",
        part=part,
        note="; ".join(wrong[:3]),
    )


def _cases() -> Finding:
    pier = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    cases = [
        Case(pier, _motion("one", 1.0), duration=3.0, gravity=9.0, name="shaken"),
        Case(pier, initial=InitialState(0.5 * pier.alpha, rolling_rate=0.3), duration=5.0, name="released"),
    ]
    methods = ("recess", "flat")
    table = sweep(CaseSweep(cases, methods), workers=1).to_dict("records")
    wrong = []
    for row, (method, case) in zip(table, itertools.product(methods, cases), strict=False):
        alone = reduced.simulate(
            Case(
                case.cylinder, case.motion, initial=case.initial, duration=case.duration, gravity=case.gravity
            ),
            **reduced.MODELS[method],
        )
        expected: dict[str, Any] = {
            "case": case.name,
            "run": method,
            "semidiagonal": 6.0,
            "tan_alpha": 0.2,
            "motion": "" if case.motion is None else case.motion.name,
            "outcome": alone.outcome,
            "peak_tilt_over_alpha": alone.peak_tilt / pier.alpha,
            "end": alone.time[-1],
            "passes": len(alone.passes),
            "closest_pass": alone.passes["minimum_tilt"].min() if len(alone.passes) else math.nan,
            **{name: getattr(alone, name) for name in NUMBERS},
        }
        wrong += [
            f"{key} of {case.name}, {method}: {row[key]}"
            for key, value in expected.items()
            if row[key] != value and not (row[key] != row[key] and value != value)
        ]
    return at_most(
        LAYER,
        f"wrong values in a sweep of {len(cases)} cases with {len(methods)} models",
        len(wrong) if len(table) == len(cases) * len(methods) else math.nan,
        0.0,
        reason="the same runs, method by method",
        part="sweep of cases: its rows, or what is kept of a run",
        note="; ".join(wrong[:3]),
    )


def _motion(name: str, strength: float) -> GroundMotion:
    """A pulse in both directions, and still ground for as long as a fall takes."""
    one = pulse("one-sine", amplitude=strength * GRAVITY * 0.2, period=0.8).acceleration
    other = pulse(
        "one-cosine", amplitude=0.5 * strength * GRAVITY * 0.2, period=0.8, azimuth=2.0
    ).acceleration
    both = (one + other)[::10]
    return GroundMotion(np.vstack([both, np.zeros((600, 2))]), 0.02, name)
