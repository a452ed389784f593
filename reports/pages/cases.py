"""A case in words: what was understood of the input, in numbers."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable

    from rockwobble.models import Case, Cylinder, GroundMotion


def describe(case: Case) -> list[str]:
    """Return the lines that echo a case: what was understood, in numbers."""
    cylinder, motion, initial = case.cylinder, case.motion, case.initial
    lines = [
        f"Cylinder: b = {cylinder.base_radius:.4g} m, 2h = {2.0 * cylinder.half_height:.4g} m, "
        f"alpha = {math.degrees(cylinder.alpha):.4g} deg "
        f"(R = {cylinder.semidiagonal:g} m, tan alpha = {cylinder.tan_alpha:g})"
    ]
    if cylinder.slab_mass_ratio > 0.0:
        columns = getattr(cylinder, "columns", 1)
        named = "the column" if columns == 1 else f"all {columns} columns"
        lines.append(f"Slab: {cylinder.slab_mass_ratio:g} times the mass of {named} under it")
    resistance = case.rolling_resistance / cylinder.base_radius
    if resistance > 0.0:
        lines.append(f"Rolling resistance: {case.rolling_resistance:g} m ({resistance:.3g} b)")
    tendon = case.tendon
    if tendon is not None:
        lines.append(
            f"Tendon: prestress {tendon.prestress:.4g} weights of a column, stiffness {tendon.stiffness:.4g} "
            "weights per base radius"
            + (f", yields at {tendon.yield_force:.4g}" if tendon.yield_force is not None else "")
        )
    if motion is not None:
        # here, because the help of the command line needs no numpy
        from rockwobble.compare.studies.spectrum.maps import uplift_factor

        threshold = cylinder.tan_alpha * (1.0 + resistance)  # over g
        factor = uplift_factor(motion, threshold, case.gravity, until=case.length)
        factor *= 1.0 if tendon is None else tendon.uplift_factor(cylinder)
        within = " within the run" if case.length < motion.duration else ""
        count, components = motion.acceleration.shape
        lines.append(
            f"Ground: {motion.name or 'record'}, {count} samples of {motion.time_step:g} s, "
            f"{components} components, peak {motion.peak / case.gravity:.3f} g "
            f"({1.0 / factor:.2f} times the uplift threshold{within})"
        )
        lines += record_lines([motion])
    if initial is not None:
        lines.append(
            f"Release: tilt {math.degrees(initial.tilt):.4g} deg "
            f"({initial.tilt / cylinder.alpha:.3g} alpha), rolling rate {initial.rolling_rate:g} rad/s"
        )
    lines += case_warnings([case])
    lines.append(f"Length of the run: {case.length:.4g} s")
    return lines


MOST_SHOWN = 12  # sources of records; the pages have the same number


def record_lines(motions: Iterable[GroundMotion | None]) -> list[str]:
    """Return a line on what each ground motion is read from."""
    from rockwobble.models.records.units import sources_of

    sources = sources_of(motions)
    lines = [f"Record: {source}" for source in sources[:MOST_SHOWN]]
    if len(sources) > MOST_SHOWN:
        lines.append(f"and {len(sources) - MOST_SHOWN} records more, which manifest.json lists")
    return lines


def case_warnings(cases: Iterable[Case]) -> list[str]:
    """Return a line on each doubt about what cases state."""
    from rockwobble.models.doubts import doubts_of_cases

    from .diagnostics import warnings

    return warnings(doubts_of_cases(cases))


def warnings_about(
    motions: Iterable[GroundMotion], cylinders: Iterable[Cylinder] = (), gravity: float = 9.81
) -> list[str]:
    """Return a line on each doubt about motions, cylinders and a gravity [m/s^2]."""
    from rockwobble.models.doubts import doubts_about

    from .diagnostics import warnings

    return warnings(doubts_about(motions=motions, cylinders=cylinders, gravities=[gravity]))


def group_of(name: str) -> str:
    """Return the group of a case: its name up to the first colon or comma, where the values follow."""
    return name.split(":")[0].split(",")[0].strip()
