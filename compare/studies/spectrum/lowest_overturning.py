"""The lowest intensity found to overturn, and the safe islands above it.

Overturning is not monotonic in intensity: a cylinder that one shaking overturns may stand the same
shaking made stronger, and what overturns may be a window much narrower than the step of a grid. So the
lowest intensity is searched from the uplift threshold up, below which nothing moves, in steps that are
stated; a narrower window may lie between them. What stands above the lowest is an island.
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

from rockwobble.models import GroundMotion

from ...metrics.tilt import overturned

if TYPE_CHECKING:
    from collections.abc import Mapping

    import pandas as pd

Array = NDArray[np.float64]
PeakTilts = Callable[[Array], Array]  # intensities (m,) -> peak tilts of one cylinder (m,) [rad]

# Of the search, over the intensity at which the peak of the horizontal resultant is g tan(alpha). No peak
# acceleration is known to such a step; the smallest is a sixteenth of it.
STEP = 0.01
_HALVINGS = 4
# A step is halved where a tilt that goes on as fast as there or in one of the steps beside it reaches alpha
# within so many times its length: next to a window the tilt changes fast.
_REACH = 8.0
# Steps that are run together: few enough to end soon after something overturns, many enough for one call.
_BLOCK = 32


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


def uplift_factor(
    motion: GroundMotion,
    tan_alpha: float,
    gravity: float,
    *,
    plane: float | None = None,
    until: float = math.inf,
) -> float:
    """Return the factor on a ground motion at which a cylinder at rest uplifts [-]; inf if none does.

    Exact: f of equation (25) is convex between samples, and so is largest at one of them.

    Parameters
    ----------
    motion : GroundMotion
    tan_alpha : float
    gravity : float
        [m/s^2]
    plane : float, optional
        Azimuth of the plane of planar motion [rad]. Default: motion in space.
    until : float, optional
        End of the run [s].
    """
    samples, times = motion.acceleration, np.arange(len(motion.acceleration)) * motion.time_step
    if until < motion.duration:
        last = [np.interp(until, times, column) for column in samples.T]
        samples = np.vstack([samples[times <= until], last])
    x, y = samples[:, 0], samples[:, 1]
    drive = np.hypot(x, y) if plane is None else np.abs(x * math.cos(plane) + y * math.sin(plane))
    if motion.has_vertical:
        drive = drive - samples[:, 2] * tan_alpha
    largest = float(drive.max())
    return gravity * tan_alpha / largest if largest > 0.0 else math.inf


def lowest_on_grid(intensities: Array, peak_tilts: Array) -> Array:
    """Return the lowest intensity of a grid that overturns each size, (n_R,); NaN where none does.

    Parameters
    ----------
    intensities : ndarray, shape (n_I,)
        Increasing.
    peak_tilts : ndarray, shape (n_R, n_I)
        [rad]
    """
    fell = overturned(peak_tilts)
    return np.where(fell.any(axis=1), intensities[fell.argmax(axis=1)], math.nan)


def search_lowest(peak_tilts: PeakTilts, start: float, stop: float, step: float, alpha: float) -> float:
    """Return the lowest intensity found to overturn one cylinder; NaN where none is.

    Parameters
    ----------
    peak_tilts : callable
        Runs the cylinder at intensities. A run that fails counts as one that stands.
    start, stop : float
        First and last intensity to be run; where they are the wrong way round, none is.
    step : float
        The largest step; it is halved up to four times where tilts change so fast that something between
        may overturn.
    alpha : float
        Slenderness [rad].

    Returns
    -------
    float
        It overturns; the highest intensity that was run below it does not, and is no further off than a
        sixteenth of `step`.
    """
    if not start <= stop:
        return math.nan
    # a last step that is rounding is none
    count = math.ceil((stop - start) / step * (1.0 - 1e-12)) + 1
    levels: Array = start + step * np.arange(count, dtype=np.float64)
    levels[-1:] = stop
    stretch: Array = np.empty(0)
    tilts: Array = np.empty(0)
    for begin in range(0, len(levels), _BLOCK):
        block = levels[begin : begin + _BLOCK]
        # from the last one of the block before
        stretch = np.concatenate([stretch[-1:], block])
        tilts = np.concatenate([tilts[-1:], peak_tilts(block)])
        lowest = _lowest_of(peak_tilts, stretch, tilts, alpha)
        if math.isfinite(lowest):
            return lowest
    return math.nan


def _lowest_of(peak_tilts: PeakTilts, levels: Array, tilts: Array, alpha: float) -> float:
    """Search between intensities (n,) that were run, with peak tilts (n,) [rad]."""
    for _ in range(_HALVINGS):
        fell = overturned(tilts)
        if fell.any():
            levels, tilts = levels[: fell.argmax() + 1], tilts[: fell.argmax() + 1]
        widths = np.diff(levels)
        slopes = np.pad(np.abs(np.diff(tilts)) / widths, 1)
        # a failed run tells nothing of the steps beside its own
        steepest = np.fmax(slopes[1:-1], np.fmax(slopes[:-2], slopes[2:]))
        reached = np.maximum(tilts[:-1], tilts[1:]) + _REACH * steepest * widths
        halved = np.flatnonzero(reached > alpha)
        if not len(halved):
            break
        middles = 0.5 * (levels[halved] + levels[halved + 1])
        levels = np.insert(levels, halved + 1, middles)
        tilts = np.insert(tilts, halved + 1, peak_tilts(middles))
    fell = overturned(tilts)
    return float(levels[fell.argmax()]) if fell.any() else math.nan


def lowest_intensities(
    semidiagonals: Array,
    intensities: Array,
    on_grid: Array,
    peak_tilts: Callable[[Array, Array], Array],
    *,
    start: float,
    step: float,
    alpha: float,
    workers: int | None = None,
    progress: Callable[[float], None] | None = None,
) -> Array:
    """Return the lowest intensity found to overturn each size.

    Parameters
    ----------
    semidiagonals : ndarray, shape (n_R,)
        Sizes [m].
    intensities : ndarray, shape (n_I,)
        A grid.
    on_grid : ndarray, shape (n_R, n_I)
        Peak tilts on it [rad].
    peak_tilts : callable
        Runs sizes (n,) [m] at intensities (m,) in one thread, for peak tilts (n, m) [rad].
    start, step, alpha
        As in `search_lowest`.
    workers : int, optional
        Number of threads.
    progress : callable, optional
        Called with the fraction done, after each size.

    Returns
    -------
    ndarray, shape (n_R,)
        No higher than the lowest of the grid; NaN where none was found up to the last of the grid.
    """
    known = lowest_on_grid(intensities, on_grid)

    def search(i: int) -> float:
        def one(levels: Array) -> Array:
            return peak_tilts(semidiagonals[i : i + 1], levels).ravel()

        stop = float(intensities[-1] if math.isnan(known[i]) else known[i])
        return search_lowest(one, start, stop, step, alpha)

    found = known.copy()
    with ThreadPoolExecutor(workers or os.cpu_count()) as pool:
        try:
            for i, lowest in enumerate(pool.map(search, range(len(found)))):
                # below the threshold of uplift nothing was searched, and nothing can overturn
                found[i] = np.fmin(lowest, known[i])
                if progress is not None:
                    progress((i + 1) / len(found))
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)
            raise
    return found


def safe_islands(semidiagonals: Array, intensities: Array, peak_tilts: Array, lowest: Array) -> list[Island]:
    """Return the islands of a grid, by size and from the lowest intensity up.

    Parameters
    ----------
    semidiagonals : ndarray, shape (n_R,)
    intensities : ndarray, shape (n_I,)
    peak_tilts : ndarray, shape (n_R, n_I)
        A failed run (NaN) ends an island, and neither opens one nor closes it.
    lowest : ndarray, shape (n_R,)
        Lowest intensity that overturns; NaN where none is known.
    """
    islands = []
    fell = overturned(peak_tilts)
    stands = ~fell & ~np.isnan(peak_tilts)
    for i in np.flatnonzero(np.isfinite(lowest)):
        first = int(np.searchsorted(intensities, lowest[i]))
        row = np.concatenate([[False], stands[i, first:], [False]]).astype(np.int8)
        begins, ends = np.flatnonzero(np.diff(row) == 1), np.flatnonzero(np.diff(row) == -1)
        for begin, end in zip(begins + first, ends + first, strict=True):
            islands.append(
                Island(
                    semidiagonal=float(semidiagonals[i]),
                    lower=float(intensities[begin]),
                    upper=float(intensities[end - 1]),
                    closed=bool(fell[i, end:].any()),
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
