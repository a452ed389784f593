"""Steps of the flat-ground model with rolling resistance where the couple turns faster than the body moves.

A body that sinks to upright while it turns about the vertical comes into a crawl: gyroscopic forces hold the
push, the speed falls with the tilt, and the couple, which has the direction of so small a velocity, follows
that within A w/(delta N). Explicit steps are bound to this time, and take a million where the motion itself
changes in ten. So a step that is longer is linearly implicit, by the method RODAS of order 4(3) with a
Jacobian by differences: E. Hairer and G. Wanner, "Solving Ordinary Differential Equations II", 2nd ed.
(1996), section IV.7 and the code of its authors.

With Lambda and S the velocity of a crawl is a small difference of large numbers. The angular velocity itself
has no such terms: with the mass centre at r = (-D'', 0, D') from the contact, in (outward along the lean,
across it, up), and w = (v, theta', Omega),

    phi' = Omega - c v/s,   V = w x r,   (I w)' + mu r x V' = r x (-a_r, -a_t, -g - az) + couple,

where a prime is the derivative in the frame that turns with phi', plus phi' times what the vertical adds.

====== ======== =====================================================================================
symbol unit     meaning
====== ======== =====================================================================================
v      rad/s    s psi', the horizontal angular velocity along the lean
Omega  rad/s    the vertical one, phi' + c psi' = tau' - t v
D''    m        b c - h s
D'     m        b s + h c
I      m^2      I2 along the axis (s, 0, c), I1 across it
q      -        theta, theta', phi, v, Omega; tau, X, Y and the energy lost, on which nothing depends
====== ======== =====================================================================================
"""

from __future__ import annotations

from collections.abc import Callable
from math import inf, nan, sqrt
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .._compile import inlined, jit
from ..body import Body
from ..equations import base_inertia
from ..rolling import (
    PIVOTS,
    across_inertia,
    across_rate,
    couple,
    pivot,
    twist_share,
)
from ..trigonometry import sin_cos
from .record import Vector, ground
from .result import State, write
from .stepping import Stepper
from .systems import scales

Array = NDArray[np.float64]
_Path = tuple[Any, float]

GAMMA = 0.25
# of each stage: share of those before it in its state, and in its slope over h
STATES = np.array(
    [
        (0.0, 0.0, 0.0, 0.0, 0.0),
        (1.544, 0.0, 0.0, 0.0, 0.0),
        (0.9466785280815826, 0.2557011698983284, 0.0, 0.0, 0.0),
        (3.314825187068521, 2.896124015972201, 0.9986419139977817, 0.0, 0.0),
        (1.221224509226641, 6.019134481288629, 12.53708332932087, -0.6878860361058950, 0.0),
        (1.221224509226641, 6.019134481288629, 12.53708332932087, -0.6878860361058950, 1.0),
    ]
)
SLOPES = np.array(
    [
        (0.0, 0.0, 0.0, 0.0, 0.0),
        (-5.6688, 0.0, 0.0, 0.0, 0.0),
        (-2.430093356833875, -0.2063599157091915, 0.0, 0.0, 0.0),
        (-0.1073529058151375, -9.594562251023355, -20.47028614809616, 0.0, 0.0),
        (7.496443313967647, -10.24680431464352, -33.99990352819905, 11.70890893206160, 0.0),
        (8.083246795921522, -7.981132988064893, -31.52159432874371, 16.31930543123136, -6.058818238834054),
    ]
)
# of each stage: its share in the state between, q (1 - x) + x (q_new + (1 - x) (first + x second))
BETWEEN = np.array(
    [
        (10.12623508344586, -7.487995877610167, -34.80091861555747, -7.992771707568823, 1.025137723295662),
        (-0.6762803392801253, 6.087714651680015, 16.43084320892478, 24.76722511418386, -6.594389125716872),
    ]
)
TIMES = np.array([0.0, 0.386, 0.21, 0.63, 1.0, 1.0])
# of the change of the slope with time
DRIFTS = np.array([0.25, -0.1043, 0.1035, -0.0362, 0.0, 0.0])

_CORE, _OTHERS, _ALL, _STAGES = 5, 4, 9, 6
# rows of the workspace: where `q` is, and where it comes to; a stage and its slope; the change of the slope
# in a step, and the first slope; then the Jacobian, a row for each variable, the inverse and the changes
START, END, ERROR = 0, 1, 2
_STAGE, _SLOPE, _DRIFT, _FIRST, _JACOBIAN, _MATRIX, _INVERSE, _CHANGES, _ROWS = 3, 4, 5, 6, 7, 12, 17, 22, 28
_SMALL = 1e-6  # of a variable, by which a derivative is taken: between its bend and its rounding
_SAFETY, _GROWTH, _SHRINK = 0.9, 5.0, 0.2
# squared cosine of the turn of the velocity up to which a step is taken
_FOLLOWED = 0.64


@jit
def rates_on_flat_ground(body: Body, work: Array, row: int, a: Vector, into: int) -> None:
    """Write the derivative of the `q` in a row of `work` under the ground acceleration `a` into another."""
    theta, omega, phi, v, Omega = work[row, 0], work[row, 1], work[row, 2], work[row, 3], work[row, 4]
    s, c = sin_cos(theta)
    sin_phi, cos_phi = sin_cos(phi)
    a_r, a_t = a[0] * cos_phi + a[1] * sin_phi, a[1] * cos_phi - a[0] * sin_phi
    beside, above = body.b * c - body.h * s, body.b * s + body.h * c
    phi_rate, tau_rate = Omega - c * v / s, Omega + s / (1.0 + c) * v
    # I w = I1 w + more (w . axis) axis
    more, spin = body.I2 - body.I1, s * v + c * Omega
    along = body.I1 * v + more * spin * s + body.mu * above * (Omega * beside + v * above)
    free = (-phi_rate * along - above * a_r - beside * (body.g + a[2])) / body.A
    tilting, turning, power = couple(body, s, c, omega, v / s, free, a[2], 0.0)
    # of v' and Omega', whose inertia about the contact is not diagonal
    carried = a_t + body.mu * omega * ((Omega + phi_rate) * above - v * beside)
    swung = c * v - s * Omega
    first = above * carried + turning + omega * (body.I1 * phi_rate - more * (swung * s + spin * c))
    second = beside * carried - omega * more * (swung * c - spin * s)
    I_v, P = pivot(body, s, c)
    I_r = body.I1 * c * c + body.I2 * s * s + body.mu * above * above
    determinant = I_r * I_v - P * P
    work[into, 0] = omega
    work[into, 1] = free + tilting / body.A
    work[into, 2] = phi_rate
    work[into, 3] = (I_v * first + P * second) / determinant
    work[into, 4] = (I_r * second + P * first) / determinant
    work[into, 5] = tau_rate
    work[into, 6] = body.b * tau_rate * sin_phi
    work[into, 7] = -body.b * tau_rate * cos_phi
    work[into, 8] = power


@jit
def _invert(work: Array) -> None:
    """Write the inverse of the matrix, which is left as the unit matrix."""
    core = work.shape[1] - _OTHERS
    for i in range(core):
        for k in range(core):
            work[_INVERSE + i, k] = 1.0 if i == k else 0.0
    for i in range(core):
        largest = i
        for j in range(i + 1, core):
            if abs(work[_MATRIX + j, i]) > abs(work[_MATRIX + largest, i]):
                largest = j
        scale = 1.0 / work[_MATRIX + largest, i]
        for first in (_MATRIX, _INVERSE):
            for k in range(core):
                row = work[first + largest, k] * scale
                work[first + largest, k] = work[first + i, k]
                work[first + i, k] = row
        for j in range(core):
            factor = work[_MATRIX + j, i]
            if j != i and factor != 0.0:
                for k in range(core):
                    work[_MATRIX + j, k] -= factor * work[_MATRIX + i, k]
                    work[_INVERSE + j, k] -= factor * work[_INVERSE + i, k]


@jit
def implicit_step(body: Body, work: Array, h: float, a: Vector, slope: Vector) -> None:
    """Write `q` after a step of length `h` [s] under the ground acceleration a + slope t, and its error.

    Not a number where a stage is not tilted.
    """
    size = work.shape[1]
    core, stages = size - _OTHERS, size - 3
    rates_on_flat_ground(body, work, START, a, _FIRST)
    speed = sqrt(work[START, 1] ** 2 + work[START, 3] ** 2)
    for i in range(size):
        work[_STAGE, i] = work[START, i]
    for j in range(core):
        scale = work[START, 0] if j == 0 else 1.0 if j == 2 else body.p if j == 4 else speed
        work[_STAGE, j] = work[START, j] + _SMALL * scale
        rates_on_flat_ground(body, work, _STAGE, a, _JACOBIAN + j)
        for i in range(size):
            change = work[_JACOBIAN + j, i] - work[_FIRST, i]
            work[_JACOBIAN + j, i] = change / (work[_STAGE, j] - work[START, j])
        work[_STAGE, j] = work[START, j]
    rates_on_flat_ground(body, work, START, ground(a, slope, h), _DRIFT)
    for i in range(size):
        work[_DRIFT, i] -= work[_FIRST, i]
    for i in range(core):
        for j in range(core):
            work[_MATRIX + i, j] = (1.0 / (GAMMA * h) if i == j else 0.0) - work[_JACOBIAN + j, i]
    _invert(work)

    for m in range(stages):
        for i in range(size):
            work[_STAGE, i] = work[START, i]
            for j in range(min(m, core)):
                work[_STAGE, i] += STATES[m, j] * work[_CHANGES + j, i]
        if not work[_STAGE, 0] > 0.0:
            work[END, 0] = nan
            return
        rates_on_flat_ground(body, work, _STAGE, ground(a, slope, TIMES[m] * h), _SLOPE)
        for i in range(size):
            work[_SLOPE, i] += DRIFTS[m] * work[_DRIFT, i]
            for j in range(min(m, core)):
                work[_SLOPE, i] += SLOPES[m, j] / h * work[_CHANGES + j, i]
        for i in range(core):
            work[_CHANGES + m, i] = 0.0
            for j in range(core):
                work[_CHANGES + m, i] += work[_INVERSE + i, j] * work[_SLOPE, j]
        for i in range(core, size):
            for j in range(core):
                work[_SLOPE, i] += work[_JACOBIAN + j, i] * work[_CHANGES + m, j]
            work[_CHANGES + m, i] = GAMMA * h * work[_SLOPE, i]
    for i in range(size):
        work[ERROR, i] = work[_CHANGES + _STAGES - 1, i]
        work[END, i] = work[_STAGE, i] + work[ERROR, i]


@jit
def write_rates(body: Body, y: State, work: Array) -> None:
    """Write the `q` of a state as that where a step begins."""
    s, c = sin_cos(y[0])
    t = s / (1.0 + c)
    v = across_rate(body, s, c, y[3], y[5])
    Omega = y[5] * base_inertia(body, t) / (body.J * body.C - body.E * body.E) - t * v
    write((y[0], y[1], y[2], v, Omega, y[4], y[6], y[7], y[8]), work[START])


@jit
def between(work: Array, x: float) -> None:
    """Write the `q` at the share `x` of the last step, with an error of its order, in place of its stage."""
    size = work.shape[1]
    for i in range(size):
        first = second = 0.0
        for j in range(size - _OTHERS):
            first += BETWEEN[0, j] * work[_CHANGES + j, i]
            second += BETWEEN[1, j] * work[_CHANGES + j, i]
        work[_STAGE, i] = work[START, i] * (1.0 - x) + x * (work[END, i] + (1.0 - x) * (first + x * second))


@jit
def state_of(body: Body, work: Array, row: int, side: float) -> State:
    """Return the state of the `q` in a row of `work`."""
    theta, omega, phi, v, Omega = work[row, 0], work[row, 1], work[row, 2], work[row, 3], work[row, 4]
    s, c = sin_cos(theta)
    t = s / (1.0 + c)
    H, tau_rate = base_inertia(body, t), Omega + t * v
    Lambda = s * H * (twist_share(body, s, c) * tau_rate - v)
    S = (body.J * body.C - body.E * body.E) / H * tau_rate
    return theta, omega, phi, Lambda, work[row, 5], S, work[row, 6], work[row, 7], work[row, 8], side


@inlined
def _ratio(body: Body, rtol: float, work: Array) -> float:
    """Return the largest error over what is allowed; infinite where the velocity turned too far."""
    theta, omega, v, Omega = work[START, 0], work[START, 1], work[START, 3], work[START, 4]
    along = omega * work[END, 1] + v * work[END, 3]
    speeds = (omega * omega + v * v) * (work[END, 1] ** 2 + work[END, 3] ** 2)
    if not (work[END, 0] > 0.0 and along > 0.0 and along * along > _FOLLOWED * speeds):
        return inf
    per_tilt, per_rate = scales(body, rtol, theta, omega, abs(v), False)
    ratio = max(abs(work[ERROR, 0]) * per_tilt, max(abs(work[ERROR, 1]), abs(work[ERROR, 3])) * per_rate)
    ratio = max(ratio, abs(work[ERROR, 4]) / (rtol * abs(Omega) + 1.0 / per_rate))
    ratio = max(ratio, max(abs(work[ERROR, 2]), abs(work[ERROR, 5])) / rtol)
    return float(max(ratio, max(abs(work[ERROR, 6]), abs(work[ERROR, 7])) / (rtol * body.b)))


def stiff_steps(explicit: Stepper, derivative: Callable[..., State]) -> Stepper:
    """Return the steps of the flat-ground model with rolling resistance: explicit ones, or implicit."""

    @jit
    def workspace(y: State) -> Array:
        return np.empty((_ROWS, _ALL))

    @inlined
    def is_stiff(body: Body, y: State, h: float) -> bool:
        """Return whether the couple turns within a step of length `h` [s] from `y`."""
        if y[9] == PIVOTS or (y[3] == 0.0 and y[5] == 0.0):
            return False
        s, c = sin_cos(y[0])
        v = across_rate(body, s, c, y[3], y[5])
        turned = body.delta * body.g * h / min(body.A, across_inertia(body, s, c, True))
        return 0.0 < y[1] * y[1] + v * v < turned * turned

    @jit
    def advance(
        body: Body,
        rtol: float,
        y: State,
        k: State,
        work: Array,
        h: float,
        length: float,
        a: Vector,
        slope: Vector,
    ) -> tuple[float, float, int, State, State, _Path]:
        """Take a step as `stepping.Stepper.advance`; an implicit one is tried once."""
        path = (y, k, a, slope)
        taken = min(h, length)
        if not is_stiff(body, y, taken):
            taken, proposed, trials, y_new, k_new, found = explicit.advance(
                body, rtol, y, k, work, h, length, a, slope
            )
            return taken, proposed, trials, y_new, k_new, (found, 0.0)
        write_rates(body, y, work)
        implicit_step(body, work, taken, a, slope)
        ratio = _ratio(body, rtol, work)
        if not ratio <= 1.0:
            shorter = max(_SHRINK, _SAFETY * ratio**-0.25) if ratio < inf else _SHRINK
            return 0.0, taken * shorter, 1, y, k, (path, taken)
        longer = taken * min(_GROWTH, _SAFETY * max(ratio, 1e-9) ** -0.25)
        y_new = state_of(body, work, END, y[9])
        k_new = derivative(body, y_new, ground(a, slope, taken))
        return taken, (longer if taken == h else max(longer, h)), 1, y_new, k_new, (path, taken)

    @jit
    def partial(body: Body, work: Array, path: _Path, time: float) -> tuple[State, State]:
        """Return the state and its derivative in the last step."""
        start, length = path
        if length == 0.0:
            return explicit.partial(body, work, start, time)
        y, _, a, slope = start
        between(work, time / length)
        y_at = state_of(body, work, _STAGE, y[9])
        return y_at, derivative(body, y_at, ground(a, slope, time))

    @inlined
    def acceleration(work: Array, path: _Path) -> float:
        return explicit.acceleration(work, path[0])

    return Stepper(workspace, explicit.restarted, advance, partial, acceleration)
