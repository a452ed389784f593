"""Motion as the tilt vector of its axis and the path of its mass centre, and its difference from a reference.

The lean sin(theta) exp(i phi) is smooth through the upright position, where the azimuth phi means nothing and
in planar motion jumps by pi.

theta  tilt: angle of the axis from the vertical        [rad]
phi    azimuth of the lean, hence of the contact point  [rad]

Two good traces of one problem diverge at some time, and near upright no azimuth means anything. So azimuth
and path are compared while the tilts agree, and the azimuth where both lean by more than a share of the
largest tilt there.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from .table import POSITION, QUATERNION, Array, Mask, Values

Complex = NDArray[np.complex128]

# normal distribution: median of the absolute value over the standard deviation
MEDIAN_OF_NORMAL = 0.6745
FEWEST_SCATTERED = 12  # least number of samples for an estimate of their scatter
SAME_TIME = 1e-9  # samples at one time up to rounding [s]
SAME_STEP = 1e-6  # relative


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Motion:
    """Samples of a motion.

    Attributes
    ----------
    time, tilt : ndarray, shape (n,)
        [s], [rad]
    lean : ndarray of complex, shape (n,), or None
        x + i y of the axis, a unit vector; None where no azimuth is known.
    path : ndarray, shape (n, 3), or None
        Mass centre from O [m]; None where it is not known.
    twist : ndarray, shape (n,), or None
        Turn about the axis since the start [rad]; None where it is not known.
    noise, path_noise : float
        Standard deviations of the noise of the axis [rad] and of each coordinate of the mass centre [m].
    """

    time: Array
    tilt: Array
    lean: Complex | None
    path: Array | None = None
    twist: Array | None = None
    noise: float = 0.0
    path_noise: float = 0.0

    @property
    def step(self) -> float:
        """Usual time between two samples [s]."""
        return float(np.median(np.diff(self.time))) if len(self.time) > 1 else 0.0

    def rotated(self, angle: float, *, mirrored: bool = False) -> Motion:
        """Return the motion turned by `angle` [rad] counter-clockwise, with y reversed first if mirrored."""
        turn, lean, path, twist = np.exp(1j * angle), self.lean, self.path, self.twist
        if twist is not None and mirrored:
            twist = -twist
        if lean is not None:
            lean = turn * (lean.conj() if mirrored else lean)
        if path is not None:
            flat = turn * (path[:, 0] + (-1j if mirrored else 1j) * path[:, 1])
            path = np.column_stack([flat.real, flat.imag, path[:, 2]])
        return replace(self, lean=lean, path=path, twist=twist)

    def at(self, time: Array) -> Motion:
        """Return the motion at other times [s], linear between its samples."""
        tilt = np.interp(time, self.time, self.tilt)
        lean = None if self.lean is None else np.interp(time, self.time, self.lean)
        path = self.path
        if path is not None:
            path = np.column_stack([np.interp(time, self.time, part) for part in path.T])
        twist = None if self.twist is None else np.interp(time, self.time, self.twist)
        return replace(self, time=time, tilt=tilt, lean=lean, path=path, twist=twist)

    def with_clock(self, *, offset: float = 0.0, rate: float = 1.0) -> Motion:
        """Return the motion with its times multiplied by `rate`, then moved by `offset` [s]."""
        return replace(self, time=rate * self.time + offset)


def motion_at(time: Array, tilt: Array, azimuth: Array | None, path: Array | None = None) -> Motion:
    """Motion of tilts and azimuths (n,) [rad], NaN at rest; the azimuth may be unknown."""
    lean = None if azimuth is None else np.sin(tilt) * np.exp(1j * np.nan_to_num(azimuth))
    return Motion(time=time, tilt=tilt, lean=lean, path=path)


def on_samples_of(reference: Motion, motion: Motion) -> tuple[Motion, Motion]:
    """Reference and motion at the samples of the sparser, as far as both reach."""
    sparser = motion if motion.step > (1.0 + SAME_STEP) * reference.step else reference
    first, last = (pick(reference.time[at], motion.time[at]) for pick, at in ((max, 0), (min, -1)))
    within = (sparser.time >= first - SAME_TIME) & (sparser.time <= last + SAME_TIME)
    time = sparser.time[within & np.isfinite(sparser.tilt)]
    return reference.at(time), motion.at(time)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Pose:
    """Poses of n samples.

    Attributes
    ----------
    axis : ndarray, shape (n, 3)
        Axis of revolution, a unit vector; in the x z plane where no azimuth is known, NaN where one lacks.
    twist : ndarray, shape (n,), or None
        Turn about the axis [rad]; None without quaternions.
    position : ndarray, shape (n, 3), or None
        Mass centre from O [m].
    azimuth_known : bool
    """

    axis: Array
    twist: Array | None
    position: Array | None
    azimuth_known: bool

    @property
    def tilt(self) -> Array:
        """Tilt, shape (n,) [rad]."""
        return np.arctan2(np.hypot(self.axis[:, 0], self.axis[:, 1]), self.axis[:, 2])

    @property
    def lean(self) -> Complex | None:
        """Tilt vector, shape (n,)."""
        return self.axis[:, 0] + 1j * self.axis[:, 1] if self.azimuth_known else None


def pose_of(values: Values, *, base_radius: float, mass_centre_height: float, recess: bool = True) -> Pose:
    """Poses in columns: from quaternions, else tilt and azimuth, else the mass centre [m].

    A cylinder in a `recess` has its mass centre at D - b = R sin(theta - alpha) from the vertical through the
    rim and z = R cos(theta - alpha), equations (8) and (10). Elsewhere only the height tells the tilt.
    """
    position = np.column_stack([values[name] for name in POSITION]) if "x" in values else None
    if "qw" in values:
        w, x, y, z = (values[name] for name in QUATERNION)
        size = w * w + x * x + y * y + z * z
        columns = [
            2.0 * (x * z + w * y) / size,
            2.0 * (y * z - w * x) / size,
            1.0 - 2.0 * (x * x + y * y) / size,
        ]
        # q and -q are one pose: a rotation by a whole turn changes the sign
        twist = np.unwrap(2.0 * np.arctan2(z, w))
        twist -= 2.0 * np.pi * np.round(twist[0] / (2.0 * np.pi))
        return Pose(axis=np.column_stack(columns), twist=twist, position=position, azimuth_known=True)
    if "tilt" in values:
        tilt, known = values["tilt"], "azimuth" in values
        azimuth = values.get("azimuth", np.zeros_like(tilt))
        # tilt -theta at phi is tilt theta at phi + pi: the axis has only one of them
        azimuth = np.where(np.isnan(azimuth) & (tilt == 0.0), 0.0, azimuth)
    else:
        assert position is not None  # a table has one of the three
        alpha, radius = (
            math.atan2(base_radius, mass_centre_height),
            math.hypot(base_radius, mass_centre_height),
        )
        known = recess
        if recess:
            outward = np.hypot(position[:, 0], position[:, 1]) - base_radius
            tilt = np.maximum(alpha + np.arctan2(outward, position[:, 2]), 0.0)
            azimuth = np.arctan2(position[:, 1], position[:, 0])
        else:
            tilt = np.abs(alpha - np.arccos(np.clip(position[:, 2] / radius, -1.0, 1.0)))
            azimuth = np.zeros_like(tilt)
    axis = np.column_stack([np.sin(tilt) * np.cos(azimuth), np.sin(tilt) * np.sin(azimuth), np.cos(tilt)])
    return Pose(axis=axis, twist=None, position=position, azimuth_known=known)


def scatter(time: Array, values: Array) -> float:
    """Standard deviation of the noise of the roughest column of values (n, k); 0 for too few samples.

    Each sample is compared with the cubic through its four neighbours, at their own times (n,), so that
    uneven samples do no harm. The median keeps the few samples out at which a pass by the upright position
    makes a real corner.
    """
    if len(time) < 5:
        return 0.0
    middle, places = time[2:-2], {at: time[at : len(time) - 4 + at] for at in (0, 1, 3, 4)}
    guess, gain = np.zeros_like(values[2:-2]), np.ones(len(middle))
    for at, one in places.items():
        others = [other for there, other in places.items() if there != at]
        weight = np.prod([(middle - other) / (one - other) for other in others], axis=0)
        guess += weight[:, None] * values[at : len(time) - 4 + at]
        gain += weight * weight
    apart = np.abs(values[2:-2] - guess) / np.sqrt(gain)[:, None]
    # samples equal to their neighbours are at rest, without the noise of motion
    moving = apart[np.isfinite(apart).all(axis=1) & (apart > 0.0).any(axis=1)]
    if len(moving) < FEWEST_SCATTERED:
        return 0.0
    return float(np.median(moving, axis=0).max()) / MEDIAN_OF_NORMAL


def exceeds(time: Array, value: Array, level: float, power: float) -> float:
    """First time at which a value exceeds a level [s], inf if never; linear between samples."""
    i = int(np.argmax(value > level))
    if i == 0:
        return float(time[0]) if value[0] > level else math.inf
    low, high = np.maximum(value[i - 1 : i + 1], 0.0) ** (1.0 / power)
    return float(time[i - 1] + (time[i] - time[i - 1]) * (level ** (1.0 / power) - low) / (high - low))


# share of the agreement time that is compared: towards its end the azimuths diverge before the tilts
BEFORE_DIVERGENCE = 0.8
# largest difference of the azimuth [rad]
AZIMUTH_BOUND = math.radians(3.0)
# largest difference of the path over b, besides that of the azimuth: about R times 1 % of alpha
PATH_BOUND = 0.01
# smallest significant difference, in standard deviations of the noise
ABOVE_NOISE = 5.0
# ratio of the noise along the tilt vector to that across it: a mass centre's is larger across, by R/h at tan
# alpha 1
BOTH_DIRECTIONS = 1.4
# least number of samples for a comparison of azimuth and path
FEWEST_COMPARED = 5
# largest share of a difference that may remain after its explanation
LEFT_OVER = 1.0 / 3.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Part:
    """Comparison of one quantity.

    Attributes
    ----------
    first_time : float
        The first difference above the bound, in the time of the run [s]; NaN where it does not differ.
    size : float
        Root mean square of the difference; alpha for the tilt, rad for the azimuth, b for the path.
    bound : float
        What the size may be, in its unit; of the tilt, what each difference may be.
    """

    first_time: float
    size: float
    bound: float

    @property
    def differs(self) -> bool:
        """Whether there is a difference above the bound."""
        return math.isfinite(self.first_time)


@dataclass(frozen=True, slots=True, kw_only=True)
class Difference:
    """Comparison of a motion with a reference.

    Attributes
    ----------
    start, end, covered : float
        Start and end of the agreement of the tilts, and the time up to which azimuth and path are compared,
        in the time of the run [s].
    compared : float
        End of what both have in common [s].
    agreed_motion, agreed_peak : float
        Integral [rad s] and largest value [rad] of the tilt of the reference over the agreement.
    tilt, azimuth, path : Part or None
        None where they are not known, or the cylinder does not lean enough while the tilts agree.
    twist : Part or None
        Turn about the axis since the start [rad]; None where it is not known.
    """

    start: float
    end: float
    covered: float
    compared: float
    agreed_motion: float
    agreed_peak: float
    tilt: Part
    azimuth: Part | None = None
    path: Part | None = None
    twist: Part | None = None

    @property
    def differs_in(self) -> tuple[str, ...]:
        """Quantities that differ, of "tilt", "azimuth", "path" and "twist"."""
        parts = {name: getattr(self, name) for name in ("tilt", "azimuth", "path", "twist")}
        return tuple(name for name, part in parts.items() if part is not None and part.differs)

    @property
    def length(self) -> float:
        """Length of the agreement of the tilts [s]."""
        return max(0.0, self.end - self.start)


@dataclass(frozen=True, slots=True, kw_only=True)
class Reference:
    """A model that trajectories are compared with.

    Attributes
    ----------
    motion : Motion
    alpha, base_radius : float
        [rad], [m]
    time_scale : float
        sqrt(R/g) [s].
    start : float
        Its uplift or release [s].
    is_free : bool
        Whether it is a release on ground that stands still.
    tilt_bound : float
        Tilt difference that ends the agreement [alpha].
    least_lean : float
        Share of the largest tilt above which an azimuth is compared.
    azimuth_bound : float
        Azimuth difference, weighted by the tilt [rad].
    """

    motion: Motion
    alpha: float
    base_radius: float
    time_scale: float
    start: float
    is_free: bool
    tilt_bound: float
    least_lean: float
    azimuth_bound: float = AZIMUTH_BOUND

    def difference(self, motion: Motion) -> Difference:
        """Compare a motion with the reference."""
        model, trial = on_samples_of(self.motion, motion)
        if not len(model.time):
            none = Part(first_time=self.start, size=math.inf, bound=self.tilt_bound)
            at = self.start
            return Difference(
                start=at, end=at, covered=at, compared=at, agreed_motion=0.0, agreed_peak=0.0, tilt=none
            )
        start = max(self.start, float(model.time[0]))
        tilt, end = self._tilt(model, trial)
        covered = start + BEFORE_DIVERGENCE * (end - start) if tilt.differs else end
        # compared to a sample, so that rounding does not drop the last one
        within, agreed = model.time <= covered + SAME_TIME, model.time <= end + SAME_TIME
        return Difference(
            start=start,
            end=end,
            covered=covered,
            compared=float(model.time[-1]),
            agreed_motion=float(
                np.diff(model.time[agreed]) @ (model.tilt[agreed][1:] + model.tilt[agreed][:-1])
            )
            / 2.0,
            agreed_peak=float(model.tilt[agreed].max(initial=0.0)),
            tilt=tilt,
            azimuth=self._azimuth(model, trial, within),
            path=self._path(model, trial, within),
            twist=self._twist(model, trial, within),
        )

    def leaning(self, model: Motion, trial: Motion, within: Mask) -> Mask:
        """Samples at which azimuths are compared: where both motions tilt far enough."""
        least = max(self.least_lean * float(model.tilt[within].max(initial=0.0)), ABOVE_NOISE * trial.noise)
        counts: Mask = within & (model.tilt > least) & (trial.tilt > least)
        return counts

    def noise_allowance(self, noise: float) -> float:
        """Allowance for noise [rad] in the bound of the tilt [alpha]; 0 where it is small."""
        added = ABOVE_NOISE * noise / self.alpha
        return added if added > 0.1 * self.tilt_bound else 0.0

    def _tilt(self, model: Motion, trial: Motion) -> tuple[Part, float]:
        apart = np.abs(trial.tilt - model.tilt) / self.alpha
        bound = self.tilt_bound + self.noise_allowance(trial.noise)
        beyond = model.time[apart > bound]
        first, size = float(beyond[0]) if len(beyond) else math.nan, float(np.sqrt(np.mean(apart**2)))
        end = first if len(beyond) else float(model.time[-1])
        return Part(first_time=first, size=size, bound=bound), end

    def _azimuth(self, model: Motion, trial: Motion, within: Mask) -> Part | None:
        if model.lean is None or trial.lean is None:
            return None
        counts = self.leaning(model, trial, within)
        if np.count_nonzero(counts) < FEWEST_COMPARED:
            return None
        product = trial.lean[counts] * model.lean[counts].conj()
        apart, weight = np.abs(np.angle(product)), np.abs(product)
        size = math.sqrt(float(np.sum(weight * apart**2) / np.sum(weight)))
        # the mean of few samples scatters itself, and noise differs with direction
        few = 1.0 + 3.0 / math.sqrt(2.0 * len(apart))
        blurred = BOTH_DIRECTIONS * trial.noise / math.sqrt(float(np.mean(weight))) * few
        beyond = apart > self.azimuth_bound + ABOVE_NOISE * trial.noise / np.sqrt(weight)
        return _part(model.time[counts], size, math.hypot(self.azimuth_bound, blurred), beyond)

    def _path(self, model: Motion, trial: Motion, within: Mask) -> Part | None:
        if model.path is None or trial.path is None or np.count_nonzero(within) < FEWEST_COMPARED:
            return None
        apart = np.linalg.norm(trial.path[within] - model.path[within], axis=1) / self.base_radius
        size = float(np.sqrt(np.mean(apart**2)))
        beside = float(np.sqrt(np.mean(np.sum(model.path[within, :2] ** 2, axis=1)))) / self.base_radius
        # factor on the noise for few samples of three coordinates
        few = 1.0 + 3.0 / math.sqrt(6.0 * len(apart))
        noise = trial.path_noise / self.base_radius
        bound = math.hypot(PATH_BOUND, self.azimuth_bound * beside, math.sqrt(3.0) * noise * few)
        return _part(model.time[within], size, bound, apart > bound + ABOVE_NOISE * noise)

    def _twist(self, model: Motion, trial: Motion, within: Mask) -> Part | None:
        if model.twist is None or trial.twist is None or np.count_nonzero(within) < FEWEST_COMPARED:
            return None
        apart = np.abs(trial.twist[within] - model.twist[within])
        bound = math.hypot(self.azimuth_bound, BOTH_DIRECTIONS * trial.noise)
        size = float(np.sqrt(np.mean(apart**2)))
        return _part(model.time[within], size, bound, apart > bound)


def explains(before: Part, after: Part | None) -> bool:
    """Whether a change removes a difference by a clear margin."""
    return after is not None and not after.differs and after.size <= LEFT_OVER * before.size


def _part(time: Array, size: float, bound: float, beyond: Mask) -> Part:
    """Comparison of a quantity by its mean; a difference begins at the first sample beyond its own bound."""
    first = float(time[np.argmax(beyond)]) if size > bound else math.nan
    return Part(first_time=first, size=size, bound=bound)
