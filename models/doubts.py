"""Doubts about the input of a user: records, lengths, gravity, masses and tendons probably in another unit.

Each doubt is a `Diagnostic`, and no error: structures of other sizes, and other planets, can be computed.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from .case import Case
from .cylinder import RockingBody
from .diagnostic import Diagnostic
from .ground_motion import GroundMotion
from .record_source import LARGEST_MEAN, METRES_PER_SECOND_SQUARED, USUAL_UNITS
from .tendon import Tendon

LARGEST_PEAK = 2.0  # [g]; few records of any earthquake have more, most numbers in m/s^2 read as g do
LARGEST_SCALED_PEAK = 5.0  # [g], for a scaled record; the largest recorded peak is about 4 g
LARGEST_RATIO = 30.0  # ratio of the peaks of two components; gal read as m/s^2 gives 100, as g 981
LONGEST_STEP, SHORTEST_STEP = 0.1, 1e-4  # [s]; recorders take 50 to 1000 samples in a second
_USUAL_PEAK = 0.4  # [g], typical peak of a strong motion: the likely unit brings a peak near to it
# components of a rotated planar motion are in proportion, the small one by its azimuth
_PROPORTIONAL = 1e-9
_GRAVITY = (0.8, 1.2)  # [g], range of a mean that is the weight of the sensor
_END, _FEWEST_AT_END = 0.02, 3  # end of a record: share of its duration, and least number of samples
_STRONG = 0.3  # share of the peak that is improbable at the end
LONGEST, SHORTEST = 300.0, 1e-3  # [m], limits of the height or diameter of structures and of their models
LARGEST_GRAVITY = 25.0  # [m/s^2], about that of Jupiter
# likely units of the user's number, in m and in m/s^2
LENGTHS: Mapping[str, float] = {"mm": 1e-3, "cm": 1e-2, "in": 0.0254, "ft": 0.3048, "km": 1e3}
GRAVITIES: Mapping[str, float] = {"ft/s2": 0.3048, "in/s2": 0.0254, "cm/s2": 1e-2, "mm/s2": 1e-3}
_USUAL_LENGTH, _USUAL_GRAVITY = 8.0, 9.81  # [m], of a pier, and [m/s^2]
# [t/m^3], mass over the volume of the cylinder: from foam to more than the densest metal
LIGHTEST, DENSEST = 0.01, 23.0
# [weights of a column], and these per base radius: a weaker tendon has hardly an effect
WEAKEST = {"prestress": 0.02, "stiffness": 0.1}
STRONGEST = 1e3  # prestress [weights of a column]


def doubts_of_cases(cases: Iterable[Case], mass: float | None = None) -> list[dict[str, object]]:
    """Doubts about the input of some cases as plain values for a file.

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
    """Doubts about motions, cylinders, their mass [t], gravities [m/s^2] and tendons.

    Of a record that comes several times, as at several scales, each doubt is there once.
    """
    records = [motion for motion in motions if motion is not None]
    facts = [(each.name or "record", fact) for each in records for fact in doubts(each)]
    known = {(subject, fact.code): (subject, fact) for subject, fact in reversed(facts)}
    facts = list(known.values())[::-1]
    for motion in records:
        facts += ((motion.name or "record", fact) for fact in _same_components(motion))
    for cylinder in cylinders:
        facts += (("cylinder", fact) for fact in _length_doubts(cylinder))
        facts += (("mass", fact) for fact in _mass_doubts(cylinder, mass))
    facts += (("gravity", fact) for gravity in gravities for fact in _gravity_doubts(gravity))
    facts += (("tendon", fact) for tendon in tendons if tendon for fact in _tendon_doubts(tendon))
    plain: dict[tuple[str, str, str], dict[str, object]] = {}
    for subject, fact in facts:
        fields = {name: getattr(fact, name) for name in ("code", "size", "bound", "detail")}
        plain.setdefault((subject, fact.code, fact.detail), {"record": subject} | fields)
    return list(plain.values())


def doubts(motion: GroundMotion) -> tuple[Diagnostic, ...]:
    """Reasons why a ground motion is improbable.

    Of one that was read from files, what makes it improbable as it was read, see `RecordSource.doubts`, and a
    peak beyond 5 g after scaling. Of one made of an array its peaks.

    Returns
    -------
    tuple of Diagnostic
        "large_peak": size is the peak [g], detail the unit that would make sense; "unlike_components": size
        is the ratio of the peaks, detail the component that is larger; and the codes of a record in `CODES`.

    Examples
    --------
    >>> motion = GroundMotion([[0, 0], [981, 0.1], [-400, 0.02]], 0.01)
    >>> [(fact.code, fact.detail) for fact in doubts(motion)]
    [('large_peak', 'cm/s2'), ('unlike_components', 'x')]
    """
    if motion.source is None or not motion.source.from_files:
        return tuple(_peak_doubts(motion.acceleration))
    facts = motion.source.doubts
    if any(fact.code == "large_peak" for fact in facts):
        return facts
    peak = motion.peak / METRES_PER_SECOND_SQUARED["g"]
    if peak > LARGEST_SCALED_PEAK:  # its unit is known, so there is no advice on it
        facts = (*facts, Diagnostic(code="large_peak", size=peak, bound=LARGEST_SCALED_PEAK))
    return facts


def doubts_as_read(
    acceleration: NDArray[np.float64],
    time_step: float,
    directions: Sequence[str | None],
    units: Sequence[str],
) -> tuple[Diagnostic, ...]:
    """Reasons why a record is improbable.

    Parameters
    ----------
    acceleration : ndarray, shape (n, 2) or (n, 3)
        [m/s^2]
    time_step : float
        [s]
    directions : sequence of str or None
        Directions that the files state of x, y and z.
    units : sequence of str
        In which their numbers were read.

    Returns
    -------
    tuple of Diagnostic
    """
    facts = [*_peak_doubts(acceleration, units), *_of_means(acceleration), *_of_step(time_step)]
    return (*facts, *_of_end(acceleration), *_of_places(directions))


def _peak_doubts(acceleration: NDArray[np.float64], units: Sequence[str] = ()) -> Iterator[Diagnostic]:
    """Doubts about peaks: "large_peak", "unlike_components"."""
    peaks = np.abs(acceleration).max(axis=0)
    resultant = float(np.hypot(acceleration[:, 0], acceleration[:, 1]).max())
    peak = max(resultant, float(peaks.max())) / METRES_PER_SECOND_SQUARED["g"]
    if peak > LARGEST_PEAK:
        used = units[int(peaks.argmax())] if units else None
        metre, reads = METRES_PER_SECOND_SQUARED, ("g", "m/s2") if used is None else (used,)
        # a file in another unit, such as ft/s2, states it in full: then no other is likely
        smaller = {
            unit: metre[unit] / metre[read]
            for read in reads
            if read in USUAL_UNITS
            for unit in USUAL_UNITS
            if metre[unit] < metre[read]
        }
        likely = _likely_unit(peak, smaller, _USUAL_PEAK) if smaller else ""
        detail = f"{likely} for {used}" if used and likely else likely
        yield Diagnostic(code="large_peak", size=peak, bound=LARGEST_PEAK, detail=detail)
    moving = peaks[peaks > 0.0]
    ratio = float(moving.max() / moving.min()) if len(moving) else 1.0
    if ratio >= LARGEST_RATIO and not _in_one_plane(acceleration):
        axis = "xyz"[int(peaks.argmax())]
        yield Diagnostic(code="unlike_components", size=ratio, bound=LARGEST_RATIO, detail=axis)


def _in_one_plane(acceleration: NDArray[np.float64]) -> bool:
    x, y = acceleration[:, :2].T
    across = math.sqrt(float(x @ x) * float(y @ y))
    return acceleration.shape[1] == 2 and abs(across - abs(float(x @ y))) <= _PROPORTIONAL * across


def _of_means(acceleration: NDArray[np.float64]) -> Iterator[Diagnostic]:
    peaks, means = np.abs(acceleration).max(axis=0), acceleration.mean(axis=0)
    in_g = np.abs(means) / METRES_PER_SECOND_SQUARED["g"]
    weights = (in_g > _GRAVITY[0]) & (in_g < _GRAVITY[1]) & (np.abs(means) > 0.5 * peaks)
    for place in np.flatnonzero(weights):
        yield Diagnostic(code="gravity_in_record", size=float(in_g[place]), bound=1.0, detail="xyz"[place])
    with np.errstate(divide="ignore", invalid="ignore"):
        parts = np.where(weights | (peaks == 0.0), 0.0, np.abs(means) / peaks)
    if parts.max() > LARGEST_MEAN:
        axis = int(parts.argmax())
        yield Diagnostic(code="offset", size=float(parts[axis]), bound=LARGEST_MEAN, detail="xyz"[axis])


def _of_step(time_step: float) -> Iterator[Diagnostic]:
    if time_step > LONGEST_STEP * (1.0 + 1e-9):
        yield Diagnostic(code="unlikely_step", size=time_step, bound=LONGEST_STEP)
    if time_step < SHORTEST_STEP * (1.0 - 1e-9):
        yield Diagnostic(code="unlikely_step", size=time_step, bound=SHORTEST_STEP)


def _of_end(acceleration: NDArray[np.float64]) -> Iterator[Diagnostic]:
    count = max(_FEWEST_AT_END, round(_END * len(acceleration)))
    if len(acceleration) < 4 * count:
        return
    centred = np.abs(acceleration - acceleration.mean(axis=0)).max(axis=1)
    part = float(centred[-count:].max() / centred.max()) if centred.any() else 0.0
    if part > _STRONG:
        yield Diagnostic(code="ends_in_strong_motion", size=part, bound=_STRONG)


def _of_places(directions: Sequence[str | None]) -> Iterator[Diagnostic]:
    for axis, direction in zip("xyz", directions, strict=False):
        if direction is not None and direction != axis:
            yield Diagnostic(code="other_direction", detail=f"{axis} is {direction}")
            return


def _length_doubts(cylinder: RockingBody) -> Iterator[Diagnostic]:
    """Doubt about a height or a base diameter beyond those of structures: "unlikely_length".

    Its size is the length [m], its bound the limit that it exceeds or falls below, its detail the unit that
    would make sense.
    """
    for length in (2.0 * cylinder.half_height, 2.0 * cylinder.base_radius):
        if not SHORTEST <= length <= LONGEST:
            bound = LONGEST if length > LONGEST else SHORTEST
            unit = _likely_unit(length, LENGTHS, _USUAL_LENGTH)
            yield Diagnostic(code="unlikely_length", size=length, bound=bound, detail=unit)
            return


def _gravity_doubts(gravity: float) -> Iterator[Diagnostic]:
    """Doubt about a gravity beyond that of planets: "unlikely_gravity", with its likely unit."""
    if gravity > LARGEST_GRAVITY:
        unit = _likely_unit(gravity, GRAVITIES, _USUAL_GRAVITY)
        yield Diagnostic(code="unlikely_gravity", size=gravity, bound=LARGEST_GRAVITY, detail=unit)


def _mass_doubts(cylinder: RockingBody, mass: float | None) -> Iterator[Diagnostic]:
    """Doubt about a mass [t] unlike that of any solid of this volume: "unlikely_mass", size in t/m3."""
    if mass is None:
        return
    density = mass / (math.pi * cylinder.base_radius**2 * 2.0 * cylinder.half_height)
    if not LIGHTEST <= density <= DENSEST:
        yield Diagnostic(code="unlikely_mass", size=density, bound=DENSEST if density > DENSEST else LIGHTEST)


def _tendon_doubts(tendon: Tendon) -> Iterator[Diagnostic]:
    """Doubt about a prestress or a stiffness unlike those of tendons: "unlikely_tendon", with its detail."""
    for name, least in WEAKEST.items():
        size = getattr(tendon, name)
        most = STRONGEST if name == "prestress" else math.inf
        if 0.0 < size < least or size > most:
            bound = least if size < least else most
            yield Diagnostic(code="unlikely_tendon", size=size, bound=bound, detail=name)
            return


def _likely_unit(number: float, units: Mapping[str, float], usual: float) -> str:
    """Unit in which a number is closest to usual values."""
    return min(units, key=lambda unit: abs(math.log(number * units[unit] / usual)))


def _same_components(motion: GroundMotion) -> Iterator[Diagnostic]:
    columns = dict(zip("xyz", motion.acceleration.T, strict=False))
    for one, other in (("x", "y"), ("x", "z"), ("y", "z")):
        if other in columns and columns[one].any() and (columns[one] == columns[other]).all():
            yield Diagnostic(code="same_components", detail=f"{one} and {other}")
            return
