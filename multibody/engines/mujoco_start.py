"""The start of MuJoCo: the depth at which contact carries the load, and leapfrog half a step back."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..protocol import Array, Scene
from ..start import Start

if TYPE_CHECKING:
    import mujoco  # type: ignore[import-untyped]

_SECANT_STEPS = 30
_STILL = 1e-9  # [m/s^2] acceleration left of the rim at the start


def set_start(model: mujoco.MjModel, data: mujoco.MjData, scene: Scene, staggered: bool) -> None:
    """Put the cylinder at its loaded penetration, and its velocity half a step back if it is `staggered`."""
    import mujoco

    start = scene.start
    inverse = start.quaternion * np.array([1.0, -1.0, -1.0, -1.0])
    data.qpos[:3], data.qpos[3:7] = start.position, start.quaternion
    data.qvel[:3] = start.velocity
    data.qvel[3:6] = to_world(inverse[None], start.angular_velocity[None])[0]
    # a slab has the velocity of the highest point of the top, and so it came to its place
    data.qpos[7:] = 2.0 * (start.position - [0.0, 0.0, scene.body.mass_centre_height])[: model.nq - 7]
    data.qvel[6:] = 2.0 * start.velocity[: model.nv - 6]
    slab_height = data.qpos[9:].copy()
    share = scene.body.slab_mass_ratio

    def rim_acceleration(depth: float) -> float:
        data.qpos[2] = start.position[2] - depth
        # the top sinks in by the share of the load that it carries
        data.qpos[9:] = slab_height - depth * (1.0 + share / (1.0 + share))
        data.qacc_warmstart[:] = 0.0
        mujoco.mj_forward(model, data)
        return _rim_acceleration(data, scene)

    # contact is a spring under a given load, so the secant is nearly exact
    before, depth = 1e-7, 2e-7
    value_before, value = rim_acceleration(before), rim_acceleration(depth)
    for _ in range(_SECANT_STEPS):
        if abs(value) < _STILL or value == value_before:
            break
        before, depth = depth, depth - value * (depth - before) / (value - value_before)
        value_before, value = value, rim_acceleration(depth)
    if staggered and not start.standing:
        data.qvel[:] -= 0.5 * model.opt.timestep * data.qacc


def _rim_acceleration(data: mujoco.MjData, scene: Scene) -> float:
    """Second derivative of the height of the lowest point of the base [m/s^2]."""
    start: Start = scene.start
    rise = float(data.qacc[2])
    if start.standing:
        return rise
    b, h = scene.body.base_radius, scene.body.mass_centre_height
    axis = to_world(start.quaternion[None], np.array([[0.0, 0.0, 1.0]]))[0]
    angular = to_world(start.quaternion[None], np.asarray(data.qacc[3:6])[None])[0]
    rate = np.cross(start.angular_velocity, axis)
    curve = np.cross(angular, axis) + np.cross(start.angular_velocity, rate)
    # height = z - h cos(theta) - b sin(theta), with cos(theta) the third component of the axis
    sine, cosine = float(np.hypot(axis[0], axis[1])), float(axis[2])
    tilt_rate = -rate[2] / sine
    tilt_curve = -(curve[2] + cosine * tilt_rate**2) / sine
    return float(rise - h * curve[2] - b * (cosine * tilt_curve - sine * tilt_rate**2))


def to_world(quaternion: Array, vector: Array) -> Array:
    """Turn vectors (n, 3) from body to world axes by quaternions (n, 4), scalar first."""
    w, x, y, z = quaternion.T
    a, b, c = vector.T
    # v + w t + q x t with t = 2 q x v
    along_x, along_y, along_z = 2.0 * (y * c - z * b), 2.0 * (z * a - x * c), 2.0 * (x * b - y * a)
    turned = np.empty((3, len(vector)))
    turned[0] = a + w * along_x + (y * along_z - z * along_y)
    turned[1] = b + w * along_y + (z * along_x - x * along_z)
    turned[2] = c + w * along_z + (x * along_y - y * along_x)
    return turned.T
