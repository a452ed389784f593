"""Error that time_step="auto" and "extrapolated" state, against their error, where passes are near.

`python tests/benchmarks step_errors --seed 7` draws releases and shaken motions with near-upright passes,
runs both ways to a time step, and prints for each the error stated and the largest tilt difference from the
reduced model of its support over the time that the statement is about, as far as the assumptions of the model
hold. An estimate may be too small by a factor of `FACTOR`; what states no number says why.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from rockwobble import multibody, reduced
from rockwobble.models import Case, Cylinder, InitialState, Trace, el_centro_1940
from rockwobble.models.case import WAYS_TO_A_STEP

from .console import options_of, show

if TYPE_CHECKING:
    import pandas as pd

FACTOR = 2.0  # an estimate that is too small by more misleads
LENGTH = 4.0  # [s] at the reference size: some passes, and a minute for the smallest step
_EXACT = 1e-10  # tolerance of the reduced model: its error is below all that an engine reaches
_ROUNDING = 1e-6  # of alpha: smaller errors are of rounding, and of no account
_SAID = ("settled", "unsettled", "extrapolated", "not_extrapolated")


def problems(count: int, seed: int, length: float = LENGTH) -> Iterator[tuple[Case, str]]:
    """Yield problems and their supports: releases of little spin, and El Centro from rest."""
    random = np.random.default_rng(seed)
    for number in range(count):
        size, tan_alpha = 10.0 ** random.uniform(0.0, 1.5), random.uniform(0.1, 0.5)
        cylinder, unit = Cylinder(semidiagonal=size, tan_alpha=tan_alpha), math.sqrt(size / 6.0)
        support = ("recess", "flat")[int(random.integers(2))]
        name = f"{number}: R {size:.3g} m, tan alpha {tan_alpha:.3g}"
        if number % 2:
            scale = random.uniform(1.5, 3.5) * 9.81 * tan_alpha / el_centro_1940().peak
            motion = el_centro_1940().rotated(random.uniform(0.0, math.tau)).scaled(scale)
            # a large cylinder takes longer to come back, a small one has its passes at once
            case = Case(cylinder, motion, duration=1.5 + length * unit, name=name)
        else:
            spin = 10.0 ** random.uniform(-2.5, -0.3) / unit
            release = InitialState(random.uniform(0.2, 0.9) * cylinder.alpha, rolling_rate=spin)
            case = Case(cylinder, initial=release, duration=length * unit, name=name)
        yield case, support


def step_errors(
    count: int,
    seed: int,
    *,
    length: float = LENGTH,
    engine: str = "mujoco",
    ways: Sequence[str] = WAYS_TO_A_STEP,
) -> pd.DataFrame:
    """Return one row for each problem and way: case, support, way, until [s], stated, error [alpha], said."""
    import pandas as pd

    rows: list[dict[str, Any]] = []
    for case, support in problems(count, seed, length):
        exact = reduced.simulate(case, support=support, rtol=_EXACT)
        for way in ways:
            trace = multibody.simulate(case, engine=engine, support=support, time_step=way)  # type: ignore[arg-type]
            rows.append({"case": case.name, "support": support, "way": way} | compared(trace, exact))
    return pd.DataFrame(rows)


def compared(trace: Trace, exact: Trace) -> dict[str, Any]:
    """Return what a trace states of its error, and its error up to there."""
    alpha, until = trace.case.cylinder.alpha, trace.settled_until
    count = min(len(trace.time), len(exact.time))
    # where the rim would have to be held, the engine lets it slip, and is right
    valid = min(exact.first("friction_needed"), exact.first("tension"))
    kept = trace.time[:count] <= (until if math.isfinite(until) else math.inf)
    kept &= trace.time[:count] < valid
    kept &= np.isclose(trace.time[:count], exact.time[:count])
    error = np.abs(trace.tilt[:count] - exact.tilt[:count])[kept].max(initial=0.0) / alpha
    facts = [fact.detail or fact.code for fact in trace.diagnostics if fact.code in _SAID]
    others = [fact.code for fact in trace.diagnostics if fact.code not in _SAID]
    stated = trace.error_estimate / alpha
    return {
        "until": until,
        "stated": stated,
        "error": error,
        "said": ", ".join(facts),
        "beside": ", ".join(others),
        "too_small": bool(error > FACTOR * max(stated, _ROUNDING)),  # not where it is NaN
    }


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the table and the shares."""
    options = options_of(
        "step_errors", "Errors stated by auto and extrapolated time steps, against true ones."
    )
    options.add_argument("--seed", type=int, default=1)
    options.add_argument("--count", type=int, default=30, help="of problems, half of them shaken")
    options.add_argument("--length", type=float, default=LENGTH, help="s at R = 6 m")
    options.add_argument("--engine", default="mujoco")
    options.add_argument("--way", choices=WAYS_TO_A_STEP, action="append", help="default: both")
    given = options.parse_args(arguments)
    table = step_errors(
        given.count,
        given.seed,
        length=given.length,
        engine=given.engine,
        ways=given.way or WAYS_TO_A_STEP,
    )
    formats = {
        "case": "", "support": "", "way": "", "until": ".3g", "stated": ".1e", "error": ".1e",
        "too_small": "", "said": "", "beside": "",
    }  # fmt: skip
    show(table, f"Errors stated by {given.engine}, seed {given.seed}", formats, "errors in alpha, until in s")
    for way, rows in table.groupby("way"):
        stated = rows[rows["stated"].notna()]
        print(
            f"{way}: {len(stated)} of {len(rows)} state an error, {stated['too_small'].sum()} of them one "
            f"that is too small by more than {FACTOR:g}"
        )
    return 0
