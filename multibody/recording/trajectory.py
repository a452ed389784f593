"""What an engine run gives: the fields of the reduced models, as far as an engine has them."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    import pandas as pd

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Trajectory:
    """One run of an engine, at n sample times; positions are relative to O and move with the ground.

    Attributes
    ----------
    engine, support, engine_version : str
    time_step : float
        Of the engine [s].
    settings : Mapping
        Every setting of the engine, given or default.
    wall_time : float
        Time that the run took [s].
    time : ndarray, shape (n,)
        Multiples of the sample step and the exact end [s]; of a run that overturns, the time at which its
        side is on the ground, which may be later than the duration asked for.
    tilt, tilt_rate, rolling_angle, rolling_rate, twist : ndarray, shape (n,)
        [rad], [rad/s]. The rolling angle and the twist are unwrapped at every step of the engine, the twist
        from 0. The rolling angle is NaN at rest: before the uplift, and where the tilt is below 5e-6 alpha.
    contact_point : ndarray, shape (n, 2)
        Lowest point of the rim [m]; NaN at rest.
    contact_offset : ndarray, shape (n,)
        How far the contact point is outside the circle of radius b about O [m], negative inside: the
        distance by which the cylinder has rolled or slipped out of its place. NaN at rest.
    contact_force : ndarray, shape (n, 3)
        Of the ground, and of walls where there are some, on the cylinder in weights, world axes: from the
        change of the engine's velocity, as a mean over 65 steps (a Hann window about the sample), because
        in a single step contact may be lost or carry twice the load. The guide is a couple and has no part
        in it. At rest it is what holds a standing cylinder, and in flight zero.
    centre_of_mass : ndarray, shape (n, 3)
        [m]
    energy : ndarray, shape (n,)
        Per unit mass, relative to the ground, zero standing [m^2/s^2].
    energy_error : ndarray, shape (n,)
        Energy that neither the start nor the excitation supplied [m^2/s^2]: what contact and numerics
        took (negative) or made (positive).
    slip : ndarray, shape (n,)
        Distance over which the contact has slipped so far [m].
    wall_contact : ndarray, shape (n,)
        Time for which the cylinder has been in contact with walls so far [s]; zero without a ring.
    wall_impulse : ndarray, shape (n,)
        Of the force of the walls so far, per unit mass [m/s]: its size added up, whatever its direction.
    first_wall_contact : float
        Time [s]; NaN if there was none.
    peak_tilt : float
        Vertex of the parabola through the largest step until the end of the run [rad]; pi/2 where
        overturned, NaN where failed.
    outcome : {"rest", "completed", "overturned", "failed"}
    message : str
        Why the run failed, or what limits it: slip, flight, passes too close to upright. May be empty.
    uplift_time, uplift_direction : float
        [s], [rad]. NaN if the base never uplifts; 0 and the rolling angle of the start for a release.
    passes : DataFrame
        Tilt minima between two maxima of one motion, with no rest between: time [s], minimum_tilt [rad],
        angle_of_turn [rad], and resolved [bool], whether the minimum exceeds `contact_resolution`.
    contact_resolution : float
        Smallest minimum tilt of a pass that the run resolves [rad]: penetration/(1.5 b), or the tilt
        that the fastest motion within the balance crosses in one step where that is larger.
    residual_displacement : float
        Horizontal distance of the base centre from O at the end [m].
    residual_twist : float
        At the end, whole turns included [rad].
    error_estimate : float
        Error of the tilt that the time step leaves, until `settled_until` [rad]; NaN unless time_step="auto".
    settled_until : float
        How far traces of successive steps agree [s]; NaN unless time_step="auto".
    """

    engine: str
    support: str
    engine_version: str
    time_step: float
    settings: Mapping[str, Any]
    wall_time: float
    time: Array
    tilt: Array
    tilt_rate: Array
    rolling_angle: Array
    rolling_rate: Array
    twist: Array
    contact_point: Array
    contact_offset: Array
    contact_force: Array
    centre_of_mass: Array
    energy: Array
    energy_error: Array
    slip: Array
    wall_contact: Array
    wall_impulse: Array
    first_wall_contact: float
    peak_tilt: float
    outcome: str
    message: str
    uplift_time: float
    uplift_direction: float
    passes: pd.DataFrame
    contact_resolution: float
    residual_displacement: float
    residual_twist: float
    error_estimate: float = math.nan
    settled_until: float = math.nan

    def to_frame(self) -> pd.DataFrame:
        """Return the sampled fields as a table with one row for each sample and units in SI."""
        import pandas as pd

        return pd.DataFrame(
            {
                "time": self.time,
                "tilt": self.tilt,
                "tilt_rate": self.tilt_rate,
                "rolling_angle": self.rolling_angle,
                "rolling_rate": self.rolling_rate,
                "twist": self.twist,
                "contact_x": self.contact_point[:, 0],
                "contact_y": self.contact_point[:, 1],
                "contact_offset": self.contact_offset,
                "force_x": self.contact_force[:, 0],
                "force_y": self.contact_force[:, 1],
                "force_z": self.contact_force[:, 2],
                "centre_x": self.centre_of_mass[:, 0],
                "centre_y": self.centre_of_mass[:, 1],
                "centre_z": self.centre_of_mass[:, 2],
                "energy": self.energy,
                "energy_error": self.energy_error,
                "slip": self.slip,
                "wall_contact": self.wall_contact,
                "wall_impulse": self.wall_impulse,
            }
        )
