"""Guard of an engine run: bounds that hold at every step, and its energy, independent of the engine.

An engine that diverges does not always say so: explicit contact gains energy silently. Each check
returns the first step that breaks it and why; a run is cut there and its outcome is "failed".

The limits are far above what a sound run shows and far below what would change a result unseen: a
sound run at the default step gains 1e-6 of the energy of its motion, and sinks in by 1e-6 b.

Energy that neither the start nor the excitation supplied is compared with the energy of the motion. A run is
as sound as its energy is: what contact takes from a motion of 0.002 alpha may be nothing beside the energy
that balances the cylinder on its rim, and still half of what moves it. So the measure is the largest energy
that the motion itself has had. That of the whole run, not of the time before: the base opens by a few 1e-4
alpha for some milliseconds before the motion that counts, and closing again takes all of that.

The couple of a rolling resistance takes energy by its law, delta N omega (delta its length, N the normal
force, omega the horizontal part of the angular velocity), and that part is no error: it is worked out at each
step from the load and the turning of the body, and what is missing beyond it is held against the same bounds
as without a couple. Bullet's couple is that one. MuJoCo bounds couple and friction T by one cone, (T/mu)^2 +
(M/delta)^2 = N^2, on which the force points against its velocities, so that the rim creeps: together they
take 1/sqrt(1 - (T/(mu N))^2) times as much (measured to 5e-4 of it), and what is more than the law is
contact's.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from .kinematics import Kinematics, mean_spin, mean_velocity
from .protocol import Steps, Wall
from .scene import Array, Body

ENERGY_GAIN = 0.02  # share of the largest energy of the motion so far
# least energy, over that at balance: a base about to open has no energy yet, and gains or losses in its
# contact are noise
_LEAST_ENERGY = 0.05
PENETRATION = 0.01  # depth over b
GUIDE_TWIST = 0.02  # [rad] about one degree
LARGEST_STEP = 1e-3  # [s] at the reference size; contact needs it ten times shorter than the fastest pass
SMALLEST_STEP = 1e-9  # [s] at the reference size; below it the change in a step is lost in rounding


@dataclass(frozen=True, slots=True)
class Breach:
    """First step that breaks a rule, and the code of its `Diagnostic`."""

    index: int
    code: str


def energy_scale(body: Body, gravity: float) -> float:
    """Energy g (R - h) that raises the mass centre over the rim [m^2/s^2]."""
    b, h = body.base_radius, body.mass_centre_height
    # R - h = b^2/(R + h), which does not cancel for slender bodies
    return gravity * b * b / (float(np.hypot(b, h)) + h)


def check_time_step(time_step: float, unit_time: float) -> None:
    """Refuse a time step [s] too large for contact, or so small that rounding dominates.

    Raises
    ------
    ValueError
        Saying what is allowed for this size and gravity.
    """
    if time_step > LARGEST_STEP * unit_time * (1.0 + 1e-9):
        raise ValueError(
            f"time_step must be at most {LARGEST_STEP * unit_time:.3g} s for contact at this size and "
            f"gravity, got {time_step:g}"
        )
    if time_step < SMALLEST_STEP * unit_time:
        raise ValueError(
            f"time_step must be at least {SMALLEST_STEP * unit_time:.3g} s, where rounding is still small, "
            f"got {time_step:g}"
        )


def first_breach(
    state: Kinematics,
    energy_error: Array,
    body: Body,
    gravity: float,
    in_recess: bool,
    wall: Wall | None = None,
    largest: float = 0.0,
) -> Breach | None:
    """Return the earliest breach among n steps, or None.

    `largest` is the energy that the motion had at most before them [m^2/s^2].
    """
    least = max(largest, _LEAST_ENERGY * energy_scale(body, gravity))
    finite = np.isfinite(state.tilt) & np.isfinite(state.energy)
    with np.errstate(invalid="ignore"):
        reached = np.maximum(np.maximum.accumulate(state.energy), least)
        rules = [
            (~finite, "not_finite"),
            (energy_error > ENERGY_GAIN * reached, "energy_gain"),
            (state.depth > PENETRATION * body.base_radius, "penetration"),
        ]
        if wall is not None:
            rules.append((wall.depth > PENETRATION * body.base_radius, "wall_penetration"))
        if in_recess:
            rules.append((np.abs(state.twist) > GUIDE_TWIST, "guide"))
    breaches = [Breach(int(np.argmax(broken)), code) for broken, code in rules if broken.any()]
    return min(breaches, key=lambda breach: breach.index, default=None)


def couple_power(poses: Steps, after: Steps, forces: Sequence[tuple[float, Array]], length: float) -> Array:
    """Power lost to the couple of a rolling resistance, per unit of the effective mass.

    Parameters
    ----------
    poses, after : Steps
        As for `kinematics`.
    forces : sequence of (float, ndarray)
        For each end that rolls, the mass whose weight the force is in, over the effective mass, times gravity
        [m/s^2], and the force on it (3, n) [weights].
    length : float
        Length of the couple [m].

    Returns
    -------
    ndarray, shape (n,)
        At each pose [m^2/s^3]. A rim that hops has a load of either sign in single steps, of the right mean.
    """
    spin = mean_spin(poses, after)
    normal = sum((weight * force[2] for weight, force in forces), start=np.zeros(len(spin)))
    return np.asarray(length * np.hypot(spin[:, 0], spin[:, 1]) * normal)


DRIFT = 1e-3  # share of the largest energy gained or lost that is reported; sound runs stay below 5e-4
_BLOCK = 100  # steps that share one largest error: the time resolution of a remark


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
        less than none, and its errors are still compared with that.

    Attributes
    ----------
    largest : float
        Energy so far, relative to the ground and zero standing [m^2/s^2].
    """

    def __init__(self, time_step: float, least: float, balance: float = 0.0) -> None:
        self._step, self._least = time_step, least
        self._work = 0.0
        self._lost, self._first = 0.0, True
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

    def loss(self, power: Array) -> Array:
        """Energy lost until each pose by a power (n,), shape (n,) [m^2/s^2]."""
        work = power * self._step
        until: Array = self._lost + np.cumsum(work) - 0.5 * work
        self._lost += float(work.sum())
        if self._first:
            until, self._lost, self._first = until - until[0], self._lost - float(until[0]), False
        return until

    @property
    def moves(self) -> bool:
        """Whether there has been a motion above the noise of standing."""
        return self.largest >= self._least

    def take(self, time: Array, energy: Array, error: Array) -> None:
        """Take the steps (n,) that belong to the result."""
        starts = np.arange(0, len(time), _BLOCK)
        high, low = np.maximum.reduceat(error, starts), np.minimum.reduceat(error, starts)
        self._blocks.append(np.stack([time[starts], np.where(high > -low, high, low)]))
        self.largest = max(self.largest, float(energy.max()))

    def remark(self, until: float) -> tuple[float, float, float]:
        """Start of an error above the reporting threshold [s], its largest share, and the bound.

        NaN and 0 if there is none. What happens after `until` [s] does not count.
        """
        time, error = np.hstack([*self._blocks, np.empty((2, 0))])
        error = error[time <= until]
        large = np.abs(error) > DRIFT * self.largest
        if not self.moves or not large.any():
            return math.nan, 0.0, DRIFT
        return float(time[np.argmax(large)]), float(error[np.abs(error).argmax()]) / self.largest, DRIFT
