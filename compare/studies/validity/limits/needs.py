"""What the recess model needs of ground and recess: friction, contact, restraining moment."""

from __future__ import annotations

import math

import numpy as np

from .numbers import Array, Numbers, Tables, column, first_failing, largest, quantile, reached, up_to

# [b] in one period: less is the creep of a contact that never lets go
SLIPPED = 1e-3
# over tan(alpha): up to here a need is that of uplift, which is 1, and a little more
MODERATE = 2.0
# [weight times base radius]: a tenth of what would tip the cylinder about its rim
SLIGHT = 0.1


def friction(tables: Tables) -> Numbers:
    """Return the friction needed over tan(alpha), and where the engine slips with less than needed.

    up_to, nine_in_ten, beyond_from: the slenderness up to which nine in ten runs that rock without
    overturning need a `MODERATE` friction, how much, and the next slenderness.
    """
    free, slip = tables["free_response"], tables["slip"]
    moving = tables["peaks"][tables["peaks"]["friction"].notna()]
    tan_alpha = column(moving, "tan_alpha")
    need = column(moving, "friction") / tan_alpha
    held, nine, beyond = _moderate(tan_alpha, need)
    share, slipped = column(slip, "share"), column(slip, "slip") > SLIPPED
    slips_at, sticks = largest(share[slipped]), share[~slipped]
    sticks = sticks[~(sticks <= slips_at)]  # what slips at one release does not hold at all
    nearest = slip[share == slips_at]
    return {
        "free_response": largest(column(free, "friction") / column(free, "tan_alpha")),
        "half": quantile(need, 0.5),
        "up_to": held,
        "nine_in_ten": nine,
        "beyond_from": beyond,
        "slips_at": slips_at,
        "holds_from": float(sticks.min()) if len(sticks) else math.nan,
        "tilt_error": largest(column(nearest, "tilt_rms")),
        "slip": largest(column(nearest, "slip")),
    }


def _moderate(tan_alpha: Array, need: Array) -> tuple[float, float, float]:
    held = nine = math.nan
    for value in np.unique(tan_alpha):
        needed = reached(need[tan_alpha == value], 0.9)
        if not needed <= MODERATE:
            return held, nine, float(value)
        held, nine = float(value), needed if math.isnan(nine) else max(nine, needed)
    return held, nine, math.nan


def contact(tables: Tables) -> Numbers:
    """Return the least normal force [weights], and from which slenderness and intensity contact is lost."""
    moving = tables["peaks"][tables["peaks"]["least_normal"].notna()]
    tan_alpha, normal = column(moving, "tan_alpha"), column(moving, "least_normal")
    in_free = column(tables["free_response"], "least_normal")
    lost = moving[normal <= 0.0]
    held = up_to(tan_alpha, normal > 0.0)
    within = normal[tan_alpha <= held]
    return {
        "held_up_to": held,
        "lost_from": first_failing(tan_alpha, normal > 0.0),
        "lost_intensity": float(lost["intensity"].min()) if len(lost) else math.nan,
        "least_held": float(within.min()) if len(within) else math.nan,
        "least": float(np.concatenate([normal, in_free]).min()),
        "lost": float(len(lost)),
        "runs": float(len(moving)),
        "free_least": float(in_free.min()),
        "free_lost_from": first_failing(column(tables["free_response"], "tan_alpha"), in_free > 0.0),
    }


def restraining_moment(tables: Tables) -> Numbers:
    """Return the restraining moment over weight and base radius."""
    moving = tables["peaks"][tables["peaks"]["moment"].notna()]
    tan_alpha, needed = column(moving, "tan_alpha"), column(moving, "moment")
    return {
        "free_response": largest(column(tables["free_response"], "moment")),
        "half": quantile(needed, 0.5),
        "nine_in_ten": quantile(needed, 0.9),
        "shaken": largest(needed),
        "slight_up_to": up_to(tan_alpha, needed <= SLIGHT),
        "heavy_from": first_failing(tan_alpha, needed <= SLIGHT),
    }
