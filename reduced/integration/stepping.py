"""Accepted steps of a system.

Nothing here knows of records: the ground acceleration is a + slope t, t from the start of the step. Two
methods take the steps. The recess model, of which millions of runs are asked, has Taylor series (`taylor`).
Planar motion and that on flat ground have a Runge-Kutta pair, which needs the equations only: the four more
variables of the flat-ground model would take as many products of series again, for single runs that take a
millisecond, and planar motion has no spin whose passes take most steps.

What that brought was measured on ten seconds of El Centro (`python tests/benchmarks speed`) at an error of
1e-7 alpha, where LSODA takes more than a thousand times as long as a whole run (396 with a Runge-Kutta
pair). Taylor series take 1108 steps instead of 1744, 0.21 ms instead of 0.52 ms: one for each of the 1000
samples and a hundred more in the passes, of a cost that the tolerance sets (order 5 to 16). Of that
gain 0.08 ms is that nothing on the way of a step is called or counts references (`_compile.inlined`,
`_compile.borrowed`, lists in place of arrays that grow), and 0.02 ms that sine and cosine are taken over
from the last step. Keeping what depends on the motion alone (`problem`) took 0.05 ms off every run. Not
kept, because they brought nothing: other safety factors, a highest order of 12, 5 and 6 among the orders
that are spelt out, shorter chains of operations that wait for each other (slower), fewer Newton
iterations at turning points.

The explicit Runge-Kutta pair is that of order 5(4) by Ch. Tsitouras, "Runge-Kutta pairs of order 5(4)
satisfying only the first column simplifying assumption", Computers & Mathematics with Applications 62 (2011)
770-775, table 1. Seven stages, the last of which is the first of the next step: also across a record sample,
where the forcing has a kink but no jump. States are tuples and the step is a pure function of them: the
compiler keeps all stages in registers, which with `sin_cos` made a step 1.8 times faster than one on arrays.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .._compile import inlined, jit
from ..body import Body
from . import taylor
from .record import Vector, ground
from .result import State
from .systems import System, make_is_flat

C2, C3, C4, C5 = 0.161, 0.327, 0.9, 0.9800255409045097
A2 = (0.161,)
A3 = (-0.008480655492356989, 0.335480655492357)
A4 = (2.8971530571054935, -6.359448489975075, 4.3622954328695815)
A5 = (5.325864828439257, -11.748883564062828, 7.4955393428898365, -0.09249506636175525)
A6 = (
    5.86145544294642,
    -12.92096931784711,
    8.159367898576159,
    -0.071584973281401,
    -0.028269050394068383,
)
# the solution of order 5, and its difference from that of order 4
B5 = (
    0.09646076681806523,
    0.01,
    0.4798896504144996,
    1.379008574103742,
    -3.290069515436081,
    2.324710524099774,
)
ERROR = (
    -0.00178001105222577714,
    -0.0008164344596567469,
    0.007880878010261995,
    -0.1447110071732629,
    0.5823571654525552,
    -0.45808210592918697,
    0.015151515151515152,
)


def make_step(
    derivative: Callable[[Body, State, Vector], State], combine: Callable[..., State]
) -> Callable[..., tuple[State, State, State, float]]:
    """Compiled step of a system.

    ``derivative(body, y, a)`` returns y' under the ground acceleration `a`, and
    ``combine(y, h, weights, slopes)`` returns y + h sum(weights slopes). The step is
    ``step(body, y, k1, h, a, slope) -> (y_new, k_new, error, lowest)``: from the state `y` with
    derivative `k1`, over `h` [s], under the ground acceleration a + slope t; `lowest` is the least
    tilt of all stages and of the new state.
    """

    @jit
    def step(
        body: Body, y: State, k1: State, h: float, a: Vector, slope: Vector
    ) -> tuple[State, State, State, float]:
        y2 = combine(y, h, A2, (k1,))
        k2 = derivative(body, y2, ground(a, slope, C2 * h))
        y3 = combine(y, h, A3, (k1, k2))
        k3 = derivative(body, y3, ground(a, slope, C3 * h))
        y4 = combine(y, h, A4, (k1, k2, k3))
        k4 = derivative(body, y4, ground(a, slope, C4 * h))
        y5 = combine(y, h, A5, (k1, k2, k3, k4))
        k5 = derivative(body, y5, ground(a, slope, C5 * h))
        y6 = combine(y, h, A6, (k1, k2, k3, k4, k5))
        k6 = derivative(body, y6, ground(a, slope, h))
        y_new = combine(y, h, B5, (k1, k2, k3, k4, k5, k6))
        k_new = derivative(body, y_new, ground(a, slope, h))
        none = combine(y, -1.0, (1.0,), (y,))
        error = combine(none, h, ERROR, (k1, k2, k3, k4, k5, k6, k_new))
        lowest = min(y[0], y2[0], y3[0], y4[0], y5[0], y6[0], y_new[0])
        return y_new, k_new, error, lowest

    return step


_SAFETY = 0.9  # aims below the tolerance, so that few steps are repeated
_GROWTH, _SHRINK = 5.0, 0.2  # bounds on the change of the step from one to the next
_SMALL = (_SAFETY / _GROWTH) ** 5  # error ratio below which the step grows by _GROWTH
_MOST_TRIALS = 200  # each trial shortens the step: enough to come down from any length to zero

_Path = tuple[State, State, Vector, Vector]  # Runge-Kutta step: its start, and the motion of the ground


class Stepper(NamedTuple):
    """Compiled functions of one method: its step, and its interpolation within a step.

    ``k`` is a tuple and ``work`` an array that one step leaves to the next, ``path`` says with
    ``work`` what the last step was. The integration never assigns ``work`` anew: counting the references
    to an array would take longer than a tenth of a step.
    """

    workspace: Callable[[State], NDArray[np.float64]]  # y -> work
    restarted: Callable[
        [Body, State, Vector, NDArray[np.float64]], State
    ]  # (body, y, a, work) -> k, where the state or the forcing jumps
    # (body, rtol, y, k, work, h, length, a, slope) -> length taken (0 if h does not fit), length proposed
    # for the next step, number of trials, new state, k, path
    advance: Callable[..., tuple[float, float, int, State, State, object]]
    partial: Callable[..., tuple[State, State]]  # (body, work, path, time) -> (y, y') in the last step
    acceleration: Callable[..., float]  # (work, path) -> theta'' at the start of the last step


@jit
def _no_workspace(y: State) -> NDArray[np.float64]:
    return np.empty(1)


def runge_kutta(system: System, combine: Callable[..., State], error_ratio: Callable[..., float]) -> Stepper:
    """Return the Runge-Kutta steps of one system.

    ``combine(y, h, weights, slopes)`` returns y + h sum(weights slopes), and
    ``error_ratio(body, rtol, h, y, y_new, error, flat)`` the error over what is allowed.
    """
    step = make_step(system.derivative, combine)
    derivative, is_flat = system.derivative, make_is_flat(system.momenta)

    @jit
    def restart(body: Body, y: State, a: Vector, work: NDArray[np.float64]) -> State:
        return derivative(body, y, a)

    @jit
    def advance(
        body: Body,
        rtol: float,
        y: State,
        k: State,
        work: NDArray[np.float64],
        h: float,
        length: float,
        a: Vector,
        slope: Vector,
    ) -> tuple[float, float, int, State, State, _Path]:
        """Take one accepted step from `y`, of length `h` at first and `length` at the most.

        A step that would pass through theta = 0 with spin is repeated: the centrifugal barrier
        cannot be crossed.
        """
        path = (y, k, a, slope)
        proposed = h
        y_new, k_new = y, k
        for trial in range(1, _MOST_TRIALS + 1):
            h = min(proposed, length)
            if proposed < length < 2.0 * proposed:
                h = 0.5 * length  # two even steps in place of a long and a short one
            y_new, k_new, error, lowest = step(body, y, k, h, a, slope)
            flat = is_flat(y) and is_flat(y_new)
            ratio = error_ratio(body, rtol, h, y, y_new, error, flat)
            if ratio <= 1.0 and (lowest > 0.0 or flat):
                longer = h * (_GROWTH if ratio < _SMALL else _SAFETY * ratio**-0.2)
                # a step cut short by the length is no reason to shorten the next
                return h, (longer if h == proposed else max(longer, proposed)), trial, y_new, k_new, path
            shorter = _SHRINK
            if lowest > 0.0 and 1.0 < ratio < np.inf:
                shorter = max(_SHRINK, _SAFETY * ratio**-0.2)
            proposed = h * shorter
        return 0.0, proposed, _MOST_TRIALS, y_new, k_new, path

    @jit
    def partial(body: Body, work: NDArray[np.float64], path: _Path, time: float) -> tuple[State, State]:
        """State and derivative within a step, each by a step of its own, as accurate as the integration."""
        y, k, a, slope = path
        y_new, k_new, _, _ = step(body, y, k, time, a, slope)
        return y_new, k_new

    @inlined
    def acceleration(work: NDArray[np.float64], path: _Path) -> float:
        return float(path[1][1])

    return Stepper(_no_workspace, restart, advance, partial, acceleration)


def taylor_series() -> Stepper:
    """Return the steps of `taylor` for the recess model."""
    return Stepper(taylor.workspace, taylor.restart, taylor.advance, taylor.partial, taylor.acceleration)
