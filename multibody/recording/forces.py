"""The contact force, from the velocities of an engine and nothing else.

The mass centre obeys force/m = change of its velocity in a step + ground acceleration + g, exactly for what
an engine stepped with, whichever engine it is; no sensor needs to be in the scene. A guide is a pure moment
and does not show.

A single step says little: MuJoCo's contact is so stiff that a rim leaves the ground for one step now and
then, and the next carries twice the load. A sample is therefore the mean over a window that is shorter than
a pass which the engine resolves.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..protocol import Steps

Array = NDArray[np.float64]

# Steps on each side of a sample. Under El Centro a quarter of MuJoCo's single steps are more than 1 % off the
# reduced model's normal force, windows of 16 still 4 %, these none; longer ones blur the kinks of a record.
HALF_WINDOW = 32
_GRIP = 0.02  # share of the friction, and weights, that rounding and the window leave in doubt
_PULL = 1e-3  # weights; far above rounding
_WEIGHTS: Array = np.hanning(2 * HALF_WINDOW + 3)[1:-1] / (HALF_WINDOW + 1.0)  # of a Hann window; sum 1


def force_of_steps(
    poses: Steps, after: Steps, ground: Array, time_step: float, gravity: float, share: float = 0.0
) -> Array:
    """Return the force of the ground and of walls on the cylinder in weights, shape (3, n), world axes.

    In a frame the weight is that of the cylinder and its `share` of the slab, which has twice the velocity.

    The velocities of `poses` are those of the step before each, those of `after` one step later;
    `ground` (n, 3) is the acceleration of the ground at the poses [m/s^2].
    """
    change = (1.0 + 2.0 * share) / (1.0 + share) * (after.velocity.T - poses.velocity.T)
    force: Array = change / (time_step * gravity) + ground.T / gravity
    force[2] += 1.0
    return force


def first_pull(time: Array, normal: Array) -> float:
    """Return when the ground first pulled at the cylinder [s], from `normal` (n,) [weights]; NaN if never.

    Contact does not pull, but a joint in its place does.
    """
    if not normal.min() < -_PULL:
        return float("nan")
    # not in single steps: where an engine pushes the rim out of the ground, the next step takes that back
    mean = np.convolve(normal, np.full(HALF_WINDOW, 1.0 / HALF_WINDOW), mode="same")
    pulled = np.flatnonzero(mean < -_PULL)
    return float(time[pulled[0]]) if len(pulled) else float("nan")


def first_grip(time: Array, force: Array, friction: float) -> float:
    """Return when more than friction first held the rim [s], from `force` (3, n) [weights]; NaN if never.

    Contact slides there, but a joint in its place does not.
    """

    def exceeds(part: Array) -> NDArray[np.bool_]:
        available = (1.0 + _GRIP) * friction * np.maximum(part[2], 0.0)
        over: NDArray[np.bool_] = np.hypot(part[0], part[1]) > available + _GRIP
        return over

    if not exceeds(force).any():
        return float("nan")
    kernel = np.full(HALF_WINDOW, 1.0 / HALF_WINDOW)
    mean = np.array([np.convolve(component, kernel, mode="same") for component in force])
    held = np.flatnonzero(exceeds(mean))
    return float(time[held[0]]) if len(held) else float("nan")


class ForceSamples:
    """Means of the force about given times, from steps that come chunk by chunk.

    Parameters
    ----------
    samples : ndarray, shape (n,)
        Times that will be asked for, as far as the run gets [s].
    time_step : float
        [s]
    """

    def __init__(self, samples: Array, time_step: float) -> None:
        self._samples, self._step = samples, time_step
        self._known: Array = np.empty((3, 0))  # force of the last steps
        self._first = 0  # number of the first of them
        self._found: list[Array] = []
        self._taken = 0

    def extend(self, samples: Array) -> None:
        """Ask for further times (n,), after the last one [s]."""
        self._samples = np.append(self._samples, samples)

    def add(self, force: Array) -> None:
        """Take the next steps, shape (3, n)."""
        if self._first == 0 and not self._known.size and force.shape[1] > 1:
            # in its first step an engine has yet to load its contact: a percent of the weight
            force, self._first = force[:, 1:], 1
        self._known = np.hstack([self._known, force])
        settled = (self._first + self._known.shape[1] - HALF_WINDOW - 2) * self._step
        due = self._samples[self._taken : np.searchsorted(self._samples, settled, side="right")]
        if len(due):
            self._found.append(self._means(due))
            self._taken += len(due)
        # a sample still to come looks back by half a window
        surplus = max(self._known.shape[1] - 2 * HALF_WINDOW - 3, 0)
        self._known, self._first = self._known[:, surplus:], self._first + surplus

    def at(self, times: Array) -> Array:
        """Return the force at the samples that a run has reached, and at its end, shape (n, 3)."""
        found = np.vstack([*self._found, np.empty((0, 3))])[: len(times)]
        return np.vstack([found, self._means(times[len(found) :])])

    def _means(self, times: Array) -> Array:
        """Means about `times` (n,), over the part of the window that is known, shape (n, 3)."""
        count = self._known.shape[1]
        position = times / self._step - self._first
        before = np.floor(position).astype(np.intp)
        part = (position - before)[:, None]
        column = before[:, None] + np.arange(-HALF_WINDOW, HALF_WINDOW + 2)
        weights = (1.0 - part) * np.append(_WEIGHTS, 0.0) + part * np.append(0.0, _WEIGHTS)
        weights *= (column >= 0) & (column < count)
        total = weights.sum(axis=1)
        # past the last step, where a fall ends between two
        weights[total == 0.0, -1], total[total == 0.0] = 1.0, 1.0
        windows = self._known[:, np.clip(column, 0, count - 1)]
        return np.asarray(np.einsum("imj,mj->mi", windows, weights) / total[:, None])
