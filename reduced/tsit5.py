"""One step of the explicit Runge-Kutta pair of order 5(4) by Tsitouras.

Ch. Tsitouras, "Runge-Kutta pairs of order 5(4) satisfying only the first column simplifying
assumption", Computers & Mathematics with Applications 62 (2011) 770-775, table 1. Seven stages, the
last of which is the first of the next step: also across a record sample, where the forcing has a
kink but no jump.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from ._compile import jit
from .body import Body

NODES = np.array([0.0, 0.161, 0.327, 0.9, 0.9800255409045097, 1.0, 1.0])
# row i makes stage i; the last row is the solution of order 5
MATRIX = np.array(
    [
        [0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        [0.161, 0.0, 0.0, 0.0, 0.0, 0.0],
        [-0.008480655492356989, 0.335480655492357, 0.0, 0.0, 0.0, 0.0],
        [2.8971530571054935, -6.359448489975075, 4.3622954328695815, 0.0, 0.0, 0.0],
        [5.325864828439257, -11.748883564062828, 7.4955393428898365, -0.09249506636175525, 0.0, 0.0],
        [
            5.86145544294642,
            -12.92096931784711,
            8.159367898576159,
            -0.071584973281401,
            -0.028269050394068383,
            0.0,
        ],
        [
            0.09646076681806523,
            0.01,
            0.4798896504144996,
            1.379008574103742,
            -3.290069515436081,
            2.324710524099774,
        ],
    ]
)
# difference of the solutions of order 5 and 4
ERROR = np.array(
    [
        -0.00178001105222577714,
        -0.0008164344596567469,
        0.007880878010261995,
        -0.1447110071732629,
        0.5823571654525552,
        -0.45808210592918697,
        0.015151515151515152,
    ]
)
STAGES = 7

Derivative = Callable[[Body, NDArray[np.float64], float, float, float, NDArray[np.float64]], None]
Step = Callable[..., float]


def make_step(derivative: Derivative, size: int) -> Step:
    """Return the compiled step for a system of `size` variables.

    ``derivative(body, y, ax, ay, az, out)`` writes y' into `out`. The step is
    ``step(body, y, k, h, a, slope, y_new, error) -> lowest``: from state `y` (size,) with k[0] its
    derivative (k has shape (7, size)), over `h` [s], under the ground acceleration a + slope t
    (both (3,)), it fills the stages k[1:], the new state and the error estimate, and returns the
    lowest first component (the tilt) of all stages and of the new state.
    """

    @jit
    def step(
        body: Body,
        y: NDArray[np.float64],
        k: NDArray[np.float64],
        h: float,
        a: NDArray[np.float64],
        slope: NDArray[np.float64],
        y_new: NDArray[np.float64],
        error: NDArray[np.float64],
    ) -> float:
        lowest = y[0]
        for stage in range(1, STAGES):
            for i in range(size):
                total = MATRIX[stage, 0] * k[0, i]
                for j in range(1, stage):
                    total += MATRIX[stage, j] * k[j, i]
                y_new[i] = y[i] + h * total
            time = NODES[stage] * h
            lowest = min(lowest, y_new[0])
            derivative(
                body,
                y_new,
                a[0] + slope[0] * time,
                a[1] + slope[1] * time,
                a[2] + slope[2] * time,
                k[stage],
            )
        for i in range(size):
            total = ERROR[0] * k[0, i]
            for j in range(1, STAGES):
                total += ERROR[j] * k[j, i]
            error[i] = h * total
        return float(lowest)

    return step
