"""The second formulation: Newton and Euler in vectors (tests/reference/rigid_body.py), sampled.

It has the axis and the angular velocity of a rigid body for its state, no Lagrangian, no angles and no
constant but radius, height and inertias: nothing of what `rockwobble.reduced` is made of.
"""

from __future__ import annotations

import itertools
import math
from typing import NamedTuple

import numba
import numpy as np
from numpy.typing import NDArray
from rigid_body import crossing, energy, excess, lifted, step, tilt_of

from rockwobble.reduced.body import body_of

from .definitions import BenchmarkRun, G
from .impact import rocked

Array = NDArray[np.float64]
REST = 1e-8  # rest threshold over alpha
NOTHING = 1e-9  # [s]
EARLY = 3e-4  # of the shortest time scale: of the series that follows an uplift


class Sampled(NamedTuple):
    """Samples of one motion, (n,) each; tilt 0 at rest."""

    time: Array
    tilt: Array
    tilt_rate: Array
    azimuth: Array


@numba.njit  # uncached: a cache would miss changes of other files
def advance(
    P: Array, p: float, y: Array, length: float, a: Array, slope: Array, rtol: float, first: float
) -> tuple[Array, float]:
    """State after `length` under a + slope t, and the size of a next step."""
    at, size = 0.0, first
    while at < length:
        tried = min(size, length - at)
        new, error = step(P, p, y, tried, a + slope * at, slope, rtol)
        if not error <= 1.0:
            size = tried * max(0.2, 0.9 * error**-0.125)
            continue
        y, at = new, length if at + tried >= length else at + tried
        grown = tried * min(5.0, 0.9 * max(error, 1e-9) ** -0.125)
        size = grown if tried >= size else max(grown, size)  # last step of a piece, possibly cut short
    return y, size


def sampled(
    run: BenchmarkRun, spacing: float, end: float, *, rtol: float = 1e-13, gyroscopic: float = 1.0
) -> Sampled:
    """Samples of a run at a step of `spacing`, optionally without its gyroscopic term."""
    times = spacing * np.arange(round(end / spacing) + 1)
    if run.closes:
        return Sampled(times, *rocked(run, times).T)
    body = body_of(run.cylinder, G)
    held = (0.0, 0.0)
    if run.tendon is not None:
        assert run.model == "recess", "on flat ground the base wanders from the anchor"
        held = run.tendon.prestress * G, run.tendon.stiffness * G / body.b
    P = np.array([body.b, body.h, body.I1, body.I2, G, float(run.model == "recess"), *held, gyroscopic])
    record, dt = _record(run)
    kinks = dt * np.arange(len(record)) if len(record) else np.array([0.0])
    breaks = np.union1d(np.round(times, 12), np.round(kinks[kinks <= times[-1] + 1e-9], 12))
    y = _start(run)
    moving = run.initial is not None
    proposed = 1e-4 / body.p
    states = {0.0: y}
    for begin, finish in itertools.pairwise(breaks):
        i = int((begin + 1e-9) / dt) if len(record) else 0
        a, slope = np.zeros(3), np.zeros(3)
        if i < len(record) - 1:
            slope = (record[i + 1] - record[i]) / dt
            a = record[i] + slope * (begin - i * dt)
        length = finish - begin
        if not moving:
            y, moving, at = _lifted(P, body.p2, y, a, slope, length)
            if moving:
                y, proposed = advance(P, body.p, y, length - at, a + slope * at, slope, rtol, 1e-5 / body.p)
        else:
            y, proposed = advance(P, body.p, y, length, a, slope, rtol, proposed)
        f = excess(P, a + slope * length)
        least = G * (
            body.b * math.sin(REST * body.alpha) - 2.0 * body.h * math.sin(0.5 * REST * body.alpha) ** 2
        )
        if moving and f < 0.0 and energy(P, y) < least * -f * body.h / (G * body.b):
            moving = False
            y = np.array([0.0, 0.0, 1.0, 0.0, 0.0, 0.0, y[6]])
        states[float(finish)] = y
        if y[2] <= 0.0:  # on its side, where it stays
            break
    chosen = np.array([states.get(float(time), y) for time in np.round(times, 12)])
    tilts = [tilt_of(one) if one[0] or one[1] else (0.0, 0.0) for one in chosen]
    return Sampled(times, *np.array(tilts).T, chosen[:, 6])


def _lifted(
    P: Array, p2: float, y: Array, a: Array, slope: Array, length: float
) -> tuple[Array, bool, float]:
    """State at an uplift within `length`, whether there is one, and its time."""
    jump = excess(P, a) > 0.0
    if not jump and excess(P, a + slope * length) <= 0.0:
        return y, False, length
    lift = 0.0 if jump else crossing(P, a, slope, 0.0, length)
    ground = a + slope * lift
    unit = 1.0 / max(math.sqrt(p2), math.hypot(slope[0], slope[1]) / math.hypot(ground[0], ground[1]))
    if length - lift < NOTHING:  # an uplift at the very end belongs to the next piece
        return y, False, length
    early = min(EARLY * unit, length - lift)
    return lifted(P, p2, ground, slope, early, y[6], jump), True, lift + early


def _record(run: BenchmarkRun) -> tuple[Array, float]:
    if run.motion is None:
        return np.zeros((0, 3)), 1.0
    samples = np.array(run.motion.acceleration)
    return np.pad(samples, ((0, 0), (0, 3 - samples.shape[1]))), run.motion.time_step


def _start(run: BenchmarkRun) -> Array:
    if run.initial is None:
        return np.array([0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0])
    tilt, rate = run.initial.tilt, run.initial.tilt_rate
    angle, spin = run.initial.rolling_angle, run.initial.rolling_rate
    s, cos, sin = math.sin(tilt), math.cos(angle), math.sin(angle)
    turning = [-spin * s * cos - rate * sin, -spin * s * sin + rate * cos, spin * (1.0 - math.cos(tilt))]
    return np.array([s * cos, s * sin, math.cos(tilt), *turning, angle])
