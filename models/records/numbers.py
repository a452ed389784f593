"""Numbers as the files of records print them: Fortran exponents, columns that touch."""

from __future__ import annotations

import math
import re
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from .component import RecordFile

# one way to match each text, so that no line takes more than linear time;
# columns may touch: in "1.2E-031.4E-03" the exponent ends where the next number needs its digit
NUMBER = r"[-+]?(?:\d+(?:\.\d*)?|\.\d+)(?:[EeDd][-+]?(?:\d\d(?=\d?\.)|\d+))?"


def parse_number(path: Path, line_number: int, token: str) -> float:
    """Parse a finite number; Fortran writes D for the exponent of a double.

    Raises
    ------
    ValueError
        If the token is not a number, or not a finite one.
    """
    try:
        value = float(re.sub("[Dd](?=[-+0-9])", "E", token))
    except ValueError:
        raise ValueError(f"{path.name}, line {line_number}: expected a number, got {token[:60]!r}") from None
    if not math.isfinite(value):
        raise ValueError(
            f"{path.name}, line {line_number}: a sample must be a finite number, got {token[:60]!r}"
        )
    return value


def block_of_numbers(file: RecordFile, first: int, last: int | None = None) -> NDArray[np.float64]:
    """Return the numbers of lines `first` (counted from 0) to `last` (left out), in reading order.

    Blank lines are passed over.

    Raises
    ------
    ValueError
        If a line holds something else, or a number that is not finite: the line is named.
    """
    values: list[float] = []
    for number, line in enumerate(file.text[first:last], start=first + 1):
        if not line.strip():
            continue
        # what is left between the numbers: columns of fixed width may touch, so blanks do not part them
        if re.sub(NUMBER, "", line).strip():
            raise ValueError(f"{file.name}, line {number}: expected accelerations, got {line.strip()[:60]!r}")
        values.extend(parse_number(file.path, number, token) for token in re.findall(NUMBER, line))
    return np.array(values, dtype=np.float64)
