"""The couple that a recess must supply so that the cylinder does not roll out."""

from __future__ import annotations

import math

import numpy as np

from .limit import Limit, Tables, column, first_failing, largest, short, up_to

# [weight times base radius]: a twentieth of what would tip the cylinder about its rim
SLIGHT = 0.05


def couple(tables: Tables) -> Limit:
    """Draw the limit from the couple along z_world + z_body in both maps."""
    free, shaken = tables["free_response"], tables["shaking"]
    moving = shaken[shaken["couple"].notna()]
    tan_alpha, needed = column(moving, "tan_alpha"), column(moving, "couple")
    slight = up_to(tan_alpha, needed <= SLIGHT)
    heavy = first_failing(tan_alpha, needed <= SLIGHT)
    worst = moving.iloc[int(np.argmax(needed))] if len(moving) else None
    numbers = {
        "free": largest(column(free, "couple")),
        "shaken": largest(needed),
        "slight_up_to": slight,
        "heavy_from": heavy,
    }
    use = (
        f"Up to tan α = {slight:g} a shallow recess is enough: it needs a couple of at most "
        f"{SLIGHT:g} weight × base radius."
        if math.isfinite(slight)
        else "With a recess made for its couple: at every slenderness mapped some shaking asks for more "
        "than "
        f"{SLIGHT:g} weight × base radius."
    )
    strongest = (
        ""
        if worst is None
        else f" (tan α {worst['tan_alpha']:g}, R = {worst['semidiagonal']:g} m, {worst['intensity']:g} g "
        "tan α)"
    )
    return Limit(
        subject="Couple of the recess",
        use=use,
        error=f"None while the recess holds; it must hold up to {short(numbers['free'])} weight × base "
        "radius in "
        f"free response and {short(numbers['shaken'])} under shaking{strongest}.",
        avoid=(
            f"On flat ground, which supplies no couple; nor, from tan α = {heavy:g} on, with a recess that "
            "holds "
            f"less than {SLIGHT:g} weight × base radius."
            if math.isfinite(heavy)
            else "On flat ground, which supplies no couple."
        ),
        numbers=numbers,
    )
