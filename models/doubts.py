"""Doubts about what a user states: records, lengths, gravity, masses and tendons probably in another unit.

Each doubt is a `Diagnostic`, and no error: structures of other sizes, and other planets, can be computed.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping

from .case import Case
from .cylinder import RockingBody
from .diagnostic import Diagnostic
from .ground_motion import GroundMotion
from .records.units import doubts_of
from .tendon import Tendon

LONGEST, SHORTEST = 300.0, 1e-3  # [m], height or diameter beyond those of structures and of their models
LARGEST_GRAVITY = 25.0  # [m/s^2], about that of Jupiter
# units in which somebody may have stated it, in m and in m/s^2
LENGTHS: Mapping[str, float] = {"mm": 1e-3, "cm": 1e-2, "in": 0.0254, "ft": 0.3048, "km": 1e3}
GRAVITIES: Mapping[str, float] = {"ft/s2": 0.3048, "in/s2": 0.0254, "cm/s2": 1e-2, "mm/s2": 1e-3}
_USUAL_LENGTH, _USUAL_GRAVITY = 8.0, 9.81  # [m], of a pier, and [m/s^2]
# [t/m^3], of mass over the volume of the cylinder: from that of foam to that of no metal
LIGHTEST, DENSEST = 0.01, 23.0
# [weights of a column], and these per base radius: a tendon of less holds nothing
WEAKEST = {"prestress": 0.02, "stiffness": 0.1}
STRONGEST = 1e3  # prestress [weights of a column]


def doubts_of_cases(cases: Iterable[Case], mass: float | None = None) -> list[dict[str, object]]:
    """Return the doubts about the input of some cases as plain values for a file.

    Each is there once; those about lengths and gravity have "cylinder" and "gravity" for a record. `mass`: of
    a cylinder, or of one column [t].

    Examples
    --------
    >>> from rockwobble.models import Cylinder
    >>> pier = Cylinder.from_dimensions(base_radius=800.0, height=9000.0)
    >>> [(each["record"], each["detail"]) for each in doubts_of_cases([Case(pier, duration=1.0)])]
    [('cylinder', 'mm')]
    """
    cases = list(cases)
    return doubts_about(
        motions=(case.motion for case in cases),
        cylinders=(case.cylinder for case in cases),
        gravities=(case.gravity for case in cases),
        tendons=(case.tendon for case in cases),
        mass=mass,
    )


def doubts_about(
    *,
    motions: Iterable[GroundMotion | None] = (),
    cylinders: Iterable[RockingBody] = (),
    gravities: Iterable[float] = (),
    tendons: Iterable[Tendon | None] = (),
    mass: float | None = None,
) -> list[dict[str, object]]:
    """Return the doubts about motions, cylinders, their mass [t], gravities [m/s^2] and tendons."""
    records = [motion for motion in motions if motion is not None]
    plain = doubts_of(records)
    others: list[tuple[str, Diagnostic]] = []
    for motion in records:
        others += ((motion.name or "record", fact) for fact in _same_components(motion))
    for cylinder in cylinders:
        others += (("cylinder", fact) for fact in length_doubts(cylinder))
        if mass is not None:
            others += (("mass", fact) for fact in mass_doubts(cylinder, mass))
    for gravity in gravities:
        others += (("gravity", fact) for fact in gravity_doubts(gravity))
    for tendon in filter(None, tendons):
        others += (("tendon", fact) for fact in tendon_doubts(tendon))
    known: dict[tuple[str, str, str], dict[str, object]] = {}
    for subject, fact in others:
        fields = {name: getattr(fact, name) for name in ("code", "size", "bound", "detail")}
        known.setdefault((subject, fact.code, fact.detail), {"record": subject} | fields)
    return [*plain, *known.values()]


def length_doubts(cylinder: RockingBody) -> Iterator[Diagnostic]:
    """Yield the doubt about a height or a base diameter beyond those of structures: "unlikely_length".

    Its size is the length [m], its bound the limit that it exceeds or falls below, its detail the unit that
    would make sense.
    """
    for length in (2.0 * cylinder.half_height, 2.0 * cylinder.base_radius):
        if not SHORTEST <= length <= LONGEST:
            bound = LONGEST if length > LONGEST else SHORTEST
            unit = likely_unit(length, LENGTHS, _USUAL_LENGTH)
            yield Diagnostic(code="unlikely_length", size=length, bound=bound, detail=unit)
            return


def gravity_doubts(gravity: float) -> Iterator[Diagnostic]:
    """Yield the doubt about a gravity beyond that of planets: "unlikely_gravity", as `length_doubts` does."""
    if gravity > LARGEST_GRAVITY:
        unit = likely_unit(gravity, GRAVITIES, _USUAL_GRAVITY)
        yield Diagnostic(code="unlikely_gravity", size=gravity, bound=LARGEST_GRAVITY, detail=unit)


def mass_doubts(cylinder: RockingBody, mass: float) -> Iterator[Diagnostic]:
    """Yield the doubt about a mass [t] that no solid has in this volume: "unlikely_mass", size in t/m3."""
    density = mass / (math.pi * cylinder.base_radius**2 * 2.0 * cylinder.half_height)
    if not LIGHTEST <= density <= DENSEST:
        yield Diagnostic(code="unlikely_mass", size=density, bound=DENSEST if density > DENSEST else LIGHTEST)


def tendon_doubts(tendon: Tendon) -> Iterator[Diagnostic]:
    """Yield the doubt about a prestress or a stiffness that no tendon has: "unlikely_tendon", its detail."""
    for name, least in WEAKEST.items():
        size = getattr(tendon, name)
        most = STRONGEST if name == "prestress" else math.inf
        if 0.0 < size < least or size > most:
            bound = least if size < least else most
            yield Diagnostic(code="unlikely_tendon", size=size, bound=bound, detail=name)
            return


def likely_unit(number: float, units: Mapping[str, float], usual: float) -> str:
    """Return the unit in which a number is closest to usual values."""
    return min(units, key=lambda unit: abs(math.log(number * units[unit] / usual)))


def _same_components(motion: GroundMotion) -> Iterator[Diagnostic]:
    columns = dict(zip("xyz", motion.acceleration.T, strict=False))
    for one, other in (("x", "y"), ("x", "z"), ("y", "z")):
        if other in columns and columns[one].any() and (columns[one] == columns[other]).all():
            yield Diagnostic(code="same_components", detail=f"{one} and {other}")
            return
