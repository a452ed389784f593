"""The static uplift sweep of the contract: threshold and direction of uplift."""

from __future__ import annotations

import dataclasses
import math

import numpy as np

from rockwobble.models import GroundMotion

from ..scene.froude import REFERENCE_GRAVITY
from .problem import PIER, hold, run, small

SWEEP_SLENDERNESS, SWEEP_DIRECTIONS, SWEEP_SHARES = (0.1, 0.2, 0.5, 1.0), 24, (0.98, 1.02)
SWEEP_DIRECTION = math.radians(1.0)
OPENED = 1e-4  # of alpha, after 0.1 s of a load 2 % over the threshold; exact is 1.2e-4
# [-] a direction that is none of the symmetries of a detector, in steps of the sweep
_ASIDE = 0.04


def uplifts_in_every_direction(engine: str, support: str) -> None:
    """A cylinder stands at 0.98 and uplifts at 1.02 of g tan(alpha), in the direction of the load."""
    for tan_alpha in SWEEP_SLENDERNESS:
        cylinder = dataclasses.replace(PIER, tan_alpha=tan_alpha)
        for azimuth in 2.0 * math.pi * (np.arange(SWEEP_DIRECTIONS) + _ASIDE) / SWEEP_DIRECTIONS:
            at = f"of g tan(alpha) = {tan_alpha:g} g towards {math.degrees(azimuth):.1f} deg"
            for share in SWEEP_SHARES:
                push = (
                    share * REFERENCE_GRAVITY * tan_alpha * np.array([math.cos(azimuth), math.sin(azimuth)])
                )
                motion = GroundMotion([0.0 * push, *[push] * 6], 0.02)
                given = {"cylinder": cylinder, "motion": motion, "initial": None, "friction": 2.0}
                found = run(engine, support, duration=None, **given)
                if share < 1.0:
                    hold(found.rests, f"it does not stand still at {share} {at}: {found.outcome}")
                    hold(math.isnan(found.uplift_time), f"it uplifts at {share} {at}")
                    continue
                hold(found.tilt[-1] > OPENED * cylinder.alpha, f"it does not uplift at {share} {at}")
                for name, angle in (("uplifts", found.uplift_direction), ("leans", found.rolling_angle[-1])):
                    off = math.remainder(angle - azimuth - math.pi, 2.0 * math.pi)
                    small(off, SWEEP_DIRECTION, f"it {name} in another direction at {share} {at}")
