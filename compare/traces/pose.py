"""From the columns of an external trajectory to poses at its own samples: checked, and unwrapped.

theta  tilt: angle of the axis from the vertical        [rad]
phi    azimuth of the lean, hence of the contact point  [rad]
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from rockwobble.models import Case, Cylinder

from .azimuth import unwrapped
from .file import POSITION, QUATERNION, Array, Columns, listed
from .scatter import scatter

# tilt below which the cylinder stands, in units of alpha; a measured azimuth means nothing there
STANDS = 1e-4
# and in standard deviations of the noise: of 10,000 samples at rest not one is expected above it
_ABOVE_NOISE = 5.0
# samples at one time up to rounding [s]
SAME_TIME = 1e-9
# a step this much longer than the usual one is a gap
_GAP = 2.5
# longest step, over the time scale of rocking sqrt(R/g): a quarter period of small tilts is longer
_COARSE = 0.5
# of the length of a quaternion; digits printed, not another convention
_UNIT_LENGTH = 1e-2
# tilts of both kinds that differ by more come from two conventions, not from rounding [rad]
_SAME_TILT = 0.01
# twist at the start beyond which the last number of the quaternion must be its first [rad]
_ANOTHER_ORDER = 0.75 * math.pi
# share of R by which the distance of mass centre and rim may be off: rolled out, or measured roughly
_FROM_RIM = 0.2
# scatter that is no noise any more, in units of alpha: the samples are of no smooth motion
_ROUGH = 0.02
# the tilt alone of a cylinder that stands is the length of two components: what it scatters of what they do
_OF_A_LENGTH = math.sqrt(2.0 - 0.5 * math.pi)
# twist at the start that is worth a word [rad]
_TWISTED = math.radians(1.0)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Poses:
    """Poses of a file at n samples; arrays of shape (n,) unless another is given.

    Attributes
    ----------
    time : ndarray
        From the start of the run [s].
    tilt : ndarray
        [rad]
    axis : ndarray, shape (n, 3)
        Axis of revolution, a unit vector; in the x z plane where no azimuth is known.
    rolling_angle : ndarray
        Azimuth of the lean without jumps, kept where the cylinder stands [rad].
    followed : ndarray of bool
        Whether the change of azimuth up to the sample is known without a guess: less than a quarter turn.
    twist : ndarray or None
        [rad]; None without quaternions.
    position : ndarray, shape (n, 3), or None
        Of the mass centre from O [m].
    stands : float
        Tilt below which the cylinder stands [rad].
    noise, position_noise : float
        Standard deviations of the noise of axis [rad] and position [m].
    told : tuple of str
        What the file tells of "tilt", "azimuth" and "path".
    notes : tuple of str
        What there is to know of the reading, in words.
    """

    time: Array
    tilt: Array
    axis: Array
    rolling_angle: Array
    followed: NDArray[np.bool_]
    twist: Array | None
    position: Array | None
    stands: float
    noise: float
    position_noise: float
    told: tuple[str, ...]
    notes: tuple[str, ...]

    def taken(self, chosen: NDArray[np.intp]) -> Poses:
        """Return the chosen samples alone."""
        arrays = {name: getattr(self, name) for name in _SAMPLED}
        return replace(self, **{name: each[chosen] for name, each in arrays.items() if each is not None})


_SAMPLED = ("time", "tilt", "axis", "rolling_angle", "followed", "twist", "position")


def poses_of(columns: Columns, case: Case, *, noise: float | None = None, time_offset: float = 0.0) -> Poses:
    """Return the poses of a file; see `External` for noise [rad] and time_offset [s].

    Raises
    ------
    ValueError
        If the time does not rise, has a gap or begins too late, a value is missing or impossible; with
        the number of the line.
    """
    time = _checked_time(columns, time_offset, case)
    position = None
    if "x" in columns.values:
        position = np.column_stack([columns.complete(name) for name in POSITION])
    twist, notes = None, []
    told = ["tilt", "azimuth"] if {"qw", "azimuth"} & set(columns.values) else ["tilt"]
    if "qw" in columns.values:
        axis, twist, note = _from_quaternions(columns)
        notes += note
        _require_same_tilt(columns, axis)
    elif "tilt" in columns.values:
        axis, note = _from_angles(columns)
        notes += note
    else:
        assert position is not None  # the file has at least one of the three
        told = []
        axis = _from_positions(columns, position, case.cylinder)
        notes.append("tilt and azimuth are those of a cylinder in a recess with this mass centre")
    own_noise = scatter(time, axis[:, :2])
    if told == ["tilt"]:
        own_noise /= _OF_A_LENGTH
    if own_noise > _ROUGH * case.cylinder.alpha:
        notes.append(
            f"the samples scatter by {own_noise / case.cylinder.alpha:.2g} alpha, which is no smooth motion"
        )
        own_noise = 0.0
    stands = noise
    if stands is None:
        stands = max(STANDS * case.cylinder.alpha, _ABOVE_NOISE * own_noise)
    if "azimuth" in columns.values and "qw" not in columns.values:
        _require_azimuth(columns, stands)
    axis = np.where(np.isnan(axis), 0.0, axis)
    tilt = np.arctan2(np.hypot(axis[:, 0], axis[:, 1]), axis[:, 2])
    if told == ["tilt"]:
        angle, followed = np.full(len(time), np.nan), np.ones(len(time), dtype=bool)
    else:
        angle, followed = unwrapped(axis, tilt > stands)
    if position is not None:
        told.append("path")
    if columns.lost:
        notes.append(f"{columns.lost} lost sample{'s are' if columns.lost > 1 else ' is'} left out")
    if columns.ignored:
        notes.append(f"columns not read: {listed(columns.ignored)}")
    return Poses(
        time=time,
        tilt=tilt,
        axis=axis,
        rolling_angle=angle,
        followed=followed,
        twist=twist,
        position=position,
        stands=stands,
        noise=own_noise,
        position_noise=0.0 if position is None else scatter(time, position),
        told=tuple(told),
        notes=tuple(notes),
    )


def _checked_time(columns: Columns, offset: float, case: Case) -> Array:
    time = columns.complete("time") + offset
    steps = np.diff(time, prepend=-math.inf)
    columns.require(
        steps > 0.0,
        lambda at: f"time must rise [s], got {time[at] - offset:g} after {time[at - 1] - offset:g}",
    )
    usual, first = float(np.median(steps[1:])), np.arange(len(time)) == 0
    longest = _COARSE * math.sqrt(case.cylinder.semidiagonal / case.gravity)
    columns.require(
        (np.arange(len(time)) != 1) | (usual <= longest),
        lambda _: (
            f"samples must be at most {longest:.2g} s apart for this cylinder, got {usual:g} s; is it ms?"
        ),
    )
    columns.require(
        first | (steps <= _GAP * usual),
        lambda at: f"a gap of {steps[at]:g} s where the usual step is {usual:g} s",
    )
    columns.require(
        ~first | (time <= 0.5 * usual),
        lambda _: (
            f"the trajectory begins {time[0]:g} s after the start of the run, where its pose is not known; "
            f"if that is the start, give its time an offset of {offset - time[0]:g} s"
        ),
    )
    columns.require(
        (np.arange(len(time)) < len(time) - 1) | (time > usual),
        lambda _: f"the trajectory ends {time[-1]:g} s after the start of the run",
    )
    return time


def _from_angles(columns: Columns) -> tuple[Array, list[str]]:
    """Axis, NaN where it leans to nobody knows where, and what there is to know of it."""
    tilt = columns.complete("tilt")
    columns.require(
        np.abs(tilt) <= math.pi,
        lambda at: (
            f"tilt must be between -pi and pi, got {tilt[at]:.4g} rad; "
            "is it in degrees, or wrapped at 360 deg?"
        ),
    )
    azimuth = columns.values.get("azimuth", np.zeros_like(tilt))
    azimuth = np.where(np.isnan(azimuth) & (tilt == 0.0), 0.0, azimuth)
    negative = int(np.count_nonzero(tilt < 0.0))
    notes = [f"{negative} negative tilts are read as a lean to the other side"] if negative else []
    # a lean by -theta at phi is one by theta at phi + pi: the axis knows only one of them
    return _axis(tilt, azimuth), notes


def _axis(tilt: Array, azimuth: Array) -> Array:
    sine = np.sin(tilt)
    return np.column_stack([sine * np.cos(azimuth), sine * np.sin(azimuth), np.cos(tilt)])


def _require_azimuth(columns: Columns, stands: float) -> None:
    tilt = columns.values["tilt"]
    columns.require(
        ~np.isnan(columns.values["azimuth"]) | (np.abs(tilt) <= stands),
        lambda at: f"azimuth must be given where the tilt is {tilt[at]:.4g} rad",
    )


def _from_quaternions(columns: Columns) -> tuple[Array, Array, list[str]]:
    w, x, y, z = (columns.complete(name) for name in QUATERNION)
    length = np.sqrt(w * w + x * x + y * y + z * z)
    columns.require(
        np.abs(length - 1.0) <= _UNIT_LENGTH,
        lambda at: f"a quaternion must have the length 1, got {length[at]:.4g}",
    )
    w, x, y, z = w / length, x / length, y / length, z / length
    axis = np.column_stack([2.0 * (x * z + w * y), 2.0 * (y * z - w * x), 1.0 - 2.0 * (x * x + y * y)])
    # q and -q are one pose: both change the half angle by half a turn
    twist = np.unwrap(2.0 * np.arctan2(z, w))
    twist -= 2.0 * np.pi * round(float(twist[0]) / (2.0 * np.pi))
    later, start = np.arange(len(twist)) > 0, abs(float(twist[0]))
    columns.require(
        later | (start <= _ANOTHER_ORDER),
        lambda _: (
            f"the quaternion is turned by {math.degrees(start):.0f} deg about the axis at the start, "
            "where it must be near 0; are its numbers in the order qx, qy, qz, qw?"
        ),
    )
    columns.require(
        later | (axis[:, 2] >= 0.0),
        lambda _: "the quaternion holds the cylinder upside down at the start; is z down?",
    )
    note = f"turned by {math.degrees(float(twist[0])):.3g} deg about its axis at the start"
    return axis, twist, [note] if start > _TWISTED else []


def _require_same_tilt(columns: Columns, axis: Array) -> None:
    if "tilt" not in columns.values:
        return
    tilt, given = np.arctan2(np.hypot(axis[:, 0], axis[:, 1]), axis[:, 2]), columns.values["tilt"]
    columns.require(
        np.abs(tilt - np.abs(given)) <= _SAME_TILT,
        lambda at: (
            f"tilt and quaternion must agree, got tilts of {given[at]:.4g} and {tilt[at]:.4g} rad; "
            "the quaternion must be qw, qx, qy, qz with z up"
        ),
    )


def _from_positions(columns: Columns, position: Array, cylinder: Cylinder) -> Array:
    """Axis of the cylinder in a recess whose mass centre is there.

    Its distance D(theta) from the vertical through O, and its height, are by equations (8) and (10)
    D - b = R sin(theta - alpha) and z = R cos(theta - alpha).
    """
    outward = np.hypot(position[:, 0], position[:, 1]) - cylinder.base_radius
    height, radius = position[:, 2], cylinder.semidiagonal
    from_rim = np.hypot(outward, height)
    columns.require(
        (np.abs(from_rim / radius - 1.0) <= _FROM_RIM) & (height >= 0.0),
        lambda at: (
            f"the mass centre must be R = {radius:.4g} m from the rim and above the ground, got "
            f"{from_rim[at]:.4g} m and z = {height[at]:.4g} m; without a tilt x, y and z must be from the "
            "original base centre, z up, in the unit of the header"
        ),
    )
    tilt = np.maximum(cylinder.alpha + np.arctan2(outward, height), 0.0)
    return _axis(tilt, np.arctan2(position[:, 1], position[:, 0]))
