"""Findings on the input: case, conditions, and sources of records."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import asdict
from typing import Any

from rockwobble.models import Case, GroundMotion
from rockwobble.models import case as of_case
from rockwobble.models.finding import Finding, Value
from rockwobble.models.ground_motion import sources_of
from rockwobble.models.plain_json import Facts

from .spectrum.parts import uplift_factor

DIFFERS = "differs"  # value of a condition that differs between cases
_GRAVITY = 9.81  # [m/s^2], of which a page says nothing
_MOST_SHOWN = 12  # sources of records


def _stated(key: str, /, **values: Value) -> Finding:
    return Finding(key=f"input.{key}", values=values)


def case_findings(case: Case) -> Iterator[Finding]:
    """Body, conditions and ground motion or release of a case."""
    cylinder, motion, initial, tendon = case.cylinder, case.motion, case.initial, case.tendon
    yield _stated(
        "cylinder",
        length=cylinder.base_radius,
        length_height=2.0 * cylinder.half_height,
        tilt=cylinder.alpha,
        length_semidiagonal=cylinder.semidiagonal,
        ratio=cylinder.tan_alpha,
    )
    if cylinder.slab_mass_ratio > 0.0:
        count = getattr(cylinder, "columns", 1)
        yield _stated("slab", ratio=cylinder.slab_mass_ratio, count=count)
    resistance = case.rolling_resistance / cylinder.base_radius
    stated = {"gravity": case.gravity, **case.terms, "tendon": tendon and asdict(tendon)}
    yield from condition_findings(stated | {"resistance_share": resistance})
    if motion is not None:
        threshold = cylinder.tan_alpha * (1.0 + resistance)  # over g
        factor = uplift_factor(motion, threshold, case.gravity, until=case.length)
        factor *= 1.0 if tendon is None else tendon.uplift_factor(cylinder)
        samples, components = motion.acceleration.shape
        yield _stated(
            "ground",
            name=motion.name or "record",
            count=samples,
            duration=motion.duration,
            count_components=components,
            ratio=motion.peak / case.gravity,
            factor=1.0 / factor,
            reason="within_the_run" if case.length < motion.duration else None,
        )
        yield from record_findings([motion])
    if initial is not None:
        yield _stated(
            "release", tilt=initial.tilt, ratio=initial.tilt / cylinder.alpha, rate=initial.rolling_rate
        )


def condition_findings(facts: Facts) -> Iterator[Finding]:
    """Conditions of a study that differ from the defaults.

    Parameters
    ----------
    facts : mapping
        gravity [m/s^2], slab_mass_ratio [-], rolling_resistance [m]; tendon, a mapping of its fields, or
        tendon_prestress and tendon_stiffness; any other term of a case by its name. Each may be missing, or
        be `DIFFERS`.
    """
    tendon = facts.get("tendon") or {
        name: facts.get(f"tendon_{name}", 0.0) for name in ("prestress", "stiffness")
    }
    stated: dict[str, Any] = {name: facts.get(name) for name in ("slab_mass_ratio", *of_case.TERMS)}
    for name, value in {**stated, "tendon": tendon, "gravity": facts.get("gravity", _GRAVITY)}.items():
        if value == DIFFERS:
            yield _stated("differs", name=f"condition_{name}")
        elif name == "gravity" and value != _GRAVITY:
            yield _stated("gravity", given=value)
        elif name == "tendon" and any(value.values()):
            given = {"given": value["prestress"], "given_stiffness": value["stiffness"]}
            yield _stated("tendon", **given, bound=value.get("yield_force") or math.nan)
        elif name in ("gravity", "tendon") or not value:
            continue
        elif name == "slab_mass_ratio":
            yield _stated("slab", ratio=value, count=math.nan)
        elif name == "rolling_resistance":
            yield _stated("resistance", length=value, ratio=facts.get("resistance_share"))
        else:
            yield _stated("term", name=name.replace("_", " ").capitalize(), detail=str(value))


def record_findings(motions: Iterable[GroundMotion | None]) -> Iterator[Finding]:
    """Source of each ground motion."""
    return source_findings(sources_of(motions))


def source_findings(sources: Sequence[str]) -> Iterator[Finding]:
    """First sources of records, and the number of others."""
    for source in sources[:_MOST_SHOWN]:
        yield _stated("record", detail=source)
    if len(sources) > _MOST_SHOWN:
        yield _stated("more_records", count=len(sources) - _MOST_SHOWN)
