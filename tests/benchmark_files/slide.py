"""A cylinder that slides from rest, x'' = -a - mu (g + az) v/|v|: by model, integration, closed form.

Its motions of the ground go on until it slides, and it slides on until they end.
"""

from __future__ import annotations

import itertools
import math

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from rockwobble import reduced
from rockwobble.models import Case

from .definitions import BenchmarkRun, G

Array = NDArray[np.float64]


def modelled(run: BenchmarkRun, times: Array) -> Array:
    """Path (n, 2) [m] at evenly spaced times, by Taylor series of the reduced model."""
    case = Case(run.cylinder, run.motion, friction=run.friction, duration=times[-1], gravity=G)
    trace = reduced.simulate(case, support="flat", rtol=1e-13, sample_step=float(times[1]))
    return np.array(trace.displacement[: len(times)])


def integrated(run: BenchmarkRun, times: Array) -> Array:
    """Path by Dormand and Prince in velocity components; at rest on still ground."""
    assert run.motion is not None
    record, dt = np.array(run.motion.acceleration), run.motion.time_step
    record = np.pad(record, ((0, 0), (0, 3 - record.shape[1])))
    ends, mu = dt * np.arange(len(record)), run.friction
    breaks = np.union1d(np.round(times[times <= ends[-1]], 12), np.round(ends, 12))
    state, sliding, states = np.zeros(4), False, {0.0: np.zeros(4)}
    for begin, finish in itertools.pairwise(breaks.tolist()):
        i = min(int((begin + 1e-9) / dt), len(record) - 2)
        slope = (record[i + 1] - record[i]) / dt

        def ground(t: float, i: int = i, slope: Array = slope) -> Array:
            return np.asarray(record[i] + slope * (t - i * dt))

        def surplus(t: float) -> float:
            ax, ay, az = ground(t)
            return math.hypot(ax, ay) - mu * (G + az)

        def rate(t: float, y: Array) -> list[float]:
            ax, ay, az = ground(t)
            along = y[2:] if y[2] or y[3] else np.array([-ax, -ay])
            ux, uy = mu * (G + az) * along / math.hypot(*along)
            return [y[2], y[3], -ax - ux, -ay - uy]

        if not sliding and surplus(finish) > 0.0:
            sliding = True
            begin = begin if surplus(begin) > 0.0 else brentq(surplus, begin, finish, xtol=1e-15, rtol=1e-15)
        if sliding:
            state = solve_ivp(rate, (begin, finish), state, method="DOP853", rtol=1e-13, atol=1e-16).y[:, -1]
        states[finish] = state
    speed = math.hypot(*state[2:])
    after = np.clip(times - ends[-1], 0.0, speed / (mu * G))[:, None]
    rest = state[:2] + state[2:] * after * (1.0 - 0.5 * mu * G * after / speed)
    known = [states.get(float(time)) for time in np.round(times, 12)]
    return np.array([last if row is None else row[:2] for row, last in zip(known, rest, strict=True)])


def closed(name: str, run: BenchmarkRun) -> float | None:
    """Closed form of a quantity under a one-directional ramp or pulse; None otherwise."""
    assert run.motion is not None
    if len(run.motion.acceleration) > 2:
        return None
    first, last = run.motion.acceleration
    shift, mu, length = (
        run.levels["slide_level"] * run.cylinder.base_radius,
        run.friction,
        run.motion.duration,
    )
    if not first.any():  # mu (g + az) is the friction, in kinetic as in static contact
        ramp = (last[0] - mu * last[2]) / length
        return mu * G / ramp + (6.0 * shift / ramp) ** (1.0 / 3.0)
    push = math.hypot(*first)
    if name == "slide_time":
        return math.sqrt(2.0 * shift / (push - mu * G))
    return push * length**2 * (push - mu * G) / (2.0 * mu * G) / run.cylinder.base_radius
