"""Whether a solution kept what the reduced model assumes: contact, and friction enough."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

# Parts of a step at which the demands are looked at: between two of them they are close to a parabola. A run
# of a million steps, which is chatter, has fewer.
_PARTS, _LEAST_PARTS, _MOST_TIMES = 8, 2, 400_000
_ROUNDS = 5  # each looks eight times closer, so that a parabola is off by 8^-8 of what it was at first


@dataclass(frozen=True, slots=True, kw_only=True)
class Breach:
    """One assumption that did not hold.

    Attributes
    ----------
    assumption : {"contact", "friction"}
    first_time : float
        When it first failed [s].
    duration : float
        For how long altogether, rest apart [s].
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


class Demands(NamedTuple):
    """What a solution asks at n times; standing included, where nothing is asked."""

    normal: Array  # (n,) normal force in weights
    friction: Array  # (n,) horizontal over normal force; inf where the normal force is not positive
    couple: Array  # (n,) of the recess, over the weight [m]
    moving: NDArray[np.bool_]  # (n,)


def review(
    demands_at: Callable[[Array], Demands], steps: Array, jumps: Array, friction: float
) -> Assumptions:
    """Hold the demands of a solution against contact and a coefficient of friction.

    Parameters
    ----------
    demands_at : callable
        Demands of the continuous solution at increasing times (n,) [s].
    steps : ndarray, shape (k,)
        Times between which the demands are smooth, from beginning to end [s]: the steps of the solution.
    jumps : ndarray, shape (j,)
        Times at which they jump: uplifts and landings [s]. At such a time the solution is that before it.
    friction : float
        Coefficient of the pair [-].
    """
    edges = np.unique(np.concatenate([steps, jumps, np.nextafter(jumps, math.inf)]))
    parts = max(_LEAST_PARTS, min(_PARTS, _MOST_TIMES // len(edges)))
    times = np.unique(_divided(edges, parts))
    found = demands_at(times)
    if not found.moving.any():
        return Assumptions(
            held=True,
            breaches=(),
            least_normal_force=1.0,
            largest_normal_force=1.0,
            largest_friction_needed=0.0,
            largest_couple=0.0,
            friction=friction,
        )

    def slips(found: Demands) -> NDArray[np.bool_]:
        # where contact is lost it is that which is said
        return found.moving & (found.normal > 0.0) & (found.friction > friction)

    def largest(quantity: Callable[[Demands], Array]) -> float:
        return _largest(quantity, demands_at, times, found)

    breaches = []
    if _lost(found).any():
        breaches.append(_breach("contact", _lost, demands_at, times, found, -largest(_pull)))
    if slips(found).any():
        breaches.append(_breach("friction", slips, demands_at, times, found, largest(_need)))
    return Assumptions(
        held=not breaches,
        breaches=tuple(breaches),
        least_normal_force=-largest(_pull),
        largest_normal_force=largest(lambda found: found.normal),
        largest_friction_needed=largest(_need),
        largest_couple=largest(lambda found: np.abs(found.couple)),
        friction=friction,
    )


def _pull(found: Demands) -> Array:
    return -found.normal


def _need(found: Demands) -> Array:
    return found.friction


def _lost(found: Demands) -> NDArray[np.bool_]:
    return found.moving & (found.normal <= 0.0)


def _breach(
    assumption: str,
    broken_at: Callable[[Demands], NDArray[np.bool_]],
    demands_at: Callable[[Array], Demands],
    times: Array,
    found: Demands,
    extreme: float,
) -> Breach:
    broken = broken_at(found)
    # where a breach begins or ends, ever closer: a step of a fall takes tenths of a second
    for _ in range(_ROUNDS - 1):
        changes = np.flatnonzero(broken[1:] != broken[:-1])
        times = np.unique(np.concatenate([times, *(_divided(times[i : i + 2], _PARTS) for i in changes)]))
        broken = broken_at(demands_at(times))
    return Breach(
        assumption=assumption,
        first_time=float(times[broken.argmax()]),
        duration=float(np.diff(times)[broken[:-1] & broken[1:]].sum()),
        extreme=extreme,
    )


def _largest(
    quantity: Callable[[Demands], Array],
    demands_at: Callable[[Array], Demands],
    times: Array,
    found: Demands,
) -> float:
    """Return the largest value in motion, looked for ever closer about the largest at `times`."""
    best = -math.inf
    for _ in range(_ROUNDS):
        values = np.where(found.moving, quantity(found), -math.inf)
        at = int(values.argmax())
        best = max(best, float(values[at]))
        if math.isinf(best):
            break
        about = times[max(at - 1, 0) : at + 2]
        times = np.unique(_divided(about, _PARTS))
        found = demands_at(times)
    return best


def _divided(edges: Array, parts: int) -> Array:
    """Return times (parts (k - 1) + 1,) that divide each interval between `edges` (k,)."""
    share = np.arange(parts) / parts
    inner = edges[:-1, None] + np.diff(edges)[:, None] * share
    return np.append(inner.ravel(), edges[-1])
