"""Measures that several limits share."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np
import pandas as pd
from numpy.typing import NDArray

Tables = Mapping[str, "pd.DataFrame"]
Array = NDArray[np.float64]
Numbers = dict[str, float]


def column(table: pd.DataFrame, name: str) -> Array:
    """Return a column as numbers."""
    return table[name].to_numpy(dtype=np.float64)


def largest(values: Array) -> float:
    """Return the largest finite value; NaN where there is none."""
    finite = values[np.isfinite(values)]
    return float(finite.max()) if len(finite) else math.nan


def reached(values: Array, share: float) -> float:
    """Return a value that a share of all does not exceed, infinite ones included; NaN of nothing."""
    known = values[~np.isnan(values)]
    return float(np.quantile(known, share, method="inverted_cdf")) if len(known) else math.nan


def up_to(points: Array, holds: NDArray[np.bool_]) -> float:
    """Return the largest point up to which every point holds; NaN where already the first does not.

    Several rows may share a point; a point holds where all of its rows do.
    """
    found = math.nan
    for point in np.unique(points):
        if not holds[points == point].all():
            break
        found = float(point)
    return found


def first_failing(points: Array, holds: NDArray[np.bool_]) -> float:
    """Return the smallest point with a row that does not hold; NaN where all do."""
    failing = points[~holds]
    return float(failing.min()) if len(failing) else math.nan
