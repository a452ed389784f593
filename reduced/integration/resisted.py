"""The models with rolling resistance as systems of first order.

Behind the variables of a model (`systems`) stands the energy lost so far, per unit mass. Motion in one plane
is that in the recess without spin.
"""

from __future__ import annotations

from collections.abc import Callable
from math import copysign, sqrt

from .._compile import jit
from ..body import Body
from ..equations import energy, flat_rhs, recess_motion
from ..restoring import standing_force
from ..rolling import couple, creep_rate, twist_share
from ..trigonometry import sin_cos
from .record import Vector
from .result import State
from .stepping import runge_kutta
from .systems import FLAT, RECESS, System, Weights, flat_combine, flat_ratio, scales

# least spin over still ground, over that of steady wobble, in tolerances. In a pass the couple lowers spin by
# orders of magnitude but never reverses it, which the error of one step could do
_LEAST_SPIN = 10.0


@jit
def _recess_derivative(body: Body, y: State, a: Vector) -> State:
    free, phi_rate, torque, s, c = recess_motion(body, y[0], y[2], y[3], a[0], a[1], a[2])
    tilting, turning, power = couple(body, s, c, y[1], -phi_rate, free, a[2])
    return y[1], free + tilting / body.A, phi_rate, torque - s * turning, power


@jit
def _flat_derivative(body: Body, y: State, a: Vector) -> State:
    omega, free, phi_rate, Lambda_rate, tau_rate, S_rate = flat_rhs(
        body, y[0], y[1], y[2], y[3], y[4], y[5], a[0], a[1], a[2]
    )
    s, c = sin_cos(y[0])
    tilting, turning, power = couple(body, s, c, omega, tau_rate - phi_rate, free, a[2])
    sin_phi, cos_phi = sin_cos(y[2])
    drift = body.b * tau_rate
    return (
        omega,
        free + tilting / body.A,
        phi_rate,
        Lambda_rate - s * turning,
        tau_rate,
        S_rate + twist_share(body, s, c) * turning,
        drift * sin_phi,
        -drift * cos_phi,
        power,
    )


@jit
def _recess_combine(y: State, h: float, weights: Weights, slopes: tuple[State, ...]) -> State:
    a = b = c = d = 0.0
    for j in range(len(weights)):
        w, k = weights[j], slopes[j]
        a += w * k[0]
        b += w * k[1]
        c += w * k[2]
        d += w * k[3]
    return y[0] + h * a, y[1] + h * b, y[2] + h * c, y[3] + h * d


@jit
def _recess_ratio(
    body: Body, rtol: float, h: float, y: State, y_new: State, error: State, flat: bool
) -> float:
    per_lever = 0.0 if flat else 1.0 / (body.J * y[0])
    per_tilt, per_rate = scales(body, rtol, y[0], y[1], abs(y[3]) * per_lever, flat)
    ratio = max(abs(error[0]) * per_tilt, abs(error[1]) * per_rate)
    return max(ratio, abs(error[2]) * (1.0 / rtol), abs(error[3]) * per_lever * per_rate)


def _with_loss(combine: Callable[..., State]) -> Callable[..., State]:
    """Weighted sum y + h sum(weights slopes) of a step, with the energy lost."""

    @jit
    def combined(y: State, h: float, weights: Weights, slopes: tuple[State, ...]) -> State:
        lost = 0.0
        for j in range(len(weights)):
            lost += weights[j] * slopes[j][-1]
        return (*combine(y, h, weights, slopes), y[-1] + h * lost)

    return combined


@jit
def _with_least_spin(body: Body, rtol: float, y: State, a: Vector, slope: Vector) -> State:
    """State of the recess model before a step; over still ground with a least spin, which keeps its sign."""
    still = a[0] == 0.0 and a[1] == 0.0 and slope[0] == 0.0 and slope[1] == 0.0
    if not still or y[3] == 0.0:
        return y
    # near upright, of the steady wobble that has the same energy
    lever = standing_force(body, 0.0) * body.b
    level = max(energy(body, y[0], y[1], y[3], 0.0), 0.0) / (1.5 * lever)
    least = _LEAST_SPIN * rtol * sqrt(body.J * lever * level) * level
    return y[0], y[1], y[2], copysign(max(abs(y[3]), least), y[3]), y[4]


@jit
def _recess_creeps(body: Body, y: State) -> bool:
    _, phi_rate, _, s, _ = recess_motion(body, y[0], y[2], y[3], 0.0, 0.0, 0.0)
    return _is_slow(body, s, y[1], s * phi_rate)


@jit
def _flat_creeps(body: Body, y: State) -> bool:
    rates = flat_rhs(body, y[0], y[1], y[2], y[3], y[4], y[5], 0.0, 0.0, 0.0)
    s = sin_cos(y[0])[0]
    return _is_slow(body, s, y[1], s * (rates[4] - rates[2]))


@jit
def _is_slow(body: Body, s: float, omega: float, across: float) -> bool:
    return omega * omega + across * across < creep_rate(body, s) ** 2


def _system(model: System, derivative: Callable[..., State], creeps: Callable[[Body, State], bool]) -> System:
    """Model with the equations `derivative` and one more variable, the energy lost."""
    momenta, placed_before = model.momenta, model.placed

    @jit
    def placed(body: Body, y: State, theta: float, omega: float, phi: float, L: float) -> State:
        # an impact and a rest lose energy; an uplift begins with the work of the couple on its first tilt
        lost = body.delta * standing_force(body, 0.0) * (theta - y[0])
        if theta == 0.0:
            lost = energy(body, y[0], y[1], *momenta(y)) - 0.5 * body.A * omega * omega
        return (*placed_before(body, y, theta, omega, phi, L), y[-1] + lost)

    return model._replace(derivative=derivative, placed=placed, creeps=creeps)


RESISTED_RECESS = _system(RECESS, _recess_derivative, _recess_creeps)._replace(
    ready=_with_least_spin, prepares=True
)
RESISTED_FLAT = _system(FLAT, _flat_derivative, _flat_creeps)._replace(grows=True)

STEPPERS = {
    "recess": runge_kutta(RESISTED_RECESS, _with_loss(_recess_combine), _recess_ratio),
    "flat": runge_kutta(RESISTED_FLAT, _with_loss(flat_combine), flat_ratio),
}
