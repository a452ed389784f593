"""A limit of the model in words and numbers, and the measures that several limits share."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    import pandas as pd

Tables = Mapping[str, "pd.DataFrame"]
Array = NDArray[np.float64]


# what is below says nothing to a reader
_LEAST_PERCENT = 1e-3


@dataclass(frozen=True, slots=True, kw_only=True)
class Limit:
    """One row of the table of limits; every number in it is computed from the tables.

    Attributes
    ----------
    subject : str
    use, error, avoid : str
        When to use the reduced model, what error to expect, when not to use it.
    numbers : dict
        The numbers behind the words, by name.
    """

    subject: str
    use: str
    error: str
    avoid: str
    numbers: dict[str, float]


def percent(share: float) -> str:
    """Return a share as a percentage that a reader can say."""
    if not math.isfinite(share):
        return "an unknown share"
    number = 100.0 * share
    if 0.0 < abs(number) < _LEAST_PERCENT:
        return f"less than {_LEAST_PERCENT:g} %"
    digits = f"{number:.2g}" if 0.0 < abs(number) < 10.0 else f"{number:.0f}"
    return f"{float(digits):g} %"


def short(value: float) -> str:
    """Return a number with the two or three digits that a limit is known to."""
    return f"{value:.2g}" if abs(value) < 10.0 else f"{value:.0f}"


def quantile(values: Array, share: float) -> float:
    """Return the value that a share of the finite values does not exceed; NaN where there are none."""
    finite = values[np.isfinite(values)]
    return float(np.quantile(finite, share)) if len(finite) else math.nan


def largest(values: Array) -> float:
    """Return the largest finite value; NaN where there is none."""
    finite = values[np.isfinite(values)]
    return float(finite.max()) if len(finite) else math.nan


def up_to(points: Array, holds: NDArray[np.bool_]) -> float:
    """Return the largest point up to which every point holds; NaN where already the first does not.

    Several rows may share a point; a point holds where all of its rows do.
    """
    reached = math.nan
    for point in np.unique(points):
        if not holds[points == point].all():
            break
        reached = float(point)
    return reached


def first_failing(points: Array, holds: NDArray[np.bool_]) -> float:
    """Return the smallest point with a row that does not hold; NaN where all do."""
    failing = points[~holds]
    return float(failing.min()) if len(failing) else math.nan


def column(table: pd.DataFrame, name: str) -> Array:
    """Return a column as numbers."""
    return table[name].to_numpy(dtype=np.float64)
