"""Pose and velocity to the quantities of the model, all steps at once.

theta  tilt: angle of the axis from the vertical                                  [rad]
phi    rolling angle: azimuth of the lean, hence of the lowest point of the rim   [rad]
tau    twist phi + psi = 2 atan2(q_z, q_w), which tells it up to whole turns       [rad]
S, O   mass centre, centre of the original base circle; positions relative to O   [m]
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .protocol import Steps
from .restraint import WEIGHT_ALONE, Restraint
from .scene import Array, Body


@dataclass(frozen=True, slots=True, eq=False)
class Kinematics:
    """Quantities of n consecutive poses that a run follows at every step; arrays of shape (n,).

    Attributes
    ----------
    tilt, tilt_rate, azimuth, twist : ndarray
        The azimuth is phi between -pi and pi, the twist as the quaternion tells it: see `unwrap_twist`.
    energy : ndarray
        Kinetic and potential, what a restraint stores included, per unit of the effective mass, zero standing
        [m^2/s^2].
    depth : ndarray
        Depth of the lowest point of the rim below the ground [m].
    slip_rate : ndarray
        Horizontal speed of the material point there [m/s].
    """

    tilt: Array
    tilt_rate: Array
    azimuth: Array
    twist: Array
    energy: Array
    depth: Array
    slip_rate: Array


def kinematics(
    poses: Steps, after: Steps, body: Body, gravity: float, restraint: Restraint = WEIGHT_ALONE
) -> Kinematics:
    """Return the quantities at `poses`, whose velocities are those of the step before.

    `after` holds the poses of one step later: the velocity at a pose is the mean of those before and
    after it. Components are taken one by one, because this runs at every step of an engine and a cross
    product of arrays costs as much as a step.
    """
    vx, vy, vz = mean_velocity(poses, after).T
    wx, wy, wz = mean_spin(poses, after).T
    axis = axis_of(poses.quaternion)
    ax, ay, az = axis.T
    z = poses.position[:, 2]
    b, h = body.base_radius, body.mass_centre_height
    sine = np.sqrt(ax * ax + ay * ay)
    safe = np.where(sine > 0.0, sine, 1.0)
    height = z - h * az - b * sine  # height of the lowest point
    # horizontal distance from the mass centre to the lowest point of the rim, along the tilt vector
    out_x, out_y = ax / safe, ay / safe
    reach = b * az - h * sine
    down = height - z
    slip_x = vx + wy * down - wz * reach * out_y
    slip_y = vy + wz * reach * out_x - wx * down
    along = wx * ax + wy * ay + wz * az
    transverse, axial = body.transverse_inertia, body.axial_inertia
    energy = body.moved_mass * (vx * vx + vy * vy + vz * vz)
    energy += transverse * (wx * wx + wy * wy + wz * wz)
    energy += (axial - transverse) * along * along
    if restraint.is_active:
        energy += 2.0 * restraint.energy(poses.position, axis, h)
    return Kinematics(
        # atan2 of both, because the cosine alone loses a tilt below 1e-8
        tilt=np.arctan2(sine, az),
        tilt_rate=wy * out_x - wx * out_y,
        azimuth=np.arctan2(ay, ax),
        twist=2.0 * np.arctan2(poses.quaternion[:, 3], poses.quaternion[:, 0]),
        energy=0.5 * energy / body.effective_mass + gravity * (z - h),
        depth=-height,
        slip_rate=np.sqrt(slip_x * slip_x + slip_y * slip_y),
    )


@dataclass(frozen=True, slots=True, eq=False)
class Rim:
    """Position and orientation of the rim, computed at some poses only.

    Attributes
    ----------
    rolling_rate : ndarray, shape (n,)
        phi' [rad/s]; it has no meaning at zero tilt (0 there).
    contact_point : ndarray, shape (n, 2)
        Lowest point of the rim, from above [m].
    base_centre : ndarray, shape (n, 3)
        [m]
    """

    rolling_rate: Array
    contact_point: Array
    base_centre: Array


def rim(poses: Steps, after: Steps, body: Body) -> Rim:
    """Position and orientation of the rim at `poses`; arguments as for `kinematics`."""
    wx, wy, wz = mean_spin(poses, after).T
    axis = axis_of(poses.quaternion)
    ax, ay, az = axis.T
    sine = np.sqrt(ax * ax + ay * ay)
    safe = np.where(sine > 0.0, sine, 1.0)
    outward = axis[:, :2] / safe[:, None]
    outward[sine == 0.0] = (1.0, 0.0)
    base_centre = poses.position - body.mass_centre_height * axis
    # horizontal part of spin x axis, across the tilt vector
    rate_x, rate_y = wy * az - wz * ay, wz * ax - wx * az
    return Rim(
        rolling_rate=(ax * rate_y - ay * rate_x) / safe**2,
        contact_point=base_centre[:, :2] + body.base_radius * axis[:, 2:] * outward,
        base_centre=base_centre,
    )


def rolling_momentum(poses: Steps, after: Steps, body: Body) -> Array:
    """Return the momentum of the rolling angle per unit mass, shape (n,) [m^2/s].

    It is the angular momentum about the contact point along the vertical less the axis: L = B phi' in a
    recess. It keeps its sign through a pass. Arguments as for `kinematics`.
    """
    velocity, spin = mean_velocity(poses, after), mean_spin(poses, after)
    axis, place = axis_of(poses.quaternion), rim(poses, after, body)
    sine = np.hypot(axis[:, 0], axis[:, 1])
    lowest = np.column_stack([place.contact_point, place.base_centre[:, 2] - body.base_radius * sine])
    along = np.einsum("ij,ij->i", spin, axis)
    about_contact = body.moved_mass * np.cross(poses.position - lowest, velocity)
    about_contact += body.transverse_inertia * spin
    about_contact += (body.axial_inertia - body.transverse_inertia) * along[:, None] * axis
    return np.asarray(np.einsum("ij,ij->i", np.array([0.0, 0.0, 1.0]) - axis, about_contact))


def mean_velocity(poses: Steps, after: Steps) -> Array:
    """Return the velocity of the mass centre at `poses`, shape (n, 3) [m/s]."""
    return 0.5 * (poses.velocity + after.velocity)


def mean_spin(poses: Steps, after: Steps) -> Array:
    """Return the angular velocity at `poses`, shape (n, 3) [rad/s]."""
    return 0.5 * (poses.angular_velocity + after.angular_velocity)


def axis_of(quaternion: Array) -> Array:
    """Return the axes of revolution, shape (n, 3), of quaternions (n, 4), scalar first."""
    w, x, y, z = quaternion.T
    axis = np.empty((3, len(quaternion)))
    axis[0] = 2.0 * (x * z + w * y)
    axis[1] = 2.0 * (y * z - w * x)
    axis[2] = 1.0 - 2.0 * (x * x + y * y)
    return axis.T


def turning(before: Array, quaternion: Array) -> Array:
    """Return the rotation vectors (n, 3), world axes, from each orientation to the next.

    From `before` (4,) to the first of the quaternions (n, 4), scalar first, and so on.
    """
    earlier = np.vstack([before, quaternion[:-1]])
    w0, v0, w1, v1 = earlier[:, :1], earlier[:, 1:], quaternion[:, :1], quaternion[:, 1:]
    real = w1 * w0 + np.einsum("ij,ij->i", v1, v0)[:, None]
    imaginary = w0 * v1 - w1 * v0 - np.cross(v1, v0)
    # the shorter rotation, for either sign of the quaternion
    imaginary, real = imaginary * np.where(real < 0.0, -1.0, 1.0), np.abs(real)
    size = np.linalg.norm(imaginary, axis=1)[:, None]
    factor = np.where(size > 0.0, 2.0 * np.arctan2(size, real) / np.where(size > 0.0, size, 1.0), 2.0)
    return np.asarray(factor * imaginary)


def about_vertical(vectors: Array, angle: Array | float) -> Array:
    """Return vectors (n, 3) turned about the vertical by one angle or by angles (n,) [rad]."""
    cosine, sine = np.cos(angle), np.sin(angle)
    x, y, z = vectors.T
    return np.column_stack([cosine * x - sine * y, sine * x + cosine * y, z])


def tilt_of(quaternion: Array) -> Array:
    """Return the tilts, shape (n,) [rad], of quaternions (n, 4), scalar first."""
    ax, ay, az = axis_of(quaternion).T
    # atan2 of both, because the cosine alone loses a tilt below 1e-8
    return np.asarray(np.arctan2(np.sqrt(ax * ax + ay * ay), az))


def unwrap_twist(twist: Array, before: float) -> Array:
    """Return the twist (n,) without jumps, going on from `before` [rad].

    A quaternion and its negative are one pose, and the twists that they tell differ by a whole turn. A step
    twists by far less than half a turn, unlike the azimuth at upright: q_z and q_w vanish together only
    upside down.
    """
    turns = np.cumsum(np.round(np.diff(twist, prepend=before) / (2.0 * np.pi)))
    return np.asarray(twist - 2.0 * np.pi * turns)


def unwrap(
    azimuth: Array,
    momentum: Callable[[NDArray[np.intp]], Array],
    meaningful: NDArray[np.bool_],
    before: float,
    leant_before: bool,
) -> Array:
    """Return the rolling angle without jumps, going on from `before` [rad].

    A change above a quarter turn in one step happens next to upright, where the shorter way round may
    be the wrong one: the sign of the momentum, given for some indices, says which way the cylinder
    turned. Where the azimuth is not `meaningful`, because the cylinder stands, the angle waits;
    `leant_before` says whether it was meaningful at `before`.
    """
    waiting = azimuth
    if not meaningful.all():
        last = np.maximum.accumulate(np.where(meaningful, np.arange(len(azimuth)), -1))
        waiting = np.where(last < 0, before, azimuth[last])
    change = np.diff(waiting, prepend=before)
    change -= 2.0 * np.pi * np.round(change / (2.0 * np.pi))
    large = np.flatnonzero(np.abs(change) > 0.5 * np.pi)
    # the first tilt after standing has no angle to continue from
    large = large[meaningful[large] & np.append(leant_before, meaningful[:-1])[large]]
    if len(large):
        way = np.sign(momentum(large))
        wrong = np.sign(change[large]) == -way
        change[large[wrong]] += 2.0 * np.pi * way[wrong]
    return np.asarray(before + np.cumsum(change))
