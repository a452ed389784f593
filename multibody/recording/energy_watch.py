"""Energy that neither the start nor the excitation supplied, held against the energy of the motion.

A run is as sound as its energy is: what contact takes from a motion of 0.002 alpha may be nothing beside the
energy that balances the cylinder on its rim, and still half of what moves it. So the measure is the largest
energy that the motion itself has had. That of the whole run, not of the time before: the base opens by a few
1e-4 alpha for some milliseconds before the motion that counts, and closing again takes all of that.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from ..kinematics import Kinematics, mean_velocity
from ..protocol import Steps

Array = NDArray[np.float64]

DRIFT = 1e-3  # of the largest energy, either way: worth a remark; sound runs stay below 5e-4
_BLOCK = 100  # steps for which one largest error is kept: the time of a remark is as fine


class EnergyWatch:
    """Follows the energy of a run chunk by chunk.

    Parameters
    ----------
    time_step : float
        [s]
    least : float
        Largest energy below which there is no motion to speak of [m^2/s^2].
    balance : float
        Energy of the balance, where the start is beyond it, else 0 [m^2/s^2]. What falls from there may have
        less than none, and its errors are still held against that.
    loses : bool
        Whether rolling friction takes energy, so that only a gain is an error.

    Attributes
    ----------
    largest : float
        Energy so far, relative to the ground and zero standing [m^2/s^2].
    """

    def __init__(self, time_step: float, least: float, balance: float = 0.0, *, loses: bool = False) -> None:
        self._step, self._least, self._loses = time_step, least, loses
        self._work = 0.0
        self._start: float | None = None
        self._blocks: list[Array] = []  # time and largest error, with its sign, of each block
        self.largest = balance

    def error(self, state: Kinematics, poses: Steps, after: Steps, acceleration: Array) -> Array:
        """Return the energy less that of the start and the work of the ground at each pose, shape (n,)."""
        # the impulse of a step acts at its pose: half of it belongs to the energy there
        velocity = mean_velocity(poses, after)
        work = -(acceleration * velocity).sum(axis=1) * self._step
        until = self._work + np.cumsum(work) - 0.5 * work
        self._work += float(work.sum())
        if self._start is None:
            self._start = float(state.energy[0] - until[0])
        return np.asarray(state.energy - self._start - until)

    def take(self, time: Array, energy: Array, error: Array) -> None:
        """Take the steps (n,) that belong to the result."""
        starts = np.arange(0, len(time), _BLOCK)
        high, low = np.maximum.reduceat(error, starts), np.minimum.reduceat(error, starts)
        self._blocks.append(np.stack([time[starts], np.where(high > -low, high, low)]))
        self.largest = max(self.largest, float(energy.max()))

    def remark(self, until: float) -> tuple[float, float, float]:
        """Return the start of an error worth a remark [s], its largest share, and the bound; NaN, 0 if never.

        What happens after `until` [s] does not count.
        """
        time, error = np.hstack([*self._blocks, np.empty((2, 0))])
        error = error[time <= until]
        if self._loses:
            error = np.maximum(error, 0.0)
        large = np.abs(error) > DRIFT * self.largest
        if self.largest < self._least or not large.any():
            return math.nan, 0.0, DRIFT
        return float(time[np.argmax(large)]), float(error[np.abs(error).argmax()]) / self.largest, DRIFT
