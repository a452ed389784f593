"""The equations of the recess model as one writes them for scipy: in plain Python, or compiled by numba."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from rockwobble.models import Cylinder, GroundMotion

SolverName = Literal["RK45", "DOP853", "LSODA"]
SOLVERS: tuple[SolverName, ...] = ("RK45", "DOP853", "LSODA")
# of tilts, rates, angles and momenta: times the relative tolerance they are the absolute ones
TOLERANCE_SCALE = np.array([1e-3, 1e-3, 1.0, 1e-3])
State = NDArray[np.float64]
Rates = Any  # (t, y) -> y'; Python or compiled


@dataclass(frozen=True, slots=True, kw_only=True)
class InitialValueProblem:
    """A motion from some time after the uplift on: at rest the equations are singular for scipy.

    Parameters
    ----------
    cylinder : Cylinder
    motion : GroundMotion
        At least a sample longer than `end`: the last stage of a solver stands there.
    start, end : float
        In the time of the ground motion [s].
    state : ndarray, shape (4,)
        Tilt [rad], its rate [rad/s], rolling angle [rad] and momentum per mass [m^2/s] at the start.
    """

    cylinder: Cylinder
    motion: GroundMotion
    start: float
    end: float
    state: State


def python_rates(problem: InitialValueProblem) -> Rates:
    """Return the equations as one writes them for scipy: plain Python and the math module."""
    from math import cos, sin

    b, h = problem.cylinder.base_radius, problem.cylinder.half_height
    I1, I2, g = (3.0 * b * b + 4.0 * h * h) / 12.0, 0.5 * b * b, 9.81
    A, J, C, E = I1 + h * h + b * b, I1 + h * h, I2 + b * b, h * b
    samples = [tuple(row) for row in problem.motion.acceleration.tolist()]
    per_second = 1.0 / problem.motion.time_step

    def rates(t: float, y: Any) -> list[float]:
        theta, omega, phi, L = y
        position = t * per_second
        i = int(position)
        part = position - i
        (ax, ay), (bx, by) = samples[i], samples[i + 1]
        ax += (bx - ax) * part
        ay += (by - ay) * part
        s, c = sin(theta), cos(theta)
        v = s * s / (1.0 + c)
        B = J * s * s + (2.0 * E * s + C * v) * v
        phi_rate = L / B
        sp, cp = sin(phi), cos(phi)
        lever = h * s + b * v
        acceleration = ((J * c + C * v) * s + E * (c * v + s * s)) * phi_rate * phi_rate
        acceleration -= g * (b * c - h * s) + (b * s + h * c) * (ax * cp + ay * sp)
        return [omega, acceleration / A, phi_rate, lever * (ax * sp - ay * cp)]

    return rates


def compiled_rates(problem: InitialValueProblem) -> Rates:
    """Return the same function compiled by numba, which scipy still calls through Python."""
    import numba

    plain: Any = python_rates(problem)
    samples = np.array(problem.motion.acceleration)
    # the same code on an array instead of a list of tuples
    names = dict(zip(plain.__code__.co_freevars, (c.cell_contents for c in plain.__closure__), strict=True))
    names["samples"] = samples
    cells = tuple(_cell(names[name]) for name in plain.__code__.co_freevars)
    function = type(plain)(plain.__code__, plain.__globals__, "rates", None, cells)
    return numba.njit(function)


def _cell(value: object) -> Any:
    return (lambda: value).__closure__[0]  # type: ignore[index]
