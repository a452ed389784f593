"""Synthetic traces with known differences."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

from rockwobble.models import Case, Cylinder, Run, Trace
from rockwobble.models.trace_file import Array, EagerSource


@pytest.fixture
def cylinder() -> Cylinder:
    return Cylinder(semidiagonal=6.0, tan_alpha=0.2)


@pytest.fixture
def make_trace(cylinder: Cylinder) -> Callable[..., Trace]:
    def make(
        time: Array,
        tilt: Array,
        *,
        rolling_angle: Array | None = None,
        passes: Sequence[tuple[float, float]] = (),
        unresolved: Sequence[float] = (),
        energy: Array | None = None,
        **fields: Any,
    ) -> Trace:
        phi = np.zeros_like(time) if rolling_angle is None else rolling_angle
        table = pd.DataFrame(list(passes), columns=["time", "minimum_tilt"], dtype=float)
        table = table.assign(angle_of_turn=np.pi, resolved=~table["time"].isin(list(unresolved)))
        values: dict[str, Any] = {
            "case": Case(cylinder, duration=float(time[-1]), name="synthetic"),
            "run": Run("mujoco", "recess"),
            "version": "1",
            "tilt_rate": np.full_like(time, np.nan),
            "rolling_angle": phi,
            "contact_point": cylinder.base_radius * np.column_stack([np.cos(phi), np.sin(phi)]),
            "centre_of_mass": np.zeros((len(time), 3)),
            "twist": np.zeros_like(time),
            "peak_tilt": float(np.max(tilt)),
            "passes": table,
            "outcome": "stands",
            "uplift_time": 0.0,
            "uplift_direction": 0.0,
            "time_step": 1e-4,
            "wall_time": 1.0,
            "contact_resolution": 0.0,
            "residual_displacement": 0.0,
            "source": EagerSource({"energy": np.zeros_like(time) if energy is None else energy}),
        }
        return Trace(time=time, tilt=tilt, **(values | fields))

    return make


@pytest.fixture
def save(tmp_path: Path) -> Callable[..., Path]:
    """Write the file of an external trajectory."""

    def write(table: pd.DataFrame | str, name: str = "table.csv") -> Path:
        path = tmp_path / name
        path.write_text(table if isinstance(table, str) else table.to_csv(index=False))
        return path

    return write
