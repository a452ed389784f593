"""Ground acceleration as an engine takes it: one constant for each step."""

from __future__ import annotations

import numpy as np

from rockwobble.models import GroundMotion

from .scene import Array, Scale


class StepMeans:
    """Means of a ground acceleration over the steps of an engine, exact for a piecewise linear record.

    MuJoCo and Bullet advance as leapfrog does: step n takes the velocity from half a step before the pose n
    to half a step after it. The force of that step is therefore the mean from (n - 1/2) h to (n + 1/2) h,
    which keeps the hold of the force second order in h; the mean over the step ahead would shift the
    whole record by h/2. Other integrators hold it elsewhere.

    Parameters
    ----------
    motion : GroundMotion or None
        None: still ground.
    scale : Scale
        From the units of the motion to those of the scene.
    time_step : float
        h, in the scene [s].
    """

    def __init__(self, motion: GroundMotion | None, scale: Scale, time_step: float) -> None:
        self._step = time_step
        if motion is None:
            self._samples: Array = np.zeros((2, 3))
            self._spacing = 1.0
        else:
            self._samples = np.zeros((len(motion.acceleration), 3))
            self._samples[:, : motion.acceleration.shape[1]] = motion.acceleration / scale.acceleration
            self._spacing = motion.time_step / scale.time
        shaken = np.flatnonzero(self._samples.any(axis=1))
        # [s] time from which the ground is still: the last sample, or the first of the last zeros
        self.still_from = self._spacing * min(shaken[-1] + 1 if len(shaken) else 0, len(self._samples) - 1)
        areas = 0.5 * self._spacing * (self._samples[1:] + self._samples[:-1])
        self._velocity: Array = np.vstack([np.zeros(3), np.cumsum(areas, axis=0)])
        self._slopes: Array = np.diff(self._samples, axis=0, append=self._samples[-1:]) / self._spacing
        # the ground keeps still after the last sample, as if zeros followed
        self._samples[-1] = 0.0
        self._still = motion is None

    def __call__(self, first: int, count: int, centre: float = 0.0) -> Array:
        """Return the mean acceleration of steps `first` to `first + count - 1`, shape (count, 3) [m/s^2].

        `centre` is that of the time over which the force of a step is held, from its pose, in steps.
        """
        if self._still:
            return np.zeros((3, count)).T
        edges: Array = (np.arange(first, first + count + 1, dtype=float) + centre - 0.5) * self._step
        velocity = self.ground_velocity(edges).T
        return np.asarray((velocity[:, 1:] - velocity[:, :-1]) / self._step).T

    def stop(self, end: float, step: int, centre: float = 0.0) -> Array:
        """Mean of the step that returns the ground to its velocity at `end` [s], (3,) [m/s^2].

        The step before it held the mean of a time that goes beyond the end. Where a record goes on there, and
        the ground shall keep still, this takes that part back.
        """
        at_end, given = self.ground_velocity(np.array([end, (step + centre - 0.5) * self._step]))
        return np.asarray((at_end - given) / self._step)

    def ground_velocity(self, time: Array) -> Array:
        """Return the integral of the acceleration up to `time` (n,), shape (n, 3) [m/s]."""
        inside = np.maximum(time, 0.0)
        # rounding may put the time of a sample just before it
        index = np.minimum((inside / self._spacing + 1e-9).astype(np.intp), len(self._samples) - 1)
        past = inside - index * self._spacing
        # component by component, which is how the steps take it
        velocity = np.empty((3, len(time)))
        for row, start, speed, slope in zip(
            velocity, self._samples.T, self._velocity.T, self._slopes.T, strict=True
        ):
            row[:] = speed[index] + past * (start[index] + 0.5 * past * slope[index])
        return velocity.T
