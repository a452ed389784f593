"""The three models with rolling resistance as systems of first order.

In the recess the sense of rolling over still ground (+1, -1, 0 where it may change) follows L. Behind the
variables of each model (`systems`) stand two more: the energy lost so far, per unit mass, and the side, the
sign of the tilt rate in planar motion, which stays what it was over a step. The couple jumps where such
motion turns, so a step ends there and the next one begins with the other side, or none: the body stands
still on its rim while the couple holds it. On flat ground it may pivot on its contact meanwhile, a motion
with one degree of freedom: its side is PIVOTS. With spin the couple turns instead of jumping, within a time
that may be short: a step is asked to follow that turn, or to be so short that it does not matter.
"""

from __future__ import annotations

from collections.abc import Callable
from math import inf, sqrt

from .._compile import inlined, jit
from ..body import Body
from ..equations import energy, flat_rhs, planar_rhs, recess_motion
from ..restoring import standing_force, with_tendon_load
from ..rolling import (
    PIVOTS,
    across_inertia,
    across_rate,
    couple,
    couple_on,
    hold_time,
    largest_at_rest,
    limit_of_pass,
    momenta_of,
    needed_to_stand,
    pivoting_rate,
    push,
    twist_share,
)
from ..trigonometry import sin_cos
from .record import Vector
from .result import State
from .stepping import runge_kutta
from .stiff import stiff_steps
from .systems import (
    FLAT,
    PLANAR,
    RECESS,
    System,
    Weights,
    as_it_was,
    flat_combine,
    flat_ratio,
    half_turn,
    make_is_flat,
    no_sense,
    planar_combine,
    planar_ratio,
    scales,
)

# squared cosine of the turn of the couple in a step up to which the step follows it
_FOLLOWED = 0.64
# of the tolerance: spin over that of steady wobble below which it is none. What it would add to the turn of
# a pass is of its size
_SPENT = 0.1
# times the tolerance on rates: so slow a body whose couple would hold it is still
_STILL = 40.0
# of the tolerance on tilts: what a body moves while the couple stops it, below which it is still
_STOPS = 0.1
# rate that the couple may take in a step, over that which a body has. The couple turns it into the direction
# of the push, the faster the slower it is, and steps above 3.3 keep a rate that is none
_STABLE = 2.0
# least inertia across the lean over that of the tilt
_LIGHT = 0.1
# of 1/p, as a power of the tolerance: time after which a body is let go where the couple ceases to hold it
# while the push turns. Before, the speed grows with the square of the time, and what a series leaves out with
# the third power
_SERIES, _LONGEST_SERIES = 0.5, 1e-3
# of 1/p: first step from a standstill, whose direction across the lean is not known before
_FIRST_STEP = 1e-6


@inlined  # a call finds code of another rounding in the process that compiles it than where it is loaded
def _planar_derivative(body: Body, y: State, a: Vector) -> State:
    free = planar_rhs(body, y[0], sin_cos(y[2])[1], a[0], a[2])
    s, c = sin_cos(y[0])
    tilting, _, power = couple(body, s, c, y[1], 0.0, free, a[2], y[4])
    return y[1], free + tilting / body.A, 0.0, power, 0.0


@jit
def _recess_derivative(body: Body, y: State, a: Vector) -> State:
    free, phi_rate, torque, s, c = recess_motion(body, y[0], y[2], y[3], a[0], a[1], a[2])
    if y[1] == 0.0 and phi_rate == 0.0:
        tilting, turning = couple_on(body, y[0], 0.0, y[2], 0.0, 0.0, free, a, False)
        power = 0.0
    else:
        tilting, turning, power = couple(body, s, c, y[1], -phi_rate, free, a[2], y[6])
    return y[1], free + tilting / body.A, phi_rate, torque - s * turning, 0.0, power, 0.0


@inlined
def _drift(body: Body, phi: float, tau_rate: float) -> tuple[float, float]:
    """Return the velocity of the centre of the circle that the rim rolls on [m/s].

    Whatever the body does, a rim that rolls leaves its contact where the twist does.
    """
    sin_phi, cos_phi = sin_cos(phi)
    return body.b * tau_rate * sin_phi, -body.b * tau_rate * cos_phi


@jit
def _flat_derivative(body: Body, y: State, a: Vector) -> State:
    omega, free, phi_rate, Lambda_rate, tau_rate, S_rate = flat_rhs(
        body, y[0], y[1], y[2], y[3], y[4], y[5], a[0], a[1], a[2]
    )
    s, c = sin_cos(y[0])
    spin = tau_rate - phi_rate
    if y[9] == PIVOTS:
        tilting, turning = needed_to_stand(body, y[0], y[2], tau_rate, body.g + a[2], a, True)
        S_rate += twist_share(body, s, c) * turning
        X_rate, Y_rate = _drift(body, y[2], tau_rate)
        return 0.0, 0.0, tau_rate, Lambda_rate - s * turning, tau_rate, S_rate, X_rate, Y_rate, 0.0, 0.0
    if omega == 0.0:
        tilting, turning = couple_on(body, y[0], omega, y[2], spin, tau_rate, free, a, True)
        power = -s * spin * turning
    else:
        tilting, turning, power = couple(body, s, c, omega, spin, free, a[2], y[9])
    X_rate, Y_rate = _drift(body, y[2], tau_rate)
    return (
        omega,
        free + tilting / body.A,
        phi_rate,
        Lambda_rate - s * turning,
        tau_rate,
        S_rate + twist_share(body, s, c) * turning,
        X_rate,
        Y_rate,
        power,
        0.0,
    )


@inlined
def _across(body: Body, theta: float, Lambda: float, S: float) -> float:
    """Return s psi' [rad/s]."""
    return across_rate(body, *sin_cos(theta), Lambda, S)


def _make_ratio(model: System, error_ratio: Callable[..., float], *, pivots: bool) -> Callable[..., float]:
    """Return the error over what is allowed, of a model with spin, corners of the couple included."""
    momenta = model.momenta

    @jit
    def ratio(body: Body, rtol: float, h: float, y: State, y_new: State, error: State, flat: bool) -> float:
        found = error_ratio(body, rtol, h, y, y_new, error, flat)
        if flat or not found <= 1.0 or y_new[0] <= 0.0 or y[-1] == PIVOTS:
            return found
        across, across_new = _across(body, y[0], *momenta(y)), _across(body, y_new[0], *momenta(y_new))
        # a step much longer than the turn sees a jump, of which its error may miss all but a hundredth
        speeds = (y[1] * y[1] + across * across) * (y_new[1] * y_new[1] + across_new * across_new)
        along = y[1] * y_new[1] + across * across_new
        unit = abs(y[1]) + abs(across) + body.p * sqrt(body.sin_alpha * y[0])
        taken = body.delta * with_tendon_load(body, body.g, *sin_cos(y[0])) * h
        if along > 0.0 and along * along > _FOLLOWED * speeds:
            slow = min(y[1] * y[1] + across * across, y_new[1] * y_new[1] + across_new * across_new)
            stable = _STABLE * sqrt(slow)
            # few steps pass the first
            if taken > _LIGHT * body.A * stable:
                return max(found, taken / (across_inertia(body, *sin_cos(y_new[0]), pivots) * stable))
            return found
        return max(found, 2.0 * taken / (body.A * rtol * unit))

    return ratio


@jit
def _recess_combine(y: State, h: float, weights: Weights, slopes: tuple[State, ...]) -> State:
    a = b = c = d = 0.0
    for j in range(len(weights)):
        w, k = weights[j], slopes[j]
        a += w * k[0]
        b += w * k[1]
        c += w * k[2]
        d += w * k[3]
    L = y[3] + h * d
    # below the error of a step a sum may have either sign; an error itself, which begins at 0, has both
    if y[3] != 0.0 and L * y[4] < 0.0:
        L = 0.0
    return y[0] + h * a, y[1] + h * b, y[2] + h * c, L, y[4]


@jit
def _recess_ratio(
    body: Body, rtol: float, h: float, y: State, y_new: State, error: State, flat: bool
) -> float:
    per_lever = 0.0 if flat else 1.0 / (body.J * y[0])
    per_tilt, per_rate = scales(body, rtol, y[0], y[1], abs(y[3]) * per_lever, flat)
    ratio = max(abs(error[0]) * per_tilt, abs(error[1]) * per_rate)
    return max(ratio, abs(error[2]) * (1.0 / rtol), abs(error[3]) * per_lever * per_rate)


def _make_combine(combine: Callable[..., State]) -> Callable[..., State]:
    """Return y + h sum(weights slopes), with the energy lost, and with the side as it is."""

    @jit
    def combined(y: State, h: float, weights: Weights, slopes: tuple[State, ...]) -> State:
        lost = 0.0
        for j in range(len(weights)):
            lost += weights[j] * slopes[j][-2]
        return (*combine(y, h, weights, slopes), y[-2] + h * lost, y[-1])

    return combined


@jit
def with_side(y: State, side: float) -> State:
    """Return a state whose tilt rate has a sign."""
    return (*y[:-1], side)


@inlined
def _series_time(body: Body, rtol: float) -> float:
    """Return for how long the series of a motion that the couple lets go is used [s]."""
    return min(_SERIES * float(rtol ** (1.0 / 3.0)), _LONGEST_SERIES) / body.p


@jit
def _ready(body: Body, rtol: float, y: State, a: Vector, slope: Vector) -> State:
    """Return a state of the recess model before a step, without spin where that is below the tolerance.

    Over still ground L' = -delta N L/(H w): L keeps its sign, and falls by orders of magnitude in each swing.
    The sense of rolling is kept beside it: it decides on which side the passes go on.
    """
    if a[0] != 0.0 or a[1] != 0.0 or slope[0] != 0.0 or slope[1] != 0.0:
        return y[0], y[1], y[2], y[3], 0.0, y[5], y[6]
    sense = y[4]
    if sense == 0.0 and y[3] != 0.0:
        sense = 1.0 if y[3] > 0.0 else -1.0
    if y[3] == 0.0 or abs(y[3]) >= _SPENT * rtol * _steady_spin(body, y):
        return y[0], y[1], y[2], y[3], sense, y[5], y[6]
    side = 1.0 if y[1] > 0.0 else -1.0 if y[1] < 0.0 else 0.0
    return y[0], y[1], y[2], 0.0, sense, y[5], side


@jit
def _steady_spin(body: Body, y: State) -> float:
    """Return L of the steady wobble that has the energy of a state, near upright [m^2/s]."""
    lever = standing_force(body, 0.0) * body.b
    level = max(energy(body, y[0], y[1], y[3], 0.0), 0.0) / (1.5 * lever)
    return sqrt(body.J * lever * level) * level


@jit
def _sense(y: State) -> float:
    return y[4]


@jit
def _pass_without_spin(body: Body, y: State, restitution: float) -> tuple[float, float]:
    """Return what a pass adds to the rolling angle [rad], and the ratio of the tilt rates."""
    if y[4] == 0.0:
        return half_turn(body, y, restitution)
    turn, ratio = limit_of_pass(body)
    return y[4] * turn, ratio


def _make_system(
    model: System,
    derivative: Callable[..., State],
    place: Callable[..., State],
    *,
    spins: bool,
    pivots: bool,
) -> System:
    """Return a model with the equations `derivative`.

    `place` gives a state other rates theta' and s psi'; `pivots` is as for `needed_to_stand`.
    """
    momenta, placed_before, is_flat = model.momenta, model.placed, make_is_flat(model.momenta)
    in_recess = spins and not pivots

    @jit
    def placed(body: Body, y: State, theta: float, omega: float, phi: float, L: float) -> State:
        # an impact and a rest lose energy; an uplift begins with the work of the couple on its first tilt
        lost = body.delta * standing_force(body, 0.0) * (theta - y[0])
        if theta == 0.0:
            lost = energy(body, y[0], y[1], *momenta(y)) - 0.5 * body.A * omega * omega
        side = 1.0 if omega > 0.0 else -1.0 if omega < 0.0 else 0.0
        return (*placed_before(body, y, theta, omega, phi, L), y[-2] + lost, side)

    @inlined
    def moving(body: Body, y: State, omega: float, across: float, side: float) -> State:
        """Return a state with the rates theta' and s psi' [rad/s], which pivots as it did."""
        return with_side(place(body, y, omega, across), side)

    @inlined
    def drive(body: Body, y: State, a: Vector, slope: Vector) -> tuple[float, float, float, float]:
        s, c = sin_cos(y[0])
        pivoting = pivoting_rate(body, s, c, *momenta(y)) if pivots else 0.0
        return push(body, y[0], y[2], pivoting, a, slope, pivots)

    @jit
    def let_go(body: Body, rtol: float, y: State, a: Vector, slope: Vector) -> bool:
        excess, growth, _, _ = drive(body, y, a, slope)
        return bool(y[-1] == PIVOTS and excess > _series_time(body, rtol) * abs(growth))

    @jit
    def hold(body: Body, rtol: float, y: State, a: Vector, slope: Vector) -> float:
        if y[1] != 0.0 or not is_flat(y):
            # over still ground nothing changes the rate at which it pivots
            return inf if y[-1] == PIVOTS and drive(body, y, a, slope)[0] <= 0.0 else 0.0
        time = hold_time(body, y[0], y[2], a, slope, pivots)
        if spins and not pivots and time < inf:
            excess, growth, _, turning = drive(body, y, a, slope)
            if turning != 0.0 and growth > 0.0:
                longer = time - excess / growth if time == 0.0 else time
                longer += _series_time(body, rtol)
                return longer if longer > _FIRST_STEP / body.p else 0.0
        return time

    @jit
    def set_off(body: Body, rtol: float, y: State, a: Vector, slope: Vector) -> tuple[State, float]:
        excess, growth, tilting, turning = drive(body, y, a, slope)
        late = _series_time(body, rtol) * abs(growth)
        if pivots and excess <= late:
            return with_side(y, PIVOTS), inf
        side, longest = 1.0 if tilting > 0.0 else -1.0, _FIRST_STEP / body.p if spins else inf
        if spins and turning != 0.0 and 0.0 < excess < 10.0 * late and growth > 0.0:
            # the couple lets go: as long as it balances most of the push the body moves along that
            since = excess / growth
            inertia = (
                body.A * tilting * tilting + across_inertia(body, *sin_cos(y[0]), pivots) * turning * turning
            )
            speed = 0.5 * growth * since * since / inertia
            return moving(body, y, speed * tilting, speed * turning, side), longest
        return moving(body, y, 0.0, 0.0, side), longest

    @jit
    def stopped(body: Body, rtol: float, y: State, a: Vector, slope: Vector) -> State:
        if spins and y[-1] != PIVOTS:
            slow = _STILL * rtol * body.p
            limit = 2.0 * body.A * slow * slow * body.sin_alpha * y[0]
            room = 2.0 * _STOPS * rtol * y[0]
            # few states pass the first
            if body.A * y[1] * y[1] < max(limit, room * largest_at_rest(body, y[0], a[2])):
                s, c = sin_cos(y[0])
                across = across_rate(body, s, c, *momenta(y))
                inertia = across_inertia(body, s, c, pivots)
                kinetic = body.A * y[1] * y[1] + inertia * across * across
                excess, growth, _, _ = drive(body, y, a, slope)
                # what is left of the couple stops it on a way of kinetic/2 over that, if it stays for so long
                stop = _FIRST_STEP / body.p
                if kinetic >= limit:
                    stop = 2.0 * sqrt(kinetic * max(body.A, inertia)) / max(-excess, 1e-300)
                within = kinetic < limit or kinetic < -excess * room
                if within and max(excess, excess + growth * stop) < 0.0:
                    y = moving(body, y, 0.0, 0.0, PIVOTS if pivots else 0.0)
                    return (*y[:-2], y[-2] + 0.5 * kinetic, y[-1])
        return y

    return System(
        derivative,
        momenta,
        placed,
        resists=True,
        hold=hold,
        set_off=set_off,
        let_go=let_go,
        stopped=stopped,
        ready=_ready if in_recess else as_it_was,
        rebound=_pass_without_spin if in_recess else half_turn,
        sense=_sense if in_recess else no_sense,
        grows=pivots,
    )


@jit
def _planar_moving(body: Body, y: State, omega: float, across: float) -> State:
    return y[0], omega, y[2], y[3], y[4]


@jit
def _recess_moving(body: Body, y: State, omega: float, across: float) -> State:
    s, c = sin_cos(y[0])
    return y[0], omega, y[2], -s * across_inertia(body, s, c, False) * across, y[4], y[5], y[6]


@jit
def _flat_moving(body: Body, y: State, omega: float, across: float) -> State:
    s, c = sin_cos(y[0])
    Lambda, S = momenta_of(body, s, c, pivoting_rate(body, s, c, y[3], y[5]), across)
    return y[0], omega, y[2], Lambda, y[4], S, y[6], y[7], y[8], y[9]


RESISTED_PLANAR = _make_system(PLANAR, _planar_derivative, _planar_moving, spins=False, pivots=False)


@jit
def _recess_placed(body: Body, y: State, theta: float, omega: float, phi: float, L: float) -> State:
    return theta, omega, phi, L, 0.0 if theta == 0.0 and omega == 0.0 else y[4]


RESISTED_RECESS = _make_system(
    RECESS._replace(placed=_recess_placed), _recess_derivative, _recess_moving, spins=True, pivots=False
)
RESISTED_FLAT = _make_system(FLAT, _flat_derivative, _flat_moving, spins=True, pivots=True)

STEPPERS = {
    "planar": runge_kutta(RESISTED_PLANAR, _make_combine(planar_combine), planar_ratio),
    "recess": runge_kutta(
        RESISTED_RECESS, _make_combine(_recess_combine), _make_ratio(RECESS, _recess_ratio, pivots=False)
    ),
    "flat": stiff_steps(
        runge_kutta(RESISTED_FLAT, _make_combine(flat_combine), _make_ratio(FLAT, flat_ratio, pivots=True)),
        RESISTED_FLAT.derivative,
    ),
}
