"""A case in words: what was understood of the input, in numbers."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from rockwobble.models import Case, GroundMotion, RockingBody
    from rockwobble.models.plain_json import Facts


def case_lines(case: Case, mass: float | None = None) -> list[str]:
    """Return the lines that echo a case and the mass of a column [t]: what was understood, in numbers."""
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
    stated = {"gravity": case.gravity, **case.terms, "tendon": tendon and dataclasses.asdict(tendon)}
    lines += conditions({name: value for name, value in stated.items() if name != "rolling_resistance"})
    if motion is not None:
        # here, because the help of the command line needs no numpy
        from rockwobble.studies.spectrum.maps import uplift_factor

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
    lines += case_warnings([case], mass)
    lines.append(f"Length of the run: {case.length:.4g} s")
    return lines


_GRAVITY = 9.81  # [m/s^2], of which a page says nothing
DIFFERS = "differs"  # a condition that cases have several of


def conditions(facts: Facts) -> list[str]:
    """Return a line on each condition of a study that is not the usual one.

    Parameters
    ----------
    facts : mapping
        gravity [m/s^2], slab_mass_ratio [-], rolling_resistance [m]; tendon, a mapping of its fields, or
        tendon_prestress and tendon_stiffness; any other term of a case by its name. Each may be missing, or
        be `DIFFERS`.
    """
    from rockwobble.models.case import TERMS  # here, because the help of the command line needs no numpy

    gravity = facts.get("gravity", _GRAVITY)
    slab, resistance = facts.get("slab_mass_ratio", 0.0), facts.get("rolling_resistance", 0.0)
    tendon = facts.get("tendon") or {
        name: facts.get(f"tendon_{name}", 0.0) for name in ("prestress", "stiffness")
    }
    pulls = tendon if isinstance(tendon, str) else any(tendon.values()) and _of_tendon(tendon)
    stated = {
        "Slab": slab and (slab if slab == DIFFERS else f"{slab:g} times the mass of its columns"),
        "Rolling resistance": resistance and (resistance if resistance == DIFFERS else f"{resistance:g} m"),
        "Tendon": pulls,
        "Gravity": gravity != _GRAVITY and (gravity if gravity == DIFFERS else f"{gravity:g} m/s²"),
    }
    for name in TERMS:
        if name not in ("rolling_resistance", "tendon") and facts.get(name):
            stated[name.replace("_", " ").capitalize()] = str(facts[name])
    return [f"{name}: {words}" for name, words in stated.items() if words]


def _of_tendon(fields: Mapping[str, Any]) -> str:
    yields = fields.get("yield_force")
    return (
        f"prestress {fields['prestress']:.4g} weights of a column, stiffness {fields['stiffness']:.4g} "
        "weights per base radius"
    ) + (f", yields at {yields:.4g}" if yields is not None else "")


_MOST_SHOWN = 12  # sources of records


def record_lines(motions: Iterable[GroundMotion | None]) -> list[str]:
    """Return a line on what each ground motion is read from."""
    from rockwobble.models.records.units import sources_of

    return source_lines(sources_of(motions), "which manifest.json lists")


def source_lines(sources: Sequence[str], where: str) -> list[str]:
    """Return a line on each of the first sources of records, and one on how many more stand `where`."""
    lines = [f"Record: {source}" for source in sources[:_MOST_SHOWN]]
    if (more := len(sources) - _MOST_SHOWN) > 0:
        lines.append(f"and {more} records more, {where}")
    return lines


def case_warnings(cases: Iterable[Case], mass: float | None = None) -> list[str]:
    """Return a line on each doubt about what cases, and the mass of a column [t], state."""
    from rockwobble.models.doubts import doubts_of_cases

    from .diagnostics import warnings

    return warnings(doubts_of_cases(cases, mass))


def warnings_about(
    motions: Iterable[GroundMotion], cylinders: Iterable[RockingBody] = (), gravity: float = 9.81
) -> list[str]:
    """Return a line on each doubt about motions, cylinders and a gravity [m/s^2]."""
    from rockwobble.models.doubts import doubts_about

    from .diagnostics import warnings

    return warnings(doubts_about(motions=motions, cylinders=cylinders, gravities=[gravity]))


def group_of(name: str) -> str:
    """Return the group of a case: its name up to the first colon or comma, where the values follow."""
    return name.split(":")[0].split(",")[0].strip()
