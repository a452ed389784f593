"""One step of the recess model as a Taylor series in time, of the order that the tolerance asks for.

The radius of convergence is the time to upright, about theta/speed, so a sample of a record takes order 5
to 7 far from upright and more steps of a high order near it. See A. Jorba and M. Zou, "A software package for
the numerical integration of ODEs by means of high-order Taylor methods", Experimental Mathematics 14 (2005)
99-117.

Sine and cosine are needed at the start only, once: the series of s = sin theta, v = 1 - cos theta,
cos phi and sin phi follow from s' = (1 - v) theta' and so on, and those of everything else from
products of series. With (x y)_k for the coefficient of t^k in a product, the equations of
`equations.recess_rhs` become

====================================== ==========================================================
series                                 from
====================================== ==========================================================
B = 2 J v + (C - J) v v + 2 E s v      s^2 = 2 v - v v, inertia of the rolling angle
Q = B'/2 A                             (J s + (C - J) s v + 3 E v - 2 E v v)/A
w = L/B                                phi', by division of series
theta''                                Q w w - (p^2/g)[r + X a_r], r = (g + az) sin(alpha - theta) and
                                       what a tendon adds (`restoring`)
L'                                     -D a_t
X = cos(alpha - theta), D = h s + b v  linear in s and v; a_r, a_t linear in cos phi and sin phi
====================================== ==========================================================

No term cancels near theta = 0. In memory coefficients are times (unit of time)^k. Behind them stand sine and
cosine at the end of the step, which the next one may take over.
"""

from __future__ import annotations

from typing import NamedTuple, cast

import numpy as np
from numpy.typing import NDArray

from .._compile import inlined, jit
from ..body import Body
from ..equations import in_plane_below
from ..restoring import half_cosine, tendon_couple, with_tendon_coefficient
from ..trigonometry import sin_cos
from .record import Vector
from .result import State
from .systems import scales

_ORDER = 16  # highest order; from 12 to 16 the cost is the same at 1e-8, and a high order serves 1e-12
_WIDTH = _ORDER + 1
TILT, RATE, ANGLE, MOMENTUM, S, V, COS, SIN, B, Q, W, WW, X, D, RADIAL, ACROSS = (
    _WIDTH * i for i in range(16)
)
TRIG = 16 * _WIDTH  # s, v, cos phi and sin phi at the end of the step
STEPS_LEFT = TRIG + 4  # number of steps for which sine and cosine may still be taken over
U = STEPS_LEFT + 1  # cos(theta/2), with a tendon
_SIZE = U + _WIDTH

Path = tuple[float, int]  # last series: unit of time [s], order


@jit
def workspace(y: State) -> NDArray[np.float64]:
    """Return the memory that a time integration needs for its steps."""
    return np.zeros(_SIZE)


@jit
def state_at(c: NDArray[np.float64], order: int, x: float) -> State:
    """Return the state at the time x in units of the series."""
    tilt, rate = c[TILT + order], c[RATE + order]
    angle, momentum = c[ANGLE + order], c[MOMENTUM + order]
    for k in range(order - 1, -1, -1):
        tilt = tilt * x + c[TILT + k]
        rate = rate * x + c[RATE + k]
        angle = angle * x + c[ANGLE + k]
        momentum = momentum * x + c[MOMENTUM + k]
    return tilt, rate, angle, momentum


@jit
def partial(body: Body, c: NDArray[np.float64], path: Path, time: float) -> tuple[State, State]:
    """State at `time` [s] after the start of a step, and its derivative, both from the same series."""
    unit, order = path
    x = time / unit
    acceleration, angle_rate = order * c[RATE + order], order * c[ANGLE + order]
    torque = order * c[MOMENTUM + order]
    for k in range(order - 1, 0, -1):
        acceleration = acceleration * x + k * c[RATE + k]
        angle_rate = angle_rate * x + k * c[ANGLE + k]
        torque = torque * x + k * c[MOMENTUM + k]
    y = state_at(c, order, x)
    return y, (y[1], acceleration / unit, angle_rate / unit, torque / unit)


@inlined
def acceleration(c: NDArray[np.float64], path: Path) -> float:
    """Return the second derivative of the tilt at the start of the step [rad/s^2]."""
    unit, _ = path
    return float(c[RATE + 1] / unit)


_LEAST_ORDER = 4  # below this order two successive terms may be small by accident
# constants with a type in common with every other order: numba types a literal by its value and would compile
# its users for each
_SECOND, _THIRD, _FOURTH = (cast("int", np.int64(order)) for order in (2, 3, 4))
# share of the tolerance that the remainder of a step aims at, estimated as a geometric series with the ratio
# of the last two terms: in a close pass the remainders of a hundred steps have one sign
_AIM = 0.1
_LAST_BUT_ONE = 10.0  # tolerances that the term before the last may be large, whatever the last term
_KEPT_FOR = 32.0  # number of steps for which sine and cosine are taken over: rounding adds up no further


class Origin(NamedTuple):
    """Start of a series, needed by every order: coefficients of order 0, ground and scales."""

    s: float
    v: float
    cos: float
    sin: float
    rate: float
    w: float
    ww: float
    Q: float
    X: float
    D: float
    radial: float
    across: float
    u: float  # cos(theta/2), with a tendon
    per_B: float  # 1/B, 0 for planar motion
    per_A: float  # 1/A
    factor: float  # p^2/g
    ground: Vector  # ax, ay, g + az [m/s^2]
    change: Vector  # change of these in the unit of time
    per_allowed: State  # inverse of the error allowed of tilt, rate, rolling angle, momentum


class Sums(NamedTuple):
    """Sums of the series to some order at the unit of time, with its last term of sin(alpha - theta)."""

    tilt: float
    rate: float
    angle: float
    momentum: float
    s: float
    v: float
    cos: float
    sin: float
    Y: float  # last coefficient of sin(alpha - theta)


class Last(NamedTuple):
    """Coefficients of highest order, passed as values: the next order would wait for memory."""

    rate: float
    momentum: float
    s: float
    v: float
    cos: float
    sin: float
    cos_before: float
    sin_before: float


@inlined
def expand(
    body: Body, rtol: float, y: State, h: float, a: Vector, slope: Vector, c: NDArray[np.float64]
) -> tuple[int, float, float, State]:
    """Write the series from the state `y` to the workspace `c`, with `h` [s] as the unit of time.

    Returns the order, the size of its term and of the one before it in tolerances at the time h,
    and the state there.
    """
    theta, omega, phi, L = y
    if c[STEPS_LEFT] > 0.0:
        c[STEPS_LEFT] -= 1.0
        s0, v0, cos0, sin0 = c[TRIG], c[TRIG + 1], c[TRIG + 2], c[TRIG + 3]
    else:
        c[STEPS_LEFT] = _KEPT_FOR
        s_half, c_half = sin_cos(0.5 * theta)
        s0, v0 = 2.0 * s_half * c_half, 2.0 * s_half * s_half
        sin0, cos0 = sin_cos(phi)
    J, C, E = body.J, body.C, body.E
    per_A, factor = 1.0 / body.A, body.p2 / body.g
    ax, ay, gravity = a[0], a[1], body.g + a[2]
    dax, day, daz = slope[0] * h, slope[1] * h, slope[2] * h

    sv, vv = s0 * v0, v0 * v0
    Q0 = (J * s0 + (C - J) * sv + (3.0 * v0 - 2.0 * vv) * E) * per_A
    X0 = body.cos_alpha * (1.0 - v0) + body.sin_alpha * s0
    Y0 = body.sin_alpha * (1.0 - v0) - body.cos_alpha * s0
    D0 = body.h * s0 + body.b * v0
    r0, t0 = ax * cos0 + ay * sin0, ay * cos0 - ax * sin0
    # motion without spin is planar and may reach theta = 0, where L/B is 0/0
    flat = False
    if L == 0.0:
        least = in_plane_below(body, ax, ay)
        flat = abs(t0) <= least and abs(day * cos0 - dax * sin0) <= least
    if flat:  # planar motion in the axes of its plane, so that rounding adds nothing across it
        ax, ay, t0 = r0, 0.0, 0.0
        dax, day = dax * cos0 + day * sin0, 0.0
        cos0, sin0 = 1.0, 0.0
    u0 = half_cosine(body, v0)
    per_B = 0.0 if flat else 1.0 / (J * s0 * s0 + 2.0 * E * sv + C * vv)
    w0 = L * per_B
    ww0 = w0 * w0

    per_lever = 0.0 if flat else 1.0 / (J * theta)
    per_tilt, per_rate = scales(body, rtol, theta, omega, abs(L) * per_lever, flat)
    per_allowed = (per_tilt, per_rate, 1.0 / rtol, per_lever * per_rate)
    ground, change = (ax, ay, gravity), (dax, day, daz)
    zero = Origin(
        s0,
        v0,
        cos0,
        sin0,
        omega,
        w0,
        ww0,
        Q0,
        X0,
        D0,
        r0,
        t0,
        u0,
        per_B,
        per_A,
        factor,
        ground,
        change,
        per_allowed,
    )

    tilt_1, angle_1 = h * omega, h * w0
    rate_1 = h * (Q0 * ww0 - factor * (gravity * Y0 + X0 * r0 + tendon_couple(body, body.sin_alpha, s0, u0)))
    momentum_1 = -h * D0 * t0
    s_1, v_1 = tilt_1 * (1.0 - v0), tilt_1 * s0
    cos_1, sin_1 = -angle_1 * sin0, angle_1 * cos0
    c[TILT], c[RATE], c[ANGLE], c[MOMENTUM] = theta, omega, phi, L
    c[TILT + 1], c[RATE + 1], c[ANGLE + 1], c[MOMENTUM + 1] = tilt_1, rate_1, angle_1, momentum_1
    c[S + 1], c[V + 1], c[COS + 1], c[SIN + 1] = s_1, v_1, cos_1, sin_1
    tilt, rate, angle, momentum = theta + tilt_1, omega + rate_1, phi + angle_1, L + momentum_1
    sums = Sums(tilt, rate, angle, momentum, s0 + s_1, v0 + v_1, cos0 + cos_1, sin0 + sin_1, Y0)

    # the orders of every step unrolled: with constants they compile to straight code
    newest = Last(rate_1, momentum_1, s_1, v_1, cos_1, sin_1, cos0, sin0)
    sums, newest, _ = extend(body, zero, sums, newest, h, _SECOND, c)
    sums, newest, before = extend(body, zero, sums, newest, h, _THIRD, c)
    sums, newest, last = extend(body, zero, sums, newest, h, _FOURTH, c)
    order = _LEAST_ORDER
    while order < _ORDER and not fits(last, before):
        order, before = order + 1, last
        sums, newest, last = extend(body, zero, sums, newest, h, order, c)
    c[TRIG], c[TRIG + 1], c[TRIG + 2], c[TRIG + 3] = sums.s, sums.v, sums.cos, sums.sin
    if flat:
        c[STEPS_LEFT] = 0.0  # these count from the plane
    return order, last, before, (sums.tilt, sums.rate, sums.angle, sums.momentum)


@inlined
def extend(
    body: Body, zero: Origin, sums: Sums, newest: Last, h: float, order: int, c: NDArray[np.float64]
) -> tuple[Sums, Last, float]:
    """Add the term of `order` to the series in `c`; return the sums and its size in tolerances."""
    J, C, E = body.J, body.C, body.E
    ax, ay, gravity = zero.ground
    dax, day, daz = zero.change
    k = order - 1
    # the parts of the products of order k from lower orders: one loop, sums side by side
    sv = vv = v_rate = s_rate = cos_w = sin_w = B_w = ww = Q_ww = X_r = D_t = 0.0
    for j in range(1, k):
        i = k - j
        sv += c[S + j] * c[V + i]
        vv += c[V + j] * c[V + i]
        v_rate += c[V + j] * c[RATE + i]
        s_rate += c[S + j] * c[RATE + i]
        cos_w += c[COS + j] * c[W + i]
        sin_w += c[SIN + j] * c[W + i]
        B_w += c[B + j] * c[W + i]
        ww += c[W + j] * c[W + i]
        Q_ww += c[Q + j] * c[WW + i]
        X_r += c[X + j] * c[RADIAL + i]
        D_t += c[D + j] * c[ACROSS + i]
    rate_k, momentum_k, s_k, v_k, cos_k, sin_k, cos_before, sin_before = newest
    sv += zero.s * v_k + zero.v * s_k
    vv += 2.0 * zero.v * v_k
    B_k = 2.0 * J * v_k + (C - J) * vv + 2.0 * E * sv
    Q_k = (J * s_k + (C - J) * sv + (3.0 * v_k - 2.0 * vv) * E) * zero.per_A
    w_k = (momentum_k - B_w - B_k * zero.w) * zero.per_B
    ww += 2.0 * zero.w * w_k
    X_k = body.sin_alpha * s_k - body.cos_alpha * v_k
    Y_k = -body.sin_alpha * v_k - body.cos_alpha * s_k
    D_k = body.h * s_k + body.b * v_k
    r_k = ax * cos_k + ay * sin_k + dax * cos_before + day * sin_before
    t_k = ay * cos_k - ax * sin_k + day * cos_before - dax * sin_before
    c[B + k], c[Q + k], c[W + k], c[WW + k] = B_k, Q_k, w_k, ww
    c[X + k], c[D + k], c[RADIAL + k], c[ACROSS + k] = X_k, D_k, r_k, t_k

    step = h / order
    centrifugal = Q_ww + zero.Q * ww + Q_k * zero.ww
    weight = with_tendon_coefficient(body, gravity * Y_k + daz * sums.Y, s_k, v_k, zero.u, k, c, U)
    tilt = step * rate_k
    rate = step * (centrifugal - zero.factor * (weight + X_r + zero.X * r_k + X_k * zero.radial))
    angle = step * w_k
    momentum = -step * (D_t + zero.D * t_k + D_k * zero.across)
    s = step * (rate_k - v_rate - zero.v * rate_k - v_k * zero.rate)
    v = step * (s_rate + zero.s * rate_k + s_k * zero.rate)
    cos = -step * (sin_w + zero.w * sin_k + w_k * zero.sin)
    sin = step * (cos_w + zero.w * cos_k + w_k * zero.cos)
    c[TILT + order], c[RATE + order], c[ANGLE + order] = tilt, rate, angle
    c[MOMENTUM + order] = momentum
    c[S + order], c[V + order], c[COS + order], c[SIN + order] = s, v, cos, sin
    per_tilt, per_rate, per_angle, per_momentum = zero.per_allowed
    # a sum, as a maximum would compile to branches
    size = (abs(tilt) * per_tilt + abs(rate) * per_rate) + (
        abs(angle) * per_angle + abs(momentum) * per_momentum
    )
    return (
        Sums(
            sums.tilt + tilt,
            sums.rate + rate,
            sums.angle + angle,
            sums.momentum + momentum,
            sums.s + s,
            sums.v + v,
            sums.cos + cos,
            sums.sin + sin,
            Y_k,
        ),
        Last(rate, momentum, s, v, cos, sin, cos_k, sin_k),
        size,
    )


@inlined
def fits(last: float, before: float) -> bool:
    """Whether a series whose last two terms are these, in tolerances, may end here."""
    return last * last <= _AIM * (before - last) and before <= _LAST_BUT_ONE


_SAFETY = 0.9  # safety factor on the length of a step that the order limits
_GROWTH = 4.0  # bound on the growth of the step from one to the next
_SHRINK = 1.0 / 32.0  # factor on a step not taken; the next trial is _GROWTH times as long


@jit
def restart(body: Body, y: State, a: Vector, work: NDArray[np.float64]) -> State:
    """Discard the sine and cosine of the last step after a jump of the state."""
    work[STEPS_LEFT] = 0.0
    return y


@jit
def fitting_share(order: int, last: float, before: float) -> float:
    """Share of the unit of time at which a series with these last two terms, in tolerances, may end."""
    by_remainder = (_AIM * before / (last * last)) ** (1.0 / (order + 1))
    by_term = (_LAST_BUT_ONE / before) ** (1.0 / (order - 1))
    return float(_SAFETY * min(1.0, by_remainder, by_term))


@inlined
def advance(
    body: Body,
    rtol: float,
    y: State,
    k: State,
    work: NDArray[np.float64],
    h: float,
    length: float,
    a: Vector,
    slope: Vector,
) -> tuple[float, float, int, State, State, Path]:
    """Take one step from `y`, of about length `h` and `length` at the most; see `stepping.Stepper`.

    The series is never repeated: where its highest order does not reach, the step is as long as it
    reaches. Only one that would pass through theta = 0 with spin, or that overflows, is not taken.
    """
    unit = min(_GROWTH * h, length)
    order, last, before, y_new = expand(body, rtol, y, unit, a, slope, work)
    taken, proposed = unit, max(unit, h)
    if not fits(last, before):
        share = fitting_share(order, last, before)
        if share > 0.5 and unit == length:
            share = 0.5  # two even steps in place of a long and a short one
        taken = proposed = share * unit
        y_new = state_at(work, order, share)
        work[STEPS_LEFT] = 0.0
    if y_new[0] > 0.0 or (y[3] == 0.0 and y_new[3] == 0.0 and y_new[0] > -np.inf):
        return taken, proposed, 1, y_new, y_new, (unit, order)
    work[STEPS_LEFT] = 0.0
    return 0.0, _SHRINK * unit, 1, y, y, (unit, order)
