"""The couple that a recess must supply so that the cylinder does not roll out."""

from __future__ import annotations

import math

import numpy as np

from .limit import Limit, Tables, column, first_failing, largest, quantile, short, up_to

# [weight times base radius]: a tenth of what would tip the cylinder about its rim
SLIGHT = 0.1


def couple(tables: Tables) -> Limit:
    """Draw the limit from the couple along z_world + z_body in both maps."""
    free, shaken = tables["free_response"], tables["shaking"]
    moving = shaken[shaken["couple"].notna()]
    tan_alpha, needed = column(moving, "tan_alpha"), column(moving, "couple")
    slight, heavy = up_to(tan_alpha, needed <= SLIGHT), first_failing(tan_alpha, needed <= SLIGHT)
    numbers = {
        "free_response": largest(column(free, "couple")),
        "half": quantile(needed, 0.5),
        "nine_in_ten": quantile(needed, 0.9),
        "shaken": largest(needed),
        "slight_up_to": slight,
        "heavy_from": heavy,
    }
    where = ""
    if len(moving):
        worst = moving.iloc[int(np.argmax(needed))]
        where = (
            f" (tan α {worst['tan_alpha']:g}, R = {worst['semidiagonal']:g} m, "
            f"{worst['intensity']:g} g tan α)"
        )
    return Limit(
        subject="Couple of the recess",
        use=(
            f"Up to tan α = {slight:g} a light recess is enough: wherever the cylinder does not fall it "
            "asks for a "
            f"couple of at most {SLIGHT:g} weight × base radius."
            if math.isfinite(slight)
            else "With a recess made for its couple: at every slenderness mapped some shaking asks for "
            "more than "
            f"{SLIGHT:g} weight × base radius."
        ),
        error="None while the recess holds. Under shaking half of the cases ask for up to "
        f"{short(numbers['half'])} weight × base radius, nine in ten for up to "
        f"{short(numbers['nine_in_ten'])}, the "
        f"worst for {short(numbers['shaken'])}{where}; free response for {short(numbers['free_response'])}.",
        avoid=(
            f"On flat ground, which supplies no couple; nor, from tan α = {heavy:g} on, with a recess that "
            "holds "
            f"less than {SLIGHT:g} weight × base radius."
            if math.isfinite(heavy)
            else "On flat ground, which supplies no couple."
        ),
        numbers=numbers,
    )
