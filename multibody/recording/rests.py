"""Rests of a cylinder between two motions, from its tilt at every step."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

# [s] at the reference size. A base that rocks by the 1e-5 alpha at which it counts as closed goes up and down
# in 8 ms, whatever its slenderness; what stays below for longer than two such swings stands.
SHORTEST = 0.02


class RestWatch:
    """Notes, chunk by chunk, the stretches over which the tilt stays below a level.

    Parameters
    ----------
    level : float
        Of the tilt [rad].
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
        """Return the same without the stand before the first motion; NaN ends one that lasts."""
        later = [rest for rest in self.rests() if rest[0] > 0.0]
        if later and self.resting:
            later[-1] = (later[-1][0], math.nan)
        return later
