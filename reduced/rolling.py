"""Rolling resistance: a couple of at most delta N against the rolling of the rim.

The couple M on the body is horizontal and acts against the horizontal part of its angular velocity, which
is theta' across the lean and s psi' along it (the axis leans by theta, and phi' is vertical):

    M = -delta N (theta', s psi')/w,   w = sqrt(theta'^2 + s^2 psi'^2 + eps^2),

so its power is -delta N w. By the velocities that no slip leaves free, theta', phi' and tau' = phi' + psi',
it is the generalised force

    Q_theta = -delta N theta'/w,   Q_tau = -delta N s^2 psi'/w = -Q_phi.

In the recess tau' = 0 and psi' = -phi'. On flat ground Lambda' has Q_phi and S' has Q_tau + (G/B) Q_phi.
The normal force is that of the same motion, N = load + mu lift theta'', and theta'' has Q_theta/A: both
follow from one linear equation. In a frame the rim of the top rolls on the slab at the same angular velocity,
so N is the sum of the forces on base and top.

The law itself is that of eps = 0, a set of couples where nothing moves. The small rate eps makes it one
couple of the state: a tilted body that the couple would hold creeps by less than eps t, and a motion that
turns or uplifts has another speed by about eps.

========= ======== ============================================================
symbol    unit     meaning
========= ======== ============================================================
delta     m        length of rolling resistance
N         m/s^2    normal force on the base, and on the top of a column; over m, in a frame w m
load      m/s^2    its part without theta'', g + az - mu D' theta'^2, and of a tendon q u + k s
                   (`restoring`)
lift      m        z'' of the mass centre for each theta'', D'' = b c - h s
w         rad/s    horizontal part of the angular velocity
eps       rad/s    rate far below which the couple vanishes, `CREEP` p
========= ======== ============================================================
"""

from __future__ import annotations

from math import cos, sin, sqrt

from ._compile import inlined
from .body import Body
from .equations import base_inertia
from .restoring import tendon_couple

CREEP = 1e-6  # eps over p: errors of 1e-6 alpha, and explicit steps that a creeping body still allows
# tilt over alpha below which eps falls with it, so that the couple acts on an uplift, whose first rates are
# below eps; and the share of eps at upright
_SMALL, _LEAST = 1e-6, 1e-6


@inlined
def creep_rate(body: Body, s: float) -> float:
    """Return eps [rad/s]."""
    return CREEP * body.p * max(_LEAST, min(1.0, s / (_SMALL * body.alpha)))


@inlined
def couple(
    body: Body, s: float, c: float, omega: float, spin: float, free: float, az: float
) -> tuple[float, float, float]:
    """Return the couple of a motion and the power that it takes, per unit mass.

    Parameters
    ----------
    body : Body
    s, c : float
        Sine and cosine of the tilt.
    omega, spin : float
        theta' and psi' [rad/s].
    free : float
        theta'' without the couple [rad/s^2].
    az : float
        [m/s^2]

    Returns
    -------
    tuple of float
        Components on theta and along the lean (on psi it is s times that) [m^2/s^2], power [m^2/s^3].
    """
    across, least = s * spin, creep_rate(body, s)
    load = body.g + az + tendon_couple(body, 1.0, s, sqrt(0.5 * (1.0 + c)))
    load -= (body.b * s + body.h * c) * omega * (body.mu * omega)
    lift = body.b * c - body.h * s
    # delta N/w of theta'' = free - delta N theta'/(A w), by one division; none where contact is lost
    pressed = body.delta * body.A * max(0.0, load + lift * (body.mu * free))
    w = sqrt(omega * omega + across * across + least * least)
    per_speed = pressed / (body.A * w + body.delta * lift * (body.mu * omega))
    return -per_speed * omega, -per_speed * across, per_speed * (omega * omega + across * across)


@inlined
def twist_share(body: Body, s: float, c: float) -> float:
    """Factor s (1 - G/B) in S' of a couple along the tilt vector."""
    t = s / (1.0 + c)
    return s - (body.E + body.C * t) / base_inertia(body, t)


@inlined
def rolling_momentum(body: Body, theta: float, Lambda: float, S: float) -> float:
    """Momentum B phi' = Lambda + G tau' [m^2/s]."""
    s, c = sin(theta), cos(theta)
    t = s / (1.0 + c)
    H = base_inertia(body, t)
    return Lambda + s * (body.E + body.C * t) * H / (body.J * body.C - body.E * body.E) * S


def impact_ratio(body: Body, restitution: float) -> float:
    """Return the ratio of tilt rates at an impact of planar motion with rolling resistance.

    The vertical impulse on the base, and on the top of a column, is n = mu b (omega + omega') per unit mass,
    and the couple takes delta n of the moment of momentum: A omega' = r A omega - delta n, r being the ratio
    without it. To first order r of Housner is the ratio of delta = b without impact.

    Parameters
    ----------
    body : Body
    restitution : float
        r [-].

    Returns
    -------
    float
        omega'/omega [-], not negative.
    """
    taken = body.delta * body.mu * body.b
    return max(0.0, (body.A * restitution - taken) / (body.A + taken))
