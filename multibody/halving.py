"""Runs at steps that halve: their common samples, the order of their error, and their limit at step zero.

Of a quantity x at the steps 2 h and h, whose error goes with the power p of the step,

    what is left of the error at h      (x(h) - x(2 h))/(2^p - 1)
    its limit at step zero              x(h) + (x(h) - x(2 h))/(2^p - 1)
    p, of a third run at 4 h            log2(|x(4 h) - x(2 h)| / |x(2 h) - x(h)|)
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise
from typing import TypeVar

import numpy as np

from .scene import Array

_SAME_TIME = 1e-9  # share of the length of a run
Difference = TypeVar("Difference", float, Array)


def common_count(times: Sequence[Array]) -> int:
    """Number of leading samples whose times are equal in all traces."""
    count = min(map(len, times))
    # the last sample of a run that overturned stands at its own time
    near = _SAME_TIME * max(1.0, *(float(time[-1]) for time in times if len(time)))
    different = np.flatnonzero(
        np.any([np.abs(time[:count] - times[0][:count]) > near for time in times], axis=0)
    )
    return int(different[0]) if len(different) else count


def error_left(difference: Difference, order: float) -> Difference:
    """Return the error of the finer of two runs, by their difference and its order in the step."""
    return difference / (math.pow(2.0, order) - 1.0)


def order_between(coarser: float, finer: float) -> float:
    """Return the order in the step of the differences of successive halvings, both above 0."""
    return math.log2(coarser / finer)


def measured_order(values: Sequence[Array]) -> float:
    """Return the order in the step of the last three of `values`.

    NaN of fewer than three, and where two of them are equal.
    """
    if len(values) < 3:
        return math.nan
    first, second = (float(np.linalg.norm(coarse - fine)) for coarse, fine in pairwise(values[-3:]))
    return order_between(first, second) if first > 0.0 and second > 0.0 else math.nan


def to_zero_step(values: Sequence[Array], order: int) -> Array:
    """Return the limit at step zero of the last two of `values`."""
    coarse, fine = values[-2:]
    return np.asarray(fine + error_left(fine - coarse, order))


def linear_extrapolation(values: Sequence[Array]) -> Array:
    """Return the limit at step zero of a straight line through all of `values`, by least squares.

    Scatter goes with the step, and one that is off by chance weighs little.
    """
    steps = 0.5 ** np.arange(len(values))
    design = np.column_stack([np.ones_like(steps), steps]) / steps[:, None]
    weights = np.linalg.pinv(design)[0] / steps
    return np.asarray(np.tensordot(weights, np.stack(values), axes=1))
