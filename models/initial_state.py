"""The state at release."""

from __future__ import annotations

import math
from dataclasses import dataclass

from .number_checks import require_finite
from .shown import Brief

_UNITS = {"tilt": "rad", "tilt_rate": "rad/s", "rolling_angle": "rad", "rolling_rate": "rad/s"}


@dataclass(frozen=True, slots=True, repr=False)
class InitialState(Brief):
    """Tilt, rolling angle and their rates at time zero; psi' = -phi' in every model and engine.

    Parameters
    ----------
    tilt : float
        theta, angle of the axis from the vertical [rad], 0 <= theta < pi/2.
    tilt_rate : float, optional
        theta' [rad/s].
    rolling_angle : float, optional
        phi, azimuth of the contact point seen from the centre of the base circle [rad].
    rolling_rate : float, optional
        phi' [rad/s].

    Raises
    ------
    ValueError
        If a value is not finite, the tilt is out of range, or a rate is given at zero tilt (where
        the direction of a rate has no meaning).

    Examples
    --------
    >>> InitialState(tilt=0.1, rolling_rate=0.5)
    InitialState(tilt=0.1, rolling_rate=0.5)
    """

    tilt: float
    tilt_rate: float = 0.0
    rolling_angle: float = 0.0
    rolling_rate: float = 0.0

    def __post_init__(self) -> None:
        for name, unit in _UNITS.items():
            object.__setattr__(self, name, require_finite(name, getattr(self, name), unit))
        if not 0.0 <= self.tilt < 0.5 * math.pi:
            raise ValueError(f"tilt must be at least 0 and below pi/2 [rad], got {self.tilt!r}")
        if self.tilt == 0.0 and (self.tilt_rate or self.rolling_rate):
            raise ValueError("tilt must be above 0 where tilt_rate or rolling_rate is given, got 0")
