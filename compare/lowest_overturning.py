"""The lowest intensity that overturns, and the safe islands above it.

Overturning is not monotonic in intensity: a cylinder that one shaking overturns may stand the same
shaking made stronger. The lowest overturning intensity is the figure to design with; what stands
above it is an island.
"""

from __future__ import annotations

import math
import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from collections.abc import Mapping

    import pandas as pd

Array = NDArray[np.float64]
PeakTilts = Callable[[Array, Array], Array]  # sizes (n,) [m], intensities (m,) -> peak tilts (n, m) [rad]


@dataclass(frozen=True, slots=True, kw_only=True)
class Island:
    """A range of intensities above the lowest overturning one in which a cylinder stands.

    Attributes
    ----------
    semidiagonal : float
        Size R [m].
    lower, upper : float
        First and last intensity of the grid that the cylinder stands [-].
    closed : bool
        Whether a higher intensity of the grid overturns it again.
    """

    semidiagonal: float
    lower: float
    upper: float
    closed: bool


def lowest_overturning(overturned: NDArray[np.bool_]) -> NDArray[np.intp]:
    """Return for each size the index of the lowest overturning intensity, (n_R,); -1 where there is none."""
    return np.where(overturned.any(axis=1), overturned.argmax(axis=1), -1)


def refined(
    semidiagonals: Array,
    intensities: Array,
    on_grid: NDArray[np.intp],
    peak_tilts: PeakTilts,
    *,
    refinements: int,
    workers: int | None = None,
) -> Array:
    """Return the lowest overturning intensities, refined by bisection below that of the grid.

    Parameters
    ----------
    semidiagonals : ndarray, shape (n_R,)
        Sizes [m].
    intensities : ndarray, shape (n_I,)
        The grid.
    on_grid : ndarray, shape (n_R,)
        Indices from `lowest_overturning`.
    peak_tilts : callable
        Runs sizes at intensities, in one thread.
    refinements : int
        Halvings of the interval below the grid's value.
    workers : int, optional
        Number of threads.

    Returns
    -------
    ndarray, shape (n_R,)
        Intensities that overturn; NaN where none of the grid does. The grid's own lowest intensity
        stays as it is: nothing below it was run. Where the edge of overturning is broken within the
        interval this is one of its edges.
    """

    def bisected(i: int) -> float:
        j = int(on_grid[i])
        if j < 0:
            return math.nan
        high = float(intensities[j])
        if j == 0:
            return high
        low = float(intensities[j - 1])
        for _ in range(refinements):
            middle = 0.5 * (low + high)
            peak = peak_tilts(semidiagonals[i : i + 1], np.array([middle]))
            if peak[0, 0] >= 0.5 * math.pi:
                high = middle
            else:
                low = middle
        return high

    with ThreadPoolExecutor(workers or os.cpu_count()) as pool:
        try:
            return np.array(list(pool.map(bisected, range(len(semidiagonals)))))
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)
            raise


def safe_islands(
    semidiagonals: Array, intensities: Array, overturned: NDArray[np.bool_], failed: NDArray[np.bool_]
) -> list[Island]:
    """Return the islands of a grid, by size and from the lowest intensity up.

    Parameters
    ----------
    semidiagonals : ndarray, shape (n_R,)
    intensities : ndarray, shape (n_I,)
    overturned, failed : ndarray, shape (n_R, n_I)
        A failed run ends an island, and neither opens one nor closes it.
    """
    islands = []
    stands = ~overturned & ~failed
    for i, lowest in enumerate(lowest_overturning(overturned)):
        if lowest < 0:
            continue
        row = np.concatenate([[False], stands[i, lowest:], [False]]).astype(np.int8)
        begins, ends = np.flatnonzero(np.diff(row) == 1), np.flatnonzero(np.diff(row) == -1)
        for begin, end in zip(begins + lowest, ends + lowest, strict=True):
            islands.append(
                Island(
                    semidiagonal=float(semidiagonals[i]),
                    lower=float(intensities[begin]),
                    upper=float(intensities[end - 1]),
                    closed=bool(overturned[i, end:].any()),
                )
            )
    return islands


def islands_frame(islands: Mapping[str, list[Island]]) -> pd.DataFrame:
    """Return islands as a table: series, semidiagonal [m], lower [-], upper [-], closed."""
    import pandas as pd

    rows = [
        (series, island.semidiagonal, island.lower, island.upper, island.closed)
        for series, found in islands.items()
        for island in found
    ]
    return pd.DataFrame(rows, columns=["series", "semidiagonal", "lower", "upper", "closed"])
