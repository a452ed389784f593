"""The maps of free response verified by an engine at some of their points."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import replace

from rockwobble.models import Run
from rockwobble.multibody import DEFAULT_ENGINE

from ...metrics.pair import make_pair
from ...metrics.tilt import tilt_rms
from ...runs.choice import SUPPORTS, own_model
from ...runs.execution import simulate_run
from .extent import Extent
from .free_response import next_maximum
from .motions import release_case
from .part import Inputs, Part, Row

_PERIODS = 2.2  # the second maximum, and a little more, so that it is seen to be one
_FRICTION = 10.0  # whatever the motion needs: friction is another limit


def _tasks(extent: Extent) -> Iterable[Inputs]:
    for tan_alpha, release, spin in extent.engine_points:
        yield {"tan_alpha": tan_alpha, "release": release, "spin": spin}


def measure(tan_alpha: float, release: float, spin: float) -> list[Row]:
    """Return a row for each support: what model and engine say of the first pass, and how far tilts differ.

    The columns: tan_alpha, release, spin, support; turn, engine_turn [rad], half_period, engine_half_period
    [s] to the first tilt minimum; tilt_rms over alpha; resolved, whether the contact of the engine resolves
    the pass; outcome.
    """
    case = replace(release_case(tan_alpha, release, spin, _PERIODS), friction=_FRICTION)
    rows: list[Row] = []
    for support in SUPPORTS:
        trial = Run(DEFAULT_ENGINE, support)
        own = simulate_run(case, Run(None, own_model(trial).support, rtol=1e-10))
        run = simulate_run(case, trial)
        passes, own_passes = run.passes, own.passes
        rows.append(
            {
                "support": support,
                "turn": next_maximum(own)[1],
                "engine_turn": float(passes["angle_of_turn"].iloc[0]) if len(passes) else math.nan,
                "half_period": float(own_passes["time"].iloc[0]) if len(own_passes) else math.nan,
                "engine_half_period": float(passes["time"].iloc[0]) if len(passes) else math.nan,
                "tilt_rms": tilt_rms(make_pair(case.cylinder, own, run)),
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
    keys=("tan_alpha", "release", "spin"),
    cost=lambda **_: 1.5,
    engine=DEFAULT_ENGINE,
)
