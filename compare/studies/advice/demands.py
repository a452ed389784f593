"""What the ground and the recess must supply so that a solution of a reduced model is possible."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rockwobble.models import Trace

Array = NDArray[np.float64]

# share of the moving time that the "usual" demands leave out: the spikes of the nearest passes
SPIKES = 0.01


@dataclass(frozen=True, slots=True, kw_only=True)
class Demands:
    """The demands of one solution; all zero, and a normal force of one weight, where nothing moves.

    Attributes
    ----------
    moving_time : float
        Time in motion [s].
    friction : float
        Coefficient that is available [-].
    friction_needed : float
        Largest need; inf where contact is lost.
    friction_usual : float
        What is not exceeded in 99 % of the moving time.
    slip_from, slip_time : float
        When the need first exceeds what is available while there is contact, and for how long [s]; NaN
        and 0 where it never does.
    slides : bool
        Whether the friction is below b/h: a cylinder at rest then slides where it would have uplifted.
    couple, couple_usual : float
        Of the recess along z_world + z_body, per mass [N m/kg], which is kN m for each tonne; the largest,
        and what is not exceeded in 99 % of the moving time.
    couple_in_radii : float
        The largest in weights times the base radius.
    least_normal_force, largest_normal_force : float
        In weights.
    lost_from, lost_time : float
        When contact would first be lost, and for how long [s]; NaN and 0 where it never is.
    """

    moving_time: float
    friction: float
    friction_needed: float
    friction_usual: float
    slip_from: float
    slip_time: float
    slides: bool
    couple: float
    couple_usual: float
    couple_in_radii: float
    least_normal_force: float
    largest_normal_force: float
    lost_from: float
    lost_time: float


def demands_of(response: Trace, *, until: float = math.inf) -> Demands:
    """Return the demands of a response: extremes of the continuous solution, the usual ones of its samples.

    Parameters
    ----------
    response : Trace
    until : float, optional
        End of the time that counts [s]; the extremes are then those of the samples, too.
    """
    kept = response.time <= until
    time, moving = response.time[kept], response.tilt[kept] > 0.0
    friction, couple = response.friction_needed[kept], np.abs(response.restraining_moment[kept])
    lengths = np.diff(time, append=time[-1])
    if math.isinf(until):
        found = _of_solution(response)
    else:
        found = _of_samples(
            time, response.contact_force[kept, 2], friction, couple, moving, response.case.friction
        )
    from_rest = response.uplift_time > 0.0
    return Demands(
        moving_time=float(lengths[moving].sum()),
        friction=response.case.friction,
        friction_usual=_usual(friction[moving]),
        slides=from_rest and response.case.friction < response.case.cylinder.tan_alpha,
        couple=found.largest_couple * response.case.gravity,
        couple_usual=_usual(couple[moving]) * response.case.gravity,
        couple_in_radii=found.largest_couple / response.case.cylinder.base_radius,
        friction_needed=found.friction_needed,
        slip_from=found.slip_from,
        slip_time=found.slip_time,
        least_normal_force=found.least_normal_force,
        largest_normal_force=found.largest_normal_force,
        lost_from=found.lost_from,
        lost_time=found.lost_time,
    )


class _Extremes(NamedTuple):
    """Extremes, in the units of `Demands`; the couple over the weight [m]."""

    friction_needed: float
    largest_couple: float
    least_normal_force: float
    largest_normal_force: float
    slip_from: float
    slip_time: float
    lost_from: float
    lost_time: float


def _of_solution(response: Trace) -> _Extremes:
    review = response.assumptions
    assert review is not None  # a reduced model knows
    breaches = {breach.code: breach for breach in review.breaches}
    lost, slips = breaches.get("tension"), breaches.get("friction_needed")
    return _Extremes(
        review.largest_friction_needed,
        review.largest_restraining_moment,
        review.least_normal_force,
        review.largest_normal_force,
        *((slips.time, slips.duration) if slips else (math.nan, 0.0)),
        *((lost.time, lost.duration) if lost else (math.nan, 0.0)),
    )


def _of_samples(
    time: Array, normal: Array, friction: Array, couple: Array, moving: NDArray[np.bool_], available: float
) -> _Extremes:
    lengths = np.diff(time, append=time[-1])

    def breach(where: NDArray[np.bool_]) -> tuple[float, float]:
        return (float(time[where.argmax()]), float(lengths[where].sum())) if where.any() else (math.nan, 0.0)

    lost = moving & (normal <= 0.0)
    return _Extremes(
        float(friction[moving].max(initial=0.0)),
        float(couple[moving].max(initial=0.0)),
        float(normal[moving].min()) if moving.any() else 1.0,
        float(normal[moving].max()) if moving.any() else 1.0,
        *breach(moving & ~lost & (friction > available)),
        *breach(lost),
    )


def _usual(values: np.ndarray) -> float:
    if not len(values):
        return 0.0
    # a value of the sample, because a mean with infinity is none
    return float(np.quantile(values, 1.0 - SPIKES, method="inverted_cdf"))
