"""One component of a record, as its file gives it."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

# one way to match each text, so that no line takes more than linear time;
# columns may touch: in "1.2E-031.4E-03" the exponent ends where the next number needs its digit
NUMBER = r"[-+]?(?:\d+(?:\.\d*)?|\.\d+)(?:[EeDd][-+]?(?:\d\d(?=\d?\.)|\d+))?"


@dataclass(frozen=True, slots=True, eq=False)
class Component:
    """Samples of one component, in the unit that the file states.

    Parameters
    ----------
    path : Path
        The file, for messages.
    values : ndarray, shape (n,)
        Acceleration [`unit`]; n >= 2, finite.
    time_step : float
        [s]
    unit : str or None
        None where the file is silent.
    start : float or None
        Time of the first sample [s]; None where the file gives no times.

    Raises
    ------
    ValueError
        If there are fewer than two samples, or the time step is not positive and finite.
    """

    path: Path
    values: NDArray[np.float64]
    time_step: float
    unit: str | None
    start: float | None = None

    def __post_init__(self) -> None:
        if len(self.values) < 2:
            raise ValueError(f"{self.path.name} must hold at least two samples, got {len(self.values)}")
        if not 0.0 < self.time_step < math.inf:
            raise ValueError(
                f"{self.path.name}: the time step must be positive and finite [s], got {self.time_step:g}"
            )


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
