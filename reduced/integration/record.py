"""A record as pieces of linear ground motion, one between each two of its samples."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .._compile import inlined, jit

Vector = tuple[float, float, float]


class Piece(NamedTuple):
    """A stretch of linear ground motion, from one sample of the record to the next."""

    begin: float  # [s]
    finish: float  # [s]
    length: float  # [s]
    a: Vector  # acceleration at its beginning [m/s^2]
    slope: Vector  # its rate [m/s^3]


@jit
def ground(a: Vector, slope: Vector, t: float) -> Vector:
    """Return the ground acceleration a + slope t [m/s^2]."""
    return a[0] + slope[0] * t, a[1] + slope[1] * t, a[2] + slope[2] * t


@inlined
def piece_of_record(
    record: NDArray[np.float64], time_step: float, index: int, begin: float, last: float
) -> Piece:
    """Piece of the record after sample `index`, from `begin` to `last` at the latest [s]."""
    if index >= len(record) - 1:  # the ground is still after the record
        return Piece(begin, last, last - begin, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
    end = index + 1
    a = (record[index, 0], record[index, 1], record[index, 2])
    slope = (
        (record[end, 0] - a[0]) / time_step,
        (record[end, 1] - a[1]) / time_step,
        (record[end, 2] - a[2]) / time_step,
    )
    finish = min(end * time_step, last)
    return Piece(begin, finish, finish - begin, a, slope)


@jit
def still_from(record: NDArray[np.float64], time_step: float) -> float:
    """Time from which the ground is still [s]: that of the last sample, or of the first of the last zeros."""
    last = max(len(record) - 1, 0)
    while last > 0 and not (record[last - 1].any() or record[last].any()):
        last -= 1
    return last * time_step
