"""Settings of Exudyn, each with its reason by measurement.

Measured on a release at alpha/2 with a rolling rate of 0.1 rad/s, h = 2 b, b = 1 m: error of the angle of
turn against the equations of the flat-ground model, 203.909800 deg.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from .values import build, one_of, positive, whole


@dataclass(frozen=True, slots=True, kw_only=True)
class ExudynSettings:
    """Settings of Exudyn: its integrator; an ideal rim leaves nothing else to set.

    Attributes
    ----------
    integrator : {"trapezoidal", "generalized-alpha"}
        The trapezoidal rule with constraints on velocities (index 2), or the generalized alpha method with
        constraints on positions (index 3). Both are second order and give the same turn to 1e-7 deg:
        2.1e-3, 8.4e-5 and 2.1e-5 deg off at steps of 1e-3, 2e-4 and 1e-4 s. The second is a third cheaper;
        the first holds what rolling is, a rim whose velocity is zero at the contact. Exudyn's explicit
        integrators, though of high order, do not take constraints.
    spectral_radius : float
        Of the generalized alpha method at infinite frequency. An ideal rim has no high frequency that
        would have to be damped: 0.5 makes the error of the tilt larger by half at 1e-4 s, and by 27 times
        at 2e-5 s; 0.9, the engine's default, by 2 %.
    relative_tolerance, absolute_tolerance : float
        At which Newton's iteration stops. The engine's own, 1e-8 and 1e-10, show as a fiftieth of the
        error of the tilt at 1e-4 s and as a fifth at 2e-5 s; these cost a quarter more there.
    iterations : int
        At most. With three, no step reaches these tolerances.
    """

    integrator: str = "trapezoidal"
    spectral_radius: float = 1.0
    relative_tolerance: float = 1e-12
    absolute_tolerance: float = 1e-13
    iterations: int = 25

    @classmethod
    def resolve(cls, given: Mapping[str, Any], time_step: float) -> ExudynSettings:
        """Return the settings, with those `given` in place of the defaults.

        Raises
        ------
        ValueError
            If a setting is unknown or out of range.
        """
        settings = build(cls, "exudyn", given, {})
        one_of(settings, "integrator", ("trapezoidal", "generalized-alpha"))
        positive(settings, "spectral_radius", most=1.0, or_zero=True)
        positive(settings, "relative_tolerance", most=1e-3)
        positive(settings, "absolute_tolerance", most=1e-3)
        whole(settings, "iterations")
        return settings
