"""Conditions that end a motion: the cylinder comes to rest, or is bound to overturn."""

from __future__ import annotations

from math import cos, hypot, pi, sin

from .._compile import inlined, jit
from ..body import Body
from ..equations import energy
from ..rolling import rolling_momentum
from .tsit5 import Vector
from .uplift import excess

HALF_PI = 0.5 * pi  # the tilt at which the side lies on the ground


@inlined
def may_sit_down(
    body: Body, rest_tilt: float, theta: float, omega: float, L: float, S: float, a: Vector
) -> bool:
    """Return whether the cylinder comes to rest: f < 0 and too little energy left to matter.

    The bound is the energy of a standstill at the tilt `rest_tilt` alpha, less what the ground
    acceleration takes off the restoring moment. With rolling resistance a twist rate may be left over,
    which near upright stays what it is, as B phi' does: then the bound is the energy with both at that tilt,
    beyond which the motion cannot rise. The twist is left to the friction of the base that closes.
    """
    limit = rest_tilt * body.alpha
    if theta > 10.0 * limit:  # above the bound, unless az exceeds 9 g
        return False
    share = 1.0 + a[2] / body.g - hypot(a[0], a[1]) * body.cos_alpha / (body.g * body.sin_alpha)
    if share <= 0.0 or excess(body, a) >= 0.0:
        return False
    standing = energy(body, limit, 0.0, 0.0, 0.0)
    if body.delta > 0.0 and S != 0.0:
        L_there = rolling_momentum(body, theta, L, S) - rolling_momentum(body, limit, 0.0, S)
        highest = energy(body, limit, 0.0, L_there, S) - (1.0 - share) * standing
        return theta < limit and energy(body, theta, omega, L, S) < highest
    return energy(body, theta, omega, L, S) < share * standing


@jit
def surely_overturns(body: Body, theta: float, strongest: float, lightest: float) -> bool:
    """Return whether a tilt above alpha that does not decrease is bound to reach pi/2, without twist.

    `strongest` is the largest |a| and `lightest` the least g + az to come: beyond the equilibrium tilt
    under these two and the couple of rolling resistance, theta'' is positive and grows with theta. Spin
    only adds to it, (18); a twist rate, which the flat-ground model has, may hold a cylinder up.
    """
    beyond = theta - body.alpha
    held = body.delta * body.sin_alpha / body.b
    return lightest > 0.0 and lightest * (sin(beyond) - held) > strongest * cos(beyond)
