"""An integration of the same problem that shares nothing with the reduced models but constants of the body.

The state is that of a rigid body in space, its axis and its angular velocity, and the equations are those of
Newton and Euler in vectors. The base touches the ground at the lowest point of its rim, which does not slip;
in the recess a moment along z_world + z_body keeps the angular velocity across that direction, and a tendon
may pull the centre of the base to its place on the ground; inside the column its forces cancel. Pair of order
8 of Dormand and Prince. Uplift is at f >= 0, towards the inertia force.
"""

from __future__ import annotations

import math

import numba
import numpy as np
from numpy.typing import NDArray
from scipy.integrate._ivp import dop853_coefficients as pair

A, B, C = np.ascontiguousarray(pair.A[:12, :12]), np.array(pair.B), np.array(pair.C[:12])
E3, E5 = np.array(pair.E3), np.array(pair.E5)

Array = NDArray[np.float64]
jit = numba.njit(cache=True)  # all of them are in this file: what is kept is as old as the file


@jit
def cross(a: Array, b: Array) -> Array:
    return np.array([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]])


@jit
def arm_of(P: Array, n: Array) -> Array:
    """From the contact point to the mass centre."""
    s = math.sqrt(n[0] * n[0] + n[1] * n[1])
    return P[1] * n - P[0] * np.array([n[2] * n[0] / s, n[2] * n[1] / s, -s])


@jit
def lifted_base(P: Array, n: Array) -> Array:
    """From its place on the ground to the centre of the base, in the recess."""
    s = math.sqrt(n[0] * n[0] + n[1] * n[1])
    fall = s * s / (1.0 + n[2])
    return P[0] * np.array([fall * n[0] / s, fall * n[1] / s, s])


@jit
def rates(P: Array, y: Array, a: Array) -> Array:
    """Derivative of axis (3), angular velocity (3) and azimuth.

    P is b, h, I1, I2, g, 1 in the recess, prestress [m/s^2] and stiffness [1/s^2] of a tendon, and the
    factor of the gyroscopic term: 1, or 0 for a body that lacks it.
    """
    b, h, I1, I2, g, recess, prestress, stiffness, gyroscopic = P
    n, w = y[:3], y[3:6]
    turn = cross(w, n)
    s = math.sqrt(n[0] * n[0] + n[1] * n[1])
    ux, uy = n[0] / s, n[1] / s
    s_rate = ux * turn[0] + uy * turn[1]
    ux_rate, uy_rate = (turn[0] - ux * s_rate) / s, (turn[1] - uy * s_rate) / s
    radius_rate = np.array([turn[2] * ux + n[2] * ux_rate, turn[2] * uy + n[2] * uy_rate, -s_rate])
    arm = arm_of(P, n)
    force = cross(w, h * turn - b * radius_rate) + a  # without the angular acceleration
    force[2] += g
    momentum = I1 * w + (I2 - I1) * np.dot(w, n) * n
    right, matrix = np.zeros(4), np.zeros((4, 4))
    right[:3] = -gyroscopic * cross(w, momentum) - cross(arm, force)
    if prestress + stiffness > 0.0:
        base = lifted_base(P, n)
        length = math.sqrt(np.dot(base, base))
        right[:3] -= cross(arm - h * n, (prestress + stiffness * length) / length * base)
    matrix[3, 3] = 1.0
    for i in range(3):
        for j in range(3):
            matrix[i, j] = (I2 - I1) * n[i] * n[j] - arm[i] * arm[j]
        matrix[i, i] += I1 + np.dot(arm, arm)
    if recess > 0.0:
        matrix[3, 3] = 0.0
        for i in range(3):
            matrix[3, i] = n[i] + (i == 2)
            matrix[i, 3] = -matrix[3, i]
    out = np.empty(7)
    out[:3], out[3:6] = turn, np.linalg.solve(matrix, right)[:3]
    out[6] = (ux * turn[1] - uy * turn[0]) / s
    return out


@jit
def tilt_of(y: Array) -> tuple[float, float]:
    """Tilt and its rate."""
    s = math.sqrt(y[0] * y[0] + y[1] * y[1])
    turn = cross(y[3:6], y[:3])
    return math.atan2(s, y[2]), (y[0] * turn[0] + y[1] * turn[1]) / (s * y[2])


@jit
def energy(P: Array, y: Array) -> float:
    b, h, I1, I2, g, _, prestress, stiffness, _ = P
    n, w = y[:3], y[3:6]
    v = cross(w, arm_of(P, n))
    s = math.sqrt(n[0] * n[0] + n[1] * n[1])
    kinetic = np.dot(v, v) + I1 * np.dot(w, w) + (I2 - I1) * np.dot(w, n) ** 2
    length = b * s * math.sqrt(2.0 / (1.0 + n[2]))
    stored = g * (b * s - h * s * s / (1.0 + n[2])) + (prestress + 0.5 * stiffness * length) * length
    return 0.5 * kinetic + stored


@jit
def excess(P: Array, a: Array) -> float:
    return math.hypot(a[0], a[1]) - (P[4] + a[2] + P[6]) * P[0] / P[1]


@jit
def crossing(P: Array, a: Array, slope: Array, low: float, high: float) -> float:
    for _ in range(200):
        middle = 0.5 * (low + high)
        if excess(P, a + slope * middle) > 0.0:
            high = middle
        else:
            low = middle
    return low


@jit
def lifted(P: Array, p2: float, a: Array, slope: Array, time: float, last: float, jump: bool) -> Array:
    """The state so soon after an uplift that the direction need only be that of the inertia force."""
    size = math.hypot(a[0], a[1])
    factor = p2 * P[1] / math.hypot(P[0], P[1]) / P[4]
    F0 = factor * max(excess(P, a), 0.0) if jump else 0.0
    F1 = factor * ((a[0] * slope[0] + a[1] * slope[1]) / size - slope[2] * P[0] / P[1])
    tilt = time * time * (F0 / 2.0 + F1 * time / 6.0)
    rate = time * (F0 + F1 * time / 2.0)
    turning = (a[0] * slope[1] - a[1] * slope[0]) / (size * size)
    angle = math.atan2(-a[1] - slope[1] * time, -a[0] - slope[0] * time)
    angle += 2.0 * math.pi * round((last - angle) / (2.0 * math.pi))
    s, cos, sin = math.sin(tilt), math.cos(angle), math.sin(angle)
    fall = 2.0 * math.sin(0.5 * tilt) ** 2
    spin = np.array([-turning * s * cos - rate * sin, -turning * s * sin + rate * cos, turning * fall])
    return np.array([s * cos, s * sin, 1.0 - fall, spin[0], spin[1], spin[2], angle])


@jit
def step(P: Array, p: float, y: Array, h: float, a: Array, slope: Array, rtol: float) -> tuple[Array, float]:
    """New state, and the error over what is allowed."""
    k = np.empty((13, 7))
    for i in range(12):
        k[i] = rates(P, y + h * (A[i, :i] @ k[:i]) if i else y, a + slope * (C[i] * h))
    new = y + h * (B @ k[:12])
    k[12] = rates(P, new, a + slope * h)
    s = math.sqrt(y[0] * y[0] + y[1] * y[1])
    speed = math.sqrt(y[3] * y[3] + y[4] * y[4]) + p * math.sqrt(s)
    allowed = rtol * np.array([s, s, 1.0, speed, speed, speed, 1.0])
    fifth, third = E5 @ k / allowed, E3 @ k / allowed
    both = np.dot(fifth, fifth) + 0.01 * np.dot(third, third)
    level = new[0] * new[0] + new[1] * new[1]
    if level < 0.5:  # the axis stays a unit vector
        new[2] = math.sqrt(1.0 - level)
    return new, h * np.dot(fifth, fifth) / math.sqrt(7.0 * both)
