"""JMA (Japan Meteorological Agency) text of its seismic intensity meters: three columns under a header."""

from __future__ import annotations

import re

from ..component import Component, RecordFile
from ..headers import direction_of
from ..numbers import table_of_numbers
from ..reading import Reading
from ..units import stated_unit

NAME = "JMA text"
_HEADER_LINES = 12
_RATE = re.compile(r"SAMPLING RATE\s{0,9}=\s{0,9}(\d{1,5}(?:\.\d{1,6})?)\s{0,9}HZ")
_UNIT = re.compile(r"UNIT\s{0,9}=\s{0,9}([A-Z/]{1,10})")


def recognizes(file: RecordFile) -> bool:
    """Whether the header has the site code and the initial time."""
    head = [line.strip() for line in file.head[:_HEADER_LINES]]
    return any(line.startswith("SITE CODE") for line in head) and any("INITIAL TIME" in line for line in head)


def read(file: RecordFile, reading: Reading) -> list[Component]:
    """Read the columns by their names, "NS,EW,UD".

    Raises
    ------
    ValueError
        If the sampling rate or the names of the columns are missing, or a row is damaged.
    """
    head = file.head[:_HEADER_LINES]
    rate = next((match for line in head if (match := _RATE.search(line))), None)
    word = next((match for line in head if (match := _UNIT.search(line))), None)
    names_at = next((at for at, line in enumerate(head) if _names(line)), None)
    if rate is None or not float(rate[1]) or names_at is None:
        raise ValueError(f"{file.name} ({NAME}): its header must have 'SAMPLING RATE= 100Hz' and 'NS,EW,UD'")
    names = _names(head[names_at])
    table = table_of_numbers(file, names_at + 1, len(names), separator=",")
    unit = stated_unit(file.path, [f"unit: {word[1]}"]) if word else None
    return [
        Component(
            path=file.path,
            values=values,
            time_step=1.0 / float(rate[1]),
            unit=unit,
            format=NAME,
            label=name,
            direction=direction_of(name),
        )
        for name, values in zip(names, table.T, strict=True)
    ]


def _names(line: str) -> list[str]:
    """Names of the columns if a line holds nothing else, else none."""
    names = [name.strip() for name in line.strip().rstrip(",").split(",")]
    return names if len(names) == 3 and all(map(direction_of, names)) else []
