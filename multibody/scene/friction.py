"""One pair coefficient of friction, converted to the convention of each engine."""

from __future__ import annotations

import math

CONVENTIONS = ("pair", "product")


def body_friction(pair: float, convention: str) -> float:
    """Return the coefficient of cylinder and ground alike whose pair has the coefficient `pair` [-].

    Parameters
    ----------
    pair : float
        Coulomb coefficient between cylinder and ground.
    convention : {"pair", "product"}
        How the engine combines two equal bodies: to what both have, or not at all, because it takes that
        of the pair (MuJoCo's explicit pairs); by the product (Bullet). A rim that slides in Bullet feels
        2 to 5 % less friction than that; one that holds is not concerned.

    Raises
    ------
    ValueError
        If the convention is unknown.
    """
    if convention == "pair":
        return pair
    if convention == "product":
        return math.sqrt(pair)  # neither body is the rough one; Bullet bounds the product at 10
    raise ValueError(f"convention must be one of {', '.join(CONVENTIONS)}, got {convention!r}")
