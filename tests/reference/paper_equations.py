"""An independent reference: equations (18) and (19) as the paper prints them, by scipy.

Nothing is shared with the package: its own inertia (16), the printed sums instead of the stable
form, phi' instead of its momentum, and uplift from a start a thousand times earlier.
"""

import math

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq


class PaperModel:
    """A homogeneous cylinder of unit mass; state (theta, theta', phi, phi')."""

    def __init__(self, b, h, g=9.81):
        self.b, self.h, self.g = b, h, g
        self.I1, self.I2 = (3 * b * b + 4 * h * h) / 12, b * b / 2

    def rates(self, y, ax, ay):
        th, om, phi, rate = y
        b, h, g, I1, I2 = self.b, self.h, self.g, self.I1, self.I2
        s, c = math.sin(th), math.cos(th)
        sp, cp = math.sin(phi), math.cos(phi)
        bracket = (I2 - I1 + b * b - h * h) * c * s - (I2 + b * b) * s - h * b * (1 + c) + 2 * h * b * c * c
        right = -h * ax * cp * c - b * ax * cp * s - h * ay * sp * c - b * ay * sp * s
        acc = (right - b * g * c + h * g * s - bracket * rate**2) / (I1 + h * h + b * b)
        inertia = (I1 - I2 + h * h - b * b) * s * s + 2 * (I2 + b * b) * (1 - c) + 2 * h * b * s * (1 - c)
        coupling = (
            2 * (I2 - I1 - h * h + b * b) * s * (1 - c)
            + 2 * h * b * (2 * s * s + c - 1)
            + 2 * (I1 + h * h) * s
        )
        right = -b * ay * (1 - c) * cp + b * ax * sp * (1 - c) - h * ay * s * cp + h * ax * sp * s
        return [om, acc, rate, (right - coupling * rate * om) / inertia]

    def free(self, y, times, rtol=1e-12):
        run = solve_ivp(
            lambda _, y: self.rates(y, 0.0, 0.0),
            (0.0, times[-1]),
            y,
            "DOP853",
            t_eval=times,
            rtol=rtol,
            atol=1e-16,
        )
        assert run.success
        return run.y

    def excited(self, acceleration, time_step, until, rtol=1e-11, start=1e-5):
        """Uplift time, and the states at the samples after uplift up to `until` [s]."""
        threshold = self.g * self.b / self.h
        size = np.hypot(*acceleration.T)
        first = int(np.argmax(size >= threshold)) - 1

        def ground(t):
            i = min(int(t / time_step), len(acceleration) - 2)
            part = t / time_step - i
            return acceleration[i] * (1 - part) + acceleration[i + 1] * part

        begin, end = first * time_step, (first + 1) * time_step
        uplift = brentq(lambda t: np.hypot(*ground(t)) - threshold, begin, end, xtol=1e-16)
        a = ground(uplift)
        slope = (acceleration[first + 1] - acceleration[first]) / time_step
        I_o = self.I1 + self.h**2 + self.b**2
        growth = (a @ slope) / np.hypot(*a) * self.h / I_o
        turning = (a[0] * slope[1] - a[1] * slope[0]) / (a @ a)
        phi = math.atan2(-a[1], -a[0])
        y = [growth * start**3 / 6, growth * start**2 / 2, phi + turning * start, turning]
        t, states = uplift + start, []
        for i in range(first + 1, round(until / time_step) + 1):
            end = i * time_step
            y = solve_ivp(
                lambda t, y, end=end: self.rates(y, *ground(min(t, end * (1 - 1e-16)))),
                (t, end),
                y,
                "DOP853",
                rtol=rtol,
                atol=1e-18,
            ).y[:, -1]
            t = end
            states.append(y)
        return uplift, phi, np.array(states)
