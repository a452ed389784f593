"""Contact: where the ground would have to pull."""

from __future__ import annotations

import math

import numpy as np

from .limit import Limit, Tables, column, first_failing, percent, short, up_to


def loss_of_contact(tables: Tables) -> Limit:
    """Draw the limit from the least normal force of both maps."""
    free, shaken = tables["free_response"], tables["shaking"]
    moving = shaken[shaken["least_normal"].notna()]
    tan_alpha, normal, in_free = (
        column(moving, "tan_alpha"),
        column(moving, "least_normal"),
        column(free, "least_normal"),
    )
    lost = normal <= 0.0
    held, fails = up_to(tan_alpha, normal > 0.0), first_failing(tan_alpha, normal > 0.0)
    at = moving[lost]
    numbers = {
        "held_up_to": held,
        "lost_from": fails,
        "least_held": float(normal[tan_alpha <= held].min()) if math.isfinite(held) else math.nan,
        "least": float(np.concatenate([normal, in_free]).min()),
        "lost_share": float(lost.mean()) if len(lost) else 0.0,
        "lost_intensity": float(at["intensity"].min()) if len(at) else math.nan,
        "free_lost": float((in_free <= 0.0).mean()),
        "free_least": float(in_free.min()),
    }
    use = (
        f"Up to tan α = {held:g}: wherever the cylinder does not fall it keeps pressing on the ground, "
        "with at "
        f"least {short(numbers['least_held'])} of its weight."
        if math.isfinite(held)
        else "At no slenderness mapped is contact kept everywhere."
    )
    where = (
        f", from {numbers['lost_intensity']:g} g tan α on" if math.isfinite(numbers["lost_intensity"]) else ""
    )
    avoid = (
        f"From tan α = {fails:g} on under strong shaking{where}: the ground would have to pull with up to "
        f"{short(-numbers['least'])} weights; a real cylinder takes off."
        if math.isfinite(fails)
        else "Nowhere on the maps for this reason."
    )
    return Limit(
        subject="Loss of contact",
        use=use,
        error=f"Contact is lost in {percent(numbers['lost_share'])} of the shaken cells that do not fall, "
        "and "
        f"in {percent(numbers['free_lost'])} of those of free response, which presses with at least "
        f"{short(numbers['free_least'])} of the weight.",
        avoid=avoid,
        numbers=numbers,
    )
