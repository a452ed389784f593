"""A case in words: what was understood of the input, in numbers."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rockwobble.models import Case, GroundMotion


def describe(case: Case) -> list[str]:
    """Return the lines that echo a case: what was understood, in numbers."""
    cylinder, motion, initial = case.cylinder, case.motion, case.initial
    lines = [
        f"Cylinder: b = {cylinder.base_radius:.4g} m, 2h = {2.0 * cylinder.half_height:.4g} m, "
        f"alpha = {math.degrees(cylinder.alpha):.4g} deg "
        f"(R = {cylinder.semidiagonal:g} m, tan alpha = {cylinder.tan_alpha:g})"
    ]
    if motion is not None:
        peak = motion.peak / case.gravity
        count, components = motion.acceleration.shape
        lines.append(
            f"Ground: {motion.name or 'record'}, {count} samples of {motion.time_step:g} s, "
            f"{components} components, peak {peak:.3f} g "
            f"({_uplift_ratio(case, motion):.2f} times the uplift threshold)"
        )
    if initial is not None:
        lines.append(
            f"Release: tilt {math.degrees(initial.tilt):.4g} deg "
            f"({initial.tilt / cylinder.alpha:.3g} alpha), rolling rate {initial.rolling_rate:g} rad/s"
        )
    lines.append(f"Length of the run: {case.length:.4g} s")
    return lines


def _uplift_ratio(case: Case, motion: GroundMotion) -> float:
    """Return the largest horizontal acceleration over tan(alpha) times gravity and the vertical one."""
    import numpy as np  # which no help needs

    x, y, *z = motion.acceleration.T
    weight = case.gravity + sum(z)
    with np.errstate(divide="ignore"):
        shares = np.hypot(x, y) / np.maximum(weight, 0.0) / case.cylinder.tan_alpha
    return float(np.nanmax(shares))


def group_of(name: str) -> str:
    """Return the group of a case: its name up to the first colon or comma, where the values follow."""
    return name.split(":")[0].split(",")[0].strip()
