"""Slides on flat ground by explicit steps in time, which write slides.csv.

x'' = f - n v/|v| as it stands, by DOP853 to rounding, with none of the substitution that keeps the product's
series smooth. Each sample ends a step. At rest |f| and n are compared on a grid and the start refined by
bisection; the first microsecond has the speed that |f| - n gives, along f. Below 1e-9 m/s a body has stopped
if |f| < n: 1e-17 m of way are left.
"""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
from numba import njit
from numpy.typing import NDArray
from scipy.integrate._ivp import dop853_coefficients as dop

G, STEP, COUNT = 9.81, 0.02, 200
TABLE = Path(__file__).with_name("slides.csv")
Array = NDArray[np.float64]
A, B, C = dop.A[:12, :12].copy(), dop.B.copy(), dop.C[:12].copy()
E3, E5 = dop.E3[:12].copy(), dop.E5[:12].copy()


def shaking(seed: int, count: int = 25) -> tuple[Array, float]:
    """Random accelerations (count, 3) [m/s^2] with stops and restarts, and a friction."""
    draw = np.random.default_rng(seed)
    friction = float(draw.uniform(0.05, 0.45))
    samples = draw.normal(size=(count, 3)) * friction * G * draw.uniform(0.6, 3.0)
    samples[:, 2] = np.clip(0.2 * samples[:, 2], -6.0, None)
    return samples, friction


@njit
def excess(f, g, n0, n1, t):
    return np.hypot(f[0] + g[0] * t, f[1] + g[1] * t) - (n0 + n1 * t)


@njit
def rate(f, g, n0, n1, t, y, out):
    speed = np.hypot(y[2], y[3])
    n = (n0 + n1 * t) / speed
    out[0], out[1] = y[2], y[3]
    out[2], out[3] = f[0] + g[0] * t - n * y[2], f[1] + g[1] * t - n * y[3]


@njit
def slide(samples, friction, A, B, C, E3, E5):
    y, new, k = np.zeros(4), np.zeros(4), np.zeros((12, 4))
    moving, h = False, 1e-7
    for i in range(len(samples) - 1):
        f = -samples[i, :2]
        g = (samples[i, :2] - samples[i + 1, :2]) / STEP
        n0, n1 = friction * (G + samples[i, 2]), friction * (samples[i + 1, 2] - samples[i, 2]) / STEP
        t = 0.0
        while t < STEP * (1.0 - 1e-12):
            if not moving:
                grid = 2000
                at, cell = -1.0, (STEP - t) / grid
                if excess(f, g, n0, n1, t) > 0.0:
                    at = t
                else:
                    for j in range(grid):
                        low, high = t + j * cell, t + (j + 1) * cell
                        if excess(f, g, n0, n1, high) > 0.0:
                            for _ in range(60):
                                half = 0.5 * (low + high)
                                if excess(f, g, n0, n1, half) > 0.0:
                                    high = half
                                else:
                                    low = half
                            at = high
                            break
                if at < 0.0:
                    break
                e = min(1e-6, STEP - at)
                first, last = max(excess(f, g, n0, n1, at), 0.0), excess(f, g, n0, n1, at + e)
                speed = 0.5 * (first + last) * e
                if speed <= 0.0:
                    t = at + e
                    continue
                here = f + g * at
                size = np.hypot(here[0], here[1])
                ahead = here + g * e * size / (size + first)
                size = np.hypot(ahead[0], ahead[1])
                y[2], y[3] = speed * ahead[0] / size, speed * ahead[1] / size
                y[0] += (2.0 * first + last) / 6.0 * e * e * ahead[0] / size
                y[1] += (2.0 * first + last) / 6.0 * e * e * ahead[1] / size
                t, moving, h = at + e, True, 1e-9
                continue
            h = min(h, STEP - t)
            for s in range(12):
                new[:] = y
                for j in range(s):
                    new += h * A[s, j] * k[j]
                rate(f, g, n0, n1, t + C[s] * h, new, k[s])
            new[:] = y
            fifth, third = np.zeros(4), np.zeros(4)
            for s in range(12):
                new += h * B[s] * k[s]
                fifth += E5[s] * k[s]
                third += E3[s] * k[s]
            scale = 1e-12 * np.hypot(y[2], y[3])  # of the speed
            five = (fifth[2] ** 2 + fifth[3] ** 2) / scale**2
            three = (third[2] ** 2 + third[3] ** 2) / scale**2
            error = h * five / np.sqrt(2.0 * (five + 0.01 * three)) if five > 0.0 else 0.0
            if error <= 1.0:
                t += h
                y[:] = new
                if np.hypot(y[2], y[3]) < 1e-9 and excess(f, g, n0, n1, t) < 0.0:
                    y[2:] = 0.0
                    moving = False
            h *= min(4.0, max(0.2, 0.9 * max(error, 1e-10) ** -0.125))
    return y


def main() -> None:
    """Write place [m] and velocity [m/s] of each slide at its last sample."""
    rows = [(seed, *slide(*shaking(seed), A, B, C, E3, E5)) for seed in range(COUNT)]
    with TABLE.open("w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["seed", "x", "y", "x_rate", "y_rate"])
        writer.writerows([seed, *(f"{float(value):.13g}" for value in row)] for seed, *row in rows)


if __name__ == "__main__":
    main()
