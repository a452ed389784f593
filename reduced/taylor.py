"""One step of the recess model as a Taylor series in time, of the order that the tolerance asks for.

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
theta''                                Q w w - (p^2/g)[(g + az) sin(alpha - theta) + X a_r]
L'                                     -D a_t
X = cos(alpha - theta), D = h s + b v  linear in s and v; a_r, a_t linear in cos phi and sin phi
====================================== ==========================================================

No term cancels near theta = 0. The radius of convergence is the time to the apex, about
theta/speed, so a sample of a record takes order 5 to 7 far from the apex and more steps of a high
order near it. See A. Jorba and M. Zou, "A software package for the numerical integration of ODEs by
means of high-order Taylor methods", Experimental Mathematics 14 (2005) 99-117.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ._compile import inlined, jit
from .body import Body
from .systems import scales
from .trigonometry import sin_cos
from .tsit5 import State, Vector

_ORDER = 16  # the highest; from 12 to 16 the cost is the same at 1e-8, and a high one serves 1e-12
_LEAST_ORDER = 3  # below it two terms in a row may be small by accident
# A step aims at a remainder of this share of the tolerance, as a geometric series with the ratio of
# the last two terms has it: in a close pass the remainders of a hundred steps have one sign.
_AIM = 0.1
_LAST_BUT_ONE = 10.0  # tolerances that the term before the last may be large, whatever the last one is
_SAFETY = 0.9  # on the length of a step that the order limits
_GROWTH = 4.0  # bound on the growth of the step from one to the next
_SHRINK = 1.0 / 32.0  # of a step not taken; the next trial is _GROWTH times as long
_KEPT_FOR = 32.0  # steps for which sine and cosine are taken over: rounding adds up no further

# where the series stand in the workspace; coefficients are times (unit of time)^k
_WIDTH = _ORDER + 1
_TILT, _RATE, _ANGLE, _MOMENTUM, _S, _V, _COS, _SIN, _B, _Q, _W, _WW, _X, _D, _RADIAL, _ACROSS = (
    _WIDTH * i for i in range(16)
)
_TRIG = 16 * _WIDTH  # s, v, cos phi and sin phi at the end of the step
_STEPS_LEFT = _TRIG + 4  # for so many steps these may still be taken over
_SIZE = _STEPS_LEFT + 1

Path = tuple[float, int]  # of the last series: unit of time [s], order


@jit
def workspace(y: State) -> NDArray[np.float64]:
    """Return the memory that a march needs for its steps."""
    return np.zeros(_SIZE)


@jit
def restarted(body: Body, y: State, a: Vector, work: NDArray[np.float64]) -> State:
    """Forget the sine and cosine of the last step: the state has jumped."""
    work[_STEPS_LEFT] = 0.0
    return y


@inlined
def expand(
    body: Body, rtol: float, y: State, h: float, a: Vector, slope: Vector, c: NDArray[np.float64]
) -> tuple[int, float, float, Any]:
    """Write the series from the state `y` to the workspace `c`, with `h` [s] as the unit of time.

    Returns the order, the size of its term and of the one before it in tolerances at the time h,
    and the state there.
    """
    theta, omega, phi, L = y
    if c[_STEPS_LEFT] > 0.0:
        c[_STEPS_LEFT] -= 1.0
        s0, v0, cos0, sin0 = c[_TRIG], c[_TRIG + 1], c[_TRIG + 2], c[_TRIG + 3]
    else:
        c[_STEPS_LEFT] = _KEPT_FOR
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
    Y = body.sin_alpha * (1.0 - v0) - body.cos_alpha * s0
    D0 = body.h * s0 + body.b * v0
    r0, t0 = ax * cos0 + ay * sin0, ay * cos0 - ax * sin0
    # without spin, now and later, the motion is planar and may reach theta = 0, where L/B is 0/0
    flat = L == 0.0 and t0 == 0.0 and day * cos0 == dax * sin0
    per_B = 0.0 if flat else 1.0 / (J * s0 * s0 + 2.0 * E * sv + C * vv)
    w0 = L * per_B
    ww0 = w0 * w0
    c[_S], c[_V], c[_COS], c[_SIN] = s0, v0, cos0, sin0
    c[_TILT], c[_RATE], c[_ANGLE], c[_MOMENTUM], c[_W] = theta, omega, phi, L, w0

    per_lever = 0.0 if flat else 1.0 / (J * theta)
    per_tilt, per_rate = scales(body, rtol, theta, omega, abs(L) * per_lever, flat)
    per_angle, per_momentum = 1.0 / rtol, per_lever * per_rate

    tilt_1, angle_1 = h * omega, h * w0
    rate_1 = h * (Q0 * ww0 - factor * (gravity * Y + X0 * r0))
    momentum_1 = -h * D0 * t0
    s_1, v_1 = tilt_1 * (1.0 - v0), tilt_1 * s0
    cos_1, sin_1 = -angle_1 * sin0, angle_1 * cos0
    c[_TILT + 1], c[_RATE + 1], c[_ANGLE + 1], c[_MOMENTUM + 1] = tilt_1, rate_1, angle_1, momentum_1
    c[_S + 1], c[_V + 1], c[_COS + 1], c[_SIN + 1] = s_1, v_1, cos_1, sin_1
    # the sums are the state at the time h
    tilt, rate, angle, momentum = theta + tilt_1, omega + rate_1, phi + angle_1, L + momentum_1
    s, v, cos, sin = s0 + s_1, v0 + v_1, cos0 + cos_1, sin0 + sin_1

    order, last, before = 1, np.inf, np.inf
    for k in range(1, _ORDER):
        # the parts of the products of order k from orders below k: one loop, sums side by side
        sv = vv = v_rate = s_rate = cos_w = sin_w = B_w = ww = Q_ww = X_r = D_t = 0.0
        for j in range(1, k):
            i = k - j
            sv += c[_S + j] * c[_V + i]
            vv += c[_V + j] * c[_V + i]
            v_rate += c[_V + j] * c[_RATE + i]
            s_rate += c[_S + j] * c[_RATE + i]
            cos_w += c[_COS + j] * c[_W + i]
            sin_w += c[_SIN + j] * c[_W + i]
            B_w += c[_B + j] * c[_W + i]
            ww += c[_W + j] * c[_W + i]
            Q_ww += c[_Q + j] * c[_WW + i]
            X_r += c[_X + j] * c[_RADIAL + i]
            D_t += c[_D + j] * c[_ACROSS + i]
        s_k, v_k, rate_k, cos_k, sin_k = c[_S + k], c[_V + k], c[_RATE + k], c[_COS + k], c[_SIN + k]
        sv += s0 * v_k + v0 * s_k
        vv += 2.0 * v0 * v_k
        B_k = 2.0 * J * v_k + (C - J) * vv + 2.0 * E * sv
        Q_k = (J * s_k + (C - J) * sv + (3.0 * v_k - 2.0 * vv) * E) * per_A
        w_k = (c[_MOMENTUM + k] - B_w - B_k * w0) * per_B
        ww += 2.0 * w0 * w_k
        X_k = body.sin_alpha * s_k - body.cos_alpha * v_k
        Y_before, Y = Y, -body.sin_alpha * v_k - body.cos_alpha * s_k
        D_k = body.h * s_k + body.b * v_k
        cos_before, sin_before = c[_COS + k - 1], c[_SIN + k - 1]
        r_k = ax * cos_k + ay * sin_k + dax * cos_before + day * sin_before
        t_k = ay * cos_k - ax * sin_k + day * cos_before - dax * sin_before
        c[_B + k], c[_Q + k], c[_W + k], c[_WW + k] = B_k, Q_k, w_k, ww
        c[_X + k], c[_D + k], c[_RADIAL + k], c[_ACROSS + k] = X_k, D_k, r_k, t_k

        order = k + 1
        step = h / order
        centrifugal = Q_ww + Q0 * ww + Q_k * ww0
        weight = gravity * Y + daz * Y_before
        tilt_k = step * rate_k
        rate_k1 = step * (centrifugal - factor * (weight + X_r + X0 * r_k + X_k * r0))
        angle_k = step * w_k
        momentum_k = -step * (D_t + D0 * t_k + D_k * t0)
        s_k1 = step * (rate_k - v_rate - v0 * rate_k - v_k * omega)
        v_k1 = step * (s_rate + s0 * rate_k + s_k * omega)
        cos_k1 = -step * (sin_w + w0 * sin_k + w_k * sin0)
        sin_k1 = step * (cos_w + w0 * cos_k + w_k * cos0)
        c[_TILT + order], c[_RATE + order], c[_ANGLE + order] = tilt_k, rate_k1, angle_k
        c[_MOMENTUM + order] = momentum_k
        c[_S + order], c[_V + order], c[_COS + order], c[_SIN + order] = s_k1, v_k1, cos_k1, sin_k1
        tilt, rate, angle, momentum = tilt + tilt_k, rate + rate_k1, angle + angle_k, momentum + momentum_k
        s, v, cos, sin = s + s_k1, v + v_k1, cos + cos_k1, sin + sin_k1
        if order < _LEAST_ORDER:
            continue
        before = last
        # sums, because a maximum would be branches
        last = (abs(tilt_k) * per_tilt + abs(rate_k1) * per_rate) + (
            abs(angle_k) * per_angle + abs(momentum_k) * per_momentum
        )
        if fits(last, before):
            break
    c[_TRIG], c[_TRIG + 1], c[_TRIG + 2], c[_TRIG + 3] = s, v, cos, sin
    return order, last, before, (tilt, rate, angle, momentum)


@inlined
def fits(last: float, before: float) -> bool:
    """Return whether a series with these last two terms, in tolerances, may end here."""
    return last * last <= _AIM * (before - last) and before <= _LAST_BUT_ONE


@jit
def fitting_share(order: int, last: float, before: float) -> float:
    """Return the share of the unit of time at which a series with these last two terms fits."""
    by_remainder = (_AIM * before / (last * last)) ** (1.0 / (order + 1))
    by_term = (_LAST_BUT_ONE / before) ** (1.0 / (order - 1))
    return float(_SAFETY * min(1.0, by_remainder, by_term))


@jit
def state_at(c: NDArray[np.float64], order: int, x: float) -> Any:
    """Return the state at the time x in units of the series."""
    tilt, rate = c[_TILT + order], c[_RATE + order]
    angle, momentum = c[_ANGLE + order], c[_MOMENTUM + order]
    for k in range(order - 1, -1, -1):
        tilt = tilt * x + c[_TILT + k]
        rate = rate * x + c[_RATE + k]
        angle = angle * x + c[_ANGLE + k]
        momentum = momentum * x + c[_MOMENTUM + k]
    return tilt, rate, angle, momentum


@jit
def partial(body: Body, c: NDArray[np.float64], path: Path, time: float) -> Any:
    """Return the state at `time` [s] after the start of a step and its derivative: of the same series."""
    unit, order = path
    x = time / unit
    acceleration, angle_rate, torque = order * c[_RATE + order], order * c[_ANGLE + order], 0.0
    torque = order * c[_MOMENTUM + order]
    for k in range(order - 1, 0, -1):
        acceleration = acceleration * x + k * c[_RATE + k]
        angle_rate = angle_rate * x + k * c[_ANGLE + k]
        torque = torque * x + k * c[_MOMENTUM + k]
    y = state_at(c, order, x)
    return y, (y[1], acceleration / unit, angle_rate / unit, torque / unit)


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
) -> tuple[float, float, int, Any, Any, Path]:
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
            share = 0.5  # two even steps instead of a long and a short one
        taken = proposed = share * unit
        y_new = state_at(work, order, share)
        work[_STEPS_LEFT] = 0.0
    if y_new[0] > 0.0 or (y[3] == 0.0 and y_new[3] == 0.0 and y_new[0] > -np.inf):
        return taken, proposed, 1, y_new, y_new, (unit, order)
    work[_STEPS_LEFT] = 0.0
    return 0.0, _SHRINK * unit, 1, y, y, (unit, order)
