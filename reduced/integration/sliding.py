"""A body that slides on flat ground, as Taylor series that stay smooth where it stops or turns about.

x'' = f - n v/|v| in the plane, f = -a_h, n = mu (g + az), both linear in time between samples. The
direction of v turns ever faster as the speed falls. With v = w^2, in the complex plane, and dt = |w|^2 ds

    dw/ds = (f conj(w) - n w)/2,   dt/ds = |w|^2,   dx/ds = |w|^2 w^2,

are polynomials, whose series of any order are sums of products. Rest is w = 0: with |f| < n it is reached
exponentially in s, with |f| > n the way leads past it. Below a least speed it counts as reached.

It starts where |f| first exceeds n, a root of a quadratic in each sample. From rest, and at low speed with
|f| near n, where s is slow, a short time t is expanded: with K = |f| - n and its rate q the speed is
v0 + K t + q t^2/2 + ..., in a direction that lags that of f, from |v| psi' = |f| sin(psi_f - psi).

====== ===========================================================================
p, q   w = p + i q [(m/s)^(1/2)]
S      |w|^2, speed [m/s]
C, D   real and imaginary part of w^2, velocity [m/s]
====== ===========================================================================
"""

from __future__ import annotations

from math import atan2, copysign, cos, hypot, inf, nan, sin, sqrt
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .._compile import jit, kernel

_ORDER = 20  # highest order; a low one costs more steps at a start or a stop
_WIDTH = _ORDER + 1
P, Q, S, C, D, T, X, Y, PATH, LOST = range(10)  # rows of the coefficients
Force = tuple[float, float, float, float]  # f at the beginning of a sample and its rates [m/s^2, m/s^3]

_STILL = 1e-11  # speed that counts as zero, over the speed that gravity gives in a sample
_STEADY = 0.1  # share of n - |f| by which it may change while a body stops
_SOON = 0.25  # power of the tolerance, 6e-4 of 1e-13: share of |f| by which f may change in a short time
# Low is a speed at which the direction lags that of f by so many radians at most; K over |f| of such a time,
# over the root of the share above; and by how much the direction may be off that lag [rad], to which it is
# drawn within |v|/|f|.
_LOW, _LEVEL, _ALIGNED = 1e-3, 0.4, 1e-5
VALUES = 7  # numbers of a sample: x, y, x', y', path, energy lost per unit mass, whether it slides


class Slide(NamedTuple):
    """Result of a slide."""

    lost_contact: float  # time at which g + az reaches 0 [s]; NaN if it does not
    began: float  # time of the first slide [s]; NaN if there is none
    end: float  # time of rest after the run, or the end of the run [s]
    slides: bool  # whether it slides at the end: without friction it never rests
    peak: float  # largest distance from where it stood [m]
    samples: NDArray[np.float64]  # (n, VALUES) at the sample times
    steps: int


@jit
def _first_excess(f: Force, n0: float, n1: float, start: float, end: float) -> float:
    """First time in start..end at which |f| exceeds n, both linear in time; infinite if none."""
    fx, fy, gx, gy = f
    c2 = gx * gx + gy * gy - n1 * n1
    c1 = fx * gx + fy * gy - n0 * n1  # half of the coefficient
    c0 = fx * fx + fy * fy - n0 * n0
    if c0 + start * (2.0 * c1 + start * c2) > 0.0:
        return start
    slope = c1 + c2 * start  # half of the slope at the start
    if c0 + end * (2.0 * c1 + end * c2) <= 0.0 and (c2 >= 0.0 or slope <= 0.0):
        return inf
    root = c1 * c1 - c0 * c2
    if root < 0.0:
        return inf
    root = sqrt(root)
    # the root at which it rises, without cancellation
    if c1 > 0.0:
        time = -c0 / (c1 + root)
    elif c2 != 0.0:
        time = (root - c1) / c2
    else:
        return inf
    return max(time, start) if time <= end else inf


@jit
def _expand(c: NDArray[np.float64], order: int, reach: float, tolerance: float,
            f: Force, n0: float, n1: float) -> tuple[int, float]:  # fmt: skip
    """Series of all but path and energy from their values at s = 0: order, and the largest valid s.

    It ends at the order that is enough for the time `reach` [s].
    """
    fx, fy, gx, gy = f
    speed = c[P, 0] * c[P, 0] + c[Q, 0] * c[Q, 0]
    size = sqrt(speed)
    c[S, 0] = speed
    c[C, 0] = c[P, 0] * c[P, 0] - c[Q, 0] * c[Q, 0]
    c[D, 0] = 2.0 * c[P, 0] * c[Q, 0]
    guess, power, last = inf, inf, inf
    for k in range(order):
        pull, turn, along, across = 0.0, 0.0, c[S, 0] * c[C, k], c[S, 0] * c[D, k]
        for i in range(1, k + 1):  # sums independent of one another, which the processor adds in parallel
            pull += c[T, i] * c[P, k - i]
            turn += c[T, i] * c[Q, k - i]
            along += c[S, i] * c[C, k - i]
            across += c[S, i] * c[D, k - i]
        share = 0.5 / (k + 1)
        c[P, k + 1] = share * ((fx - n0) * c[P, k] + fy * c[Q, k] + (gx - n1) * pull + gy * turn)
        c[Q, k + 1] = share * (fy * c[P, k] - (fx + n0) * c[Q, k] + gy * pull - (gx + n1) * turn)
        c[T, k + 1] = c[S, k] / (k + 1)
        c[X, k + 1], c[Y, k + 1] = along / (k + 1), across / (k + 1)
        pp, qq, pq = 0.0, 0.0, 0.0
        for i in range((k + 2) // 2):  # half of the terms, as they are symmetric
            j = k + 1 - i
            pp += c[P, i] * c[P, j]
            qq += c[Q, i] * c[Q, j]
            pq += c[P, i] * c[Q, j] + c[P, j] * c[Q, i]
        pp, qq = 2.0 * pp, 2.0 * qq
        if k % 2:
            middle = (k + 1) // 2
            pp, qq = pp + c[P, middle] ** 2, qq + c[Q, middle] ** 2
            pq += c[P, middle] * c[Q, middle]
        c[S, k + 1], c[C, k + 1], c[D, k + 1] = pp + qq, pp - qq, 2.0 * pq
        if k == 1:
            # s of the time reached, to second order; none where it stops before
            root = speed * speed + 2.0 * c[S, 1] * reach
            guess = 2.1 * reach / (speed + sqrt(root)) if root > 0.0 else inf
            power = guess * guess
        elif k > 1:
            power *= guess
            term = max(abs(c[P, k + 1]), abs(c[Q, k + 1])) * power
            if term < tolerance * size and last < tolerance * size:
                return k + 1, guess
            last = term
    far = inf
    for k in (order - 1, order):
        term = max(abs(c[P, k]), abs(c[Q, k]))
        if term > 0.0:
            far = min(far, (tolerance * size / term) ** (1.0 / k))
    return order, min(far, guess)


@jit
def _path(c: NDArray[np.float64], order: int, n0: float, n1: float) -> None:
    """Series of path and energy lost, dE/ds = n dx/ds."""
    for k in range(order):
        path = 0.0
        for i in range(k + 1):
            path += c[S, i] * c[S, k - i]
        c[PATH, k + 1] = path / (k + 1)
    for k in range(order):
        lost = n0 * (k + 1) * c[PATH, k + 1]
        for i in range(1, k + 1):
            lost += n1 * c[T, i] * (k + 1 - i) * c[PATH, k + 1 - i]
        c[LOST, k + 1] = lost / (k + 1)


@jit
def _at(c: NDArray[np.float64], row: int, order: int, s: float) -> float:
    value = float(c[row, order])
    for k in range(order - 1, -1, -1):
        value = value * s + c[row, k]
    return value


@jit
def _when(c: NDArray[np.float64], order: int, time: float, end: float) -> float:
    """Root s in 0..end at which the series reaches a time, by Newton's iteration."""
    low, high = 0.0, end
    s = end if 0.9 * c[T, 1] * end < time else time / c[T, 1]
    for _ in range(60):
        value, slope = c[T, order], 0.0
        for k in range(order - 1, -1, -1):
            slope = slope * s + value
            value = value * s + c[T, k]
        off = value - time
        if off > 0.0:
            high = s
        else:
            low = s
        after = s - off / slope if slope > 0.0 else 0.5 * (low + high)
        if not low <= after <= high:
            after = 0.5 * (low + high)
        if abs(after - s) <= 1e-15 * end:
            return after
        s = after
    return s


@jit
def _rotate(c: NDArray[np.float64], order: int, end: float) -> float:
    """Largest distance within a step that begins outwards and ends inwards [m]."""
    low, high = 0.0, end
    for _ in range(50):
        s = 0.5 * (low + high)
        outward = _at(c, X, order, s) * _at(c, C, order, s) + _at(c, Y, order, s) * _at(c, D, order, s)
        if outward > 0.0:
            low = s
        else:
            high = s
    return hypot(_at(c, X, order, low), _at(c, Y, order, low))


@jit
def _creep(f: Force, n0: float, n1: float, time: float, left: float, v0: float,
           soon: float) -> tuple[float, float, float, float, float, float]:  # fmt: skip
    """A short time from `time` on, with f almost constant: its length, then x, y, speed, direction and path.

    It begins at rest, or at a low speed v0 in a direction that follows that of f; a speed of 0 is a stop.
    """
    fx, fy, gx, gy = f
    fx, fy, n = fx + gx * time, fy + gy * time, n0 + n1 * time
    force, slope = hypot(fx, fy), hypot(gx, gy)
    if force == 0.0:  # frictionless: begins at a root of f
        e = left
        speed = 0.5 * slope * e * e
        return e, gx * e**3 / 6.0, gy * e**3 / 6.0, speed, atan2(gy, gx), slope * e**3 / 6.0
    f1, W = (fx * gx + fy * gy) / force, (fx * gy - fy * gx) / (force * force)
    W1, curve = -2.0 * W * f1 / force, force * W * W  # rate of W, second derivative of |f|
    K, q = force - n, f1 - n1
    if v0 == 0.0 and abs(K) <= 1e-13 * force:
        K = 0.0
    steepest = max(slope, abs(n1))
    e = left
    if steepest > 0.0:
        e = min(left, soon * force / steepest)
    c1 = -K * W / (K + force)
    c2 = -(0.5 * q * (W + c1) + f1 * c1 + K * W1) / (force + 2.0 * K)
    # reduction by the lag, at its leading term
    middle = v0 + 0.5 * e * (K + 0.25 * q * e)
    slower = 0.5 * middle * middle * W * W / force if v0 > 0.0 else 0.0
    fourth = force * c1 * c1 if v0 == 0.0 else 0.0
    if v0 + e * (K - slower + 0.5 * q * e) <= 0.0:  # it stops
        root = K * K - 2.0 * q * v0
        if v0 > 0.0 and K < 0.0 and root >= 0.0:
            e = min(e, 2.0 * v0 / (-K + sqrt(root)))
        elif q < 0.0:
            e = min(e, (K + sqrt(max(root, 0.0))) / -q)
    x, y, path, speed, heading = 0.0, 0.0, 0.0, v0, 0.0
    for k in range(3):
        t = 0.5 * k * e
        speed = v0 + t * (K - slower + t * (0.5 * q + t * (curve - fourth) / 6.0))
        fxt, fyt = fx + gx * t, fy + gy * t
        ft = hypot(fxt, fyt)
        lag = -speed * (fxt * gy - fyt * gx) / ft**3 if v0 > 0.0 else t * (c1 + t * c2)
        heading = atan2(fyt, fxt) + lag
        weight = (4.0 if k == 1 else 1.0) * e / 6.0 * speed
        x, y, path = x + weight * cos(heading), y + weight * sin(heading), path + weight
    return e, x, y, max(speed, 0.0), heading, path


@jit
def _stop(fx: float, fy: float, force: float, n: float, p: float,
          q: float) -> tuple[float, float, float, float]:  # fmt: skip
    """Time until a body stops where f and n stay as they are, |f| < n, and its x, y and path until then.

    Along f and across it w decays by the rates (n - |f|)/2 and (n + |f|)/2 in s, and dt, dx and the path are
    polynomials of w.
    """
    along, across = (fx / force, fy / force) if force > 0.0 else (1.0, 0.0)
    half = sqrt(0.5 * (1.0 + abs(along)))  # cosine of half the azimuth of f, or of its opposite
    c, s = (half, 0.5 * across / half) if along >= 0.0 else (0.5 * abs(across) / half, copysign(half, across))
    a, b = p * c + q * s, q * c - p * s
    slow, fast = n - force, n + force
    straight = 0.5 * a**4 / slow
    bent = 0.5 * b**4 / fast
    u, v = straight - bent, 2.0 * a * b * (a * a / (n + slow) + b * b / (n + fast))
    path = straight + bent + a * a * b * b / n
    return a * a / slow + b * b / fast, u * along - v * across, u * across + v * along, path


@kernel
def slide(
    record: NDArray[np.float64],
    time_step: float,
    friction: float,
    gravity: float,
    duration: float,
    times: NDArray[np.float64],
    tolerance: float,
) -> Slide:
    """Slide from rest under a record (m, 3) [m/s^2], sampled at `times` (n,) [s].

    After the shorter of record and `duration` the ground is still, and a slide is followed to rest.
    """
    count, taken, steps = len(times), 0, 0
    samples = np.zeros((count, VALUES))
    c = np.zeros((10, _WIDTH))
    still, soon = _STILL * gravity * time_step, tolerance**_SOON
    level, stops = _LEVEL * sqrt(soon), tolerance * gravity * time_step * time_step
    loads = np.maximum(gravity + record[:, 2], 0.0)
    held = (friction * loads) ** 2 - record[:, 0] ** 2 - record[:, 1] ** 2
    held[loads == 0.0] = -1.0
    x, y, path, lost, p, q = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    peak, began, slides = 0.0, nan, False
    limit = min(duration, (len(record) - 1) * time_step)
    for i in range(len(record) - 1):
        base = i * time_step
        length = min(time_step, limit - base)
        if length <= 0.0:
            break
        if count == 0 and not slides and min(held[i], held[i + 1]) >= 0.0:
            continue  # |f| - n is convex
        gx, gy = (record[i, 0] - record[i + 1, 0]) / time_step, (record[i, 1] - record[i + 1, 1]) / time_step
        load, rise = gravity + record[i, 2], (record[i + 1, 2] - record[i, 2]) / time_step
        if load <= 0.0 or load + rise * length <= 0.0:
            when = base + (0.0 if load <= 0.0 else -load / rise)
            return Slide(when, began, when, slides, nan, samples[:taken], steps)
        n0, n1 = friction * load, friction * rise
        f = (-record[i, 0], -record[i, 1], gx, gy)
        now = 0.0
        while now < length * (1.0 - 1e-13):
            steps += 1
            speed = p * p + q * q
            if not slides:
                now = _first_excess(f, n0, n1, now, length)
                while taken < count and times[taken] <= base + min(now, length):
                    samples[taken, 0], samples[taken, 1] = x, y
                    samples[taken, 4], samples[taken, 5] = path, lost
                    taken += 1
                if now >= length * (1.0 - 1e-12):
                    break
                speed = 0.0
                began = base + now if not began >= 0.0 else began
            reach = length - now
            fx, fy, n = f[0] + gx * now, f[1] + gy * now, n0 + n1 * now
            low = not slides or speed * sqrt(gx * gx + gy * gy) <= _LOW * (fx * fx + fy * fy)
            force = sqrt(fx * fx + fy * fy) if low else inf
            if slides and force < n:
                spent, dx, dy, moved = _stop(fx, fy, force, n, p, q)
                change = (sqrt(gx * gx + gy * gy) + abs(n1)) * spent
                if (
                    change * spent * spent < stops
                    and change <= _STEADY * (n - force)
                    and spent <= reach
                    and (taken == count or times[taken] >= base + now + spent)  # no sample lies on its way
                    and (x * (p * p - q * q) + y * 2.0 * p * q <= 0.0 or x * fx + y * fy >= 0.0)
                ):
                    x, y, path, lost = x + dx, y + dy, path + moved, lost + n * moved
                    peak, now, slides = max(peak, x * x + y * y), now + spent, False
                    continue
            if not slides or (
                abs(force - n) < level * force
                and fx * (p * p - q * q) + fy * 2.0 * p * q > 0.0
                and abs(fx * 2.0 * p * q - fy * (p * p - q * q) + (fx * gy - fy * gx) * (speed / force) ** 2)
                < _ALIGNED * force * speed
            ):
                spent, dx, dy, fast, towards, moved = _creep(f, n0, n1, now, reach, speed, soon)
                while taken < count and times[taken] <= base + now + spent:
                    _, ex, ey, fast_, towards_, part = _creep(
                        f, n0, n1, now, times[taken] - base - now, speed, soon
                    )
                    samples[taken, 0], samples[taken, 1] = x + ex, y + ey
                    samples[taken, 2], samples[taken, 3] = fast_ * cos(towards_), fast_ * sin(towards_)
                    samples[taken, 4], samples[taken, 5] = path + part, lost + n * part
                    samples[taken, 6] = 1.0
                    taken += 1
                x, y, path, lost = x + dx, y + dy, path + moved, lost + n * moved
                peak = max(peak, x * x + y * y)
                p, q = sqrt(fast) * cos(0.5 * towards), sqrt(fast) * sin(0.5 * towards)
                now, slides = now + max(spent, 1e-9 * time_step), fast > still
                continue
            c[P, 0], c[Q, 0], c[T, 0], c[X, 0], c[Y, 0] = p, q, 0.0, x, y
            c[PATH, 0], c[LOST, 0] = path, lost
            order, far = _expand(c, _ORDER, reach, tolerance, (fx, fy, gx, gy), n, n1)
            if count > 0:
                _path(c, order, n, n1)
            spent = _at(c, T, order, far)
            if spent >= reach:
                far, spent = _when(c, order, reach, far), reach
            while taken < count and times[taken] <= base + now + spent:
                s = _when(c, order, times[taken] - base - now, far)
                for value, row in enumerate((X, Y, C, D, PATH, LOST)):
                    samples[taken, value] = _at(c, row, order, s)
                samples[taken, 6] = 1.0
                taken += 1
            outward = x * c[C, 0] + y * c[D, 0]
            x, y, p, q = (
                _at(c, X, order, far),
                _at(c, Y, order, far),
                _at(c, P, order, far),
                _at(c, Q, order, far),
            )
            if count > 0:
                path, lost = _at(c, PATH, order, far), _at(c, LOST, order, far)
            if outward > 0.0 and x * (p * p - q * q) + y * 2.0 * p * q < 0.0:
                peak = max(peak, _rotate(c, order, far) ** 2)
            peak = max(peak, x * x + y * y)
            now += spent
            slides = p * p + q * q > still
    # over still ground along a line, so that the farthest point is an end of it
    end, speed, slows = duration, p * p + q * q, friction * gravity
    if not slides:
        speed, slows = 0.0, 1.0
    elif friction > 0.0:
        end = max(duration, limit + speed / slows)
    along, across = (p * p - q * q) / max(speed, still), 2.0 * p * q / max(speed, still)
    far = 0.0
    stop = speed / slows if slows > 0.0 else end - limit
    while taken < count:
        t = min(times[taken] - limit, stop)
        far = t * (speed - 0.5 * slows * t)
        fast = speed - slows * t if times[taken] - limit < stop else 0.0
        samples[taken, 0], samples[taken, 1] = x + far * along, y + far * across
        samples[taken, 2], samples[taken, 3] = fast * along, fast * across
        samples[taken, 4], samples[taken, 5] = path + far, lost + slows * far * slides
        samples[taken, 6] = fast > 0.0
        taken += 1
    far = stop * (speed - 0.5 * slows * stop)
    peak = max(sqrt(peak), hypot(x + far * along, y + far * across))
    return Slide(nan, began, end, slides and friction == 0.0, peak, samples, steps)
