"""Files of external trajectories, in every form of columns."""

from __future__ import annotations

import numpy as np
import pandas as pd

from rockwobble.models import Trace

ANGLES = ["time", "tilt [rad]", "azimuth [rad]"]
TURN, PLACE = ["time", "qw", "qx", "qy", "qz"], ["x", "y", "z"]


def columns(trace: Trace, spin: float = 0.0) -> pd.DataFrame:
    """All columns of a file, in SI units; the quaternion is that of a body that spins [rad/s].

    A turn by -phi + twist about the axis, a tilt about y, a turn by phi about z.
    """
    phi = np.nan_to_num(trace.rolling_angle)
    half, turn = 0.5 * trace.tilt, 0.5 * (np.nan_to_num(trace.twist) + spin * trace.time)
    quaternion = [
        np.cos(half) * np.cos(turn),
        -np.sin(half) * np.sin(phi - turn),
        np.sin(half) * np.cos(phi - turn),
        np.cos(half) * np.sin(turn),
    ]
    azimuth = np.mod(trace.rolling_angle + np.pi, 2.0 * np.pi) - np.pi
    rows = np.column_stack([trace.time, trace.tilt, azimuth, *quaternion, trace.centre_of_mass])
    return pd.DataFrame(rows, columns=[*ANGLES, *TURN[1:], *PLACE])
