"""What the recess model needs of ground and recess: friction, contact, restraining moment."""

from __future__ import annotations

import math

import numpy as np
import pandas as pd

from .distributions import cells
from .numbers import Numbers, Tables, column, first_failing, largest, up_to

# [b] in one period: less is the creep of a contact that never lets go
SLIPPED = 1e-3
# [weight times base radius]: a tenth of what would tip the cylinder about its rim
SLIGHT = 0.1


def needs(tables: Tables) -> pd.DataFrame:
    """Return what ground and recess must supply, by slenderness and intensity.

    What nine in ten of the records that rock a cylinder without overturning it need at most, of the size that
    needs most: sizes differ by a few percent, slenderness and intensity by factors.

    Returns
    -------
    DataFrame
        tan_alpha, intensity, sizes with enough such records, motions that rock them, friction over
        tan(alpha), normal [weights] (at least), and moment over weight and base radius. No row where no size
        has enough.
    """
    known = cells(tables).dropna(subset="moment_90")
    return known.groupby(["tan_alpha", "intensity"], as_index=False).agg(
        sizes=("semidiagonal", "count"),
        motions=("standing", "sum"),
        friction=("friction_90", "max"),
        normal=("normal_10", "min"),
        moment=("moment_90", "max"),
    )


def friction(tables: Tables) -> Numbers:
    """Return the friction needed over tan(alpha), and where the engine slips with less than needed."""
    free, slip = tables["free_response"], tables["slip"]
    moving = tables["peaks"][tables["peaks"]["friction"].notna()]
    share, slipped = column(slip, "share"), column(slip, "slip") > SLIPPED
    slips_at, sticks = largest(share[slipped]), share[~slipped]
    sticks = sticks[~(sticks <= slips_at)]  # what slips at one release does not hold at all
    nearest = slip[share == slips_at]
    return {
        "free_response": largest(column(free, "friction") / column(free, "tan_alpha")),
        "shaken": largest(column(moving, "friction") / column(moving, "tan_alpha")),
        "slips_at": slips_at,
        "holds_from": float(sticks.min()) if len(sticks) else math.nan,
        "tilt_error": largest(column(nearest, "tilt_rms")),
        "slip": largest(column(nearest, "slip")),
    }


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
        "shaken": largest(needed),
        "slight_up_to": up_to(tan_alpha, needed <= SLIGHT),
        "heavy_from": first_failing(tan_alpha, needed <= SLIGHT),
    }
