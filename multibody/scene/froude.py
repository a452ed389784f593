"""Froude scaling: every scene runs at one size and one gravity, and the result is scaled back.

With all lengths times F, times go with sqrt(F/g): the mechanics does not change, but tolerances of
an engine are absolute. At one reference size only tan(alpha) changes the scene, and a cylinder of
1 cm is computed as accurately as one of 100 m.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

REFERENCE_SEMIDIAGONAL = 6.0  # [m] the size of the examples: contact settings were measured there
REFERENCE_GRAVITY = 9.81  # [m/s^2]
REFERENCE_TIME_STEP = 1e-4  # [s] at the reference size


@dataclass(frozen=True, slots=True)
class Scale:
    """Units of the reference scene in the units of the user.

    Attributes
    ----------
    length : float
        User metres for each reference metre.
    time : float
        User seconds for each reference second.
    """

    length: float
    time: float

    @property
    def acceleration(self) -> float:
        """User accelerations for each reference acceleration."""
        return self.length / self.time**2

    @property
    def energy(self) -> float:
        """User energies per unit mass for each reference one."""
        return (self.length / self.time) ** 2


def froude_scale(semidiagonal: float, gravity: float) -> Scale:
    """Return the scale that carries the reference scene to a semidiagonal [m] and a gravity [m/s^2]."""
    length = semidiagonal / REFERENCE_SEMIDIAGONAL
    return Scale(length, math.sqrt(length * REFERENCE_GRAVITY / gravity))


def default_step(semidiagonal: float, gravity: float) -> float:
    """Return the time step of a run that states none [s], for a semidiagonal [m] and a gravity [m/s^2]."""
    return REFERENCE_TIME_STEP * froude_scale(semidiagonal, gravity).time
