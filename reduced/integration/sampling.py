"""States at the times that are asked for, which do not influence the steps."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .._compile import inlined
from ..body import Body
from .record import Piece
from .result import write
from .tsit5 import State

Wanted = tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.bool_]]  # times, states there, in motion


class Sampling(NamedTuple):
    """The compiled functions that fill in the samples of a stretch; each returns the next one to fill."""

    of_rest: Callable[..., int]
    of_uplift: Callable[..., int]
    of_step: Callable[..., int]


def make_sampling(lifted: Callable[..., State], partial: Callable[..., Any]) -> Sampling:
    """Return the sampling of uplifts by `lifted` and of steps that `partial` fills."""

    @inlined
    def of_rest(wanted: Wanted, sample: int, until: float, y: State) -> int:
        """Fill in where the cylinder stands."""
        times, states, _ = wanted
        while sample < len(times) and times[sample] <= until:
            write(y, states[sample])
            sample += 1
        return sample

    @inlined
    def of_uplift(
        wanted: Wanted,
        sample: int,
        until: float,
        body: Body,
        time_step: float,
        piece: Piece,
        lift: float,
        begin: float,
        y: State,
    ) -> int:
        """Fill in what the series of an uplift covers, which begins at the time `begin`."""
        times, states, moving = wanted
        while sample < len(times) and times[sample] <= until:
            write(lifted(body, time_step, piece, lift, times[sample] - begin, y), states[sample])
            moving[sample] = True
            sample += 1
        return sample

    @inlined
    def of_step(
        wanted: Wanted,
        sample: int,
        until: float,
        body: Body,
        work: NDArray[np.float64],
        path: Any,
        begin: float,
        y_new: State,
    ) -> int:
        """Fill in a step from the time `begin` to `until`, where the state is `y_new`."""
        times, states, moving = wanted
        while sample < len(times) and times[sample] <= until:
            if times[sample] == until:
                write(y_new, states[sample])
            else:
                y_at, _ = partial(body, work, path, times[sample] - begin)
                write(y_at, states[sample])
            moving[sample] = True
            sample += 1
        return sample

    return Sampling(of_rest, of_uplift, of_step)
