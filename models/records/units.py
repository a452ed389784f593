"""Units of acceleration, as the files of records state them."""

from __future__ import annotations

import re
from pathlib import Path

from ..number_checks import quoted
from ..record_source import ALLOWED_UNITS, USUAL_UNITS
from .component import Component

_SPELLINGS = {  # units without blanks and signs of powers and products, "sec" as "s"
    "g": "g g's gs",
    "m/s2": "m/s2 m/s/s ms-2 m/ss",
    "cm/s2": "cm/s2 cm/s/s cms-2 cm/ss gal gals",
    "mm/s2": "mm/s2 mm/s/s mms-2 mm/ss",
    "µm/s2": "µm/s2 μm/s2 µm/s/s μm/s/s",
    "mgal": "mgal mgals milligal",
    "%g": "%g g%",
    "mg": "mg millig milli-g mg's mgs",
    "µg": "µg μg microg micro-g",
    "ft/s2": "ft/s2 ft/s/s fts-2 ft/ss feet/s2 feet/s/s",
    "in/s2": "in/s2 in/s/s ins-2 in/ss inch/s2 inches/s2 inch/s/s inches/s/s",
}
_UNIT_OF = {spelling: unit for unit, spellings in _SPELLINGS.items() for spelling in spellings.split()}
# text that can only be a unit, so that one outside the allowed units is refused, not skipped
_RATE = re.compile(r"[a-z]{1,3}/s(?:ec)?\S*", re.IGNORECASE)
_POWER = r"[a-z]{1,3}\s?[.·⋅*]?\s?s(?:ec)?\s?(?:\^|\*\*)?\s?\(?[-−⁻]\s?[2²]\)?"  # "m s-2", "m·s⁻²"
_WORD = rf"(%\s?g|{_POWER}|[^\s,;()\[\]]+)"
_SAME = str.maketrans({"²": "2", "⁻": "-", "−": "-", **dict.fromkeys(" \t·⋅.*^()")})
_PLACES = tuple(
    re.compile(place, re.IGNORECASE)
    for place in (
        rf"[\[(]\s*{_WORD}\s*[\])]",
        rf"(?:units?|unidad(?:es)?|unité|unità|einheit|birim)\b(?:\s*[:=,]|\s+(?:of|in|are|is)\b(?!/))*\s*{_WORD}",
        rf"\b(?:acc|acel|beschl|ivme|przysp)\w*\.?[\s,:]+(?:(?:in|en|em)\s+)?{_WORD}",
    )
)


def unit_of(word: str) -> str | None:
    """Unit of acceleration spelled by a word, None for other words.

    Examples
    --------
    >>> unit_of("cm/sec/sec"), unit_of("Gal"), unit_of("m·s⁻²"), unit_of("milli-g"), unit_of("mm")
    ('cm/s2', 'cm/s2', 'm/s2', 'mg', None)
    """
    return _UNIT_OF.get(re.sub("s(?:ec|eg|n|q)", "s", word.lower().translate(_SAME)))


def given_unit(word: str) -> str:
    """Unit of acceleration in an option of the user.

    Raises
    ------
    ValueError
        If it spells none.
    """
    unit = unit_of(word) if isinstance(word, str) else None
    if unit is None:
        raise ValueError(f"units must be one of {ALLOWED_UNITS}, got {quoted(word)}")
    return unit


def stated_unit(path: Path, header: list[str]) -> str | None:
    """Unit of acceleration in the header lines, None without one.

    A unit stands in brackets, "time [s], acceleration [cm/s^2]", after the word units, "UNITS OF G",
    or right after the acceleration, "t, acc in g". A "0.3 g" elsewhere is a value and states nothing.

    Raises
    ------
    ValueError
        If the file holds velocities or displacements, or states a unit that is not allowed, or two.
    """
    _require_acceleration(path, header)
    entries: dict[str, str] = {}
    for line in header:
        for word in _candidates(line):
            unit = unit_of(word)
            if unit is not None:
                entries[unit] = word
            elif _RATE.fullmatch(word) or re.fullmatch(_POWER, word, re.IGNORECASE):
                raise ValueError(f"{path.name} is in {word[:20]}, allowed are {ALLOWED_UNITS}")
    if len(entries) > 1:
        raise ValueError(f"{path.name} states two units: {' and '.join(entries.values())}")
    return next(iter(entries), None)


def settled_unit(component: Component, given: str | None) -> str:
    """Unit of a component: from its file, or from the user.

    Raises
    ------
    ValueError
        If there is neither, or the two contradict each other.
    """
    unit, name = component.unit or given, component.path.name
    if unit is None:
        raise ValueError(f"{name} does not say its unit: give units, such as {', '.join(USUAL_UNITS)}")
    if given not in (None, unit):
        raise ValueError(f"{name} says that it is in {unit}, but units is {given!r}")
    return unit


def _require_acceleration(path: Path, header: list[str]) -> None:
    other = next((line for line in header if re.search("velocity|displacement", line, re.IGNORECASE)), None)
    # "peak velocity 20 cm/s" beside the title of an acceleration record is no unit of it
    if other is not None and "acc" not in " ".join(header).lower():
        raise ValueError(f"{path.name} is not an acceleration record, it says {other.strip()[:60]!r}")


def _candidates(line: str) -> list[str]:
    """Words of a header line at the places of a unit."""
    words = [word for place in _PLACES for word in place.findall(line)]
    return [word.rstrip(".") for word in words]
