"""Recorder of a run, chunk by chunk: samples, turning points, peak, uplift and guard, never all steps.

Contact with walls is that of the engine's own sensors: they come back from a rollout with the states, and
cost 0.1 us a step, 3 % of it. To work out the distances of 32 walls again from the poses takes ten times as
long, and would not know the force.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from rockwobble.models.bounds import OVERTURNED_TILT
from rockwobble.models.plain_json import fields_of

from .guard import EnergyWatch, couple_power, energy_scale, first_breach
from .kinematics import (
    Kinematics,
    axis_of,
    kinematics,
    rim,
    rolling_momentum,
    tilt_of,
    unwrap,
    unwrap_twist,
)
from .passes import RestWatch, TurningPoint, turning_points
from .protocol import Steps, Wall
from .reaction import (
    ForceSamples,
    UpliftWatch,
    begun_at,
    contact_tension_time,
    force_of_steps,
    slip_onset_time,
    sure_tilt,
)
from .scene import Array, Scene, Start

Indices = NDArray[np.intp]
T = TypeVar("T", Steps, Kinematics, Wall)

_SIDE_TOUCHES = OVERTURNED_TILT - 1e-3  # [rad] contact of the side may stop the fall a little before

FLIGHT = 1e-3  # height over b that counts as flight: in MuJoCo a sliding rim may hover below it
SLIP = 0.01  # slip over b beyond the creep of a rolling rim
# share of the energy scale: a base that opens by less than 1e-4 alpha has not moved
_LEAST_ENERGY = 2e-4
_ROUNDING = 1e-6  # share of a step
COLUMNS = (
    "tilt", "tilt_rate", "rolling_angle", "rolling_rate", "twist", "contact_x", "contact_y",
    "x", "y", "z", "energy", "energy_error", "energy_lost", "slip",
    "wall_contact", "wall_impulse", "elongation",
)  # fmt: skip


class Recorder:
    """Turns the steps of an engine into samples at given times.

    Parameters
    ----------
    scene : Scene
    samples : ndarray, shape (n,)
        Times of the samples, in the scene [s].
    rolling_angle : float
        At the start of a release [rad].
    starts_at_turn : bool
        Whether the release is at rest in tilt.
    rounding : float
        Relative rounding error of the engine.
    joined : bool
        Whether a joint keeps the slab of a frame on the top; a column in contact may hop without it.
    """

    def __init__(
        self,
        scene: Scene,
        samples: Array,
        rolling_angle: float,
        starts_at_turn: bool,
        rounding: float = 2.0**-53,
        *,
        joined: bool = False,
    ) -> None:
        body, start = scene.body, scene.start
        self._gains = body.velocity_ratios if joined else body.velocity_ratios[:1]
        self._scene, self._samples = scene, samples
        self.mode = scene.mode
        self.asked = float(samples[-1])  # end of the requested run, before any extension [s]
        self.off_grid = False  # whether the end is off the sample grid of an extended run
        self._watch: UpliftWatch | None = None
        if start.standing:
            self._watch = UpliftWatch(body, scene.tipping_gravity, scene.time_step, rounding)
        self._start: Start | None = start
        self._last: Steps | None = None  # pose whose next velocity is still to come
        self._count = 0  # poses analysed
        self._angle, self._twist = rolling_angle, 0.0
        self._leans = not start.standing  # whether it tilts at the last pose analysed
        self._tail: Array = np.empty((3, 0))  # time, tilt and rolling angle of the last steps
        # last step analysed: time and the fields of `COLUMNS`
        self.last_row: Array = np.empty(len(COLUMNS) + 1)
        self._rows: list[Array] = []
        self._taken = 0
        self.forces = ForceSamples(samples, scene.time_step)
        self._depths: list[float] = []
        self._slipped = 0.0
        self.walls = WallWatch(scene.time_step)
        self.slip_time = math.nan  # when the slip was first above the reporting threshold [s]
        self.flight_time = math.nan  # when the rim left the ground [s]
        balance, lean = energy_scale(body, scene.gravity), float(tilt_of(start.quaternion[None])[0])
        self.energy = EnergyWatch(
            scene.time_step,
            _LEAST_ENERGY * balance if start.standing else 0.0,
            balance if lean > scene.balance_tilt else 0.0,
        )
        self.looks = 0  # checks of the solver, and the number without convergence
        self.unsolved = 0
        # times at which an end needed more than friction, and a pull, which only a joint supplies [s]
        self.grip_time = self.pull_time = math.nan
        # a standing cylinder tilts by less, in no direction
        sure = sure_tilt(body, rounding)
        self.floor = sure if start.standing else min(sure, 0.5 * lean)
        self.rests = RestWatch(2.0 * self.floor)
        self._at_turn = not start.standing and starts_at_turn
        self.points: list[TurningPoint] = []
        self.peak = 0.0
        self.elongation = 0.0  # largest elongation so far [m]
        self.yield_time = math.nan  # when the tendon would first have yielded [s]
        self._balance = scene.balance_tilt
        self.fastest = 0.0
        self.uplift: tuple[float, float] | None = None if start.standing else (0.0, rolling_angle)
        self.missing_load = math.nan  # at the uplift, missing share of the uplift load
        self.ended: str = ""
        self.failure = ""  # code of the diagnostic that ended the run
        self.warnings: list[str] = []
        self.end_time = math.inf
        self.followed_until = math.nan  # time of the next maximum, or of rest, after the end [s]
        self.undecided = False  # whether neither of both, nor the ground, was reached in time

    @property
    def table(self) -> Array:
        """Samples taken so far, shape (m, 1 + columns): time and the fields of `COLUMNS`."""
        return np.vstack(self._rows) if self._rows else np.empty((0, len(COLUMNS) + 1))

    @property
    def end(self) -> float:
        """Time of the last sample asked for [s]."""
        return float(self._samples[-1])

    @property
    def resting(self) -> bool:
        """Whether it stands still at the last step analysed."""
        return self.uplift is None or self.rests.resting

    def last_value(self, name: str) -> float:
        """Field of `COLUMNS` at the last step analysed."""
        return float(self.last_row[1 + COLUMNS.index(name)])

    @property
    def penetration(self) -> float:
        """Median depth of the lowest point of the rim under the ground [m]."""
        return max(float(np.median(self._depths)), 0.0) if self._depths else 0.0

    def take(self, steps: Steps, acceleration: Array) -> None:
        """Analyse the poses for which `steps` brings the following velocity.

        `acceleration` (n, 3) is the ground's during `steps`: its first row belongs to the step that
        follows the last pose known so far.
        """
        self.looks, self.unsolved = self.looks + 1, self.unsolved + steps.unsolved
        poses, after = self._pair(steps)
        count, wall = len(poses.position), steps.wall
        time: Array = self._scene.time_step * np.arange(self._count, self._count + count, dtype=float)
        body = self._scene.body
        state = kinematics(poses, after, body, self._scene.gravity, self._scene.restraint)
        state = replace(state, twist=unwrap_twist(state.twist, self._twist))
        gained = self.energy.error(state, poses, after, acceleration)
        # before the couple, whose estimate is too coarse to end a run
        stop = self._stop(time, state, gained, wall)
        if not stop:
            return
        lost = self._rolling_loss(poses, after, acceleration)
        gained = gained + lost
        if stop < count:
            # motion after the end, the side on the ground included, is no part of the run
            inside = slice(stop)
            time, gained, lost, acceleration = (each[inside] for each in (time, gained, lost, acceleration))
            poses, after, state = _rows(poses, inside), _rows(after, inside), _rows(state, inside)
            wall = wall and _rows(wall, inside)
        if self._watch is not None and self.uplift is None:
            self.uplift = self._watch.watch(time, state.tilt, poses, after, acceleration)
            self.missing_load = self._watch.missing
        leans = state.tilt > self.floor
        angle = unwrap(
            state.azimuth,
            lambda at: rolling_momentum(_rows(poses, at), _rows(after, at), body),
            leans,
            self._angle,
            self._leans,
        )
        if self._watch is not None and self.uplift is not None and leans.any():
            angle = begun_at(self.uplift[1], angle, leans)
            self._watch = None
        slip = self._slip(time, state)
        wall_contact, wall_impulse = self.walls.take(time, wall)
        elongation = self._watch_tendon(time, poses)

        def rows(at: Indices) -> Array:
            some, later = _rows(poses, at), _rows(after, at)
            place = rim(some, later, body)
            return np.column_stack(
                [time[at], state.tilt[at], state.tilt_rate[at], angle[at], place.rolling_rate,
                 state.twist[at], place.contact_point, some.position,
                 state.energy[at], gained[at], lost[at], slip[at], wall_contact[at], wall_impulse[at],
                 elongation[at]]
            )  # fmt: skip

        self._depths.append(float(np.median(state.depth)))
        self._follow(np.stack([time, state.tilt, angle]))
        self.energy.take(time, state.energy, gained)
        self.rests.take(time, state.tilt)
        # a fall beyond the balance is faster than any pass, and no pass follows it
        within = state.tilt < self._balance
        self.fastest = max(self.fastest, float(np.abs(state.tilt_rate[within]).max(initial=0.0)))
        self._sample(time, rows)
        # forces on the base, and on a slab that keeps to the top
        ends = self._contact_forces(poses, after, acceleration, self._gains)
        self.forces.add(ends[0])
        # a wall may push the cylinder down, by its friction or where the rim is below it
        if math.isnan(self.pull_time) and wall is None:
            self.pull_time = float(np.fmin.reduce([contact_tension_time(time, force) for force in ends]))
        if math.isnan(self.grip_time) and wall is None:
            friction = self._scene.friction
            self.grip_time = float(np.fmin.reduce([slip_onset_time(time, force, friction) for force in ends]))
        self._angle, self._twist, self._leans = float(angle[-1]), float(state.twist[-1]), bool(leans[-1])
        self._count += stop

    def extend(self, samples: Array) -> None:
        """Extend the run to further samples, at times (n,) after the last one [s]."""
        self._samples = np.append(self._samples, samples)
        self.forces.extend(samples)

    def warn(self, text: str) -> None:
        """Keep a warning of the engine, which ends the run at the last step analysed."""
        if not self.ended:
            self.ended, self.failure, self.end_time = "failed", "warning", float(self.last_row[0])
        if self.ended == "failed":
            self.warnings.append(text)

    def _pair(self, steps: Steps) -> tuple[Steps, Steps]:
        """Poses with the velocities before them, and the poses one step later."""
        if self._last is None:
            start = self._start
            assert start is not None
            # the mean of this and the next velocity is the velocity of the start
            self._last = Steps(
                start.position[None],
                start.quaternion[None],
                2.0 * start.velocity[None] - steps.velocity[:1],
                2.0 * start.angular_velocity[None] - steps.angular_velocity[:1],
            )
        joined = Steps(
            _after(self._last.position, steps.position),
            _after(self._last.quaternion, steps.quaternion),
            _after(self._last.velocity, steps.velocity),
            _after(self._last.angular_velocity, steps.angular_velocity),
        )
        self._last = _rows(joined, slice(-1, None))
        return _rows(joined, slice(0, -1)), _rows(joined, slice(1, None))

    @property
    def _carried_shares(self) -> tuple[float, float]:
        """Masses on the base (a column and its share of the slab) and on the top (the share) [columns]."""
        slab = self._scene.body.slab_mass_ratio
        return 1.0 + slab, slab

    def _contact_forces(
        self, poses: Steps, after: Steps, ground: Array, gains: Sequence[float]
    ) -> list[Array]:
        """Force of contact (3, n) on each end that has a gain, over the weight that it carries."""
        scene = self._scene
        ends = [force_of_steps(poses, after, ground, scene.time_step, scene.gravity, gain) for gain in gains]
        if scene.restraint.is_active:
            # the tendon acts on the column and its slab as contact does
            height = scene.body.mass_centre_height
            pulls = scene.restraint.forces(poses.position, axis_of(poses.quaternion), height) / scene.gravity
            for end, mass in zip(ends, self._carried_shares, strict=False):
                end -= pulls / mass
        return ends

    def _rolling_loss(self, poses: Steps, after: Steps, ground: Array) -> Array:
        """Energy lost to the rolling resistance until each pose, shape (n,) [m^2/s^2]."""
        scene, body = self._scene, self._scene.body
        if scene.rolling_resistance == 0.0:
            return np.zeros(len(poses.position))
        masses = (mass * scene.gravity / body.effective_mass for mass in self._carried_shares)
        ends = self._contact_forces(poses, after, ground, body.velocity_ratios)
        forces = list(zip(masses, ends, strict=False))
        power = couple_power(poses, after, forces, scene.rolling_resistance)
        return self.energy.loss(power)

    def _slip(self, time: Array, state: Kinematics) -> Array:
        """Slip distance of the contact until each pose [m]; times of slip and flight are recorded."""
        b = self._scene.body.base_radius
        touching = state.depth > -FLIGHT * b
        slipped: Array = self._slipped + self._scene.time_step * np.cumsum(state.slip_rate * touching)
        self._slipped = float(slipped[-1])
        self.slip_time = _first_time(self.slip_time, time, slipped > SLIP * b)
        self.flight_time = _first_time(self.flight_time, time, state.depth < -FLIGHT * b)
        return slipped

    def _watch_tendon(self, time: Array, poses: Steps) -> Array:
        """Elongations of the tendon, shape (n,) [m]; the time of yield is recorded."""
        restraint, height = self._scene.restraint, self._scene.body.mass_centre_height
        if not restraint.is_active:
            return np.zeros(len(time))
        elongation = restraint.elongation(poses.position, axis_of(poses.quaternion), height)
        self.elongation = max(self.elongation, float(elongation.max()))
        self.yield_time = _first_time(self.yield_time, time, elongation > restraint.yield_elongation)
        return elongation

    def _stop(self, time: Array, state: Kinematics, gained: Array, wall: Wall | None) -> int:
        """Number of steps of this chunk that belong to the result."""
        stop = len(time)
        over = np.flatnonzero(state.tilt >= _SIDE_TOUCHES)
        if len(over):
            stop = int(over[0])
            self.ended = "overturned"
            rate = max(float(state.tilt_rate[stop]), 1e-3)
            self.end_time = float(time[stop] + max(OVERTURNED_TILT - state.tilt[stop], 0.0) / rate)
        breach = first_breach(
            state, gained, self._scene.body, self._scene.gravity, self._scene.support.guided, wall,
            self.energy.largest,
        )  # fmt: skip
        if breach is not None and breach.index < stop:
            stop = breach.index
            self.ended, self.failure, self.end_time = "failed", breach.code, float(time[stop])
        # the start belongs to every run
        return max(stop, 1) if self._count == 0 else stop

    def _follow(self, track: Array) -> None:
        """Turning points and peak of consecutive steps: time, tilt and rolling angle, shape (3, n)."""
        joined = np.hstack([self._tail, track])
        fresh = joined[:, max(self._tail.shape[1] - 2, 0) :]
        tilt, angle = joined[1:]
        if self._at_turn and len(tilt) > 1:
            # in a release at rest in tilt, the start is a turning point as well
            self.points.append(TurningPoint(0.0, float(tilt[0]), float(angle[0]), bool(tilt[1] < tilt[0])))
            self._at_turn = False
        if joined.shape[1] > 2 and self.uplift is not None:
            # the two carried steps were inner ones already, except for the last of them
            self.points += [point for point in turning_points(*fresh) if point.time >= self.uplift[0]]
        self._tail = joined[:, -3:].copy()
        # the last step may lie beyond the last sample
        self.peak = max(self.peak, float(tilt[joined[0] <= self.end].max(initial=0.0)))

    def _sample(self, time: Array, rows: Callable[[Indices], Array]) -> None:
        """Take the samples that are due; `rows` gives the fields at some of the steps."""
        last = len(time) - 1
        # the end of a run, a sum of samples, may round beyond its last step
        reached = time[-1] + _ROUNDING * self._scene.time_step
        due = self._samples[self._taken : np.searchsorted(self._samples, reached, side="right")]
        # the steps around each sample; -1 is the last step of the chunk before
        before = np.searchsorted(time, due, side="right") - 1
        after = np.minimum(before + 1, last)
        needed = np.unique(np.concatenate([before, after, [last]]))
        known = rows(needed[needed >= 0])
        if needed[0] < 0:
            known = np.vstack([self.last_row, known])
        if len(due):
            left, right = (known[np.searchsorted(needed, at)] for at in (before, after))
            span = right[:, 0] - left[:, 0]
            part = np.where(span > 0.0, (due - left[:, 0]) / np.where(span > 0.0, span, 1.0), 0.0)[:, None]
            taken = left + part * (right - left)
            taken[:, 0] = due
            self._rows.append(taken)
            self._taken += len(due)
        self.last_row = known[-1]


def _first_time(known: float, time: Array, happens: NDArray[np.bool_]) -> float:
    """First time of an event [s]: known before, or in these steps; NaN without one."""
    return float(time[np.argmax(happens)]) if math.isnan(known) and happens.any() else known


def _after(last: Array, rows: Array) -> Array:
    """One row and then rows (n, k), stored by component."""
    joined = np.empty((rows.shape[1], len(rows) + 1))
    joined[:, 0], joined[:, 1:] = last[0], rows.T
    return joined.T


def _rows(values: T, part: slice | Indices) -> T:
    """Selection of steps, as the same kind of table."""
    arrays: dict[str, Any] = {
        name: each[part] for name, each in fields_of(values).items() if isinstance(each, np.ndarray)
    }
    return replace(values, **arrays)


class WallWatch:
    """Sum over chunks of the duration and the impulse of contact with walls.

    Attributes
    ----------
    first : float
        Time of the first contact [s]; NaN before.
    """

    def __init__(self, time_step: float) -> None:
        self._step = time_step
        self._contact, self._impulse = 0.0, 0.0
        self.first = math.nan

    def take(self, time: Array, wall: Wall | None) -> tuple[Array, Array]:
        """Duration of contact until each time [s], and its impulse per unit mass [m/s]."""
        if wall is None:
            return np.zeros(len(time)), np.zeros(len(time))
        self.first = _first_time(self.first, time, wall.touching)
        contact: Array = self._contact + self._step * np.cumsum(wall.touching, dtype=np.float64)
        impulse: Array = self._impulse + self._step * np.cumsum(wall.force)
        self._contact, self._impulse = float(contact[-1]), float(impulse[-1])
        return contact, impulse
