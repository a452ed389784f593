"""Friction: what the model needs, and where the engine begins to slip."""

from __future__ import annotations

import math

import numpy as np

from .limit import Limit, Tables, column, largest, percent, quantile, short

# [b] in one period: less is the creep of a contact that never lets go
SLIPPED = 1e-3
# concrete on concrete, for the sake of an example
EXAMPLE = 0.6


def friction(tables: Tables) -> Limit:
    """Draw the limit from both maps and the engine with less friction than needed."""
    free, shaken, slip = tables["free_response"], tables["shaking"], tables["slip"]
    in_free = largest(column(free, "friction") / column(free, "tan_alpha"))
    need = column(shaken, "friction") / column(shaken, "tan_alpha")
    need = need[~np.isnan(need)]
    nine = float(np.quantile(need, 0.9, method="inverted_cdf")) if len(need) else math.nan
    share, slipped = column(slip, "share"), column(slip, "slip") > SLIPPED
    slips_at = float(share[slipped].max()) if slipped.any() else math.nan
    sticks = share[~slipped]
    holds_from = float(sticks.min()) if len(sticks) else math.nan
    nearest = slip[share == slips_at]
    numbers = {
        "free": in_free,
        "shaken_half": quantile(need, 0.5),
        "shaken_nine_in_ten": nine,
        "unlimited": float(np.isinf(need).mean()) if len(need) else math.nan,
        "slips_at": slips_at,
        "holds_from": holds_from,
        "tilt_error": largest(column(nearest, "tilt_rms")),
        "slip": largest(column(nearest, "slip")),
        "example": EXAMPLE / nine,
    }
    return Limit(
        subject="Friction",
        use=f"With friction above {short(nine)} tan α, which is enough in nine of ten cases that shake "
        "without "
        f"falling (half need {short(numbers['shaken_half'])} tan α, free response at most {short(in_free)} "
        "tan α); at "
        f"a friction of {EXAMPLE:g} that is tan α up to {short(numbers['example'])}.",
        error=_error(numbers),
        avoid=f"Without a recess that holds the base in place where friction is below tan α: the cylinder "
        f"slides before it uplifts. In {percent(numbers['unlimited'])} of the cases no friction is enough, "
        "because "
        "contact is lost.",
        numbers=numbers,
    )


def _error(numbers: dict[str, float]) -> str:
    if math.isnan(numbers["slips_at"]):
        return "The engine did not slip at any friction tried."
    held = (
        f", and holds from {short(numbers['holds_from'])} of it on"
        if math.isfinite(numbers["holds_from"])
        else ""
    )
    return (
        f"None above that. The engine slips at {short(numbers['slips_at'])} of the friction that the model "
        f"needs{held}; there it slides {short(numbers['slip'])} b in one period and the tilt errs by "
        f"{percent(numbers['tilt_error'])} of α."
    )
