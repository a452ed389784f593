"""Records in the format PEER AT2, with each form of its header."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from .component import NUMBER, Component, parse_number
from .units import stated_unit

# titles of the forms in circulation are three lines long; one comment more does no harm
_HEADER_LINES = 6
_LONGEST_HEADER = 200  # the line has 80 characters; bounds what a pattern can cost on one that is damaged


def is_at2(lines: list[str]) -> bool:
    """Return whether a header line announces a number of points (NPTS)."""
    return any("NPTS" in line.upper() for line in lines[:_HEADER_LINES])


def read_at2(path: Path, lines: list[str]) -> Component:
    """Read the lines of an AT2 file.

    Raises
    ------
    ValueError
        If the header, a line of values or the number of samples is not as the format has it.
    """
    at = next(index for index, line in enumerate(lines) if "NPTS" in line.upper())
    count, time_step = _counts(path, at + 1, lines[at])
    unit = stated_unit(path, lines[:at])
    values: list[float] = []
    for number, line in enumerate(lines[at + 1 :], start=at + 2):
        if not line.strip():
            continue
        # what is left between the numbers: columns of fixed width may touch, so blanks do not part them
        if re.sub(NUMBER, "", line).strip():
            raise ValueError(f"{path.name}, line {number}: expected accelerations, got {line.strip()[:60]!r}")
        values.extend(parse_number(path, number, token) for token in re.findall(NUMBER, line))
    # the last line may be filled up with zeros, and the ground is still after the record anyway
    if len(values) < count or any(values[count:]):
        raise ValueError(
            f"{path.name}, line {at + 1}: announces {count} samples, the file holds {len(values)}"
        )
    return Component(path, np.array(values[:count]), time_step, unit)


def _counts(path: Path, number: int, line: str) -> tuple[int, float]:
    """Number of samples and time step, from "NPTS= 4000, DT= .0100 SEC" or "4000 .0100 NPTS, DT"."""
    line = line[:_LONGEST_HEADER]
    named = re.search(rf"NPTS\s*[=:]?\s*(\d{{1,9}})\b.*?DT\s*[=:]?\s*({NUMBER})", line, re.IGNORECASE)
    bare = re.match(rf"\s*(\d{{1,9}})[\s,]+({NUMBER})\s*,?\s*NPTS", line, re.IGNORECASE)
    found = named or bare
    if found is None:
        raise ValueError(
            f"{path.name}, line {number}: expected 'NPTS= n, DT= step SEC' or 'n step NPTS, DT', "
            f"got {line.strip()[:60]!r}"
        )
    return int(found.group(1)), parse_number(path, number, found.group(2))
