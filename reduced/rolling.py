"""Rolling resistance: a couple of at most delta N against the rolling of the rim.

The couple M on the body is horizontal and acts against the horizontal part of its angular velocity, which
is theta' across the lean and s psi' along it (the axis leans by theta, and phi' is vertical):

    M = -delta N (theta', s psi')/w,   w = sqrt(theta'^2 + s^2 psi'^2),

so its power is -delta N w. By the velocities that no slip leaves free, theta', phi' and tau' = phi' + psi',
it is the generalised force

    Q_theta = -delta N theta'/w,   Q_tau = -delta N s^2 psi'/w = -Q_phi.

In the recess tau' = 0 and psi' = -phi'. On flat ground Lambda' has Q_phi and S' has Q_tau + (G/B) Q_phi.
The normal force is that of the same motion, N = load + mu lift theta'', and theta'' has Q_theta/A: both
follow from one linear equation. In a frame the rim of the top rolls on the slab at the same angular velocity,
so N is the sum of the forces on base and top. Where w = 0 the couple is what holds the body, if delta N
suffices: standing still N = g + az, theta'' = 0 and L' = 0 need

    M_theta = (g + az) D'' + D' a_r,   M_psi = -(D/s) a_t,   |M| <= delta (g + az).

On flat ground no couple of rolling keeps the body from turning about the vertical through its contact. What
neither tilts nor rolls pivots there at the rate Omega = phi' = tau', and with the mass centre beside that
vertical by D'' and above the ground by D' Euler's equations of this rotation are

    I_v Omega' = D'' a_t,  M_theta = (g + az) D'' + D' a_r - P Omega^2,  M_psi = -(D' + P D''/I_v) a_t,
    I_v = I1 s^2 + I2 c^2 + mu D''^2,   P = (I1 - I2) s c - mu D' D''.

========= ======== ============================================================
symbol    unit     meaning
========= ======== ============================================================
delta     m        length of rolling resistance
N         m/s^2    normal force on the base, and on the top of a column; over m, in a frame w m
load      m/s^2    its part without theta'', g + az - mu D' theta'^2, and of a tendon q u + k s
                   (`restoring`), which also adds b (q u + k s) to M_theta
lift      m        z'' of the mass centre for each theta'', D'' = b c - h s
w         rad/s    horizontal part of the angular velocity
side      -        sign of the tilt rate, of motion in one plane
Omega     rad/s    rate at which a body pivots on its contact: `pivoting`
I_v, P    m^2      moment and product of inertia about the contact, of that
========= ======== ============================================================
"""

from __future__ import annotations

from math import copysign, cos, exp, inf, log, pi, sin, sqrt

from ._compile import inlined, jit
from .body import Body
from .equations import base_inertia, in_plane_below
from .restoring import with_tendon_load, with_tendon_moment

Vector = tuple[float, float, float]

# side of a body that neither tilts nor rolls, but pivots (`integration.resisted`)
PIVOTS = 2.0
# of 1/p: a hold that ends so soon is over. By rounding the end of one would be followed by another
_HAIR = 1e-9
# of the integrals over a pass, even; they converge as those of a smooth function do
_PARTS = 400
# of tau': what is left of psi' = tau' - phi' where both are the same
_ROUNDING = 1e-12


@inlined
def normal_force(body: Body, s: float, c: float, omega: float, az: float) -> tuple[float, float]:
    """Return load [m/s^2] and lift [m] of the normal force N = load + mu lift theta''."""
    load = with_tendon_load(body, body.g + az, s, c) - (body.b * s + body.h * c) * omega * (body.mu * omega)
    return load, body.b * c - body.h * s


@inlined
def couple(
    body: Body, s: float, c: float, omega: float, spin: float, free: float, az: float, side: float
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
    side : float
        Takes the place of theta'/w where psi' is 0, unless it is 0: in one plane the couple jumps where the
        tilt turns, and a step goes on smoothly beyond it to find where that is.

    Returns
    -------
    tuple of float
        Components on theta and along the lean (on psi it is s times that) [m^2/s^2], power [m^2/s^3].
    """
    across = s * spin
    load, lift = normal_force(body, s, c, omega, az)
    # delta N/w of theta'' = free - delta N theta'/(A w), by one division; none where contact is lost. mu = 1
    # times a rate leaves every sum of a cylinder as it rounds, which times a difference it does not
    pressed = body.delta * body.A * max(0.0, load + lift * (body.mu * free))
    if across != 0.0:
        speed = sqrt(omega * omega + across * across)
        per_speed = pressed / (body.A * speed + body.delta * lift * (body.mu * omega))
        return -per_speed * omega, -per_speed * across, per_speed * speed * speed
    tilting = side if side != 0.0 or omega == 0.0 else copysign(1.0, omega)
    largest = pressed / (body.A + body.delta * lift * (body.mu * tilting))
    return -largest * tilting, 0.0, largest * tilting * omega


@inlined
def twist_share(body: Body, s: float, c: float) -> float:
    """Return s (1 - G/B), the part that a couple along the lean has in S'."""
    t = s / (1.0 + c)
    return s - (body.E + body.C * t) / base_inertia(body, t)


@inlined
def pivot(body: Body, s: float, c: float) -> tuple[float, float]:
    """Return I_v and P [m^2]."""
    beside, above = body.b * c - body.h * s, body.b * s + body.h * c
    difference = (body.I1 - body.I2) * s * c
    moved = body.mu * beside
    return body.I1 * s * s + body.I2 * c * c + moved * beside, difference - moved * above


@inlined
def across_rate(body: Body, s: float, c: float, Lambda: float, S: float) -> float:
    """Return s psi' [rad/s]."""
    t = s / (1.0 + c)
    H = base_inertia(body, t)
    twist_rate = S * H / (body.J * body.C - body.E * body.E)
    return twist_share(body, s, c) * twist_rate - Lambda / (s * H)


@inlined
def across_inertia(body: Body, s: float, c: float, pivots: bool) -> float:
    """Return the inertia of s psi' [m^2], of what pivots beside that as it did."""
    if pivots:
        return (body.J * body.C - body.E * body.E) / pivot(body, s, c)[0]
    return base_inertia(body, s / (1.0 + c))


@inlined
def rolling_momentum(body: Body, theta: float, Lambda: float, S: float) -> float:
    """Return B phi' [m^2/s], Lambda and what the twist rate takes off it."""
    s, c = sin(theta), cos(theta)
    t = s / (1.0 + c)
    H = base_inertia(body, t)
    return Lambda + s * (body.E + body.C * t) * H / (body.J * body.C - body.E * body.E) * S


@inlined
def pivoting_rate(body: Body, s: float, c: float, Lambda: float, S: float) -> float:
    """Return Omega [rad/s] of the moment of momentum about the vertical through the contact.

    The couple is horizontal and does not change it: S + (1 - G/B) Lambda.
    """
    return (S + twist_share(body, s, c) / s * Lambda) / pivot(body, s, c)[0]


@jit
def momenta_of(body: Body, s: float, c: float, pivoting: float, across: float) -> tuple[float, float]:
    """Return Lambda and S [m^2/s] for the moment of momentum of `pivoting` and the rate `across`, s psi'."""
    t = s / (1.0 + c)
    H = base_inertia(body, t)
    share, M = twist_share(body, s, c), (body.J * body.C - body.E * body.E) / H
    # what pivots slower by as much as it rolls: tau' = Omega + (share H/I_v) across, by (1 - G/B) and B
    twist_rate = pivoting + share * H / pivot(body, s, c)[0] * across
    return s * H * (share * twist_rate - across), M * twist_rate


@jit
def needed_to_stand(
    body: Body, theta: float, phi: float, pivoting: float, vertical: float, a: Vector, pivots: bool
) -> tuple[float, float]:
    """Return the couple that holds a tilted body, on theta and along the lean, over m [m^2/s^2].

    Linear in `vertical`, g + az or its rate, `a`, the ground acceleration or its rate, and the square of
    the rate `pivoting`. `pivots` says that nothing but its inertia keeps the body from that.
    """
    s, c = sin(theta), cos(theta)
    b, h = body.b, body.h
    a_r = a[0] * cos(phi) + a[1] * sin(phi)
    a_t = a[1] * cos(phi) - a[0] * sin(phi)
    beside, above = b * c - h * s, b * s + h * c
    tilting, arm = vertical * beside + above * a_r, h + b * s / (1.0 + c)
    if pivots:
        I_v, P = pivot(body, s, c)
        tilting -= P * pivoting * pivoting
        arm = above + P * beside / I_v
    return tilting, -arm * a_t


@jit
def _needed_and_its_rate(
    body: Body, theta: float, phi: float, pivoting: float, a: Vector, slope: Vector, pivots: bool
) -> tuple[float, float, float, float]:
    """Return the couple that holds a body, on theta and along the lean, and the rates of both."""
    tilting, turning = needed_to_stand(body, theta, phi, pivoting, body.g + a[2], a, pivots)
    tilting = with_tendon_moment(body, tilting, sin(theta), cos(theta))
    # seen from the body that pivots, the ground acceleration turns
    seen = slope[0] + pivoting * a[1], slope[1] - pivoting * a[0], slope[2]
    tilting_1, turning_1 = needed_to_stand(body, theta, phi, 0.0, slope[2], seen, pivots)
    if pivoting != 0.0:
        s, c = sin(theta), cos(theta)
        I_v, P = pivot(body, s, c)
        a_t = a[1] * cos(phi) - a[0] * sin(phi)
        tilting_1 -= 2.0 * P * pivoting * (body.b * c - body.h * s) * a_t / I_v
    return tilting, turning, tilting_1, turning_1


@inlined
def largest_at_rest(body: Body, theta: float, az: float) -> float:
    """Return the largest couple on a tilted body that stands still [m^2/s^2]."""
    return body.delta * with_tendon_load(body, body.g + az, sin(theta), cos(theta))


@inlined
def _turning_below(body: Body, a: Vector) -> float:
    """Return the couple along the lean [m^2/s^2] that cannot be told from none: of motion in one plane."""
    return (body.h + body.b) * in_plane_below(body, a[0], a[1])


@jit
def push(
    body: Body, theta: float, phi: float, pivoting: float, a: Vector, slope: Vector, pivots: bool
) -> tuple[float, float, float, float]:
    """Return what moves a tilted body that stands still, or only pivots.

    Returns
    -------
    tuple of float
        Excess of the push over the couple [m^2/s^2], its rate [m^2/s^3], and the direction of the push on
        theta and along the lean; the last is exactly 0 in one plane.
    """
    tilting, turning, tilting_1, turning_1 = _needed_and_its_rate(
        body, theta, phi, pivoting, a, slope, pivots
    )
    if abs(turning) <= _turning_below(body, a):
        turning = 0.0
    size = sqrt(tilting * tilting + turning * turning)
    allowed = largest_at_rest(body, theta, a[2])
    if size == 0.0:
        return -allowed, 0.0, 0.0, 0.0
    tilting, turning = -tilting / size, -turning / size
    growth = -tilting_1 * tilting - turning_1 * turning - body.delta * slope[2]
    return size - allowed, growth, tilting, turning


@jit
def hold_time(body: Body, theta: float, phi: float, a: Vector, slope: Vector, pivots: bool) -> float:
    """Return for how long the couple holds a tilted body that stands still [s]; 0 if it does not.

    The ground acceleration is a + slope t, so |M|^2 - (delta N)^2 is a parabola in t. What `pivots` does not
    stand still under a force across its lean.
    """
    allowed, allowed_1 = largest_at_rest(body, theta, a[2]), body.delta * slope[2]
    tilting, turning, tilting_1, turning_1 = _needed_and_its_rate(body, theta, phi, 0.0, a, slope, pivots)
    below = _turning_below(body, a)
    if pivots and (abs(turning) > below or abs(turning_1) > below):
        return 0.0
    excess = tilting * tilting + turning * turning - allowed * allowed
    if allowed <= 0.0 or excess > 0.0:
        return 0.0
    half = tilting * tilting_1 + turning * turning_1 - allowed * allowed_1
    bend = tilting_1 * tilting_1 + turning_1 * turning_1 - allowed_1 * allowed_1
    under_root = half * half - bend * excess
    if under_root < 0.0 or (bend <= 0.0 and half <= 0.0):
        return inf
    root = sqrt(under_root)
    time = -excess / (half + root) if half > 0.0 else (root - half) / bend
    return time if time > _HAIR / body.p else 0.0


@jit
def couple_on(
    body: Body,
    theta: float,
    omega: float,
    phi: float,
    spin: float,
    twist_rate: float,
    free: float,
    a: Vector,
    pivots: bool,
) -> tuple[float, float]:
    """Return the couple on a body in motion, or on one that it holds, on theta and along the lean.

    Per unit mass [m^2/s^2]; arguments as for `couple` and `needed_to_stand`, with tau' and the ground
    acceleration `a`.
    """
    if omega == 0.0 and abs(spin) <= _ROUNDING * abs(twist_rate) and theta > 0.0:
        tilting, turning = needed_to_stand(body, theta, phi, twist_rate, body.g + a[2], a, pivots)
        tilting = with_tendon_moment(body, tilting, sin(theta), cos(theta))
        allowed, needed = largest_at_rest(body, theta, a[2]), sqrt(tilting * tilting + turning * turning)
        if needed <= allowed:
            return tilting, turning
        if abs(turning) > _turning_below(body, a):
            # about to move the way that it is pushed, as far as both inertias are alike: for a first moment
            share = max(0.0, allowed) / needed
            return share * tilting, share * turning
        spin = 0.0
    side = copysign(1.0, free) if omega == 0.0 else 0.0
    tilting, turning, _ = couple(body, sin(theta), cos(theta), omega, spin, free, a[2], side)
    return tilting, turning


@jit
def limit_of_pass(body: Body) -> tuple[float, float]:
    """Return the turn [rad] of a pass of vanishing spin under the couple, and its ratio of the tilt rates.

    Upright the tilt is a polar distance, and N = mu b theta'' alone: with x = cos(chi) = theta'/w, from -1
    to 1, and e = delta mu b, the equations of the recess are

        dphi = -dchi/[x^2 + (1 - x^2)(J + e x)/(A + e x)],
        dln(w) = -[(A - J) x + e]/[(A - J) x^2 + e x + J] dx.

    Without the couple the turn is pi sqrt(A/J) and nothing is lost.
    """
    e = body.delta * body.mu * body.b
    turn = taken = 0.0
    # the trapezia of an even periodic function, and Simpson's rule
    for i in range(_PARTS + 1):
        end = i == 0 or i == _PARTS
        x = cos(pi * i / _PARTS)
        turn += (0.5 if end else 1.0) / (x * x + (1.0 - x * x) * (body.J + e * x) / (body.A + e * x))
        x = 2.0 * i / _PARTS - 1.0
        weight = 1.0 if end else 4.0 if i % 2 == 1 else 2.0
        taken += weight / ((body.A - body.J) * x * x + e * x + body.J)
    logarithm = -0.5 * log((body.A + e) / (body.A - e)) - 0.5 * e * taken * 2.0 / (3.0 * _PARTS)
    return turn * pi / _PARTS, exp(logarithm)


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
