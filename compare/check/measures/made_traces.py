"""Traces that no model computed: functions of time that are written down, so that every metric is known."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pandas as pd

from rockwobble.models import Case, Run, Trace
from rockwobble.models.traces.trace_source import Known

from ..bench import Array
from ..problems import PIER

RECESS = Run(None, "recess")
CASE = Case(PIER, duration=20.0, name="made")


def made(time: Array, tilt: Array, *, energy: Array | None = None, **fields: Any) -> Trace:
    """Return a trace with tilts (n,) at times (n,); fields that are not given are zero, or unknown."""
    none, flat, space = (np.zeros(size) for size in (len(time), (len(time), 2), (len(time), 3)))
    given: dict[str, object] = {
        "case": CASE,
        "run": RECESS,
        "version": "1",
        "tilt_rate": none,
        "rolling_angle": none,
        "twist": none,
        "contact_point": flat,
        "centre_of_mass": space,
        "peak_tilt": float(np.max(tilt)),
        "outcome": "stands",
        "uplift_time": 0.0,
        "uplift_direction": 0.0,
        "source": Known({"energy": none if energy is None else energy}),
        "wall_time": 1.0,
        "time_step": 1e-4,
        "contact_resolution": 0.0,
    }
    return Trace(time=time, tilt=tilt, **{**given, **fields})


def passes(times: list[float], minima: list[float], resolved: list[bool] | None = None) -> pd.DataFrame:
    """Return a table of passes, each of half a turn; without `resolved` as of a reduced model."""
    table = pd.DataFrame(
        {"time": times, "minimum_tilt": minima, "angle_of_turn": [math.pi] * len(times)}, dtype=float
    )
    return table.assign(resolved=True if resolved is None else resolved)
