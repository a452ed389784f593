"""Rocking and wobbling with a tendon and rolling resistance, integrated apart from the package by scipy.

A column of unit mass and radius b, its share `slab` of a slab on it, in the recess or in one plane. From
energies: k = 1 + 4 slab, w = 1 + 2 slab, n gaps that the tendon crosses, e = 2 n b sin(theta/2),

    A theta'' = B'/2 phi'^2 - w (g + az)(b c - h s) - (P0 + K e) de/dtheta - w (h c + b s) a_r + Q_theta,
    (B phi')' = -w D a_t + Q_phi,   D = h s + b (1 - c).

The couple of rolling resistance goes against the horizontal angular velocity (theta', s phi'), of the size
delta times the normal forces on both ends: w (g + az) + k z'' + n (P0 + K e) cos(theta/2).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp
from scipy.optimize import brentq
from tendon import Pier

Array = NDArray[np.float64]
# absolute tolerances: next to upright the azimuth turns fast, and L is small
_LEAST = np.array([1e-16, 1e-15, 1e-12, 1e-18, 1e-18])


@dataclass(frozen=True, kw_only=True)
class Model:
    """Equations of a pier with a length of rolling resistance [m]."""

    pier: Pier
    delta: float = 0.0
    plane: float | None = None  # azimuth of planar motion [rad]

    def __post_init__(self) -> None:
        pier = self.pier
        b, h, k = pier.b, pier.h, 1.0 + 4.0 * pier.slab
        of = object.__setattr__
        of(self, "k", k)
        of(self, "w", 1.0 + 2.0 * pier.slab)
        of(self, "n", 2 if pier.slab else 1)
        of(self, "J", (3.0 * b * b + 4.0 * h * h) / 12.0 + k * h * h)
        of(self, "C", 0.5 * b * b + k * b * b)
        of(self, "E", k * h * b)
        of(self, "A", self.J + k * b * b)

    def rates(self, y: Array, a: Array) -> Array:
        """Return the rates of theta, theta', phi, B phi' and the energy lost; `a` has three components."""
        theta, omega, phi, L, _ = y
        pier, b, h, g = self.pier, self.pier.b, self.pier.h, self.pier.g + a[2]
        s, c, v = math.sin(theta), math.cos(theta), 2.0 * math.sin(0.5 * theta) ** 2
        radial = a[0] * math.cos(phi) + a[1] * math.sin(phi)
        across = a[1] * math.cos(phi) - a[0] * math.sin(phi)
        B = self._turn_inertia(theta)
        spin = L / B if L else 0.0
        half_slope = self.J * s * c + self.E * (c * v + s * s) + self.C * v * s
        tension = pier.prestress + pier.stiffness * 2.0 * self.n * b * math.sin(0.5 * theta)
        opening = self.n * b * math.cos(0.5 * theta)
        moment = half_slope * spin**2 - self.w * (g * (b * c - h * s) + (h * c + b * s) * radial)
        moment -= tension * opening
        turning = -self.w * (h * s + b * v) * across
        lost = 0.0
        rolling = math.hypot(omega, s * spin)
        if self.delta and rolling:
            still = self.w * g + tension * opening / b - self.k * (b * s + h * c) * omega**2
            lift = self.k * (b * c - h * s)
            share = self.delta * omega / rolling
            normal = max(0.0, (still + lift * moment / self.A) / (1.0 + lift * share / self.A))
            moment -= share * normal
            turning -= self.delta * normal * s * s * spin / rolling
            lost = self.delta * normal * rolling
        return np.array([omega, moment / self.A, spin, turning if self.plane is None else 0.0, lost])

    def _turn_inertia(self, theta: float) -> float:
        s, v = math.sin(theta), 2.0 * math.sin(0.5 * theta) ** 2
        return float(self.J * s * s + 2.0 * self.E * s * v + self.C * v * v)

    def _on(self, y: Array, start: float, end: float, ground: object, times: Array) -> tuple[Array, Array]:
        """Integrate to `end`, in a plane from turn to turn and from impact to impact."""
        states = []

        def rates(t: float, z: Array) -> Array:
            return self.rates(z, ground(min(max(t, start), end)))  # type: ignore[operator]

        def impact(_: float, z: Array) -> float:
            return float(z[0])

        def turn(_: float, z: Array) -> float:
            return float(z[1])

        impact.terminal, impact.direction = True, -1.0  # type: ignore[attr-defined]
        turn.terminal = self.delta > 0.0  # type: ignore[attr-defined]
        events = None if self.plane is None else [impact, turn]
        now = start
        while now < end:
            wanted = times[(times > now) & (times <= end)]
            run = solve_ivp(
                rates, (now, end), y, "DOP853", events=events, dense_output=True, rtol=1e-13, atol=_LEAST
            )
            assert run.success, run.message
            reached = wanted[wanted <= run.t[-1]]
            if len(reached):
                states.append(run.sol(reached).T)
            now, y = run.t[-1], run.y[:, -1].copy()
            if run.status == 1 and len(run.t_events[0]):
                taken = self.delta * self.k * self.pier.b
                ratio = (self.A - taken) / (self.A + taken)
                y[4] += 0.5 * self.A * (1.0 - ratio**2) * y[1] ** 2
                y[0], y[1], y[2] = 1e-300, -ratio * y[1], y[2] + math.pi
            elif run.status == 1:
                y[1] = 0.0
                acceleration = self.rates(y, ground(now))[1]  # type: ignore[operator]
                y[1] = math.copysign(1e-18, acceleration)
        return y, np.concatenate(states) if states else np.empty((0, 5))

    def released(self, tilt: float, spin: float, times: Array) -> Array:
        """Return theta, theta', phi, B phi' and the energy lost (n, 5) at `times`, the first of them 0."""
        still = np.zeros(3)
        rate, L = -1e-18 if self.plane is not None else 0.0, self._turn_inertia(tilt) * spin
        start = np.array([tilt, rate, self.plane or 0.0, L, 0.0])
        _, states = self._on(start, 0.0, float(times[-1]), lambda _: still, times)
        return np.concatenate([[start], states])

    def shaken(
        self, acceleration: Array, time_step: float, until: float, start: float = 5e-4
    ) -> tuple[float, Array, Array]:
        """Return the uplift time, and times and states (n, 5) of the samples of the record after it."""
        record = np.array(acceleration)
        if self.plane is not None:
            direction = np.array([math.cos(self.plane), math.sin(self.plane)])
            record[:, :2] = np.outer(record[:, :2] @ direction, direction)
        pier, b, h = self.pier, self.pier.b, self.pier.h

        def between(i: int, t: float) -> Array:
            part = t / time_step - i
            return np.asarray(record[i] * (1.0 - part) + record[i + 1] * part)

        def standing(a: Array) -> float:
            held = (b + self.delta) * (self.w * (pier.g + a[2]) + self.n * pier.prestress)
            return float(self.w * h * math.hypot(a[0], a[1]) - held)

        first = int(np.argmax([standing(a) > 0.0 for a in record])) - 1
        uplift = brentq(
            lambda t: standing(between(first, t)), first * time_step, (first + 1) * time_step, xtol=1e-15
        )
        a, slope = between(first, uplift), (record[first + 1] - record[first]) / time_step
        size = math.hypot(a[0], a[1])
        growth = self.w * (h * (a[:2] @ slope[:2]) / size - (b + self.delta) * slope[2])
        growth /= self.A + self.delta * self.k * b
        normal = self.w * (pier.g + a[2]) + self.n * pier.prestress
        lag = 1.0 + self.delta * normal / (3.0 * self.w * h * size)
        turning = (a[0] * slope[1] - a[1] * slope[0]) / size**2 / lag
        tilt = growth * start**3 / 6.0
        phi = math.atan2(-a[1], -a[0]) + turning * start
        L = self._turn_inertia(tilt) * turning if self.plane is None else 0.0
        y = np.array([tilt, 0.5 * growth * start**2, phi, L, self.delta * normal * tilt])
        now, states = uplift + start, []
        times = np.arange(first + 1, round(until / time_step) + 1) * time_step
        for end in times:
            i = round(end / time_step) - 1
            y, reached = self._on(y, now, end, lambda t, i=i: between(i, t), np.array([end]))
            states.append(reached[-1])
            now = end
        return uplift, times, np.array(states)
