"""Settings of the support "ring", a recess with walls and clearance, as parameters of a run."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass, fields
from typing import Any

from rockwobble.models.number_checks import quoted
from rockwobble.models.support import SUPPORTS

STEEPEST = 1.5  # [rad] a wall that leans further is a floor


@dataclass(frozen=True, slots=True, kw_only=True)
class RingSettings:
    """A ring of facets around the base, each an infinite half-space.

    Attributes
    ----------
    ring_clearance : float
        Distance of the foot of the walls from the base circle, in base radii. 1e-3 is not touched by a
        slender cylinder in free response (tan alpha 0.2, half of alpha); a tighter ring takes energy from
        it and holds it no better.
    ring_inclination : float
        Of the walls, outward from the vertical [rad]. Default alpha: the side of a cylinder that leans less
        than to its balance does not meet such a wall. Steeper walls hold better: under El Centro a slender
        cylinder rolls out by 0.005 b at 0.1 rad, 0.02 b at 0.5 and 0.1 b at 1.1.
    ring_facets : int
        Number of walls. The rim of a squat cylinder bumps from wall to wall: in free response at tan alpha
        1 it loses 34, 14, 7 and 5 % of its energy with 32, 64, 128 and 256; a slender one sees no
        difference. A wall costs 1.5 % of a step.
    ring_friction : float
        Coulomb coefficient of the pair wall and cylinder [-]. 0.5 is that of concrete or steel; without
        friction a cylinder rolls out and twists several times as far.

    Raises
    ------
    ValueError
        If a value is out of range.
    """

    ring_clearance: float = 1e-3
    ring_inclination: float
    ring_facets: int = 128
    ring_friction: float = 0.5

    def __post_init__(self) -> None:
        _require("ring_clearance", self.ring_clearance, 100.0, "base radii")
        _require("ring_inclination", self.ring_inclination, STEEPEST, "rad, outward from the vertical")
        _require("ring_friction", self.ring_friction, 100.0, "")
        if type(self.ring_facets) is not int or not 3 <= self.ring_facets <= 1000:
            raise ValueError(f"ring_facets must be a whole number from 3 to 1000, got {self.ring_facets!r}")

    def as_dict(self) -> dict[str, Any]:
        """Return the settings by name."""
        return asdict(self)


def take_ring(
    given: Mapping[str, Any], support: str, tan_alpha: float
) -> tuple[dict[str, Any], RingSettings | None]:
    """Return the settings that are not of the ring, and the ring; None for every other support.

    The inclination is arctan(tan_alpha) unless given.

    Raises
    ------
    ValueError
        If a setting of the ring is given for another support, or is out of range.
    """
    names = {field.name for field in fields(RingSettings)}
    others = {name: value for name, value in given.items() if name not in names}
    walls = {name: value for name, value in given.items() if name in names}
    if SUPPORTS[support].walls:
        return others, RingSettings(**{"ring_inclination": min(math.atan(tan_alpha), STEEPEST), **walls})
    if walls:
        raise ValueError(f"{', '.join(walls)} is for support 'ring' only, got support {support!r}")
    return others, None


def _require(name: str, value: Any, high: float, unit: str) -> None:
    number = isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)
    if not (number and 0.0 <= value <= high):
        raise ValueError(
            f"{name} must be from 0 to {high:g}{f' [{unit}]' if unit else ''}, got {quoted(value)}"
        )
