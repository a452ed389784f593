"""A motion as the lean of its axis and the path of its mass centre, and the pose that columns tell.

The lean sin(theta) exp(i phi) is smooth through the upright position, where the azimuth phi means nothing and
in planar motion jumps by pi.

theta  tilt: angle of the axis from the vertical        [rad]
phi    azimuth of the lean, hence of the contact point  [rad]
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from .table import POSITION, QUATERNION, Array, Values

Complex = NDArray[np.complex128]

# of a normal distribution: median of the absolute value over the standard deviation
MEDIAN_OF_NORMAL = 0.6745
FEWEST_SCATTERED = 12  # samples without which their scatter is not known
FITTED_SAMPLES = 7  # of the polynomial through a maximum of the tilt
SAME_TIME = 1e-9  # samples at one time up to rounding [s]
SAME_STEP = 1e-6  # relative


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Motion:
    """The samples of a motion.

    Attributes
    ----------
    time, tilt : ndarray, shape (n,)
        [s], [rad]
    lean : ndarray of complex, shape (n,), or None
        x + i y of the axis, a unit vector; None where no azimuth is known.
    path : ndarray, shape (n, 3), or None
        Mass centre from O [m]; None where it is not known.
    noise, path_noise : float
        Standard deviations of the noise of the axis [rad] and of each coordinate of the mass centre [m].
    """

    time: Array
    tilt: Array
    lean: Complex | None
    path: Array | None = None
    noise: float = 0.0
    path_noise: float = 0.0

    @property
    def step(self) -> float:
        """Usual time between two samples [s]."""
        return float(np.median(np.diff(self.time))) if len(self.time) > 1 else 0.0

    def turned(self, angle: float, *, mirrored: bool = False) -> Motion:
        """Return the motion turned by `angle` [rad] counter-clockwise, with y reversed first if mirrored."""
        turn, lean, path = np.exp(1j * angle), self.lean, self.path
        if lean is not None:
            lean = turn * (lean.conj() if mirrored else lean)
        if path is not None:
            flat = turn * (path[:, 0] + (-1j if mirrored else 1j) * path[:, 1])
            path = np.column_stack([flat.real, flat.imag, path[:, 2]])
        return replace(self, lean=lean, path=path)

    def at(self, time: Array) -> Motion:
        """Return the motion at other times [s], linear between its samples."""
        tilt = np.interp(time, self.time, self.tilt)
        lean = None if self.lean is None else np.interp(time, self.time, self.lean)
        path = self.path
        if path is not None:
            path = np.column_stack([np.interp(time, self.time, part) for part in path.T])
        return replace(self, time=time, tilt=tilt, lean=lean, path=path)

    def clocked(self, *, offset: float = 0.0, rate: float = 1.0) -> Motion:
        """Return the motion with its times multiplied by `rate`, then moved by `offset` [s]."""
        return replace(self, time=rate * self.time + offset)


def motion_at(time: Array, tilt: Array, azimuth: Array | None, path: Array | None = None) -> Motion:
    """Return the motion of tilts and azimuths (n,) [rad], NaN at rest; the azimuth may be unknown."""
    lean = None if azimuth is None else np.sin(tilt) * np.exp(1j * np.nan_to_num(azimuth))
    return Motion(time=time, tilt=tilt, lean=lean, path=path)


def on_samples_of(reference: Motion, motion: Motion) -> tuple[Motion, Motion]:
    """Return both at the samples of the sparser, as far as both reach: reference, motion."""
    sparser = motion if motion.step > (1.0 + SAME_STEP) * reference.step else reference
    first, last = (pick(reference.time[at], motion.time[at]) for pick, at in ((max, 0), (min, -1)))
    within = (sparser.time >= first - SAME_TIME) & (sparser.time <= last + SAME_TIME)
    time = sparser.time[within & np.isfinite(sparser.tilt)]
    return reference.at(time), motion.at(time)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Pose:
    """The poses of n samples.

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
        """Lean, shape (n,)."""
        return self.axis[:, 0] + 1j * self.axis[:, 1] if self.azimuth_known else None


def pose_of(values: Values, *, base_radius: float, mass_centre_height: float, recess: bool = True) -> Pose:
    """Return the poses that columns tell: by quaternions, else tilt and azimuth, else by the mass centre [m].

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
        # q and -q are one pose: both change the half angle by half a turn
        twist = np.unwrap(2.0 * np.arctan2(z, w))
        twist -= 2.0 * np.pi * np.round(twist[0] / (2.0 * np.pi))
        return Pose(axis=np.column_stack(columns), twist=twist, position=position, azimuth_known=True)
    if "tilt" in values:
        tilt, known = values["tilt"], "azimuth" in values
        azimuth = values.get("azimuth", np.zeros_like(tilt))
        # a lean by -theta at phi is one by theta at phi + pi: the axis knows only one of them
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
    """Standard deviation of the noise of the roughest column of values (n, k); 0 where too few tell it.

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
    # samples that are exactly those of their neighbours stand, and say nothing of the noise in motion
    moving = apart[np.isfinite(apart).all(axis=1) & (apart > 0.0).any(axis=1)]
    if len(moving) < FEWEST_SCATTERED:
        return 0.0
    return float(np.median(moving, axis=0).max()) / MEDIAN_OF_NORMAL


def maxima(motion: Motion) -> Iterator[tuple[float, float, float]]:
    """Yield time [s], tilt and azimuth [rad] of each maximum of the tilt inside the run, by a polynomial fit.

    The azimuth is NaN where none is known.
    """
    tilt, half, degree = motion.tilt, FITTED_SAMPLES // 2, FITTED_SAMPLES - 1
    peaks = np.flatnonzero((tilt[1:-1] > tilt[:-2]) & (tilt[1:-1] >= tilt[2:])) + 1
    for i in peaks[(peaks >= half) & (peaks < len(tilt) - half)]:
        near = slice(i - half, i + half + 1)
        unit = motion.time[i + half] - motion.time[i - half]
        time = (motion.time[near] - motion.time[i]) / unit
        fit = np.polyfit(time, tilt[near], degree)
        roots = np.roots(np.polyder(fit))
        best = float(min(roots[np.abs(roots.imag) < 1e-9].real, key=abs, default=0.0))
        azimuth = math.nan
        if motion.lean is not None:
            turned = np.angle(motion.lean[near] * np.conj(motion.lean[i]))
            azimuth = float(np.angle(motion.lean[i]) + np.polyval(np.polyfit(time, turned, degree), best))
        yield float(motion.time[i] + best * unit), float(np.polyval(fit, best)), azimuth


def exceeds(time: Array, value: Array, level: float, power: float) -> float:
    """Return when a value first exceeds a level [s], inf if never; its root is linear between samples."""
    i = int(np.argmax(value > level))
    if i == 0:
        return float(time[0]) if value[0] > level else math.inf
    low, high = np.maximum(value[i - 1 : i + 1], 0.0) ** (1.0 / power)
    return float(time[i - 1] + (time[i] - time[i - 1]) * (level ** (1.0 / power) - low) / (high - low))
