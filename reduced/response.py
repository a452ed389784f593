"""The response of a reduced model, with everything that can be asked of it."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from rockwobble.models import Cylinder

from . import forces
from .assumptions import Assumptions, Demands, review
from .columns import ground_at
from .integration.march import MAXIMUM, MINIMUM
from .problem import Problem

if TYPE_CHECKING:
    import pandas as pd

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False, kw_only=True)
class Response:
    """Motion of the cylinder by a reduced model; n samples.

    Attributes
    ----------
    time : ndarray, shape (n,)
        Multiples of the sample step, and the exact end [s].
    tilt, tilt_rate : ndarray, shape (n,)
        theta >= 0 [rad] and theta' [rad/s].
    rolling_angle : ndarray, shape (n,)
        phi, azimuth of the contact point, unwrapped [rad]; NaN at rest.
    rolling_rate : ndarray, shape (n,)
        phi' [rad/s]; 0 at rest.
    twist : ndarray, shape (n,)
        phi + psi [rad]; 0 but in the flat-ground model.
    contact_point : ndarray, shape (n, 2)
        On the ground, relative to O [m]; NaN at rest.
    centre_of_mass : ndarray, shape (n, 3)
        Relative to O, the centre of the original base circle, which moves with the ground [m].
    energy : ndarray, shape (n,)
        Relative to the ground, per unit mass, zero standing [m^2/s^2].
    contact_force : ndarray, shape (n, 3)
        On the cylinder, in weights, world axes.
    restraining_moment : ndarray, shape (n,)
        Couple along z_world + z_body that the recess supplies, over the weight [m]; 0 without one.
    friction_needed : ndarray, shape (n,)
        Horizontal over normal force; inf where the normal force is not positive.
    peak_tilt : float
        Largest tilt of the continuous solution [rad]; pi/2 if overturned, NaN if failed.
    outcome : {"rest", "completed", "overturned", "failed"}
        "rest": standing at the end; "completed": still in motion at the end.
    message : str
        The outcome in words.
    uplift_time : float
        First uplift [s]; 0 for a release, NaN if there is none.
    uplift_direction : float
        Rolling angle there [rad].
    rests : ndarray, shape (r, 2)
        When the cylinder came to rest after it had moved, and when it uplifted again; NaN if it did not [s].
    model : str
    cylinder : Cylinder
    gravity : float
        [m/s^2]
    friction : float
        Coefficient that `assumptions` holds the friction needed against.
    wall_time : float
        Computing time without compilation [s].
    step_count : int
        Steps tried by the integrator.
    """

    time: Array
    tilt: Array
    tilt_rate: Array
    rolling_angle: Array
    twist: Array
    peak_tilt: float
    outcome: str
    message: str
    uplift_time: float
    uplift_direction: float
    friction: float
    wall_time: float
    step_count: int
    problem: Problem
    momentum: Array  # L or Lambda (n,) [m^2/s]
    twist_momentum: Array  # S (n,) [m^2/s]
    roll_out: Array  # centre of the circle that the rim rolls on, relative to O (n, 2) [m]
    extrema: Array  # (k, 4): time, tilt, rolling angle, MAXIMUM or MINIMUM
    rests: Array

    @property
    def model(self) -> str:
        """Name of the model."""
        return self.problem.model

    @property
    def cylinder(self) -> Cylinder:
        """The body."""
        return self.problem.cylinder

    @property
    def gravity(self) -> float:
        """Gravity [m/s^2]."""
        return self.problem.gravity

    @property
    def signed_tilt(self) -> Array:
        """Tilt (n,) [rad], negative where it leans away from the reference direction.

        That is the azimuth of the plane in the planar model, and the direction of first uplift or
        release in the others. In planar motion the signed tilt is continuous.
        """
        reference = self.problem.plane if self.model == "planar" else self.uplift_direction
        away = np.cos(np.nan_to_num(self.rolling_angle) - np.nan_to_num(reference)) < 0.0
        return np.where(away, -self.tilt, self.tilt)

    @property
    def rolling_rate(self) -> Array:
        """Rate of the rolling angle, phi' (n,) [rad/s]; 0 at rest."""
        return self._derived[:, forces.ROLLING_RATE]

    @property
    def energy(self) -> Array:
        """Energy (n,) relative to the ground, per unit mass, zero standing [m^2/s^2]."""
        return self._derived[:, forces.ENERGY]

    @property
    def contact_force(self) -> Array:
        """Force (n, 3) of the ground on the cylinder, in weights, world axes."""
        return self._derived[:, forces.FORCE_X : forces.FORCE_Z + 1]

    @property
    def restraining_moment(self) -> Array:
        """Couple (n,) of the recess along z_world + z_body, over the weight [m]."""
        return self._derived[:, forces.COUPLE]

    @property
    def friction_needed(self) -> Array:
        """Horizontal over normal force (n,) [-]; inf where the normal force is not positive."""
        return friction_of(self.contact_force)

    @property
    def contact_point(self) -> Array:
        """Contact point (n, 2) relative to O [m]; NaN at rest."""
        b = self.cylinder.base_radius
        phi = self.rolling_angle
        return self.roll_out + b * np.column_stack([np.cos(phi), np.sin(phi)])

    @property
    def centre_of_mass(self) -> Array:
        """Mass centre (n, 3) relative to O [m]: equations (8) and (10)."""
        b, h = self.cylinder.base_radius, self.cylinder.mass_centre_height
        s, c = np.sin(self.tilt), np.cos(self.tilt)
        radius = s * (h + b * np.tan(0.5 * self.tilt))
        phi = np.nan_to_num(self.rolling_angle)
        horizontal = self.roll_out + radius[:, None] * np.column_stack([np.cos(phi), np.sin(phi)])
        return np.column_stack([horizontal, b * s + h * c])

    @property
    def passes(self) -> pd.DataFrame:
        """Passes: a tilt minimum between two maxima, one row each.

        Columns: time [s] of the minimum, minimum_tilt [rad], angle_of_turn [rad], the change of
        rolling angle from maximum to maximum. Turning points closer than the tolerance of the
        solution, as in steady wobble, are not told apart and make no pass, and neither does a rest.
        """
        import pandas as pd

        rows = self.extrema
        kinds = rows[:, 3]
        motion = np.searchsorted(self.rests[:, 0], rows[:, 0])  # number of rests before
        found = [
            (rows[i, 0], rows[i, 1], rows[i + 1, 2] - rows[i - 1, 2])
            for i in range(1, len(rows) - 1)
            if kinds[i] == MINIMUM
            and kinds[i - 1] == kinds[i + 1] == MAXIMUM
            and motion[i - 1] == motion[i + 1]
            and min(rows[i - 1, 1], rows[i + 1, 1]) > rows[i, 1] * (1.0 + 100.0 * self.problem.rtol)
        ]
        return pd.DataFrame(found, columns=["time", "minimum_tilt", "angle_of_turn"], dtype=float)

    @cached_property
    def assumptions(self) -> Assumptions:
        """Whether contact and friction held, from the extrema of the continuous solution; solved again."""
        return self.assumptions_until(math.inf)

    def assumptions_until(self, end: float) -> Assumptions:
        """Return whether contact and friction held until the time `end` [s], such as that of a fall."""
        march, _ = self.problem.solve(np.empty(0), record_steps=True)
        steps = np.concatenate([[0.0], march.steps[:, 0], self.rests[:, 0], [min(march.end, end)]])
        landings = self.extrema[self.extrema[:, 1] == 0.0, 0]
        jumps = np.concatenate([[self.uplift_time], self.rests[:, 1], landings])
        jumps = jumps[np.isfinite(jumps) & (jumps > 0.0) & (jumps < end)]
        return review(self._demands_at, np.unique(steps[steps <= end]), jumps, self.friction)

    def _demands_at(self, times: Array) -> Demands:
        march, azimuth = self.problem.solve(times)
        reached = march.reached
        states = six_columns(march.samples[:reached], azimuth)
        derived = self._derive(times[:reached], states)
        force = derived[:, forces.FORCE_X : forces.FORCE_Z + 1]
        return Demands(force[:, 2], friction_of(force), derived[:, forces.COUPLE], march.moving[:reached])

    def to_frame(self) -> pd.DataFrame:
        """Return the samples as a table, one column for each component, SI units and radians."""
        import pandas as pd

        contact, centre, force = self.contact_point, self.centre_of_mass, self.contact_force
        return pd.DataFrame(
            {
                "time": self.time,
                "tilt": self.tilt,
                "tilt_rate": self.tilt_rate,
                "rolling_angle": self.rolling_angle,
                "rolling_rate": self.rolling_rate,
                "twist": self.twist,
                "contact_x": contact[:, 0],
                "contact_y": contact[:, 1],
                "centre_x": centre[:, 0],
                "centre_y": centre[:, 1],
                "centre_z": centre[:, 2],
                "energy": self.energy,
                "force_x": force[:, 0],
                "force_y": force[:, 1],
                "force_z": force[:, 2],
                "restraining_moment": self.restraining_moment,
                "friction_needed": self.friction_needed,
            }
        )

    @cached_property
    def _derived(self) -> Array:
        phi = np.nan_to_num(self.rolling_angle)
        states = np.column_stack(
            [self.tilt, self.tilt_rate, phi, self.momentum, self.twist, self.twist_momentum]
        )
        return self._derive(self.time, states)

    def _derive(self, times: Array, states: Array) -> Array:
        return forces.derived_quantities(
            self.problem.body,
            np.ascontiguousarray(states),
            ground_at(self.problem.motion, self.problem.duration, times),
            self.model == "flat",
        )


def friction_of(force: Array) -> Array:
    """Return horizontal over normal force (n,) of `force` (n, 3); inf where N is not positive."""
    horizontal, normal = np.hypot(force[:, 0], force[:, 1]), force[:, 2]
    pressed = normal > 0.0
    return np.where(pressed, horizontal / np.where(pressed, normal, 1.0), math.inf)


def six_columns(states: Array, azimuth: float) -> Array:
    """Return theta, theta', phi, Lambda, tau, S (n, 6) of the variables of any model."""
    full = np.zeros((len(states), 6))
    width = min(states.shape[1], 6)
    full[:, :width] = states[:, :width]
    full[:, 2] += azimuth
    return full
