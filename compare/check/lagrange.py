"""Lagrange's equations from the energies alone: the derivation that computed motions are compared with.

Nothing here is shared with `rockwobble.reduced`, and no equation of motion is written down. The
positions (8), (10) and the rotation (5), (6) with psi = -phi give the velocities; those give the
kinetic energy (13)-(15) and the potential energy (17) with the ground's acceleration in it. The
derivatives of the energies by tilt, rolling angle and their rates are complex steps, exact to rounding
(W. Squire and G. Trapp, SIAM Review 40 (1998) 110-112); those by time are taken along the motion.

A column of a frame has its share of the slab in both energies, which goes twice as far as its mass centre.

====== ======== =============================================================== ========
symbol unit     meaning                                                         source
====== ======== =============================================================== ========
b, h   m        base radius, height of the mass centre                          Fig. 1
I1, I2 m^2      transverse and axial inertia about the mass centre              (16)
r      m        mass centre relative to O                                       (8), (10)
slab   -        mass of the slab over that of the columns, 0 without one
T, V   m^2/s^2  kinetic and potential energy per unit mass; in a frame per unit (13)-(17)
                of the mass on which gravity works at r, 1 + 2 slab columns
====== ======== =============================================================== ========
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import factorial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rockwobble.models import Cylinder

Array = NDArray[Any]  # of float, or of complex within a complex step

REACH = 6  # samples on either side of a difference: order 12, which leaves (step/time scale)^12
_STEP = 1e-100  # of a complex step: no difference is taken, so none is too small
_ALONG = 1e-2  # [s] of the steps along a motion, where sines and cosines are all that changes


@dataclass(frozen=True, slots=True, kw_only=True)
class Shape:
    """Lengths and inertias of a cylinder or frame; symbols in the module docstring."""

    b: float
    h: float
    I1: float
    I2: float
    g: float
    slab: float


def shape_of(cylinder: Cylinder) -> Shape:
    """Return the constants of a cylinder, homogeneous where it has no inertias of its own: (16)."""
    b, h = cylinder.base_radius, cylinder.mass_centre_height
    I1, I2 = cylinder.transverse_inertia, cylinder.axial_inertia
    height = 2.0 * cylinder.half_height
    return Shape(
        b=b,
        h=h,
        I1=b * b / 4.0 + height * height / 12.0 if I1 is None else I1,
        I2=b * b / 2.0 if I2 is None else I2,
        g=9.81,
        slab=cylinder.slab_mass_ratio,
    )


def kinetic(shape: Shape, theta: Array, phi: Array, theta_rate: Array, phi_rate: Array) -> Array:
    """Return T per unit mass [m^2/s^2] of n states, (n,) each; equations (13)-(15)."""
    s, c, sp, cp = np.sin(theta), np.cos(theta), np.sin(phi), np.cos(phi)
    one, none = np.ones_like(s), np.zeros_like(s)
    turn = _matrix([[cp, -sp, none], [sp, cp, none], [none, none, one]])  # about z by phi
    tilt = _matrix([[c, none, s], [none, one, none], [-s, none, c]])  # about y by theta
    rotation = turn @ tilt @ np.swapaxes(turn, -1, -2)  # psi = -phi
    about_z = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 0.0]])
    about_y = np.array([[0.0, 0.0, 1.0], [0.0, 0.0, 0.0], [-1.0, 0.0, 0.0]])
    rate, spin = theta_rate[..., None, None], phi_rate[..., None, None]
    rotation_rate = (
        spin * (about_z @ rotation)
        + rate * (turn @ tilt @ about_y @ np.swapaxes(turn, -1, -2))
        - spin * (rotation @ about_z)
    )
    skew = np.swapaxes(rotation, -1, -2) @ rotation_rate  # angular velocity in body axes
    spin_x, spin_y, spin_z = skew[..., 2, 1], skew[..., 0, 2], skew[..., 1, 0]
    base_rate = shape.b * np.stack(
        [
            theta_rate * s * cp - phi_rate * (1.0 - c) * sp,
            theta_rate * s * sp + phi_rate * (1.0 - c) * cp,
            theta_rate * c,
        ],
        axis=-1,
    )
    velocity = base_rate + shape.h * rotation_rate[..., :, 2]
    of_slab = 2.0 * velocity
    twice: Array = (
        (velocity * velocity + shape.slab * of_slab * of_slab).sum(axis=-1)
        + shape.I1 * (spin_x * spin_x + spin_y * spin_y)
        + shape.I2 * spin_z * spin_z
    )
    return 0.5 / (1.0 + 2.0 * shape.slab) * twice


def mass_centre(shape: Shape, theta: Array, phi: Array) -> Array:
    """Return the mass centre relative to O (n, 3) [m]; equations (8), (10)."""
    s, c = np.sin(theta), np.cos(theta)
    out = shape.b * (1.0 - c) + shape.h * s
    return np.stack([out * np.cos(phi), out * np.sin(phi), shape.b * s + shape.h * c], axis=-1)


def potential(shape: Shape, theta: Array, phi: Array, ground: Array) -> Array:
    """Return V per unit mass, zero standing, with the inertia of the ground's acceleration (n, 3)."""
    pull = ground + np.array([0.0, 0.0, shape.g])
    standing = np.array([0.0, 0.0, shape.h])
    found: Array = ((mass_centre(shape, theta, phi) - standing) * pull).sum(axis=-1)
    return found


def energy(shape: Shape, theta: Array, phi: Array, theta_rate: Array, phi_rate: Array) -> Array:
    """Return T + V over still ground (n,) [m^2/s^2]."""
    still = np.zeros((*np.shape(theta), 3))
    found = kinetic(shape, theta, phi, theta_rate, phi_rate) + potential(shape, theta, phi, still)
    return np.asarray(found, dtype=float)


def momenta(
    shape: Shape, theta: Array, phi: Array, theta_rate: Array, phi_rate: Array
) -> tuple[Array, Array]:
    """Return dT/dtheta' and dT/dphi' (n,) [m^2/s]; the second is L of (19)."""
    step = 1j * _STEP
    by_tilt = kinetic(shape, theta + 0j, phi + 0j, theta_rate + step, phi_rate + 0j).imag / _STEP
    by_turn = kinetic(shape, theta + 0j, phi + 0j, theta_rate + 0j, phi_rate + step).imag / _STEP
    return by_tilt, by_turn


def forces(
    shape: Shape, theta: Array, phi: Array, theta_rate: Array, phi_rate: Array, ground: Array
) -> tuple[Array, Array]:
    """Return d(T - V)/dtheta and d(T - V)/dphi (n,) [m^2/s^2]."""

    def by(tilt_step: complex, turn_step: complex) -> Array:
        tilt, turn = theta + tilt_step, phi + turn_step
        rates = (theta_rate + 0j, phi_rate + 0j)
        found = kinetic(shape, tilt, turn, *rates) - potential(shape, tilt, turn, ground)
        return np.asarray(found.imag / _STEP)

    return by(1j * _STEP, 0j), by(0j, 1j * _STEP)


def residuals(
    shape: Shape,
    place: tuple[Array, Array],
    rates: tuple[Array, Array],
    curves: tuple[Array, Array],
    ground: Array,
) -> tuple[Array, Array]:
    """Return the residuals of Lagrange's equations (12) for tilt and rolling angle (n,) [m^2/s^2].

    `place`, `rates` and `curves` are tilt and rolling angle (n,), their rates and their second derivatives;
    `ground` (n, 3) is the acceleration of the ground.
    """
    # the momenta along the parabola that has this place, these rates and these curves
    time = (np.arange(2 * REACH + 1) - REACH)[:, None] * _ALONG
    tilt, turn = (x + v * time + 0.5 * w * time**2 for x, v, w in zip(place, rates, curves, strict=True))
    tilt_rate, turn_rate = (v + w * time for v, w in zip(rates, curves, strict=True))
    found = momenta(shape, tilt, turn, tilt_rate, turn_rate)
    needed = forces(shape, *place, *rates, ground)
    by_tilt, by_turn = (
        rate(momentum, _ALONG)[0] - force for momentum, force in zip(found, needed, strict=True)
    )
    return by_tilt, by_turn


def rate(values: Array, step: float) -> Array:
    """Return the rate (n - 2 REACH, ...) of samples (n, ...) that are `step` [s] apart."""
    weights = [_weight(k) / k for k in range(1, REACH + 1)]
    pairs = (weight * (_shifted(values, k) - _shifted(values, -k)) for k, weight in enumerate(weights, 1))
    return np.asarray(sum(pairs) / step)


def curve(values: Array, step: float) -> Array:
    """Return the second derivative (n - 2 REACH, ...) of samples (n, ...)."""
    centre = _shifted(values, 0)
    pairs = (
        2.0 * _weight(k) / k**2 * ((_shifted(values, k) - centre) + (_shifted(values, -k) - centre))
        for k in range(1, REACH + 1)
    )
    return np.asarray(sum(pairs) / step**2)


def _weight(k: int) -> float:
    return float((-1) ** (k + 1) * factorial(REACH) ** 2 / (factorial(REACH - k) * factorial(REACH + k)))


def _shifted(values: Array, by: int) -> Array:
    return values[REACH + by : len(values) - REACH + by]


def slope(function: Callable[[Array], Array], at: float) -> float:
    """Return the derivative of a function of one angle, by a complex step."""
    return float(function(np.array([at + 1j * _STEP])).imag[0] / _STEP)


def _matrix(rows: list[list[Array]]) -> Array:
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)
