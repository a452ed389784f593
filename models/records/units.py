"""Units of acceleration, as the files of records state them, and doubts where one cannot be right."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Iterator
from pathlib import Path

import numpy as np

from ..diagnostic import Diagnostic
from ..ground_motion import GroundMotion

# 1 g is 9.81 m/s^2, the default gravity of every model here, so that a/g stays what the file says
METRES_PER_SECOND_SQUARED = {"g": 9.81, "m/s2": 1.0, "cm/s2": 0.01}
UNITS = tuple(METRES_PER_SECOND_SQUARED)

_SPELLINGS = {
    "g": "g g's gs",
    "m/s2": "m/s2 m/s^2 m/s/s m/s**2 m/s² m/sec2 m/sec^2 m/sec**2 m/sec/sec",
    "cm/s2": "cm/s2 cm/s^2 cm/s/s cm/s**2 cm/s² cm/sec2 cm/sec^2 cm/sec**2 cm/sec/sec gal",
}
_UNIT_OF = {spelling: unit for unit, spellings in _SPELLINGS.items() for spelling in spellings.split()}
# a word that can only be a unit, so that one which is not allowed is refused instead of overlooked
_RATE = re.compile(r"[a-z]{1,3}/s(?:ec)?\S*", re.IGNORECASE)
# parts of g, which no spelling above allows
_PART = re.compile(r"%\s?g|m(?:illi-?)?g(?:al)?|[µμ]g", re.IGNORECASE)
_TIME = r"((?:m|milli|[uµμ]|micro)s(?:ec(?:ond)?s?)?|min(?:ute)?s?)"
_OTHER_TIME = re.compile(
    rf"\b(?:time|t)(?:\s*[\[(]\s*{_TIME}\s*[\])]|(?:\s+in\s+|_){_TIME}\b)", re.IGNORECASE
)
_WORD = r"(%\s?g|[^\s,;()\[\]]+)"
_PLACES = tuple(
    re.compile(place, re.IGNORECASE)
    for place in (
        rf"[\[(]\s*{_WORD}\s*[\])]",
        rf"\bunits?\b(?:\s*[:=]|\s+(?:of|in|are|is)\b)*\s*{_WORD}",
        rf"\bacc[a-z]*\.?[\s,:]+(?:in\s+)?{_WORD}",
    )
)


def stated_unit(path: Path, header: list[str]) -> str | None:
    """Return the unit of acceleration that the header lines state, None where they are silent.

    A unit stands in brackets, "time [s], acceleration [cm/s^2]", after the word units, "UNITS OF G",
    or right after the acceleration, "t, acc in g". A "0.3 g" elsewhere is a value and states nothing.

    Raises
    ------
    ValueError
        If the file holds velocities or displacements, or states a unit that is not allowed, or two.
    """
    _require_acceleration(path, header)
    found: dict[str, str] = {}
    for line in header:
        for word in _candidates(line):
            unit = _UNIT_OF.get(word.lower())
            if unit is not None:
                found[unit] = word
            elif _RATE.fullmatch(word) or _PART.fullmatch(word):
                raise ValueError(f"{path.name} is in {word[:20]}, allowed are {', '.join(UNITS)}")
    if len(found) > 1:
        raise ValueError(f"{path.name} states two units: {' and '.join(found.values())}")
    return next(iter(found), None)


def require_seconds(path: Path, header: list[str]) -> None:
    """Refuse times that the header states in another unit than seconds.

    Raises
    ------
    ValueError
        If it does, as "time [ms]".
    """
    for line in header:
        other = _OTHER_TIME.search(line)
        if other is not None:
            raise ValueError(f"{path.name} gives times in {other[1] or other[2]}, allowed is s")


def factor(path: Path, stated: str | None, given: str | None) -> float:
    """Return the factor to m/s^2 from the unit that the file states and the one that the caller gives.

    Raises
    ------
    ValueError
        If there is neither, or the two contradict each other.
    """
    unit = stated or given
    if unit is None:
        raise ValueError(f"{path.name} does not say its unit: give units, one of {', '.join(UNITS)}")
    if given is not None and given != unit:
        raise ValueError(f"{path.name} says that it is in {unit}, but units is {given!r}")
    return METRES_PER_SECOND_SQUARED[unit]


def _require_acceleration(path: Path, header: list[str]) -> None:
    other = next((line for line in header if re.search("velocity|displacement", line, re.IGNORECASE)), None)
    # a note such as "peak velocity 20 cm/s" beside the title of an acceleration record is none
    if other is not None and "acc" not in " ".join(header).lower():
        raise ValueError(f"{path.name} is not an acceleration record, it says {other.strip()[:60]!r}")


def _candidates(line: str) -> list[str]:
    """Words of a header line that stand where a unit would."""
    words = [word for place in _PLACES for word in place.findall(line)]
    return [word.rstrip(".") for word in words]


LARGEST_PEAK = 5.0  # [g]; the largest that was ever recorded at the ground is about 4 g
LARGEST_RATIO = 50.0  # of the peaks of two components; gal taken for m/s^2 makes 100, for g 981
_USUAL = 0.4  # [g], peak of a strong motion: among the units the one that comes next to it makes sense
# a planar motion that was turned has components in proportion, the small one by its azimuth
_PROPORTIONAL = 1e-9


def doubts(motion: GroundMotion) -> tuple[Diagnostic, ...]:
    """Return what makes a record improbable: a peak beyond 5 g, and components 50 times apart.

    Returns
    -------
    tuple of Diagnostic
        "large_peak": size is the peak [g], detail the unit that would make sense; "unlike_components": size
        is the ratio of the peaks, detail the component that is larger.

    Examples
    --------
    >>> motion = GroundMotion([[0, 0], [981, 0.1], [-400, 0.02]], 0.01)
    >>> [(fact.code, fact.detail) for fact in doubts(motion)]
    [('large_peak', 'cm/s2'), ('unlike_components', 'x')]
    """
    return tuple(_doubts(motion))


def doubts_of(motions: Iterable[GroundMotion | None]) -> list[dict[str, object]]:
    """Return the doubts about many motions as plain values, for a file: record and fields of each.

    Of a record that comes several times, as at several scales, each doubt is there once.
    """
    found: dict[tuple[str, str], dict[str, object]] = {}
    for motion in motions:
        if motion is None:
            continue
        for fact in doubts(motion):
            fields = {name: getattr(fact, name) for name in ("code", "size", "bound", "detail")}
            found.setdefault((motion.name, fact.code), {"record": motion.name or "record"} | fields)
    return list(found.values())


def _doubts(motion: GroundMotion) -> Iterator[Diagnostic]:
    peaks = np.abs(motion.acceleration).max(axis=0)
    peak = float(max(motion.peak, peaks.max())) / METRES_PER_SECOND_SQUARED["g"]
    if peak > LARGEST_PEAK:
        yield Diagnostic(code="large_peak", size=peak, bound=LARGEST_PEAK, detail=likely_unit(peak)[0])
    moving = peaks[peaks > 0.0]
    ratio = float(moving.max() / moving.min()) if len(moving) else 1.0
    if ratio >= LARGEST_RATIO and not _in_one_plane(motion):
        axis = "xyz"[int(peaks.argmax())]
        yield Diagnostic(code="unlike_components", size=ratio, bound=LARGEST_RATIO, detail=axis)


def likely_unit(peak: float) -> tuple[str, float]:
    """Return the unit in which a peak that was read as `peak` [g] makes sense, and the peak in it [g]."""
    metre = METRES_PER_SECOND_SQUARED
    read_as_g = [(unit, peak * metre[unit] / metre["g"]) for unit in ("m/s2", "cm/s2")]
    read_as_metres = ("cm/s2", peak * metre["cm/s2"] / metre["m/s2"])
    return min((*read_as_g, read_as_metres), key=lambda unit: abs(math.log(unit[1] / _USUAL)))


def _in_one_plane(motion: GroundMotion) -> bool:
    x, y = motion.acceleration[:, :2].T
    across = math.sqrt(float(x @ x) * float(y @ y))
    return not motion.has_vertical and abs(across - abs(float(x @ y))) <= _PROPORTIONAL * across
