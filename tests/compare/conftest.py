"""Made-up traces with known differences."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

from rockwobble.models import Cylinder


@dataclasses.dataclass(frozen=True, kw_only=True)
class MadeUpTrace:
    """The fields of a response and of a trajectory, given one by one."""

    time: np.ndarray
    tilt: np.ndarray
    rolling_angle: np.ndarray
    contact_point: np.ndarray
    centre_of_mass: np.ndarray
    energy: np.ndarray
    twist: np.ndarray
    passes: pd.DataFrame
    peak_tilt: float
    outcome: str = "completed"
    message: str = ""
    uplift_time: float = 0.0
    uplift_direction: float = 0.0
    wall_time: float = 1.0
    engine: str = "made up"
    engine_version: str = "1"
    support: str = "recess"
    time_step: float = 1e-4
    contact_resolution: float = 0.0
    residual_displacement: float = 0.0
    residual_twist: float = 0.0
    tilt_rate: np.ndarray | None = None

    def to_frame(self) -> pd.DataFrame:
        return pd.DataFrame({"time": self.time, "tilt": self.tilt, "rolling_angle": self.rolling_angle})


@pytest.fixture
def cylinder() -> Cylinder:
    return Cylinder(semidiagonal=6.0, tan_alpha=0.2)


@pytest.fixture
def make_trace(cylinder: Cylinder) -> Callable[..., Any]:
    def make(
        time: np.ndarray,
        tilt: np.ndarray,
        *,
        rolling_angle: np.ndarray | None = None,
        passes: list[tuple[float, float]] = (),
        unresolved: list[float] | None = None,
        **fields: Any,
    ) -> MadeUpTrace:
        phi = np.zeros_like(time) if rolling_angle is None else rolling_angle
        table = pd.DataFrame(list(passes), columns=["time", "minimum_tilt"], dtype=float)
        table["angle_of_turn"] = np.pi
        if unresolved is not None:
            table["resolved"] = ~table["time"].isin(unresolved)
        values: dict[str, Any] = {
            "rolling_angle": phi,
            "contact_point": cylinder.base_radius * np.column_stack([np.cos(phi), np.sin(phi)]),
            "centre_of_mass": np.zeros((len(time), 3)),
            "energy": np.zeros_like(time),
            "twist": np.zeros_like(time),
            "peak_tilt": float(np.max(tilt)),
            "passes": table,
        }
        return MadeUpTrace(time=time, tilt=tilt, **(values | fields))

    return make


@pytest.fixture
def save(tmp_path: Path) -> Callable[..., Path]:
    """Write the file of an external trajectory."""

    def write(table: pd.DataFrame | str, name: str = "table.csv") -> Path:
        path = tmp_path / name
        path.write_text(table if isinstance(table, str) else table.to_csv(index=False))
        return path

    return write
