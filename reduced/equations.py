"""Equations of motion of the planar, recess and flat models, in a form without cancellation near upright.

All are written per unit mass, with s = sin theta, c = cos theta, v = 1 - c = 2 sin^2(theta/2),
t = tan(theta/2) = v/s and

====== ======== =============================================================== ========
symbol unit     meaning                                                         source
====== ======== =============================================================== ========
theta  rad      tilt, angle of the axis from the vertical                       Fig. 2
omega  rad/s    theta'                                                          Fig. 2
phi    rad      rolling angle, azimuth of the contact point                     Fig. 2
L      m^2/s    B phi', momentum of the rolling angle (recess)                  (19)
Lambda m^2/s    B phi' - G tau', the same where the twist is free (flat)
tau    rad      twist phi + psi; 0 in the recess                                (14)
S      m^2/s    M tau', momentum of the twist (flat)
H      m^2      J + 2 E t + C t^2
B      m^2      s^2 H = J s^2 + 2 E s v + C v^2, inertia of the rolling angle   (19)
D      m        h s + b v, horizontal distance of the mass centre from O        (11)
a      m/s^2    ground acceleration; a_r along the contact azimuth, a_t across  (11)
====== ======== =============================================================== ========

Equation (18) reads A theta'' = B' phi'^2/2 - A p^2 [(1 + az/g) sin(alpha - theta) +
cos(alpha - theta) a_r/g], and (19) reads (B phi')' = -D a_t. The sums that (18) and (19) print for
B and B' cancel near theta = 0 and for squat cylinders; here every term of B is positive, and none
is a quotient.
"""

from __future__ import annotations

from ._compile import inlined, jit
from .body import Body
from .restoring import restoring, restoring_moment, stored_energy
from .trigonometry import sin_cos

_PLANE = 1e-13  # a few hundred roundings: what a rotation of a record leaves across its plane


@jit
def in_plane_below(body: Body, ax: float, ay: float) -> float:
    """Largest acceleration across a plane [m/s^2] that counts as rounding.

    Motion without spin in the plane of the ground acceleration stays there. Rounding across it would
    choose on which side such motion passes the upright position.
    """
    return _PLANE * (abs(ax) + abs(ay) + body.g * (body.sin_alpha / body.cos_alpha))


@inlined
def base_inertia(body: Body, t: float) -> float:
    """Return H [m^2]."""
    return body.J + (2.0 * body.E + body.C * t) * t


@jit
def planar_rhs(body: Body, theta: float, direction: float, a: float, az: float) -> float:
    """Return theta'' [rad/s^2] in one vertical plane: (21) with phi' = 0.

    `theta` is the unsigned tilt, `direction` +1 or -1 the side it leans to, `a` the ground
    acceleration along the plane [m/s^2].
    """
    s, c = sin_cos(theta)
    held = restoring(body, s, c, body.g + az)
    inertial = (body.cos_alpha * c + body.sin_alpha * s) * direction * a
    return -(body.p2 / body.g) * (held + inertial)


@jit
def recess_rhs(
    body: Body, theta: float, omega: float, phi: float, L: float, ax: float, ay: float, az: float
) -> tuple[float, float, float, float]:
    """Return (theta', theta'', phi', L') of the paper's model: (18) and (19)."""
    theta_acceleration, phi_rate, L_rate, _, _ = recess_motion(body, theta, phi, L, ax, ay, az)
    return omega, theta_acceleration, phi_rate, L_rate


@inlined
def recess_motion(
    body: Body, theta: float, phi: float, L: float, ax: float, ay: float, az: float
) -> tuple[float, float, float, float, float]:
    """Return theta'', phi', L' of the paper's model, and sine and cosine of theta."""
    s_half, c_half = sin_cos(0.5 * theta)
    s, v = 2.0 * s_half * c_half, 2.0 * s_half * s_half
    c = 1.0 - v
    B = body.J * s * s + (2.0 * body.E * s + body.C * v) * v
    half_B_theta = (body.J * c + body.C * v) * s + body.E * (c * v + s * s)
    # L = 0 is planar motion, also at theta = 0 where L/B is 0/0
    phi_rate = L / B if L != 0.0 else 0.0
    sin_phi, cos_phi = sin_cos(phi)
    a_r = ax * cos_phi + ay * sin_phi
    a_t = ay * cos_phi - ax * sin_phi
    if L == 0.0 and abs(a_t) <= in_plane_below(body, ax, ay):
        a_t = 0.0
    held = restoring(body, s, c, body.g + az)
    inertial = (body.cos_alpha * c + body.sin_alpha * s) * a_r
    # the two constants depend on nothing before, so the processor computes them meanwhile
    centrifugal = half_B_theta * (1.0 / body.A) * (phi_rate * phi_rate)
    theta_acceleration = centrifugal - (body.p2 / body.g) * (held + inertial)
    return theta_acceleration, phi_rate, -(body.h * s + body.b * v) * a_t, s, c


@jit
def flat_rhs(
    body: Body,
    theta: float,
    omega: float,
    phi: float,
    Lambda: float,
    tau: float,
    S: float,
    ax: float,
    ay: float,
    az: float,
) -> tuple[float, float, float, float, float, float]:
    """Return (theta', theta'', phi', Lambda', tau', S') of the cylinder that rolls without slip.

    No slip alone leaves the twist free: it is driven by N1 theta' Lambda and by the excitation
    across the contact azimuth. S = 0 throughout would be the recess model.
    """
    b, h, C, E, J = body.b, body.h, body.C, body.E, body.J
    s, c = sin_cos(theta)
    t = s / (1.0 + c)
    sec2 = 1.0 + t * t
    roll = E + C * t
    H = base_inertia(body, t)
    H_theta = roll * sec2
    delta = J * C - E * E
    M = delta / H
    sin_phi, cos_phi = sin_cos(phi)
    a_r = ax * cos_phi + ay * sin_phi
    a_t = ay * cos_phi - ax * sin_phi
    if Lambda == 0.0 and S == 0.0 and abs(a_t) <= in_plane_below(body, ax, ay):
        a_t = 0.0

    tau_rate = S / M
    L_over_B = Lambda / (s * s * H) if Lambda != 0.0 else 0.0
    roll_ratio = roll / (s * H) if S != 0.0 else 0.0  # G/B
    roll_ratio_theta = 0.0  # (G/B)'
    if S != 0.0:
        roll_ratio_theta = (0.5 * C * sec2 * s * H - roll * (c * H + s * H_theta)) / (s * s * H * H)

    centrifugal = L_over_B * L_over_B * s * (c * H + 0.5 * s * H_theta)
    twisting = -0.5 * delta * H_theta / (H * H) * tau_rate * tau_rate - roll_ratio_theta * Lambda * tau_rate
    held = restoring_moment(body, s, c, body.g + az)
    inertial = (b * s + h * c) * a_r
    theta_acceleration = (centrifugal + twisting - held - inertial) / body.A
    Lambda_rate = -body.mu * b * (b * s + h * c) * omega * tau_rate - s * (h + b * t) * a_t
    # the coupling vanishes without spin, also at theta = 0 where its coefficient is infinite
    coupling = twist_coupling(body, t, H) * omega * Lambda if Lambda != 0.0 else 0.0
    S_rate = coupling + (b * body.I1 - h * body.I2 * t) / H * a_t
    return omega, theta_acceleration, L_over_B + roll_ratio * tau_rate, Lambda_rate, tau_rate, S_rate


@jit
def twist_coupling(body: Body, t: float, H: float) -> float:
    """Return N1 [-], the coefficient of theta' Lambda in S'; it tends to infinity as 1/t at upright."""
    b, h, I1, I2, C, E = body.b, body.h, body.I1, body.I2, body.C, body.E
    polynomial = body.mu * b * b * I1 + t * (-2.0 * I2 * E + t * (C * (I1 - I2) + body.mu * I2 * h * h))
    return (1.0 + t * t) / (2.0 * t * H * H) * polynomial


@jit
def energy(body: Body, theta: float, omega: float, L: float, S: float) -> float:
    """Return the energy relative to the ground, zero standing upright, per unit mass [m^2/s^2].

    Equations (13), (15) and (17); S is 0 in the recess.
    """
    s, c = sin_cos(theta)
    t = s / (1.0 + c)
    H = base_inertia(body, t)
    spin = L * L / (2.0 * s * s * H) if L != 0.0 else 0.0
    twist = S * S * H / (2.0 * (body.J * body.C - body.E * body.E)) if S != 0.0 else 0.0
    return 0.5 * body.A * omega * omega + spin + twist + stored_energy(body, s, c, t)
