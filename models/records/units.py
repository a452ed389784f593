"""Units of acceleration, as the files of strong-motion records state them."""

from __future__ import annotations

import re
from pathlib import Path

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
