"""Uplift: the time at which the cylinder leaves the ground, and the first motion after it.

The cylinder stands until f = |a| - (g + az) tan(alpha) reaches zero (25), and lifts off towards the
inertia force (26). Rolling resistance holds it longer: a couple of at most delta N, N = g + az, acts
against the moment about the rim, so tan(alpha) becomes (b + delta)/h; a tendon adds its prestress to N.
There theta = 0 is a singular point
of the polar coordinates with a regular solution: a power series in the time since uplift gives the state
a little later, from where the equations are integrated. Within one sample |a| is convex and az linear, so
f is convex: a single sign change tells all.
"""

from __future__ import annotations

from math import atan2, hypot, pi, sqrt

import numpy as np

from .._compile import jit
from ..body import Body
from ..equations import in_plane_below
from ..restoring import growth_at_uplift, standing_force
from .record import Vector, ground

# The series ends at the share x of the shortest time scale there: 1/p, and the time in which the ground
# acceleration turns or changes by its own size. The terms left out are below x^3 relative to the others, so
# x^3 is the tolerance. The solution oscillates about the direction of the inertia force, ever faster towards
# t = 0, so an earlier start of the integration costs steps, about 1/sqrt(x).
_LATEST_START = 5e-3
# Where the very first sample is already over the threshold the oscillation is only logarithmic in t, and a
# start earlier by this factor costs nothing.
STEP_START = 1e-6
# Below this share of g a horizontal acceleration has no direction; it lifts only where g + az <= 0.
WEAK = 1e-12


@jit
def excess(body: Body, a: Vector) -> float:
    """Return f = |a| - (g + az)(b + delta)/h [m/s^2]; the cylinder cannot stand where it is positive."""
    return sqrt(a[0] * a[0] + a[1] * a[1]) - standing_force(body, a[2]) * uplift_slope(body)


@jit
def uplift_slope(body: Body) -> float:
    """Return the horizontal acceleration that uplifts over the vertical one, (b + delta)/h [-]."""
    return body.sin_alpha / body.cos_alpha * (1.0 + body.delta / body.b)


@jit
def uplift_in(body: Body, a: Vector, slope: Vector, end: float) -> float:
    """First time in [0, end) at which f rises through zero, or -1.0.

    Times count from where the acceleration is `a`, with rate `slope` per second. A root at `end`
    itself belongs to the next sample.
    """
    f_begin, f_end = excess(body, a), excess(body, ground(a, slope, end))
    if f_begin > 0.0:
        return 0.0
    if f_end <= 0.0:
        return -1.0
    low, high = 0.0, end
    # bisection and regula falsi in turn (Illinois): f is convex, so one secant side would stall
    f_low, f_high = f_begin, f_end
    for _ in range(200):
        middle = high - f_high * (high - low) / (f_high - f_low)
        if not low < middle < high:
            middle = 0.5 * (low + high)
            if not low < middle < high:
                break
        f = excess(body, ground(a, slope, middle))
        if f > 0.0:
            high, f_high = middle, f
            f_low *= 0.5
        else:
            low, f_low = middle, f
            f_high *= 0.5
        if f == 0.0:
            break
    return low


@jit
def nearest_branch(angle: float, last: float) -> float:
    """Return `angle` plus the multiple of 2 pi that brings it nearest to `last` [rad]."""
    return float(angle + 2.0 * pi * np.rint((last - angle) / (2.0 * pi)))


@jit
def start(
    body: Body,
    time_step: float,
    a: Vector,
    slope: Vector,
    at: float,
    time: float,
) -> tuple[float, float, float, float]:
    """Return theta, theta', the direction of the contact and its rate, `time` after uplift.

    Parameters
    ----------
    body : Body
    time_step : float
        Spacing of the samples [s], over which what the ground turns by less than a rounding is none.
    a, slope : tuple of 3 floats
        Acceleration at the last sample and its rate.
    at : float
        Time of uplift since that sample [s].
    time : float
        Time since uplift [s], short against 1/p.

    Returns
    -------
    tuple of float
        theta [rad], theta' [rad/s], phi [rad] in (-pi, pi] up to its lag, phi' [rad/s].

    Notes
    -----
    theta'' = F(t) + Q theta with F = p^2 cos(alpha) f/g expanded to t^3. The contact follows the
    inertia force, which turns at the rate W, with the lag that balances
    (J theta^2 phi')' = -h theta |a| sin(lag), (19) near upright: two rounds of its expansion. Where
    f starts above zero the lag is linear in time from the start and the balance is exact:
    phi' = W/(1 + 2 J F0/(h |a|)).

    Rolling resistance adds delta mu b theta'' to the inertia of the tilt, N being g + az + mu b theta''
    there, and the couple -delta N theta^2 phi'/theta' across, which holds the contact back behind the force:
    by kappa W t with kappa/(1 - kappa) = delta N/(3 h |a|), or where f starts above zero by its term in phi'.
    """
    ax, ay, az = ground(a, slope, at)
    size = max(hypot(ax, ay), WEAK * body.g)
    along = (ax * slope[0] + ay * slope[1]) / size  # d|a|/dt
    cross = ax * slope[1] - ay * slope[0]  # |a|^2 times the turning rate, constant in a sample
    if abs(cross) * time_step <= in_plane_below(body, ax, ay) * size:
        cross = 0.0
    turning = cross / (size * size)
    heavier = 1.0 + body.delta * body.mu * body.b / body.A
    factor = body.p2 * body.cos_alpha / body.g / heavier
    tan_alpha = uplift_slope(body)
    held = body.delta * standing_force(body, az) / (body.h * size)
    behind = held / (3.0 + held)  # kappa
    F0 = factor * max(excess(body, (ax, ay, az)), 0.0)
    F1 = factor * (along - slope[2] * tan_alpha)
    rolling = turning * (1.0 - behind)
    held_less = body.delta * standing_force(body, az) * rolling * rolling / (9.0 * body.A * heavier)
    F2 = factor * size * turning * turning * (1.0 - behind * behind) + held_less
    F3 = -3.0 * F2 * along / size
    widened = (1.0 + body.delta * body.b / (body.b * body.b + body.h * body.h)) / heavier
    Q = growth_at_uplift(body, az, widened) + body.J / body.A / heavier * rolling * rolling
    t = time
    theta = t * t * (F0 / 2 + t * (F1 / 6 + t * ((F2 + Q * F0) / 24 + t * (F3 + Q * F1) / 120)))
    theta_1 = t * (F0 + t * (F1 / 2 + t * ((F2 + Q * F0) / 6 + t * (F3 + Q * F1) / 24)))
    theta_2 = F0 + t * (F1 + t * ((F2 + Q * F0) / 2 + t * (F3 + Q * F1) / 6))

    bx, by = ax + slope[0] * t, ay + slope[1] * t
    direction = atan2(-by, -bx)
    now = max(hypot(bx, by), WEAK * body.g)
    W = cross / (now * now)
    if starts_as_step(F0, F1, shortest_time(body, a, slope, at)):
        pressed = body.delta * (standing_force(body, az) + body.mu * body.b * F0) / (2.0 * body.h * size)
        rate = W / (1.0 + 2.0 * body.J * F0 / (body.h * size) + pressed)
        return theta, theta_1, direction - (W - rate) * t, rate
    direction -= behind * W * t
    W *= 1.0 - behind
    W_1 = -2.0 * W * (bx * slope[0] + by * slope[1]) / (now * now)
    lag = body.J / (body.h * now)
    lag_1 = -lag * (2.0 * theta_2 * W + 3.0 * theta_1 * W_1)
    lag_2 = -lag * (2.0 * F1 * W + 5.0 * theta_2 * W_1)
    offset = -lag * (2.0 * theta_1 * (W + lag_1) + theta * (W_1 + lag_2))
    return theta, theta_1, direction + offset, W + lag_1


@jit
def shortest_time(body: Body, a: Vector, slope: Vector, at: float) -> float:
    """Return the time [s] in which motion or ground acceleration change by their own size at an uplift."""
    ax, ay, _ = ground(a, slope, at)
    change = hypot(slope[0], slope[1]) / max(hypot(ax, ay), WEAK * body.g)
    return 1.0 / max(body.fastest, change)


@jit
def starts_as_step(F0: float, F1: float, unit: float) -> bool:
    """Whether the jump F0 of theta'', in any unit, outweighs its rise F1 t at the first of the times."""
    return abs(F1) * STEP_START * unit < F0


@jit
def start_length(body: Body, rtol: float, a: Vector, slope: Vector, at: float) -> float:
    """Time after uplift [s] for which the series is used."""
    ax, ay, az = ground(a, slope, at)
    # both slopes over p^2 cos(alpha)/g
    F0 = max(excess(body, (ax, ay, az)), 0.0)
    along = (ax * slope[0] + ay * slope[1]) / max(hypot(ax, ay), WEAK * body.g)
    F1 = along - slope[2] * uplift_slope(body)
    unit = shortest_time(body, a, slope, at)
    if not starts_as_step(F0, F1, unit):
        return unit * min(float(rtol ** (1.0 / 3.0)), _LATEST_START)
    return min(STEP_START * unit, 1e-3 * F0 / abs(F1)) if F1 != 0.0 else STEP_START * unit
