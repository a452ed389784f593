"""Planar rocking with impacts that conserve the moment of momentum, in vectors from the pivot corner.

State are the vector from that corner to the mass centre and the rate of turn about y. No angle is integrated
and no coefficient of restitution enters: at a closing the moment of momentum about the next corner is kept.
"""

from __future__ import annotations

import itertools
import math

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from rockwobble.reduced.body import body_of

from .definitions import BenchmarkRun, G

Array = NDArray[np.float64]


def rocked(run: BenchmarkRun, times: Array) -> Array:
    """Tilt [rad], tilt rate [rad/s] and azimuth [rad] at these times [s], shape (n, 3); at rest 0."""
    assert run.motion is not None
    body = body_of(run.cylinder, G)
    b, h, about_corner = body.b, body.h, body.I1 + body.b**2 + body.h**2
    step, push = run.motion.time_step, np.append(run.motion.acceleration[:, 0], 0.0)
    kinks = step * np.arange(len(push) - 1)
    known = {0.0: (0.0, 0.0, 0.0)}
    side, now, state = 0.0, 0.0, np.zeros(3)
    for begin, end in itertools.pairwise(np.union1d(np.round(times, 12), np.round(kinks, 12))):
        i = min(int((begin + 1e-9) / step), len(push) - 1)
        slope = (push[i + 1] - push[i]) / step if i < len(push) - 2 else 0.0
        level = push[i] - slope * i * step if i < len(push) - 1 else 0.0
        now = begin
        if side == 0.0:
            if abs(level + slope * end) * h <= G * b:
                known[float(end)] = (0.0, 0.0, 0.0)
                continue
            # the ground goes towards x, the body leans back over its other corner
            side = -math.copysign(1.0, level + slope * end)
            now = max(begin, (-side * G * b / h - level) / slope)
            state = np.array([-side * b, h, 0.0])
        while now < end:

            def rates(time: float, y: Array) -> list[float]:
                x, z, turn = y
                return [turn * z, -turn * x, (G * x - (level + slope * time) * z) / about_corner]  # noqa: B023

            def closes(time: float, y: Array) -> float:
                return side * (y[0] * h + side * b * y[1])  # noqa: B023

            closes.terminal, closes.direction = True, -1.0  # type: ignore[attr-defined]
            part = solve_ivp(rates, (now, end), state, "DOP853", rtol=1e-13, atol=1e-15, events=closes)
            now, state = float(part.t[-1]), part.y[:, -1]
            if part.status == 1:
                velocity = state[2] * np.array([h, side * b])
                side = -side
                kept = body.I1 * state[2] + h * velocity[0] + side * b * velocity[1]
                state = np.array([-side * b, h, kept / about_corner])
        tilt = math.atan2(side * state[0] * h + b * state[1], h * state[1] - side * state[0] * b)
        known[float(end)] = (tilt, side * state[2], 0.0 if side > 0.0 else math.pi)
    return np.array([known[float(time)] for time in np.round(times, 12)])


def maximum_after(tilt: float, run: BenchmarkRun, closings: int) -> float:
    """Largest tilt after so many impacts on still ground, from the one before them [rad]: a closed form."""
    body = body_of(run.cylinder, G)
    alpha = body.alpha
    sine = math.sin(alpha) ** 2 / (body.I1 / (body.b**2 + body.h**2) + 1.0)
    kept = (1.0 - 2.0 * sine) ** (2 * closings)
    return alpha - math.acos(math.cos(alpha) + kept * (math.cos(alpha - tilt) - math.cos(alpha)))
