"""Settings of Drake, each with its reason by measurement."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from .values import GUIDE, build, one_of, positive


@dataclass(frozen=True, slots=True, kw_only=True)
class DrakeSettings:
    """Settings of Drake: contact in discrete time.

    Attributes
    ----------
    guide_stiffness : float
        As for MuJoCo [1/s^2].
    approximation : {"lagged", "similar", "tamsi", "sap"}
        Of contact. "lagged" is Drake's default and convex; SAP loses a hundred times more energy.
    contact_stiffness : float
        For each unit of mass, at the reference size [1/s^2]; the weight sinks in by 1e-9 m. It is solved
        for implicitly, so the step does not limit it.
    dissipation : float
        Of Hunt and Crossley, at the reference size [s/m]. Contact pushes apart by 1/dissipation at most
        [m/s]: without it a base that lands, by then as deep as it fell in a step, is thrown back by all of
        that. At 1000 it holds a rim that a near pass moves up.
    stiction_tolerance : float
        Speed at which what sticks creeps at the limit of friction, at the reference size [m/s]. At Drake's
        1e-4 a base under 0.8 of that creeps by 1.5e-4 m in a second. SAP's own limit, a thousandth of what a
        free body would gain in a step, is about as small.
    friction_damping : float
        As for MuJoCo: share of the slip velocity that one step removes. Drake knows no other than 1, which is
        made up for by a velocity of the frame. At 1.8 the error under twice El Centro on flat ground
        (6 m, 0.2) is 8.0e-5 alpha after 4 s of motion, at 1 it is 6.7e-4.
    """

    guide_stiffness: float
    approximation: str = "lagged"
    contact_stiffness: float = 1e10
    dissipation: float = 100.0
    stiction_tolerance: float = 1e-6
    friction_damping: float = 1.8

    @classmethod
    def resolve(cls, given: Mapping[str, Any], time_step: float) -> DrakeSettings:
        """Return the settings for a time step [s], with those `given` in place of the defaults.

        Raises
        ------
        ValueError
            If a setting is unknown or out of range.
        """
        settings = build(cls, "drake", given, {"guide_stiffness": (GUIDE / time_step) ** 2 / 4.0})
        positive(settings, "guide_stiffness")
        one_of(settings, "approximation", ("lagged", "similar", "tamsi", "sap"))
        positive(settings, "contact_stiffness")
        positive(settings, "dissipation", or_zero=True)
        positive(settings, "stiction_tolerance")
        positive(settings, "friction_damping", most=2.0)
        return settings
