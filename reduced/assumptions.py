"""Check of a solution against what the reduced model assumes: contact, and friction enough."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rockwobble.models import Assumptions, Diagnostic

Array = NDArray[np.float64]

# Parts of a step at which the demands are looked at: between two of them they are close to a parabola. A run
# of a million steps, which is chatter, has fewer.
_PARTS, _LEAST_PARTS, _MOST_TIMES = 8, 2, 400_000
_ROUNDS = 5  # each looks eight times closer, so that a parabola is off by 8^-8 of what it was at first


class Demands(NamedTuple):
    """Demands of a solution at n times; standing included, where nothing is asked."""

    normal: Array  # (n,) least normal force in weights
    load: Array  # (n,) largest normal force in weights
    friction: Array  # (n,) horizontal over normal force; inf where the normal force is not positive
    moment: Array  # (n,) the restraining one, over the weight [m]
    moving: NDArray[np.bool_]  # (n,)


def review(
    demands_at: Callable[[Array], Demands], steps: Array, jumps: Array, friction: float
) -> Assumptions:
    """Compare the demands of a solution with contact and a coefficient of friction.

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
        return Assumptions(friction=friction)

    def slips(found: Demands) -> NDArray[np.bool_]:
        # where contact is lost it is that which is said
        return found.moving & (found.normal > 0.0) & (found.friction > friction)

    def largest(quantity: Callable[[Demands], Array]) -> tuple[float, float]:
        return _largest(quantity, demands_at, times, found)

    (pull, pulled), (need, needed) = largest(_pull), largest(_need)
    (normal, _), (moment, _) = (
        largest(lambda found: found.load),
        largest(lambda found: np.abs(found.moment)),
    )
    if (pull >= 0.0 and not _lost(found).any()) or (need > friction and not slips(found).any()):
        # a breach that is shorter than a part of a step
        times = np.union1d(times, [pulled, needed])
        found = demands_at(times)
    breaches = []
    if _lost(found).any():
        breaches.append(_breach("tension", _lost, demands_at, times, found, -pull, 0.0))
    if slips(found).any():
        breaches.append(_breach("friction_needed", slips, demands_at, times, found, need, friction))
    return Assumptions(
        breaches=tuple(breaches),
        least_normal_force=-pull,
        largest_normal_force=normal,
        largest_friction_needed=need,
        largest_restraining_moment=moment,
        friction=friction,
    )


def _pull(found: Demands) -> Array:
    return -found.normal


def _need(found: Demands) -> Array:
    return found.friction


def _lost(found: Demands) -> NDArray[np.bool_]:
    return found.moving & (found.normal <= 0.0)


def _breach(
    code: str,
    broken_at: Callable[[Demands], NDArray[np.bool_]],
    demands_at: Callable[[Array], Demands],
    times: Array,
    found: Demands,
    size: float,
    bound: float,
) -> Diagnostic:
    broken = broken_at(found)
    # where a breach begins or ends, ever closer: a step of a fall takes tenths of a second
    for _ in range(_ROUNDS - 1):
        changes = np.flatnonzero(broken[1:] != broken[:-1])
        times = np.unique(np.concatenate([times, *(_divided(times[i : i + 2], _PARTS) for i in changes)]))
        broken = broken_at(demands_at(times))
    return Diagnostic(
        code=code,
        time=float(times[broken.argmax()]),
        duration=float(np.diff(times)[broken[:-1] & broken[1:]].sum()),
        size=size,
        bound=bound,
    )


def _largest(
    quantity: Callable[[Demands], Array],
    demands_at: Callable[[Array], Demands],
    times: Array,
    found: Demands,
) -> tuple[float, float]:
    """Return the largest value in motion, looked for ever closer about that at `times`, and its time."""
    best, when = -math.inf, math.nan
    for _ in range(_ROUNDS):
        values = np.where(found.moving, quantity(found), -math.inf)
        at = int(values.argmax())
        if not values[at] <= best:
            best, when = float(values[at]), float(times[at])
        if math.isinf(best):
            break
        about = times[max(at - 1, 0) : at + 2]
        times = np.unique(_divided(about, _PARTS))
        found = demands_at(times)
    return best, when


def _divided(edges: Array, parts: int) -> Array:
    """Return times (parts (k - 1) + 1,) that divide each interval between `edges` (k,)."""
    share = np.arange(parts) / parts
    inner = edges[:-1, None] + np.diff(edges)[:, None] * share
    return np.append(inner.ravel(), edges[-1])
