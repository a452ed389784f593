"""What the paper says of figure 5, held against this response and its neighbours."""

from __future__ import annotations

import math

import numpy as np

from .claim import Claim, verdict_of
from .earthquake import CYLINDER, NUDGE, Part, Shaken, abrupt_time

# a difference of a quarter is seen in a figure
_PLAINLY = 1.25
# a millionth of the base radius is below what any survey of a structure resolves
_RESIDUAL = 1e-6


def earthquake_claims(data: Shaken) -> list[Claim]:
    """Return the claims on figure 5."""
    return [_abrupt_claim(data), _smooth_claim(data), _return_claim(data)]


def _abrupt_claim(data: Shaken) -> Claim:
    strong, weak = data.strong, data.weak
    others = sum(2 * part.abrupt > part.passes for part, _ in data.neighbours)
    return Claim(
        says="φ changes abruptly during the more intense part of the ground motion.",
        found=f"while the record by itself can uplift the cylinder, from {data.response.uplift_time:.2f} to "
        f"{data.strong_end:.2f} s, the middle half of the turn takes {_time(strong.half_turn)} (median of "
        f"{strong.passes} passes); {strong.abrupt} of them are abrupt, faster than {_time(abrupt_time())}, a "
        f"tenth of what steady wobble at α/2 takes. So are {weak.abrupt} of the {weak.passes} passes after "
        f"that. Most passes of the strong part are abrupt in {others} of {len(data.neighbours)} runs with "
        "the record scaled by up to a tenth.",
        verdict=verdict_of(strong.abrupt > 0, 2 * strong.abrupt > strong.passes),
    )


def _smooth_claim(data: Shaken) -> Claim:
    strong, weak = data.strong, data.weak
    return Claim(
        says="when the ground motion becomes weaker the cylinder follows a quasi-free vibration, and the "
        "movement of the contact point is slower and smoother.",
        found=f"after {data.strong_end:.2f} s the energy changes from one pass to the next by "
        f"{_percent(weak.energy_change)} (median; {_percent(strong.energy_change)} before), the middle half "
        f"of the turn takes {_time(weak.half_turn)} ({_time(strong.half_turn)} before), the size of the "
        f"angle of turn scatters by {math.degrees(weak.scatter):.0f} deg "
        f"({math.degrees(strong.scatter):.0f} before), and the contact point turns back {weak.reversals} "
        f"times in {weak.passes} passes ({strong.reversals} in {strong.passes} before). "
        f"{_neighbours(data)}",
        verdict=verdict_of(_quasi_free(strong, weak), _slower(strong, weak), _smoother(strong, weak)),
    )


def _quasi_free(strong: Part, weak: Part) -> bool:
    return _PLAINLY * weak.energy_change < strong.energy_change


def _slower(strong: Part, weak: Part) -> bool:
    return weak.half_turn > _PLAINLY * strong.half_turn


def _smoother(strong: Part, weak: Part) -> bool:
    # reversals by the pass, without a division where there is none
    steadier = _PLAINLY * weak.scatter < strong.scatter
    return steadier and _PLAINLY * weak.reversals * strong.passes < strong.reversals * weak.passes


def _neighbours(data: Shaken) -> str:
    counts = [
        sum(test(strong, weak) for strong, weak in data.neighbours)
        for test in (_quasi_free, _slower, _smoother)
    ]
    total = len(data.neighbours)
    return (
        f"Of {total} runs with the record scaled by up to a tenth, {counts[0]} are plainly nearer to free "
        f"vibration there (by a quarter or more), {counts[1]} slower and {counts[2]} smoother."
    )


def _return_claim(data: Shaken) -> Claim:
    response = data.response
    least = float(response.passes["minimum_tilt"].min())
    away = 2.0 * math.sin(0.5 * least) ** 2
    last = 2.0 * math.sin(0.5 * float(response.tilt[-1])) ** 2
    twist = float(np.abs(response.twist).max())
    end = (
        "it stands where it stood"
        if response.outcome == "rest"
        else f"it still rocks, undamped as it is, at {response.tilt[-1] / CYLINDER.alpha:.3f} α, the centre "
        f"of its base {last:.1g} b from its place"
    )
    return Claim(
        says="the cylinder has zero residual displacement at the end of its motion.",
        found=f"the peak tilt is {response.peak_tilt / CYLINDER.alpha:.3f} α; at the end of the record "
        f"{end}. At the nearest of its {len(response.passes)} passes by the upright position that distance "
        f"is {away:.0e} b, and the twist is {twist:g} throughout: upright it is back in its place.",
        verdict=verdict_of(response.outcome in ("rest", "completed"), away < _RESIDUAL, twist == 0.0),
    )


def sensitivity(data: Shaken) -> str:
    """Return the sentence on how far this one response can be trusted."""
    stronger = f"stronger by {100.0 * NUDGE:g} %, less than tells two instruments apart,"
    if math.isinf(data.horizon):
        return f"A twin whose record is {stronger} stays within 1 % of α of this response to the end."
    return (
        f"A twin whose record is {stronger} differs by 1 % of α from {data.horizon:.1f} s on: passes close "
        "to upright amplify every difference, and from there on this response is one of many."
    )


def _time(value: float) -> str:
    return f"{1e3 * value:.0f} ms"


def _percent(share: float) -> str:
    return f"{100.0 * share:.1f} %"
