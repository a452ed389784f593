"""Traces that no model computed: functions of time that are written down, so that every metric is known."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    import pandas as pd

Array = NDArray[np.float64]


def _no_passes() -> pd.DataFrame:
    return passes([], [])


@dataclass(frozen=True, kw_only=True, eq=False)
class MadeTrace:
    """What metrics ask of a trace; n samples. What is not given is known to nobody.

    Parameters
    ----------
    time, tilt, rolling_angle, twist, energy : ndarray, shape (n,)
        [s], [rad], [rad], [rad], [m^2/s^2].
    contact_point : ndarray, shape (n, 2)
        [m]
    centre_of_mass : ndarray, shape (n, 3)
        [m]
    passes : DataFrame
    """

    time: Array
    tilt: Array
    rolling_angle: Array
    contact_point: Array
    centre_of_mass: Array
    energy: Array
    twist: Array
    passes: pd.DataFrame = field(default_factory=_no_passes)
    peak_tilt: float = math.nan
    outcome: str = "completed"
    message: str = ""
    uplift_time: float = 0.0
    uplift_direction: float = 0.0
    wall_time: float = 1.0
    engine: str = "made"
    engine_version: str = "1"
    support: str = "recess"
    time_step: float = 1e-4
    contact_resolution: float = 0.0
    residual_displacement: float = math.nan
    residual_twist: float = math.nan

    def to_frame(self) -> pd.DataFrame:
        """Return time and tilt as a table."""
        import pandas as pd

        return pd.DataFrame({"time": self.time, "tilt": self.tilt})


def made(time: Array, tilt: Array, **fields: Array | float | str | pd.DataFrame) -> MadeTrace:
    """Return a trace with tilts (n,) at times (n,); fields that are not given are zero, or unknown."""
    none = np.zeros(len(time))
    given: dict[str, object] = {
        "rolling_angle": none,
        "contact_point": np.zeros((len(time), 2)),
        "centre_of_mass": np.zeros((len(time), 3)),
        "energy": none,
        "twist": none,
        "peak_tilt": float(np.max(tilt)),
        **fields,
    }
    return MadeTrace(time=time, tilt=tilt, **given)  # type: ignore[arg-type]


def passes(times: list[float], minima: list[float], resolved: list[bool] | None = None) -> pd.DataFrame:
    """Return a table of passes; without `resolved` as of a reduced model."""
    import pandas as pd

    table = pd.DataFrame(
        {"time": times, "minimum_tilt": minima, "angle_of_turn": [math.pi] * len(times)}, dtype=float
    )
    if resolved is not None:
        table["resolved"] = np.array(resolved, dtype=bool)
    return table
