"""Turning points of the tilt, and rests between two motions, from the engine's own steps."""

from __future__ import annotations

import math
from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from .scene import Array

# Steps in the time that the minimum tilt of a pass takes at the largest rate: of 200 small motions those with
# fewer were off by 2e-3 to 2 of their peak, those with 2.5 to 10 by 5e-2 at most
STEPS_OF_A_PASS = 2.5


@dataclass(frozen=True, slots=True)
class TurningPoint:
    """An extremum of the tilt: time [s], tilt [rad], rolling angle [rad]."""

    time: float
    tilt: float
    rolling_angle: float
    is_maximum: bool


def turning_points(time: Array, tilt: Array, rolling_angle: Array) -> list[TurningPoint]:
    """Return the extrema among the inner steps, each refined by a parabola through three steps.

    The parabola is that of the squared tilt: near upright the axis goes past in a straight line, on
    which the squared tilt is exactly a parabola however few steps the pass takes.
    """
    rising = np.diff(tilt) > 0.0
    entries = []
    for index in np.flatnonzero(rising[1:] != rising[:-1]) + 1:
        around = slice(index - 1, index + 2)
        offset, square = _vertex(tilt[around] ** 2)
        step = time[index] - time[index - 1]
        at = time[index] + offset * step
        angle = np.interp(at, time[around], rolling_angle[around])
        entries.append(
            TurningPoint(float(at), float(np.sqrt(max(square, 0.0))), float(angle), not rising[index])
        )
    return entries


def filter_noise_swings(points: list[TurningPoint], threshold: float) -> list[TurningPoint]:
    """Turning points without swings smaller than `threshold` [rad], which are contact noise."""
    kept: list[TurningPoint] = []
    for point in points:
        if kept and point.is_maximum != kept[-1].is_maximum and abs(point.tilt - kept[-1].tilt) < threshold:
            kept.pop()
        if kept and point.is_maximum == kept[-1].is_maximum:
            # two maxima or minima meet where a small swing between them was dropped: the outer one is real
            if (point.tilt > kept[-1].tilt) == point.is_maximum:
                kept[-1] = point
        else:
            kept.append(point)
    return kept


def passes_between(
    points: list[TurningPoint], threshold: float, rests: Sequence[tuple[float, float]] = ()
) -> dict[str, Array]:
    """Passes, tilt minima between two maxima, without swings smaller than `threshold` [rad].

    A pass belongs to one motion: both its maxima lie on the same side of every rest, of which `rests` holds
    start and end [s].

    Returns
    -------
    dict of ndarray, shape (p,)
        time of the minimum [s], minimum_tilt [rad], and angle_of_turn, the change of the rolling angle from
        maximum to maximum [rad].
    """
    motions: list[list[TurningPoint]] = [[] for _ in range(len(rests) + 1)]
    ends = [end for _, end in rests]
    for point in points:
        number = bisect_right(ends, point.time)
        # extrema during a rest are no swing of either motion
        if number == len(rests) or point.time < rests[number][0]:
            motions[number].append(point)
    rows = [
        (low.time, low.tilt, after.rolling_angle - before.rolling_angle)
        for kept in (filter_noise_swings(motion, threshold) for motion in motions)
        for before, low, after in zip(kept, kept[1:], kept[2:], strict=False)
        if before.is_maximum and not low.is_maximum
    ]
    columns = np.array(rows, dtype=float).reshape(-1, 3).T
    return dict(zip(("time", "minimum_tilt", "angle_of_turn"), columns, strict=True))


def negligible_uplifts(
    points: Sequence[TurningPoint], threshold: float, rests: Sequence[tuple[float, float]]
) -> list[float]:
    """Times of openings by less than `threshold` [rad] between two rests, before the last larger one.

    The models, which lose nothing there, still move when it opens next; contact has come to rest or moves
    otherwise, so that the direction in which the next motion begins is left to it.
    """
    largest = [
        (opened, max((point.tilt for point in points if opened <= point.time < closed), default=0.0))
        for (_, opened), (closed, _) in pairwise([*rests, (math.inf, math.inf)])
    ]
    moved = max((opened for opened, tilt in largest if tilt >= threshold), default=-math.inf)
    return [opened for opened, tilt in largest if 0.0 < tilt < threshold and opened < moved]


def _vertex(values: Array) -> tuple[float, float]:
    """Vertex of the parabola through three values one step apart: offset in steps, value."""
    left, middle, right = (float(value) for value in values)
    curve = left - 2.0 * middle + right
    if curve == 0.0:
        return 0.0, middle
    slope = 0.5 * (right - left)
    offset = min(max(-slope / curve, -1.0), 1.0)
    return offset, middle + 0.5 * slope * offset


# [s] at the reference size. A base that rocks by the 1e-5 alpha at which it counts as closed rises and
# falls in 8 ms, at any slenderness; a tilt below that for longer than two such swings is a rest.
SHORTEST = 0.02


class RestWatch:
    """Watch over chunks of steps for stretches in which the tilt stays below a level.

    Parameters
    ----------
    level : float
        Level of the tilt [rad].
    """

    def __init__(self, level: float) -> None:
        self._level = level
        self._since: float | None = None  # time from which the tilt has been below the level
        self._last = 0.0
        self._over: list[tuple[float, float]] = []

    def take(self, time: Array, tilt: Array) -> None:
        """Take the next steps (n,)."""
        closed = tilt < self._level
        change = np.flatnonzero(np.diff(closed, prepend=self._since is not None))
        for index in change:
            if closed[index]:
                self._since = float(time[index])
            else:
                self._close(float(time[index]))
        self._last = float(time[-1])

    def _close(self, end: float) -> None:
        if self._since is not None and end - self._since > SHORTEST:
            self._over.append((self._since, end))
        self._since = None

    @property
    def resting(self) -> bool:
        """Whether the last step taken belongs to a rest."""
        return self._since is not None and self._last - self._since > SHORTEST

    def rests(self) -> list[tuple[float, float]]:
        """Return start and end of every rest so far [s]; one that lasts ends at the last step."""
        if self._since is None or not self.resting:
            return list(self._over)
        return [*self._over, (self._since, self._last)]

    def after_motion(self) -> list[tuple[float, float]]:
        """Rests without the stand before the first motion; NaN ends a rest that lasts."""
        later = [rest for rest in self.rests() if rest[0] > 0.0]
        if later and self.resting:
            later[-1] = (later[-1][0], math.nan)
        return later
