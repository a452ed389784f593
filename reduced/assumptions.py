"""Whether a solution kept what the reduced model assumes: contact, and friction enough."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, slots=True, kw_only=True)
class Breach:
    """One assumption that did not hold.

    Attributes
    ----------
    assumption : {"contact", "friction"}
    first_time : float
        When it first failed [s].
    duration : float
        For how long altogether [s].
    extreme : float
        Least normal force in weights (contact), or largest friction needed (friction).
    """

    assumption: str
    first_time: float
    duration: float
    extreme: float

    def __str__(self) -> str:
        when = f"first at {self.first_time:.4g} s, for {self.duration:.3g} s altogether"
        if self.assumption == "contact":
            return f"contact is lost, {when}: the ground would have to pull with {-self.extreme:.3g} weights"
        need = "more than any friction" if math.isinf(self.extreme) else f"a friction of {self.extreme:.3g}"
        return f"the cylinder slips, {when}: it would need {need}"


@dataclass(frozen=True, slots=True, kw_only=True)
class Assumptions:
    """The demands of a solution on ground and recess, and where they could not be met.

    Attributes
    ----------
    held : bool
    breaches : tuple of Breach
    least_normal_force, largest_normal_force : float
        In weights, while the cylinder is in motion; 1 if it never is.
    largest_friction_needed : float
        In motion; inf where contact is lost, 0 if it never moves.
    largest_couple : float
        Of the recess, over the weight [m].
    friction : float
        The coefficient it was held against.
    """

    held: bool
    breaches: tuple[Breach, ...]
    least_normal_force: float
    largest_normal_force: float
    largest_friction_needed: float
    largest_couple: float
    friction: float

    def __str__(self) -> str:
        if self.held:
            return (
                f"the assumptions held: normal force at least {self.least_normal_force:.3g} weights, "
                f"friction needed at most {self.largest_friction_needed:.3g} of {self.friction:.3g}"
            )
        return "the assumptions broke: " + "; ".join(str(breach) for breach in self.breaches)


def review(
    times: NDArray[np.float64],
    force: NDArray[np.float64],
    couple: NDArray[np.float64],
    moving: NDArray[np.bool_],
    friction: float,
) -> Assumptions:
    """Hold the forces of a solution against contact and a coefficient of friction.

    Parameters
    ----------
    times : ndarray, shape (n,)
        Every step of the solution [s].
    force : ndarray, shape (n, 3)
        Contact force in weights.
    couple : ndarray, shape (n,)
        Of the recess, over the weight [m].
    moving : ndarray of bool, shape (n,)
        False where the cylinder stands.
    friction : float
        Coefficient of the pair [-].
    """
    if not moving.any():
        return Assumptions(
            held=True,
            breaches=(),
            least_normal_force=1.0,
            largest_normal_force=1.0,
            largest_friction_needed=0.0,
            largest_couple=0.0,
            friction=friction,
        )
    normal = force[:, 2]
    lost = moving & (normal <= 0.0)
    pressed = moving & (normal > 0.0)
    needed = np.zeros(len(times))
    needed[pressed] = np.hypot(force[pressed, 0], force[pressed, 1]) / normal[pressed]
    needed[lost] = math.inf
    slips = pressed & (needed > friction)
    breaches = []
    if lost.any():
        breaches.append(_breach("contact", times, lost, float(normal[lost].min())))
    if slips.any():
        breaches.append(_breach("friction", times, slips, float(needed[slips].max())))
    return Assumptions(
        held=not breaches,
        breaches=tuple(breaches),
        least_normal_force=float(normal[moving].min()),
        largest_normal_force=float(normal[moving].max()),
        largest_friction_needed=float(needed.max()),
        largest_couple=float(np.abs(couple[moving]).max()),
        friction=friction,
    )


def _breach(assumption: str, times: NDArray[np.float64], where: NDArray[np.bool_], extreme: float) -> Breach:
    # each step stands for the time until the next
    lengths = np.diff(times, append=times[-1])
    return Breach(
        assumption=assumption,
        first_time=float(times[where.argmax()]),
        duration=float(lengths[where].sum()),
        extreme=extreme,
    )
