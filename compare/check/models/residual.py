"""Layer: no displacement is left, and no twist: the cylinder ends where it stood."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from rockwobble.models import Case, Cylinder, el_centro_1940

from ..bench import Bench
from ..finding import Finding, at_most

LAYER = "residual"
CYLINDER = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
SQUAT = Cylinder(semidiagonal=6.0, tan_alpha=1.0)
ROUNDING = 1e-13
PLACE = "no twist, no roll-out: psi = -phi (14)"


def check(bench: Bench) -> Iterator[Finding]:
    """Yield the findings of this layer."""
    motion = el_centro_1940()
    runs = (
        ("El Centro doubled", CYLINDER, motion.scaled(2.0), 8.0),
        ("El Centro five times, tan alpha = 1", SQUAT, motion.scaled(5.0), 6.0),
    )
    for name, cylinder, record, duration in runs:
        found = bench.reduced.simulate(Case(cylinder, record, duration=duration))
        b, h = cylinder.base_radius, cylinder.mass_centre_height
        yield at_most(
            LAYER,
            f"twist phi + psi, {name}",
            np.abs(found.twist).max(),
            0.0,
            unit="rad",
            reason="exactly zero in a recess",
            part=PLACE,
        )
        moving = np.isfinite(found.rolling_angle) & (found.tilt > 0.0)
        radius = np.hypot(*found.contact_point[moving].T)
        yield at_most(
            LAYER,
            f"contact point on the original circle, {name}",
            np.abs(radius / b - 1.0).max(initial=0.0) if moving.any() else np.nan,
            ROUNDING,
            unit="b",
            reason="rounding",
            part=PLACE,
        )
        # the base centre is off its place by b (1 - cos theta), and with it nothing where the tilt is zero
        s, c = np.sin(found.tilt), np.cos(found.tilt)
        azimuth = np.nan_to_num(found.rolling_angle)
        ahead = np.column_stack([np.cos(azimuth), np.sin(azimuth)])
        base = found.centre_of_mass[:, :2] - h * s[:, None] * ahead
        yield at_most(
            LAYER,
            f"base centre off its place by b (1 - cos theta), {name}",
            np.abs(np.hypot(*base.T) - b * (1.0 - c)).max() / b,
            10.0 * ROUNDING,
            unit="b",
            reason="rounding of sums of the size of h",
            part="positions (8), (10), or roll-out",
        )
