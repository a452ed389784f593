"""Exact solutions of free motion by quadrature, from the energies of `lagrange` alone.

Free motion of the recess model conserves its energy e and L = B phi', so that

    A theta'^2 = 2 (e - V) - L^2/B,    phi' = L/B,

and the time and the turn from one turning tilt to the other are integrals over the tilt. With
theta = mid - half cos(u) the roots at both ends cancel, and Gauss-Legendre nodes give 12 digits for
spins that are not small.
"""

from __future__ import annotations

import math

import numpy as np

from ..bench import Array
from .lagrange import Shape, kinetic, potential

_NODES = 64  # more of them come nearer to the ends, where rounding of the energies counts
_BISECTIONS = 200


def tilt_inertia(shape: Shape) -> float:
    """Return A, twice the kinetic energy of a unit tilt rate [m^2]."""
    return float(2.0 * kinetic(shape, *_at(0.3), np.array([1.0]), np.array([0.0]))[0])


def turn_inertia(shape: Shape, tilt: Array) -> Array:
    """Return B (n,) of tilts (n,), twice the kinetic energy of a unit rolling rate [m^2]."""
    none = np.zeros_like(tilt)
    return np.asarray(2.0 * kinetic(shape, tilt, none, none, np.ones_like(tilt)), dtype=float)


def cone_inertia(shape: Shape) -> float:
    """Return J of B = J theta^2 near upright [m^2]."""
    small = 1e-4
    near, double = turn_inertia(shape, np.array([small, 2.0 * small]))
    # the next term is one of theta^3: extrapolated
    return float(2.0 * near - 0.25 * double) / small**2


def height_energy(shape: Shape, tilt: Array) -> Array:
    """Return V (n,) of tilts (n,) over still ground [m^2/s^2]."""
    still = np.zeros((len(tilt), 3))
    return np.asarray(potential(shape, tilt, np.zeros_like(tilt), still), dtype=float)


def period_and_turn(shape: Shape, tilt: float, spin: float) -> tuple[float, float]:
    """Return time [s] and turn [rad] between two tilt maxima, released at `tilt` with `spin` [rad/s]."""
    top = np.array([tilt])
    L = float(turn_inertia(shape, top)[0]) * spin
    e = float(height_energy(shape, top)[0]) + 0.5 * L * spin

    def excess(theta: Array) -> Array:
        return np.asarray(2.0 * (e - height_energy(shape, theta)) - L * L / turn_inertia(shape, theta))

    low, high = 1e-12, 0.5 * tilt
    for _ in range(_BISECTIONS):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if excess(np.array([middle]))[0] < 0.0 else (low, middle)
    lowest = 0.5 * (low + high)
    nodes, weights = np.polynomial.legendre.leggauss(_NODES)
    u = 0.5 * math.pi * (nodes + 1.0)
    theta = lowest + (tilt - lowest) * np.sin(0.5 * u) ** 2
    factor = np.sqrt(tilt_inertia(shape) / excess(theta)) * 0.5 * (tilt - lowest) * np.sin(u)
    scale = 2.0 * 0.5 * math.pi  # there and back
    time = scale * float((weights * factor).sum())
    turn = scale * float((weights * factor * L / turn_inertia(shape, theta)).sum())
    return time, turn


def planar_quarter(shape: Shape, tilt: float) -> float:
    """Return the time of planar rocking from rest at `tilt` to the upright position [s]."""
    nodes, weights = np.polynomial.legendre.leggauss(_NODES)
    x = 0.5 * (nodes + 1.0)
    theta = tilt * (1.0 - x * x)
    drop = height_energy(shape, np.array([tilt])) - height_energy(shape, theta)
    speed = np.sqrt(2.0 * drop / tilt_inertia(shape))
    return float((0.5 * weights * 2.0 * tilt * x / speed).sum())


def steady_rate(shape: Shape, tilt: float) -> float:
    """Return the rolling rate at which the tilt stays [rad/s]: V' = B'/2 of its square."""
    step = 1e-100
    at = np.array([tilt + 1j * step])
    none, still = np.array([0j]), np.zeros((1, 3))
    by_height = potential(shape, at, none, still).imag / step
    by_inertia = 2.0 * kinetic(shape, at, none, none, none + 1.0).imag / step
    return float(np.sqrt(2.0 * by_height / by_inertia)[0])


def _at(tilt: float) -> tuple[Array, Array]:
    return np.array([tilt]), np.array([0.0])
