"""One pair coefficient of friction, converted to the convention of each engine."""

from __future__ import annotations

import math

CONVENTIONS = ("pair", "maximum", "product")


def body_friction(pair: float, convention: str) -> tuple[float, float]:
    """Return the coefficients of cylinder and ground whose pair has the coefficient `pair` [-].

    Parameters
    ----------
    pair : float
        Coulomb coefficient between cylinder and ground.
    convention : {"pair", "maximum", "product"}
        How the engine combines two bodies: not at all, because it takes that of the pair (MuJoCo's
        explicit pairs); by the larger (MuJoCo's geoms); by the product (Bullet). A rim that slides in
        Bullet feels 2 to 5 % less friction than that; one that holds is not concerned.

    Raises
    ------
    ValueError
        If the convention is unknown.
    """
    if convention in ("pair", "maximum"):
        return pair, pair
    if convention == "product":
        # equal shares, because neither body is the rough one; Bullet bounds the product at 10
        return math.sqrt(pair), math.sqrt(pair)
    raise ValueError(f"convention must be one of {', '.join(CONVENTIONS)}, got {convention!r}")
