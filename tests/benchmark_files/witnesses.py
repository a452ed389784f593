"""Third witness of the free motions: engines of hard contact, extrapolated to zero step.

DART solves the impulses of points in contact, Exudyn rolls a disc as a constraint: neither has the equations
that certify a value, nor always its accuracy. So their numbers stand beside it and do not enter its bound.
"""

from __future__ import annotations

import math
from typing import Any

from rockwobble import multibody
from rockwobble.models import Case
from rockwobble.multibody.engines.registry import find_engine

from .definitions import BenchmarkRun, Definition, G
from .references import measured
from .second import Sampled

WITNESSED = {"turn-flat": ("dart", "exudyn"), "turn-recess": ("dart",), "tendon": ("dart",)}
FINEST_STEP = 1e-5  # of the three runs [s]


def with_witnesses(definition: Definition, quantities: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """Quantities with the results of installed engines for free motions."""
    said: dict[tuple[str, str], dict[str, float]] = {}
    names = [name for name in WITNESSED.get(definition.name, ()) if name in multibody.available_engines()]
    for name in names:
        label = f"{name} {find_engine(name).version()}, extrapolated to a vanishing step"
        for run in definition.runs:
            trace = _sampled(name, run, definition.step * run.time_unit)
            for one in quantities:
                if trace is not None and one["run"] == run.name:
                    value = measured(one["name"], run, trace)
                    said.setdefault((one["name"], run.name), {})[label] = float(f"{value:.12g}")
    return [
        {**one, **({"engines": said[key]} if (key := (one["name"], one["run"])) in said else {})}
        for one in quantities
    ]


def _sampled(engine: str, run: BenchmarkRun, spacing: float) -> Sampled | None:
    """Samples of the extrapolated run; None if its runs do not converge to the end."""
    case = Case(
        run.cylinder,
        run.motion,
        initial=run.initial,
        duration=run.duration,
        gravity=G,
        friction=run.friction,
        tendon=run.tendon,
    )
    given: dict[str, Any] = {"time_step": "extrapolated", "finest_step": FINEST_STEP, "sample_step": spacing}
    trace = multibody.simulate(case, engine=engine, support=run.model, **given)
    if not math.isclose(trace.settled_until, trace.time[-1]):
        return None
    return Sampled(trace.time, trace.tilt, trace.tilt_rate, trace.rolling_angle)
