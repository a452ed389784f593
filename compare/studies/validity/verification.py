"""The maps of free response verified by an engine at some of their points."""

from __future__ import annotations

import math
from collections.abc import Sequence

from rockwobble import reduced
from rockwobble.models import Case, Run

from ...metrics.tilt import tilt_rms
from ...runs.choice import SUPPORTS, own_model
from ...runs.execution import simulate_run
from ...traces.pair import make_pair
from .extent import Extent
from .free_response import next_maximum
from .part import Inputs, Part, Row
from .releases import released

ENGINE = "mujoco"
_PERIODS = 2.2  # the second maximum, and a little more, so that it is seen to be one
_FRICTION = 10.0  # whatever the motion needs: friction is another limit


def _tasks(extent: Extent) -> Sequence[Inputs]:
    return [
        {"tan_alpha": tan_alpha, "release": release, "spin": spin}
        for tan_alpha, release, spin in extent.engine_points
    ]


def measure(inputs: Inputs) -> list[Row]:
    """Return a row for each support: what model and engine say of the first pass, and how far tilts differ.

    The columns: tan_alpha, release, spin, support, model; turn, engine_turn [rad], half_period,
    engine_half_period [s] to the first tilt minimum; tilt_rms over alpha; resolved, whether the contact of
    the engine resolves the pass; outcome.
    """
    cylinder, initial = released(inputs["tan_alpha"], inputs["release"], inputs["spin"])
    duration = _PERIODS * reduced.free_response(cylinder, initial).period
    case = Case(cylinder, initial=initial, duration=duration, friction=_FRICTION)
    rows = []
    for support in SUPPORTS:
        trial = Run(ENGINE, support)
        model = own_model(trial).support
        own, run = simulate_run(case, Run(None, model, rtol=1e-10)), simulate_run(case, trial)
        passes, own_passes = run.passes, own.passes
        rows.append(
            {
                **inputs,
                "support": support,
                "model": model,
                "turn": next_maximum(own)[1],
                "engine_turn": float(passes["angle_of_turn"].iloc[0]) if len(passes) else math.nan,
                "half_period": float(own_passes["time"].iloc[0]) if len(own_passes) else math.nan,
                "engine_half_period": float(passes["time"].iloc[0]) if len(passes) else math.nan,
                "tilt_rms": tilt_rms(make_pair(cylinder, own, run)),
                "resolved": bool(passes["resolved"].iloc[0]) if len(passes) else False,
                "outcome": run.outcome,
            }
        )
    return rows


PART = Part(
    name="verification",
    title="free response in the engine",
    tasks=_tasks,
    measure=measure,
    cost=lambda inputs: 1.5,
    module=__name__,
    engine=ENGINE,
)
