"""An independent reference: rigid bodies in space by Newton and Euler, in vectors.

Nothing is shared with the package but the constants of the body. It touches the ground at the lowest
point of its rim, which does not slip, and a slab, if there is one, at the highest point of its top. What
follows for forces, moment of the recess and the accelerations of the Euler angles is the solution of one
linear system, in as many digits as the caller sets with mpmath.
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
    """What the vector equations give, per unit mass of a column."""

    theta: Any  # second derivatives
    phi: Any
    psi: Any
    force: Vector  # (3,) of the ground on the body, world axes
    moment: Any  # of the recess along z_world + z_body, at the base
    top: Vector  # (3,) of the body on the slab
    slab_turn: Vector  # (3,) angular acceleration of the slab


class Slab(NamedTuple):
    """A slab on columns that all have one motion, at a moment when it does not turn."""

    share: Any  # mass over that of the columns
    places: list[Vector]  # of the centres of their tops from its mass centre; [] if it cannot turn
    inertia: Any = 0  # about each axis through its mass centre, over the mass of a column


NO_SLAB = Slab(0, [])


def vector(*components: Any) -> Vector:
    return np.array([mp.mpf(component) for component in components], dtype=object)


def newton_euler(
    body: Body, state: State, ground: Vector, recess: bool, slab: Slab = NO_SLAB, eps: Any = 0
) -> Motion:
    """Solve for accelerations, contact forces and the moment of the recess of every body by itself.

    `body` is a column alone. Its top, the highest point of the rim, does not slip on the slab.
    """
    e_z, e_tilt, axis, radius = frame(state)
    frame_rate = (
        state.phi_rate * e_z + state.theta_rate * e_tilt
    )  # of the axes that do not spin with the body
    spin = frame_rate + state.psi_rate * axis
    arm = body.h * axis - body.b * radius  # from the contact point to the mass centre, and on to the top
    arm_rate = np.cross(frame_rate, arm)
    inertia = inertia_of(body, axis)
    units = list(np.array([[mp.mpf(j == k) for j in range(3)] for k in range(3)], dtype=object))
    rolling = spin - (spin @ e_z) * e_z

    # angular acceleration: what the rates give, and one column for theta'', phi'' and psi'' each
    spin_rate = np.cross(frame_rate, state.theta_rate * e_tilt + state.psi_rate * axis)
    columns = (e_tilt, e_z, axis)
    known_acceleration = np.cross(spin_rate, arm) + np.cross(spin, arm_rate)
    known_moment = inertia @ spin_rate + np.cross(spin, inertia @ spin)
    outward = vector(mp.cos(state.phi), mp.sin(state.phi), 0)
    tops = [place - body.b * outward for place in slab.places] or [vector(0, 0, 0)]
    mass = slab.share * len(tops)

    # unknowns of each column: theta'', phi'', psi'', forces at base and top on it (3 each), moment;
    # of the slab: acceleration and angular acceleration (3 each)
    size = 10 * len(tops) + 6
    matrix, right = mp.zeros(size, size), mp.zeros(size, 1)
    last = size - 6

    def add(row: int, column: int, value: Vector) -> None:
        for i in range(3):
            matrix[row + i, column] += value[i]

    for count, top in enumerate(tops):
        at = 10 * count
        for k, column in enumerate(columns):
            add(at, at + k, -np.cross(column, arm))
            add(at + 3, at + k, -(inertia @ column))
            add(at + 6, at + k, 2 * np.cross(column, arm))
        for k, unit in enumerate(units):
            # Newton: the mass centre turns about the contact point
            add(at, at + 3 + k, unit)
            add(at, at + 6 + k, unit)
            # Euler about the mass centre
            add(at + 3, at + 3 + k, -np.cross(arm, unit))
            add(at + 3, at + 6 + k, np.cross(arm, unit))
            # the top moves with the slab
            add(at + 6, last + k, -unit)
            add(at + 6, last + 3 + k, -np.cross(unit, top))
            # the slab, by Newton and by Euler
            add(last, at + 6 + k, -unit)
            add(last + 3, at + 6 + k, -np.cross(top, unit) if slab.places else 0 * unit)
        add(at + 3, at + 9, e_z + axis)
        # rolling resistance: delta times the upward force, against the horizontal part of the spin; the slab
        # presses on the top, and the top takes it along
        if body.delta:
            couple = body.delta * rolling / mp.sqrt(rolling @ rolling + eps**2)
            add(at + 3, at + 5, -couple)
            add(at + 3, at + 8, couple)
            add(last + 3, at + 8, -couple if slab.places else 0 * couple)
        for i in range(3):
            right[at + i] = (ground + body.g * e_z + known_acceleration)[i]
            right[at + 3 + i] = known_moment[i]
            right[at + 6 + i] = -2 * known_acceleration[i]
        if recess:  # psi'' = -phi''
            matrix[at + 9, at + 1] = matrix[at + 9, at + 2] = 1
        else:  # flat ground: no moment
            matrix[at + 9, at + 9] = 1
    for k, unit in enumerate(units):
        add(last, last + k, -mass * unit)
        add(last + 3, last + 3 + k, -(slab.inertia if slab.places else 1) * unit)
        right[last + k] = mass * (ground + body.g * e_z)[k]
    solution = mp.lu_solve(matrix, right)
    force, top_force = vector(*solution[3:6]), -vector(*solution[6:9])
    return Motion(*solution[:3], force, solution[9], top_force, vector(*solution[last + 3 :]))


def frame(state: State) -> tuple[Vector, Vector, Vector, Vector]:
    """Return the vertical, the axis of tilting, the axis of the body, and the direction from the base
    centre to the contact point: down as far as the base allows."""
    s, c = mp.sin(state.theta), mp.cos(state.theta)
    sp, cp = mp.sin(state.phi), mp.cos(state.phi)
    e_z, axis = vector(0, 0, 1), vector(s * cp, s * sp, c)
    return e_z, vector(-sp, cp, 0), axis, (c * axis - e_z) / s


def inertia_of(body: Body, axis: Vector) -> NDArray[Any]:
    return body.I1 * np.eye(3, dtype=int).astype(object) + (mp.mpf(body.I2) - body.I1) * np.outer(axis, axis)


def kinetic_energy(body: Body, state: State, share: Any = 0) -> Any:
    """Return the kinetic energy of a column and its share of the slab, over the mass of the column."""
    e_z, e_tilt, axis, radius = frame(state)
    spin = state.phi_rate * e_z + state.theta_rate * e_tilt + state.psi_rate * axis
    velocity = np.cross(spin, body.h * axis - body.b * radius)
    slab = 2 * velocity
    return (velocity @ velocity + share * slab @ slab + spin @ inertia_of(body, axis) @ spin) / 2
