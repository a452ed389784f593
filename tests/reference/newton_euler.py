"""An independent reference: the rigid body in space by Newton and Euler, in vectors.

Nothing is shared with the package but the constants of the body. The body touches the ground at the
lowest point of its rim, which does not slip; what follows for force, moment of the recess and the
accelerations of the Euler angles is the solution of one linear system, in as many digits as the
caller sets with mpmath.
"""

from typing import Any, NamedTuple

import mpmath as mp
import numpy as np
from numpy.typing import NDArray

from rockwobble.reduced.body import Body

Vector = NDArray[Any]  # (3,) of mpf


class State(NamedTuple):
    """Euler angles 3-2-3 and rates; psi does not matter to a body of revolution."""

    theta: Any
    theta_rate: Any
    phi: Any
    phi_rate: Any
    psi_rate: Any


class Motion(NamedTuple):
    """What the vector equations give, per unit mass."""

    theta: Any  # second derivatives
    phi: Any
    psi: Any
    force: Vector  # (3,) of the ground on the body, world axes
    moment: Any  # of the recess along z_world + z_body


def vector(*components: Any) -> Vector:
    return np.array([mp.mpf(component) for component in components], dtype=object)


def newton_euler(body: Body, state: State, ground: Vector, recess: bool) -> Motion:
    """Solve for the accelerations, the contact force and the moment of the recess."""
    e_z, e_tilt, axis, radius = frame(state)
    frame_rate = (
        state.phi_rate * e_z + state.theta_rate * e_tilt
    )  # of the axes that do not spin with the body
    spin = frame_rate + state.psi_rate * axis
    arm = body.h * axis - body.b * radius  # from the contact point to the mass centre
    arm_rate = np.cross(frame_rate, arm)
    inertia = inertia_of(body, axis)
    rolling = spin - (spin @ e_z) * e_z

    # angular acceleration: what the rates give, and one column for theta'', phi'' and psi'' each
    spin_rate = np.cross(frame_rate, state.theta_rate * e_tilt + state.psi_rate * axis)
    columns = (e_tilt, e_z, axis)

    # unknowns theta'', phi'', psi'', three components of the force, moment
    matrix, right = mp.zeros(7, 7), mp.zeros(7, 1)
    # Newton: force = ground + gravity + d(spin x arm)/dt, the mass centre turning about the contact point
    known_force = ground + body.g * e_z + np.cross(spin_rate, arm) + np.cross(spin, arm_rate)
    # Euler about the mass centre: -arm x force + moment (e_z + axis) = d(inertia spin)/dt
    known_moment = inertia @ spin_rate + np.cross(spin, inertia @ spin)
    for i in range(3):
        for k, column in enumerate(columns):
            matrix[i, k] = -np.cross(column, arm)[i]
            matrix[3 + i, k] = -(inertia @ column)[i]
        for k in range(3):
            unit = np.array([mp.mpf(k == j) for j in range(3)], dtype=object)
            matrix[i, 3 + k] = unit[i]
            matrix[3 + i, 3 + k] = -np.cross(arm, unit)[i]
        matrix[3 + i, 6] = (e_z + axis)[i]
        # rolling resistance: delta times the upward force, against the horizontal part of the spin
        if body.delta:
            matrix[3 + i, 5] -= body.delta * rolling[i] / mp.sqrt(rolling @ rolling)
        right[i], right[3 + i] = known_force[i], known_moment[i]
    if recess:  # psi'' = -phi''
        matrix[6, 1] = matrix[6, 2] = 1
    else:  # flat ground: no moment
        matrix[6, 6] = 1
    solution = mp.lu_solve(matrix, right)
    return Motion(solution[0], solution[1], solution[2], vector(*solution[3:6]), solution[6])


def frame(state: State) -> tuple[Vector, Vector, Vector, Vector]:
    """Return the vertical, the axis of tilting, the axis of the body, and the direction from the base
    centre to the contact point: down as far as the base allows."""
    s, c = mp.sin(state.theta), mp.cos(state.theta)
    sp, cp = mp.sin(state.phi), mp.cos(state.phi)
    e_z, axis = vector(0, 0, 1), vector(s * cp, s * sp, c)
    return e_z, vector(-sp, cp, 0), axis, (c * axis - e_z) / s


def inertia_of(body: Body, axis: Vector) -> NDArray[Any]:
    return body.I1 * np.eye(3, dtype=int).astype(object) + (mp.mpf(body.I2) - body.I1) * np.outer(axis, axis)


def kinetic_energy(body: Body, state: State) -> Any:
    e_z, e_tilt, axis, radius = frame(state)
    spin = state.phi_rate * e_z + state.theta_rate * e_tilt + state.psi_rate * axis
    velocity = np.cross(spin, body.h * axis - body.b * radius)
    return (velocity @ velocity + spin @ inertia_of(body, axis) @ spin) / 2
