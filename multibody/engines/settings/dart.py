"""Settings of DART, each with its reason by measurement."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from .values import GUIDE, build, positive, whole


@dataclass(frozen=True, slots=True, kw_only=True)
class DartSettings:
    """Settings of DART: hard contact has neither stiffness nor damping.

    Attributes
    ----------
    guide_stiffness : float
        As for MuJoCo [1/s^2].
    depth : float
        At which the rim is kept, at the reference size [m]: so much that where the detector finds the rim
        instead of corners, from a lean of depth/b on, its radius is off by 1e-4 b only. It is taken off the
        poses.
    depth_gain : float
        Share of a change of depth that one step takes back. At 0.3 what two steps extrapolate to is 4e-9,
        1e-8 and 2e-7 alpha off after a release at tan alpha 0.35, 1 and 3; at 0.05 it is 7e-8, 5e-7 and 3e-6.
        1 would make landing elastic.
    friction_damping : float
        As for MuJoCo: share of the slip velocity that one step removes. DART knows no other than 1, which is
        made up for by a velocity of the ground. At 1.8 the error of a free response is a fifth to a tenth of
        that at 1, and under twice El Centro on flat ground (R = 6 m, tan alpha 0.2, to 22 s) it is 7e-3 alpha
        and not 7e-2, for a fifth more time a step.
    tolerance, iterations : float, int
        Of the Gauss-Seidel method; one contact takes a single sweep, the four of a base that is about to open
        some hundreds, and fewer leave it a velocity.
    """

    guide_stiffness: float
    depth: float = 1e-6
    depth_gain: float = 0.3
    friction_damping: float = 1.8
    tolerance: float = 1e-12
    iterations: int = 1000

    @classmethod
    def resolve(cls, given: Mapping[str, Any], time_step: float) -> DartSettings:
        """Return the settings for a time step [s], with those `given` in place of the defaults.

        Raises
        ------
        ValueError
            If a setting is unknown or out of range.
        """
        settings = build(cls, "dart", given, {"guide_stiffness": (GUIDE / time_step) ** 2 / 4.0})
        positive(settings, "guide_stiffness")
        positive(settings, "depth", most=1e-3)
        positive(settings, "depth_gain", most=1.0)
        positive(settings, "friction_damping", most=2.0)
        positive(settings, "tolerance", most=1e-3)
        whole(settings, "iterations")
        return settings
