"""Search for the lowest intensity that overturns a cylinder.

Overturning is not monotonic in intensity: a cylinder that one shaking overturns may stand the same shaking
made stronger, and what overturns may be a window much narrower than the step of a grid. So the lowest is
searched from the threshold of uplift up, below which nothing moves: a grid is refined wherever a tilt that
changes as fast as its neighbours do could reach alpha, down to the step that is stated. Then intensities
drawn at random below the lowest are run, until of so many none overturns: that bounds the share of weaker
shaking that does.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Generator, Sequence
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from rockwobble.compare.metrics.pair import overturned
from rockwobble.compare.metrics.statistics import CONFIDENCE
from rockwobble.models.cpus import in_threads

Array = NDArray[np.float64]
T = TypeVar("T")
# Yields intensities (m,), is sent the peak tilts of one cylinder there (m,) [rad], returns what it found.
Search = Generator[Array, Array, T]

_COARSEST = 8.0  # coarsest step in units of the finest, where nothing asks for a finer one
# A step is halved where a tilt that goes on as fast as there, or in one of the two steps beside it on either
# side, reaches alpha within so many times its length: next to a window the tilt changes fast.
_REACH, _BESIDE = 6.0, 2
_SPARE = 10  # a tenth of reserve: overturning near the lowest intensity needs no further draws
_CLOSE = 1e-6  # relative distance to uplift below which no intensity is drawn


def lowest_on_grid(intensities: Array, peak_tilts: Array) -> Array:
    """Lowest intensity (n_I,) of a grid that overturns each size, (n_R,); NaN where none does."""
    fell = overturned(peak_tilts)
    return np.where(fell.any(axis=1), intensities[fell.argmax(axis=1)], math.nan)


def search_lowest(
    intensities: Array, known: Array, *, start: float, step: float, alpha: float, stands: bool = True
) -> Search[float]:
    """Search for the lowest intensity that overturns one cylinder; NaN where none is found.

    A run that fails counts as one that stands.

    Parameters
    ----------
    intensities, known : ndarray, shape (n,)
        A grid, increasing, and the peak tilts on it [rad]. The search ends at the first that overturns, or
        at the last.
    start : float
        Intensity of uplift, from which it begins.
    step : float
        Steps are halved until they are no longer than this, where tilts change so fast that something
        between may overturn; none is longer than eight times this.
    alpha : float
        Slenderness [rad].
    stands : bool, optional
        Whether the cylinder stands still at `start`, where it would chatter for long, and is not run there.
    """
    fell = overturned(known)
    last = int(fell.argmax()) if fell.any() else len(intensities) - 1
    if not start < intensities[last]:
        return float(intensities[last]) if fell.any() else math.nan
    inside = intensities[: last + 1] > start
    levels = np.concatenate([[start], intensities[: last + 1][inside]])
    parts = np.ceil(np.diff(levels) / (_COARSEST * step) * (1.0 - 1e-12)).astype(int)
    between = [np.linspace(a, b, n + 1)[1:-1] for a, b, n in zip(levels, levels[1:], parts, strict=False)]
    wanted = np.concatenate([[] if stands else levels[:1], *between])
    tilts = known[: last + 1][inside]
    levels, tilts = (levels, np.concatenate([[0.0], tilts])) if stands else (levels[1:], tilts)
    while True:
        if len(wanted):
            levels, tilts = np.concatenate([levels, wanted]), np.concatenate([tilts, (yield wanted)])
            order = np.argsort(levels, kind="stable")
            levels, tilts = levels[order], tilts[order]
        fell = overturned(tilts)
        if fell.any():
            levels, tilts = levels[: fell.argmax() + 1], tilts[: fell.argmax() + 1]
        widths = np.diff(levels)
        slopes = np.pad(np.abs(np.diff(tilts)) / widths, _BESIDE)
        # a failed run says nothing about neighbouring steps
        steepest = np.fmax.reduce([slopes[i : i + len(widths)] for i in range(2 * _BESIDE + 1)])
        reached = np.fmax(tilts[:-1], tilts[1:]) + _REACH * steepest * widths > alpha
        halved = np.flatnonzero(reached & (widths > step * (1.0 + 1e-9)))
        if not len(halved):
            return float(levels[-1]) if overturned(tilts).any() else math.nan
        wanted = 0.5 * (levels[halved] + levels[halved + 1])


def probe_below(
    start: float, stop: float, lowest: float, *, probes: int, seed: Sequence[int]
) -> Search[tuple[float, int]]:
    """Run random intensities below the lowest one, until none of `probes` overturns.

    One in each of so many equal parts, and a tenth more, from `start` to the lowest, or to `stop` where it is
    NaN; if some overturn, the lowest of them takes its place, and others are drawn if fewer than `probes`
    are left below it. That none overturns is less likely than of as many drawn from the whole, whatever
    share of it would.

    Returns
    -------
    float, int
        The lowest, and how many on the way to it have overturned: what the search had missed.
    """
    random, missed = np.random.default_rng(seed), 0
    while probes and (end := stop if math.isnan(lowest) else lowest) > start * (1.0 + _CLOSE):
        edges = np.linspace(start, end, probes + probes // _SPARE + 1)
        drawn = random.uniform(edges[:-1], edges[1:])
        fell = overturned((yield drawn))
        if not fell.any():
            break
        first = int(fell.argmax())
        lowest, missed = float(drawn[first]), missed + int(fell.sum())
        if first >= probes:
            break
    return lowest, missed


def gap_bound(probes: int) -> float:
    """Upper 95 % bound on the overturning share of intensities after that many draws without overturning."""
    return 1.0 - math.pow(1.0 - CONFIDENCE, 1.0 / probes)


def run_searches(
    searches: Sequence[Search[T]],
    peak_tilts: Callable[[int, Array], Array],
    *,
    workers: int | None = None,
) -> list[T]:
    """Run searches in parallel, each in one thread, and return their results.

    Parameters
    ----------
    searches : sequence of Search
    peak_tilts : callable
        Runs one of them, by index, at some intensities (m,), for their peak tilts (m,) [rad].
    workers : int, optional
        Number of threads. Default: one for each processor that this process may use.
    """

    def run(i: int) -> T:
        search = searches[i]
        try:
            wanted = next(search)
            while True:
                wanted = search.send(peak_tilts(i, wanted))
        except StopIteration as end:
            lowest: T = end.value
            return lowest

    return list(in_threads(run, range(len(searches)), workers=workers))
