"""Layer residual: no displacement is left, and no twist: the cylinder ends where it stood."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from rockwobble.models import Case, Cylinder, el_centro_1940

from ..bench import Bench, largest
from ..finding import Bound, Finding, at_most
from ..problems import PIER

SQUAT = Cylinder(semidiagonal=6.0, tan_alpha=1.0)
PLACE = "no twist, no roll-out: psi = -phi (14)"
NO_TWIST = Bound(0.0, "exactly zero in a recess", "rad")
CIRCLE = Bound(1e-13, "rounding", "b")
CENTRE = Bound(1e-12, "rounding of sums of the size of h", "b")


def check(bench: Bench) -> Iterator[Finding]:
    """Yield the findings of this layer."""
    motion = el_centro_1940()
    for name, cylinder, record, duration in (
        ("El Centro doubled", PIER, motion.scaled(2.0), 8.0),
        ("El Centro five times, tan alpha = 1", SQUAT, motion.scaled(5.0), 6.0),
    ):
        found = bench.solve(Case(cylinder, record, duration=duration))
        b, h = cylinder.base_radius, cylinder.mass_centre_height
        yield at_most(f"twist phi + psi, {name}", largest(found.twist), NO_TWIST, PLACE)
        moving = np.isfinite(found.rolling_angle) & (found.tilt > 0.0)
        radius = np.hypot(*found.contact_point[moving].T)
        off = largest(radius / b - 1.0) if moving.any() else math.nan
        yield at_most(f"contact point on the original circle, {name}", off, CIRCLE, PLACE)
        # the base centre is off its place by b (1 - cos theta), and with it nothing where the tilt is zero
        s, c = np.sin(found.tilt), np.cos(found.tilt)
        azimuth = np.nan_to_num(found.rolling_angle)
        ahead = np.column_stack([np.cos(azimuth), np.sin(azimuth)])
        base = found.centre_of_mass[:, :2] - h * s[:, None] * ahead
        yield at_most(
            f"base centre off its place by b (1 - cos theta), {name}",
            largest(np.hypot(*base.T) - b * (1.0 - c)) / b,
            CENTRE,
            "positions (8), (10), or roll-out",
        )
