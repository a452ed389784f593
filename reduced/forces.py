"""Contact force and restraining moment of a solution of the reduced models.

The force follows from the acceleration of the mass centre; S is at the radius D - b + |contact| of
the contact azimuth, so its velocity across that azimuth is D phi' - b tau' and the terms that grow
without bound towards upright cancel exactly when collected, as they are here. In a frame they are those
at the base, with the load and the inertia of the share gamma m of the slab; that at the top follows.

====== ======== =============================================================== ========
symbol unit     meaning                                                         source
====== ======== =============================================================== ========
F_r    m/s^2    contact force on the cylinder along the contact azimuth, over   (11)
                the mass (1 + gamma) m that it carries
F_t    m/s^2    the same across it, counter-clockwise                           (11)
N      m/s^2    the same upwards                                                (11)
kappa  m^2/s^2  restraining moment along z_world + z_body, over the same
====== ======== =============================================================== ========
"""

from __future__ import annotations

from math import cos, sin

import numpy as np
from numpy.typing import NDArray

from ._compile import jit, kernel
from .body import Body
from .equations import base_inertia, energy, flat_rhs
from .restoring import TiedBody, tendon_pull
from .rolling import couple, twist_share

# columns of the table of derived quantities
ROLLING_RATE, ENERGY, FORCE_X, FORCE_Y, FORCE_Z, MOMENT = range(6)


@jit
def contact_force(
    body: Body,
    theta: float,
    omega: float,
    phi: float,
    Lambda: float,
    S: float,
    ax: float,
    ay: float,
    az: float,
    free_twist: bool,
) -> tuple[float, float, float, float]:
    """Return F_r, F_t, N and kappa of a state, for the flat-ground model or (S = 0) for the recess."""
    b, h, C, E, nu = body.b, body.h, body.C, body.E, body.nu
    rates = flat_rhs(body, theta, omega, phi, Lambda, 0.0, S, ax, ay, az)
    theta_acceleration, phi_rate, tau_rate, S_rate = rates[1], rates[2], rates[4], rates[5]
    s, c = sin(theta), cos(theta)
    turning = 0.0
    if body.delta > 0.0:
        spin = tau_rate - phi_rate
        tilting, turning, _ = couple(body, s, c, omega, spin, theta_acceleration, az)
        theta_acceleration += tilting / body.A
        S_rate += twist_share(body, s, c) * turning
    t = s / (1.0 + c)
    sec2 = 1.0 + t * t
    roll, reach = E + C * t, h + b * t
    H = base_inertia(body, t)
    H_theta = roll * sec2
    a_r = ax * cos(phi) + ay * sin(phi)
    a_t = ay * cos(phi) - ax * sin(phi)
    D, D_1, D_2 = s * reach, b * s + h * c, b * c - h * s

    kappa, tau_acceleration = 0.0, 0.0
    if free_twist:
        # S = M tau', M = (J C - E^2)/H
        tau_acceleration = (S_rate * H + S * H_theta * omega) / (body.J * C - E * E)
    else:
        kappa = -nu * S_rate / (1.0 + c)
    L_over_B = Lambda / (s * s * H) if Lambda != 0.0 else 0.0
    q = reach * roll / H
    q_1 = 0.5 * sec2 * (b * roll + C * reach) / H - q * H_theta / H
    outward = D_1 * theta_acceleration + D_2 * omega * omega - phi_rate * (D * phi_rate - b * tau_rate)
    across = (
        L_over_B * omega * (2.0 * b * t - D * H_theta / H)
        + omega * tau_rate * (0.5 * D_1 * body.I2 * sec2 / H + q_1)
        + (q - b) * tau_acceleration
    )
    up = D_2 * theta_acceleration - D_1 * omega * omega
    F_t = nu * across + a_t * (1.0 - nu * reach * reach / H)
    if body.delta > 0.0:
        F_t -= nu * reach / H * turning
    down, inward = tendon_pull(body, c)
    return nu * outward + a_r + inward, F_t, body.g + az + nu * up + down, kappa


def top_force(
    body: Body,
    base: NDArray[np.float64],
    ground: NDArray[np.float64],
    states: NDArray[np.float64],
    gamma: float,
) -> NDArray[np.float64]:
    """Return the contact force of a column on the slab, over the weight of its share of the slab.

    The slab has twice the acceleration of the mass centre, which is what the force at the base shows, less
    that of a tendon; the tendon pulls the slab as it pulls the base, in the opposite direction.

    Parameters
    ----------
    body : Body
    base : ndarray, shape (n, 3)
        Contact force at the base, over the weight that it carries [-].
    ground : ndarray, shape (n, 3)
        Ground acceleration [m/s^2].
    states : ndarray, shape (n, 6)
        As of `derived_quantities`.
    gamma : float
        Mass of the share of the slab over that of the column [-].

    Returns
    -------
    ndarray, shape (n, 3)
    """
    standing = ground / body.g + np.array([0.0, 0.0, 1.0])
    tendon = np.zeros_like(base)
    if isinstance(body, TiedBody):
        phi = states[:, 2]
        down, inward = np.array([tendon_pull(body, each) for each in np.cos(states[:, 0])]).T
        tendon = np.column_stack([inward * np.cos(phi), inward * np.sin(phi), down]) / body.g
    return np.asarray(standing + 2.0 / body.nu * (base - tendon - standing) + (1.0 + 1.0 / gamma) * tendon)


@kernel
def derived_quantities(
    body: Body, states: NDArray[np.float64], ground: NDArray[np.float64], free_twist: bool
) -> NDArray[np.float64]:
    """Return forces, energy and rolling rate of each state.

    Parameters
    ----------
    body : Body
    states : ndarray, shape (n, 6)
        theta, theta', phi, Lambda, tau, S; theta = 0 with no rates stands at rest.
    ground : ndarray, shape (n, 3)
        Ground acceleration [m/s^2].
    free_twist : bool
        Whether the model is that of flat ground.

    Returns
    -------
    ndarray, shape (n, 6)
        phi' [rad/s], energy per unit mass [m^2/s^2], contact force in world axes over the weight
        (3 columns) [-], restraining moment kappa over the weight [m].
    """
    out = np.zeros((len(states), 6))
    for i in range(len(states)):
        theta, omega, phi, Lambda, tau, S = states[i]
        ax, ay, az = ground[i]
        if theta == 0.0 and omega == 0.0:
            out[i, FORCE_X], out[i, FORCE_Y], out[i, FORCE_Z] = ax / body.g, ay / body.g, 1.0 + az / body.g
            out[i, FORCE_Z] += tendon_pull(body, 1.0)[0] / body.g
            continue
        out[i, ROLLING_RATE] = flat_rhs(body, theta, omega, phi, Lambda, tau, S, ax, ay, az)[2]
        out[i, ENERGY] = energy(body, theta, omega, Lambda, S)
        F_r, F_t, N, kappa = contact_force(body, theta, omega, phi, Lambda, S, ax, ay, az, free_twist)
        out[i, FORCE_X] = (F_r * cos(phi) - F_t * sin(phi)) / body.g
        out[i, FORCE_Y] = (F_r * sin(phi) + F_t * cos(phi)) / body.g
        out[i, FORCE_Z] = N / body.g
        out[i, MOMENT] = kappa / body.g
    return out
