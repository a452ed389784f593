"""How motion ends: the cylinder sits down, or it falls and nothing can stop it."""

from __future__ import annotations

from math import cos, hypot, pi, sin

from ._compile import inlined, jit
from .body import Body
from .equations import energy
from .tsit5 import Vector
from .uplift import excess

HALF_PI = 0.5 * pi  # the tilt at which the side lies on the ground


@inlined
def may_sit_down(
    body: Body, seating: float, theta: float, omega: float, L: float, S: float, a: Vector
) -> bool:
    """Return whether the cylinder comes to rest: f < 0 and too little energy left to matter.

    The bound is the energy of a standstill at the tilt `seating` alpha, less what the ground
    acceleration takes off the restoring moment.
    """
    limit = seating * body.alpha
    if theta > 10.0 * limit:  # above the bound, unless az exceeds 9 g
        return False
    share = 1.0 + a[2] / body.g - hypot(a[0], a[1]) * body.cos_alpha / (body.g * body.sin_alpha)
    if share <= 0.0 or excess(body, a) >= 0.0:
        return False
    return energy(body, theta, omega, L, S) < share * energy(body, limit, 0.0, 0.0, 0.0)


@jit
def surely_falls(body: Body, theta: float, strongest: float, lightest: float, time: float) -> bool:
    """Return whether a tilt above alpha that does not decrease is bound to reach pi/2 within `time`.

    `strongest` is the largest |a| and `lightest` the least g + az to come: beyond the equilibrium
    tilt under these two, theta'' is positive and grows with theta. The spin only adds to it.
    """
    if lightest <= 0.0:
        return False
    beyond = theta - body.alpha
    least = body.p2 / body.g * (lightest * sin(beyond) - strongest * cos(beyond))
    return least > 0.0 and 2.0 * (HALF_PI - theta) < least * time * time
