"""Scenes and traces as tests of engines begin with them."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd

from rockwobble.models import Case, Cylinder, Diagnostic, InitialState, RockingBody, Run, Trace
from rockwobble.models.support import FLAT
from rockwobble.models.trace_file import EagerSource
from rockwobble.multibody.scene import Scene, scaled_body, starting_state

PASS = ("time", "minimum_tilt", "angle_of_turn")


def scene_of(cylinder: RockingBody, initial: InitialState | None = None, **changes: Any) -> Scene:
    """A scene at the size of the cylinder, at steps of 1e-4 s on flat ground, with `changes`."""
    body = scaled_body(cylinder, 1.0)
    fields: dict[str, Any] = {
        "body": body,
        "start": starting_state(body, initial, 1.0),
        "support": FLAT,
        "friction": 1.0,
        "time_step": 1e-4,
        "gravity": 9.81,
        "components": "xy",
        "unit_time": 1.0,
    }
    return Scene(**{**fields, **changes})


def trace_of(tilt: Any, *, passes: tuple[float, ...] = (), outcome: str = "stands", **fields: Any) -> Trace:
    """A trace with that tilt and times of passes, and nothing else to speak of."""
    n = len(tilt)
    zeros, points = np.zeros(n), np.zeros((n, 3))
    plain: dict[str, Any] = {
        "case": Case(Cylinder(semidiagonal=6.0, tan_alpha=0.2), duration=1.0),
        "run": Run("none", "flat"),
        "version": "",
        "time": 0.01 * np.arange(n),
        "tilt": np.asarray(tilt, dtype=float),
        "tilt_rate": zeros,
        "rolling_angle": zeros,
        "twist": zeros,
        "contact_point": points[:, :2],
        "centre_of_mass": points,
        "peak_tilt": float(np.max(tilt)),
        "outcome": outcome,
        "facts": (Diagnostic(code="warning", detail="why"),) if outcome == "failed" else (),
        "uplift_time": 0.0,
        "uplift_direction": 0.0,
        "passes": pd.DataFrame(dict.fromkeys(PASS, np.array(passes, dtype=float))).assign(resolved=True),
        "contact_resolution": 1e-6,
        "wall_time": 1.0,
        "source": EagerSource({"energy": np.asarray(tilt, dtype=float), "slip": zeros}),
    }
    return Trace(**{**plain, **fields})
