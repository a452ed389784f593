"""Limit states: what a run must not exceed."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from rockwobble.models.number_checks import require_one_of

OVERTURNED, CONTACT_LOST = "overturned", "contact_lost"
# name: the tilt that is reached [alpha]; NaN where it is no tilt that decides
LIMITS: Mapping[str, float] = {
    "uplift": 0.0,
    "0.1 alpha": 0.1,
    "0.25 alpha": 0.25,
    "0.5 alpha": 0.5,
    "1 alpha": 1.0,
    OVERTURNED: math.nan,
    CONTACT_LOST: math.nan,
}
DEFAULT_LIMITS = tuple(name for name in LIMITS if name != CONTACT_LOST)


def require_limits(names: Iterable[str]) -> tuple[str, ...]:
    """Return the limit states, each once, in the order of `LIMITS`.

    Raises
    ------
    ValueError
        If one is unknown, or there is none.
    """
    given = list(names)
    for name in given:
        require_one_of("a limit", name, LIMITS)
    if not given:
        raise ValueError("a fragility needs at least one limit, got none")
    return tuple(name for name in LIMITS if name in given)


def exceeded(runs: pd.DataFrame, limit: str) -> NDArray[np.float64]:
    """Return 1 where a run exceeds a limit, 0 where it does not, NaN where that is not known.

    Overturned is what the run itself says: the side reaches the ground, or no later ground motion can stop
    it. Such a run exceeds every limit: when in its fall it leaves the ground depends on where a method ends
    the fall. A cylinder at rest has not uplifted; any tilt above zero is uplift.

    Parameters
    ----------
    runs : DataFrame
        Columns peak_tilt [alpha], outcome, contact_lost.
    limit : str
        One of `LIMITS`.
    """
    failed = (runs["outcome"] == "failed").to_numpy(bool)
    fell = (runs["outcome"] == "overturned").to_numpy(bool)
    if limit == CONTACT_LOST:
        lost = runs["contact_lost"].to_numpy(float)
        found = np.where(fell & ~np.isnan(lost), 1.0, lost)
    elif limit == OVERTURNED:
        found = fell.astype(float)
    else:
        peaks = runs["peak_tilt"].to_numpy(float)
        bound = LIMITS[limit]
        found = (fell | (peaks > 0.0 if bound == 0.0 else peaks >= bound)).astype(float)
    return np.where(failed, np.nan, found)
