"""Layer studies, third part: a row of a sweep against a run of its own, and which rows there are."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator

import numpy as np

from rockwobble import reduced
from rockwobble.models import Case, Cylinder, GroundMotion, InitialState, Run, Suite, Trace, pulse

from ...studies.sweep.grid import Grid
from ...studies.sweep.study import sweep
from ..bench import Bench
from ..finding import Bound, Finding, at_most, none_wrong
from ..problems import GRAVITY, PIER

SIZES, SLENDERNESS, SCALES, MODELS = (3.0, 8.0), (0.1, 0.3), (0.25, 2.0, 8.0), ("recess", "planar")
EXACT = Bound(0.0, "the same runs: scales are powers of two", "rad, alpha")
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
    first, table = (sweep(grid, workers=1, chunk_size=size).table for size in (2, 6))
    axes = itertools.product(motions, MODELS, SLENDERNESS, SIZES, SCALES)
    wrong: list[str] = [] if first.equals(table) else ["it depends on the chunks"]
    apart, outcomes = 0.0, set()
    for row, (motion, model, tan_alpha, size, scale) in zip(table.to_dict("records"), axes, strict=False):
        stated = tuple(row[key] for key in ("motion", "model", "tan_alpha", "semidiagonal", "scale"))
        if stated != (motion.name, model, tan_alpha, size, scale):
            wrong.append(f"row {len(wrong)}: {stated}")
        case = Case(Cylinder(semidiagonal=size, tan_alpha=tan_alpha), motion.scaled(scale))
        alone = reduced.simulate(case, rtol=1e-8, rest_tilt=1e-4, **reduced.MODELS[model])
        outcomes.add((alone.outcome, alone.peak_tilt > 0.0))
        if row["outcome"] != alone.outcome:
            wrong.append(f"{motion.name}, {model}, {tan_alpha:g}, {size:g} m, {scale:g}: {row['outcome']}")
        over_alpha = abs(row["peak_tilt_over_alpha"] - alone.peak_tilt / case.cylinder.alpha)
        apart = max(apart, abs(row["peak_tilt"] - alone.peak_tilt), over_alpha)
    count = len(motions) * len(MODELS) * len(SLENDERNESS) * len(SIZES) * len(SCALES)
    part = "sweep of a grid: its rows, or what is kept of a run"
    yield at_most(
        f"peaks of a sweep against single runs, {count} rows",
        apart if len(table) == count and len(outcomes) == 3 else math.nan,
        EXACT,
        part,
        f"outcomes, and uplift: {sorted(outcomes)}",
    )
    reason = "motion, model, slenderness, size, scale: the last fastest"
    yield none_wrong("rows of a sweep with wrong values or outcomes", wrong, reason, part)


def _cases() -> Finding:
    release = InitialState(0.5 * PIER.alpha, rolling_rate=0.3)
    cases = [
        Case(PIER, _motion("one", 1.0), duration=3.0, gravity=9.0, name="shaken"),
        Case(PIER, initial=release, duration=5.0, name="released"),
    ]
    runs = [Run(None, "recess"), Run(None, "flat")]
    table = sweep(Suite(cases, runs), workers=1).table.to_dict("records")
    wrong = []
    for row, (run, case) in zip(table, itertools.product(runs, cases), strict=False):
        expected = _row(case, run, reduced.simulate(case, support=run.support))
        wrong += [
            f"{key} of {case.name}, {run}: {row[key]}"
            for key, value in expected.items()
            if row[key] != value and not (row[key] != row[key] and value != value)
        ]
    return none_wrong(
        f"wrong values in a sweep of {len(cases)} cases with {len(runs)} models",
        wrong,
        "the same runs, method by method",
        "sweep of cases: its rows, or what is kept of a run",
        made=len(table) == len(cases) * len(runs),
    )


def _row(case: Case, run: Run, alone: Trace) -> dict[str, object]:
    passes = alone.passes
    return {
        "case": case.name,
        "run": str(run),
        "semidiagonal": 6.0,
        "tan_alpha": 0.2,
        "motion": "" if case.motion is None else case.motion.name,
        "outcome": alone.outcome,
        "peak_tilt_over_alpha": alone.peak_tilt / PIER.alpha,
        "end": alone.time[-1],
        "passes": len(passes),
        "closest_pass": passes["minimum_tilt"].min() if len(passes) else math.nan,
        **{name: getattr(alone, name) for name in NUMBERS},
    }


def _motion(name: str, strength: float) -> GroundMotion:
    """A pulse in both directions, and still ground for as long as a fall takes."""
    most = strength * GRAVITY * 0.2
    one = pulse("one-sine", amplitude=most, period=0.8).acceleration
    other = pulse("one-cosine", amplitude=0.5 * most, period=0.8, azimuth=2.0).acceleration
    return GroundMotion(np.vstack([(one + other)[::10], np.zeros((600, 2))]), 0.02, name)
