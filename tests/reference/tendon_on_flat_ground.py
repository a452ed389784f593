"""A column with a tendon that rolls on flat ground, alone or under a slab, by Newton and Euler.

The lowest point of the rim is at rest; the force of the ground, a multiplier, keeps it so. The slab has twice
the velocity of the mass centre, so by d'Alembert its forces count twice there. The tendon pulls at places in
space: at the centre of the base, and as much at the slab.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp
from tendon import Pier

Array = NDArray[np.float64]
_UP = np.array([0.0, 0.0, 1.0])


def _cross(vector: Array) -> Array:
    x, y, z = vector
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])


def _lowest(axis: Array) -> Array:
    """Direction from the centre of the base to its lowest point."""
    downwards = axis[2] * axis - _UP
    return np.asarray(downwards / np.linalg.norm(downwards))


def _rates(pier: Pier, y: Array) -> Array:
    """Rates of mass centre, rotation matrix, velocity and angular velocity."""
    centre, turn, velocity, w = y[:3], y[3:12].reshape(3, 3), y[12:15], y[15:]
    axis = turn[:, 2]
    axis_rate = np.cross(w, axis)
    out = _lowest(axis)
    sine = np.sqrt(1.0 - axis[2] ** 2)
    out_rate = (axis_rate * axis[2] + axis * axis_rate[2] + out * axis[2] * axis_rate[2] / sine) / sine
    arm = pier.b * out - pier.h * axis  # from the mass centre to the lowest point
    arm_rate = pier.b * out_rate - pier.h * axis_rate
    base = centre - pier.h * axis
    gaps, stretch = (2, 2.0 * np.linalg.norm(base)) if pier.slab else (1, np.linalg.norm(base))
    pull = -(pier.prestress + pier.stiffness * stretch) * base / np.linalg.norm(base)
    force = -(1.0 + 2.0 * pier.slab) * pier.g * _UP + (2.0 * pull if pier.slab else pull)
    # under a slab its pulls on both ends of the column cancel, and that on the slab counts twice
    torque = gaps * np.cross(-pier.h * axis, pull)
    transverse, axial = (3.0 * pier.b**2 + 4.0 * pier.h**2) / 12.0, 0.5 * pier.b**2
    inertia = transverse * np.eye(3) + (axial - transverse) * np.outer(axis, axis)
    system, right = np.zeros((9, 9)), np.zeros(9)
    system[:3, :3], system[:3, 6:] = (1.0 + 4.0 * pier.slab) * np.eye(3), -np.eye(3)
    system[3:6, 3:6], system[3:6, 6:] = inertia, -_cross(arm)
    system[6:, :3], system[6:, 3:6] = np.eye(3), -_cross(arm)
    right[:3], right[3:6], right[6:] = force, torque - np.cross(w, inertia @ w), -np.cross(w, arm_rate)
    solved = np.linalg.solve(system, right)
    return np.concatenate([velocity, (_cross(w) @ turn).ravel(), solved[:6]])


def rolled(pier: Pier, tilt: float, spin: float, times: Array) -> tuple[Array, Array]:
    """Return tilt and distance of the base centre from O, each (n,), after a release without twist."""
    c, s = np.cos(tilt), np.sin(tilt)
    turn = np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])
    axis = turn[:, 2]
    contact = np.array([pier.b, 0.0, 0.0])
    centre = contact - pier.b * _lowest(axis) + pier.h * axis
    w = spin * (_UP - axis)
    start = np.concatenate([centre, turn.ravel(), np.cross(w, centre - contact), w])
    solution = solve_ivp(
        lambda _, y: _rates(pier, y), (0.0, times[-1]), start, "DOP853", times, rtol=1e-11, atol=1e-12
    )
    axes = solution.y[3:12].reshape(3, 3, -1)[:, 2]
    base = solution.y[:3] - pier.h * axes
    return np.arctan2(np.hypot(axes[0], axes[1]), axes[2]), np.linalg.norm(base, axis=0)
