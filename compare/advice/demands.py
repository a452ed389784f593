"""What the ground and the recess must supply so that a solution of a reduced model is possible."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from rockwobble.reduced import Response

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


def demands_of(response: Response) -> Demands:
    """Return the demands of a response: extremes from every step, the usual ones from its samples."""
    review = response.assumptions
    breaches = {breach.assumption: breach for breach in review.breaches}
    lost, slips = breaches.get("contact"), breaches.get("friction")
    moving = response.tilt > 0.0
    lengths = np.diff(response.time, append=response.time[-1])
    from_rest = response.uplift_time > 0.0
    return Demands(
        moving_time=float(lengths[moving].sum()),
        friction=response.friction,
        friction_needed=review.largest_friction_needed,
        friction_usual=_usual(response.friction_needed[moving]),
        slip_from=slips.first_time if slips else math.nan,
        slip_time=slips.duration if slips else 0.0,
        slides=from_rest and response.friction < response.cylinder.tan_alpha,
        couple=review.largest_couple * response.gravity,
        couple_usual=_usual(np.abs(response.recess_couple[moving])) * response.gravity,
        couple_in_radii=review.largest_couple / response.cylinder.base_radius,
        least_normal_force=review.least_normal_force,
        largest_normal_force=review.largest_normal_force,
        lost_from=lost.first_time if lost else math.nan,
        lost_time=lost.duration if lost else 0.0,
    )


def _usual(values: np.ndarray) -> float:
    if not len(values):
        return 0.0
    # a value of the sample, because a mean with infinity is none
    return float(np.quantile(values, 1.0 - SPIKES, method="inverted_cdf"))
