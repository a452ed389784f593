"""One component of a record, as its file gives it."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

# one way to match each text, so that no line takes more than linear time;
# columns may touch: in "1.2E-031.4E-03" the exponent ends where the next number needs its digit
NUMBER = r"[-+]?(?:\d+(?:\.\d*)?|\.\d+)(?:[EeDd][-+]?(?:\d\d(?=\d?\.)|\d+))?"

# over a whole record two components may drift apart by this part of a step, the rounding of printed times
DRIFT = 0.05
_MOST_PARTS = 20  # of the smallest step: a record of more samples by that is a mistake, not a common step


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


def resampled(components: Sequence[Component]) -> list[Component]:
    """Return components at the largest time step that divides the steps of all, linear between samples.

    That changes no record: each is linear between its samples, and all of them stay.

    Raises
    ------
    ValueError
        If no such step is at least a twentieth of the smallest one.
    """
    finest = min(components, key=lambda each: each.time_step)
    for parts in range(1, _MOST_PARTS + 1):
        step = finest.time_step / parts
        counts = [round(each.time_step / step) for each in components]
        drifts = [
            abs(each.time_step - count * step) * len(each.values)
            for each, count in zip(components, counts, strict=True)
        ]
        if max(drifts) <= DRIFT * step:
            return [_refined(each, count, step) for each, count in zip(components, counts, strict=True)]
    coarsest = max(components, key=lambda each: each.time_step)
    raise ValueError(
        f"components are resampled to a step that divides all, at least 1/{_MOST_PARTS} of the smallest: "
        f"{finest.time_step:g} s in {finest.path.name} and {coarsest.time_step:g} s in {coarsest.path.name} "
        "have none"
    )


def _refined(component: Component, count: int, step: float) -> Component:
    """Return a component with each of its time steps cut into `count` of `step` [s]."""
    values = component.values
    places = np.arange((len(values) - 1) * count + 1) / count
    return replace(component, values=np.interp(places, np.arange(len(values)), values), time_step=step)


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
