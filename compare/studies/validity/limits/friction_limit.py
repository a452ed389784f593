"""Friction: what the model needs, and where the engine begins to slip."""

from __future__ import annotations

import math

import numpy as np

from .limit import Array, Limit, Tables, column, largest, percent, quantile, short

# [b] in one period: less is the creep of a contact that never lets go
SLIPPED = 1e-3
# over tan(alpha): up to here a need is that of uplift, which is 1, and a little more
MODERATE = 2.0
# concrete on concrete, for the sake of an example
EXAMPLE = 0.6


def friction(tables: Tables) -> Limit:
    """Draw the limit from both maps and the engine with less friction than needed."""
    free, shaken, slip = tables["free_response"], tables["shaking"], tables["slip"]
    moving = shaken[shaken["friction"].notna()]
    tan_alpha = column(moving, "tan_alpha")
    need = column(moving, "friction") / tan_alpha
    reached, nine, beyond = _moderate(tan_alpha, need)
    share, slipped = column(slip, "share"), column(slip, "slip") > SLIPPED
    slips_at = largest(share[slipped])
    sticks = share[~slipped]
    nearest = slip[share == slips_at]
    numbers = {
        "free_response": largest(column(free, "friction") / column(free, "tan_alpha")),
        "half": quantile(need, 0.5),
        "moderate_up_to": reached,
        "nine_in_ten": nine,
        "beyond_from": beyond,
        "unlimited": float(np.isinf(need).mean()) if len(need) else math.nan,
        "slips_at": slips_at,
        "holds_from": float(sticks.min()) if len(sticks) else math.nan,
        "tilt_error": largest(column(nearest, "tilt_rms")),
        "slip": largest(column(nearest, "slip")),
        "example": min(EXAMPLE / nine, reached) if math.isfinite(nine) else math.nan,
    }
    return Limit(
        subject="Friction",
        use=_use(numbers),
        error=_error(numbers),
        avoid=_avoid(numbers),
        numbers=numbers,
    )


def _moderate(tan_alpha: Array, need: Array) -> tuple[float, float, float]:
    """Return up to which slenderness nine in ten need a moderate friction, how much, and what comes next."""
    reached = nine = math.nan
    for value in np.unique(tan_alpha):
        needed = float(np.quantile(need[tan_alpha == value], 0.9, method="inverted_cdf"))
        if not needed <= MODERATE:
            return reached, nine, float(value)
        reached, nine = float(value), needed if math.isnan(nine) else max(nine, needed)
    return reached, nine, math.nan


def _use(numbers: dict[str, float]) -> str:
    free = f"Free response needs at most {short(numbers['free_response'])} tan α."
    if math.isnan(numbers["moderate_up_to"]):
        return f"At no slenderness mapped is a friction of {MODERATE:g} tan α enough in nine of ten cases. "
        f"{free}"
    return (
        f"Up to tan α = {numbers['moderate_up_to']:g} with friction above {short(numbers['nine_in_ten'])} "
        "tan α, enough "
        f"in nine of ten cases that shake without falling; with a friction of {EXAMPLE:g} up to tan α = "
        f"{short(numbers['example'])}. {free}"
    )


def _error(numbers: dict[str, float]) -> str:
    if math.isnan(numbers["slips_at"]):
        return "The engine did not slip at any friction tried."
    held = (
        f", and holds from {numbers['holds_from']:g} of it on" if math.isfinite(numbers["holds_from"]) else ""
    )
    return (
        f"None above that. The engine slips at {numbers['slips_at']:g} of the friction that the model "
        f"needs{held}; there it slides {short(numbers['slip'])} b in one period and the tilt errs by "
        f"{percent(numbers['tilt_error'])} of α."
    )


def _avoid(numbers: dict[str, float]) -> str:
    words = "With friction below tan α the cylinder slides before it uplifts."
    if math.isfinite(numbers["beyond_from"]):
        words += (
            f" From tan α = {numbers['beyond_from']:g} on one case in ten needs more than {MODERATE:g} tan α."
        )
    return (
        f"{words} In {percent(numbers['unlimited'])} of the cases no friction is enough, because contact "
        "is lost."
    )
