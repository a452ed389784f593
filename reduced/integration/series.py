"""The series of one step in memory: where their coefficients stand, and their sums at a time.

Coefficients are times (unit of time)^k. Behind them stand sine and cosine at the end of the step, which the
next one may take over.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from .._compile import inlined, jit
from ..body import Body
from .tsit5 import State

ORDER = 16  # the highest; from 12 to 16 the cost is the same at 1e-8, and a high one serves 1e-12
_WIDTH = ORDER + 1
TILT, RATE, ANGLE, MOMENTUM, S, V, COS, SIN, B, Q, W, WW, X, D, RADIAL, ACROSS = (
    _WIDTH * i for i in range(16)
)
TRIG = 16 * _WIDTH  # s, v, cos phi and sin phi at the end of the step
STEPS_LEFT = TRIG + 4  # for so many steps these may still be taken over
_SIZE = STEPS_LEFT + 1

Path = tuple[float, int]  # of the last series: unit of time [s], order


@jit
def workspace(y: State) -> NDArray[np.float64]:
    """Return the memory that a time integration needs for its steps."""
    return np.zeros(_SIZE)


@jit
def state_at(c: NDArray[np.float64], order: int, x: float) -> Any:
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
def partial(body: Body, c: NDArray[np.float64], path: Path, time: float) -> Any:
    """Return the state at `time` [s] after the start of a step and its derivative: of the same series."""
    unit, order = path
    x = time / unit
    acceleration, angle_rate, torque = order * c[RATE + order], order * c[ANGLE + order], 0.0
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
