"""Contact force and uplift, from the velocities of an engine alone.

The mass centre obeys force/m = change of its velocity in a step + ground acceleration + g, exactly for what
an engine stepped with, whichever engine it is; no sensor needs to be in the scene. A guide is a pure moment
and does not show.

A single step says little: MuJoCo's contact is so stiff that a rim leaves the ground for one step now and
then, and the next carries twice the load. A sample is therefore the mean over a window that is shorter than
a pass which the engine resolves.

The base uplifts when the ground's reaction reaches its rim. Contact yields, so tilt itself has no sharp
onset: the eccentricity of the reaction, from the engine's own accelerations, has. It follows the
excitation until it is b, and stays there while the cylinder rolls on its rim. The search therefore goes
back from the first tilt that is motion beyond doubt to the last steps at which the reaction still
followed the excitation, and takes the last few percent of the way to the rim from the course of the
excitation, which bends at every sample of a record.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from .protocol import Steps
from .scene import Array, Body

# Steps on each side of a sample. Under El Centro a quarter of MuJoCo's single steps are more than 1 % off the
# reduced model's normal force, windows of 16 still 4 %, these none; longer ones blur the kinks of a record.
HALF_WINDOW = 32
_GRIP = 0.02  # share of the friction, and weights, within the error of rounding and the window
_PULL = 1e-3  # weights; far above rounding
_WEIGHTS: Array = np.hanning(2 * HALF_WINDOW + 3)[1:-1] / (HALF_WINDOW + 1.0)  # Hann window; sum 1


def force_of_steps(
    poses: Steps, after: Steps, ground: Array, time_step: float, gravity: float, gain: float = 1.0
) -> Array:
    """Contact force on the carried mass, in its weights, shape (3, n), world axes.

    The cylinder is, by the ground and by walls; in a frame with its share of the slab, or the slab alone by
    the top. The velocity of its mass centre is `gain` times that of the cylinder.

    The velocities of `poses` are those of the step before each, those of `after` one step later;
    `ground` (n, 3) is the acceleration of the ground at the poses [m/s^2].
    """
    change = gain * (after.velocity.T - poses.velocity.T)
    force: Array = change / (time_step * gravity) + ground.T / gravity
    force[2] += 1.0
    return force


def contact_tension_time(time: Array, force: Array) -> float:
    """First time of tensile contact force [s], from `force` (3, n) [weights]; NaN if never.

    Contact does not pull, but a joint in its place does.
    """
    return _first(time, force, lambda part: part[2] < -_PULL)


def slip_onset_time(time: Array, force: Array, friction: float) -> float:
    """First time at which `force` (3, n) [weights] on the rim exceeds friction [s]; NaN if never.

    Contact slides there, but a joint in its place does not.
    """

    def exceeds(part: Array) -> NDArray[np.bool_]:
        available = (1.0 + _GRIP) * friction * np.maximum(part[2], 0.0)
        over: NDArray[np.bool_] = np.hypot(part[0], part[1]) > available + _GRIP
        return over

    return _first(time, force, exceeds)


def _first(time: Array, force: Array, breaks: Callable[[Array], NDArray[np.bool_]]) -> float:
    """First time at which a force (3, n) `breaks` a rule in the mean over a window [s]; NaN if never."""
    if not breaks(force).any():
        return float("nan")
    # a mean, not single steps: an engine that pushes the rim out of the ground pulls it back in the next step
    kernel = np.full(HALF_WINDOW, 1.0 / HALF_WINDOW)
    mean = np.array([np.convolve(component, kernel, mode="same") for component in force])
    losses = np.flatnonzero(breaks(mean))
    return float(time[losses[0]]) if len(losses) else float("nan")


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
        self._known: Array = np.empty((3, 0))  # force in the last steps
        self._first = 0  # number of the first of these steps
        self._found: list[Array] = []
        self._taken = 0

    def extend(self, samples: Array) -> None:
        """Ask for further times (n,), after the last one [s]."""
        self._samples = np.append(self._samples, samples)

    def add(self, force: Array) -> None:
        """Take the next steps, shape (3, n)."""
        if self._first == 0 and not self._known.size and force.shape[1] > 1:
            # in the first step an engine has yet to load its contact: a percent of the weight
            force, self._first = force[:, 1:], 1
        self._known = np.hstack([self._known, force])
        settled = (self._first + self._known.shape[1] - HALF_WINDOW - 2) * self._step
        due = self._samples[self._taken : np.searchsorted(self._samples, settled, side="right")]
        if len(due):
            self._found.append(self._means(due))
            self._taken += len(due)
        # a later sample needs half a window before it
        surplus = max(self._known.shape[1] - 2 * HALF_WINDOW - 3, 0)
        self._known, self._first = self._known[:, surplus:], self._first + surplus

    def at(self, times: Array) -> Array:
        """Force at the samples that a run has reached, and at its end, shape (n, 3)."""
        forces = np.vstack([*self._found, np.empty((0, 3))])[: len(times)]
        return np.vstack([forces, self._means(times[len(forces) :])])

    def _means(self, times: Array) -> Array:
        """Means about `times` (n,), over the known part of the window, shape (n, 3)."""
        count = self._known.shape[1]
        position = times / self._step - self._first
        before = np.floor(position).astype(np.intp)
        part = (position - before)[:, None]
        column = before[:, None] + np.arange(-HALF_WINDOW, HALF_WINDOW + 2)
        weights = (1.0 - part) * np.append(_WEIGHTS, 0.0) + part * np.append(0.0, _WEIGHTS)
        weights *= (column >= 0) & (column < count)
        total = weights.sum(axis=1)
        # after the last step, where a fall ends between two steps
        weights[total == 0.0, -1], total[total == 0.0] = 1.0, 1.0
        windows = self._known[:, np.clip(column, 0, count - 1)]
        return np.asarray(np.einsum("imj,mj->mi", windows, weights) / total[:, None])


SURE_TILT = 5e-6  # tilt over alpha; a standing cylinder tilts by 1e-9 rad in MuJoCo, 1e-8 rad in Bullet
# Rounding errors; at 0.98 of the uplift load a standing cylinder tilts by up to 120 of them in Rapier, the
# single precision of the height of its corners
_SURE_ROUNDINGS = 150.0
_MEMORY = 4000  # steps stored before that tilt: from the uplift to it there are a few hundred
# Eccentricities, over b, up to which the reaction should follow. Contact yields next to the rim, and Bullet's
# four contacts share the load in turn there: the highest with a steady ratio counts.
_LEVELS = (0.97, 0.94, 0.9, 0.8)
_FIT = 20  # number of steps that must follow
_STEADY = 2e-3  # largest deviation of their ratio
_AT_RIM = 0.99  # eccentricity over b; a polygon of 48 corners carries the reaction at 0.998 b or more
_SPIKE = 9  # steps; a single step without contact, or with twice the load, is noise
# eccentricity over b; a reaction with a larger lag has left the excitation: the base tips early
_DEPARTURE = 0.015
# share of the uplift load: engines in double precision open within 3e-4 of it, Rapier up to a tenth early
EARLY = 5e-3
_MINIMUM_LOAD = 0.1  # weights; a smaller reaction, in the step that loses contact, has no eccentricity


def sure_tilt(body: Body, rounding: float) -> float:
    """Tilt [rad] beyond the noise of standing, at a relative rounding error."""
    return max(SURE_TILT * float(np.arctan(body.tan_alpha)), _SURE_ROUNDINGS * rounding)


def begun_at(direction: float, angle: Array, leans: NDArray[np.bool_]) -> Array:
    """Rolling angle (n,) from the first tilt on, in the turn of `direction`."""
    first = int(np.argmax(leans))
    turns = np.round((direction - angle[first]) / (2.0 * np.pi))
    return np.where(np.arange(len(angle)) < first, angle, angle + 2.0 * np.pi * turns)


class UpliftWatch:
    """Watch over chunks of steps for the uplift of a standing cylinder.

    Attributes
    ----------
    missing : float
        Share of the load that uplifts which was missing when the base opened; NaN before.
    """

    def __init__(self, body: Body, gravity: float, time_step: float, rounding: float) -> None:
        self._body, self._gravity, self._step = body, gravity, time_step
        self._sure = sure_tilt(body, rounding)
        # time, eccentricity of the reaction, eccentricity of a reaction that follows the excitation at once
        self._history: Array = np.empty((0, 5))
        self.missing = float("nan")

    def watch(
        self, time: Array, tilt: Array, poses: Steps, after: Steps, acceleration: Array
    ) -> tuple[float, float] | None:
        """Time [s] and direction [rad] of the uplift once it has happened, None before.

        `acceleration` (n, 3) is the ground's in the step after each pose.
        """
        still = -self._body.mass_centre_height * acceleration[:, :2] / (self._gravity + acceleration[:, 2:])
        reaction = self._reaction_eccentricity(poses, after, acceleration)
        rows = np.column_stack([time, reaction, still])
        b = self._body.base_radius
        # a load beyond the rim for a millisecond uplifts the base by less than that tilt
        passes = (np.hypot(still[:, 0], still[:, 1]) >= b) & (
            np.hypot(reaction[:, 0], reaction[:, 1]) > _AT_RIM * b
        )
        sure = np.flatnonzero((tilt > self._sure) | passes)
        end = int(sure[0]) + 1 if len(sure) else len(tilt)
        self._history = np.vstack([self._history, rows[:end]])[-_MEMORY:]
        return self._crossing() if len(sure) else None

    def _reaction_eccentricity(self, poses: Steps, after: Steps, acceleration: Array) -> Array:
        """Point of action of the ground's reaction, relative to the centre of the base, shape (n, 2) [m]."""
        body = self._body
        # per unit of the effective mass; in a frame the forces at base and top act on opposite sides of it
        moved = body.moved_mass / body.effective_mass
        force = moved * (after.velocity - poses.velocity) / self._step + acceleration
        load = np.maximum(force[:, 2] + self._gravity, _MINIMUM_LOAD * self._gravity)
        # upright, the moment about the mass centre is that of the transverse inertia
        inertia = body.transverse_inertia / body.effective_mass
        change = inertia * (after.angular_velocity - poses.angular_velocity) / self._step
        height = body.mass_centre_height
        return np.column_stack(
            [-(change[:, 1] + height * force[:, 0]) / load, (change[:, 0] - height * force[:, 1]) / load]
        )

    def _crossing(self) -> tuple[float, float]:
        time, still = self._history[:, 0], self._history[:, 3:]
        reaction = _without_spikes(self._history[:, 1:3])
        share, expected = (np.hypot(at[:, 0], at[:, 1]) / self._body.base_radius for at in (reaction, still))
        for level in _LEVELS:
            inside = np.flatnonzero(share < level)
            end = int(inside[-1]) + 1 if len(inside) else 0
            fit = slice(end - _FIT, end)
            if end < _FIT or not (expected[fit] > 0.0).all():
                continue
            ratio = share[fit] / expected[fit]
            middle = float(np.median(ratio))
            if np.abs(ratio - middle).max() > _STEADY:
                continue
            return self._follow(time, still, middle * expected, share, end)
        # the load jumped over the rim: there is no approach, and no doubt about the step
        inside = np.flatnonzero(share < _LEVELS[0])
        step = min(int(inside[-1]) + 1 if len(inside) else 0, len(time) - 1)
        return self._open(float(time[step]), still[step])

    def _follow(
        self, time: Array, still: Array, expected: Array, share: Array, end: int
    ) -> tuple[float, float]:
        """Continue from step `end` to an expected eccentricity of b, or to a reaction that lags for good."""
        over = np.flatnonzero(expected[end:] >= 1.0)
        step = end + int(over[0]) if len(over) else len(time) - 1
        follows = np.flatnonzero(expected[end:step] - share[end:step] < _DEPARTURE)
        step = min(step, end + (int(follows[-1]) + 1 if len(follows) else 0))
        before = expected[step - 1]
        part = 1.0
        if expected[step] >= 1.0 and expected[step] > before:
            part = min(max((1.0 - before) / (expected[step] - before), 0.0), 1.0)
        at = still[step - 1] + part * (still[step] - still[step - 1])
        return self._open(float(time[step - 1] + part * (time[step] - time[step - 1])), at)

    def _open(self, time: float, still: Array) -> tuple[float, float]:
        """Time and direction of an uplift under a load of eccentricity `still` (2,), which is recorded."""
        self.missing = 1.0 - float(np.hypot(*still)) / self._body.base_radius
        return time, float(np.arctan2(still[1], still[0]))


def _without_spikes(values: Array) -> Array:
    """Median of each value (n, 2) and its neighbours in time."""
    padded = np.pad(values, ((_SPIKE // 2, _SPIKE // 2), (0, 0)), mode="edge")
    windows = np.lib.stride_tricks.sliding_window_view(padded, _SPIKE, axis=0)
    return np.asarray(np.median(windows, axis=-1))
