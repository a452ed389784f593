"""Pose and velocity to the quantities of the model, all steps at once.

theta  tilt: angle of the axis from the vertical                                  [rad]
phi    rolling angle: azimuth of the lean, hence of the lowest point of the rim   [rad]
tau    twist phi + psi = 2 atan2(q_z, q_w)                                        [rad]
S, O   mass centre, centre of the original base circle; positions relative to O   [m]
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .body import Body
from .engine import Steps

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class Kinematics:
    """Quantities of n consecutive poses; arrays of shape (n,) unless another is given.

    Attributes
    ----------
    tilt, tilt_rate, azimuth, rolling_rate, twist : ndarray
        The azimuth is phi between -pi and pi. The rolling rate has no meaning at zero tilt (0 there).
    contact_point : ndarray, shape (n, 2)
        Lowest point of the rim, from above [m].
    centre_of_mass, base_centre : ndarray, shape (n, 3)
        [m]
    energy : ndarray
        Kinetic and potential, per unit mass, zero standing [m^2/s^2].
    momentum : ndarray
        Momentum of the rolling angle per unit mass [m^2/s]: angular momentum about the contact point along
        the vertical less the axis. It is L = B phi' in a recess, and keeps its sign through a pass.
    depth : ndarray
        Of the lowest point of the rim below the ground [m].
    slip_rate : ndarray
        Horizontal speed of the material point there [m/s].
    """

    tilt: Array
    tilt_rate: Array
    azimuth: Array
    rolling_rate: Array
    twist: Array
    contact_point: Array
    centre_of_mass: Array
    base_centre: Array
    energy: Array
    momentum: Array
    depth: Array
    slip_rate: Array


def kinematics(poses: Steps, after: Steps, body: Body, gravity: float) -> Kinematics:
    """Return the quantities at `poses`, whose velocities are those of the step before.

    `after` holds the poses of one step later: the velocity at a pose is the mean of those before and
    after it.
    """
    velocity = 0.5 * (poses.velocity + after.velocity)
    spin = 0.5 * (poses.angular_velocity + after.angular_velocity)
    position = poses.position
    axis = axis_of(poses.quaternion)
    b, h = body.base_radius, body.mass_centre_height
    sine = np.hypot(axis[:, 0], axis[:, 1])
    # atan2 of both, because the cosine alone loses a tilt below 1e-8
    tilt = np.arctan2(sine, axis[:, 2])
    safe = np.where(sine > 0.0, sine, 1.0)
    outward = axis[:, :2] / safe[:, None]
    outward[sine == 0.0] = (1.0, 0.0)
    rate = np.cross(spin, axis)
    tilt_rate = (spin[:, 1] * axis[:, 0] - spin[:, 0] * axis[:, 1]) / safe
    rolling_rate = (axis[:, 0] * rate[:, 1] - axis[:, 1] * rate[:, 0]) / safe**2
    base_centre = position - h * axis
    contact = base_centre[:, :2] + b * axis[:, 2:] * outward
    lowest = np.column_stack([contact, base_centre[:, 2] - b * sine])
    slip = velocity + np.cross(spin, lowest - position)
    along = np.einsum("ij,ij->i", spin, axis)
    turning = -axis
    turning[:, 2] += 1.0
    about_contact = np.cross(position - lowest, velocity) + body.transverse_inertia * spin
    about_contact += (body.axial_inertia - body.transverse_inertia) * along[:, None] * axis
    energy = 0.5 * np.einsum("ij,ij->i", velocity, velocity) + gravity * (position[:, 2] - h)
    energy += 0.5 * body.transverse_inertia * np.einsum("ij,ij->i", spin, spin)
    energy += 0.5 * (body.axial_inertia - body.transverse_inertia) * along**2
    return Kinematics(
        tilt=tilt,
        tilt_rate=tilt_rate,
        azimuth=np.arctan2(axis[:, 1], axis[:, 0]),
        rolling_rate=rolling_rate,
        twist=2.0 * np.arctan2(poses.quaternion[:, 3], poses.quaternion[:, 0]),
        contact_point=contact,
        centre_of_mass=position,
        base_centre=base_centre,
        energy=energy,
        momentum=np.einsum("ij,ij->i", turning, about_contact),
        depth=b * sine - base_centre[:, 2],
        slip_rate=np.hypot(slip[:, 0], slip[:, 1]),
    )


def axis_of(quaternion: Array) -> Array:
    """Return the axes of revolution, shape (n, 3), of quaternions (n, 4), scalar first."""
    w, x, y, z = quaternion.T
    return np.column_stack([2.0 * (x * z + w * y), 2.0 * (y * z - w * x), 1.0 - 2.0 * (x * x + y * y)])


def unwrap(azimuth: Array, momentum: Array, meaningful: NDArray[np.bool_], before: float) -> Array:
    """Return the rolling angle without jumps, going on from `before` [rad].

    A change above a quarter turn in one step happens next to the apex, where the shorter way round may
    be the wrong one: the sign of the momentum says which way the cylinder turned. Where the azimuth is
    not `meaningful`, because the cylinder stands, the angle waits.
    """
    last = np.maximum.accumulate(np.where(meaningful, np.arange(len(azimuth)), -1))
    waiting = np.where(last < 0, before, azimuth[last])
    change = np.diff(waiting, prepend=before)
    change -= 2.0 * np.pi * np.round(change / (2.0 * np.pi))
    way = np.sign(momentum)
    wrong = (np.abs(change) > 0.5 * np.pi) & (np.sign(change) == -way)
    # the first lean after standing comes from no turn at all
    wrong &= meaningful & np.concatenate([[True], meaningful[:-1]])
    change[wrong] += 2.0 * np.pi * way[wrong]
    return np.asarray(before + np.cumsum(change))
