"""From the columns of a foreign trajectory to poses at its own samples: checked, and unwrapped.

theta  tilt: angle of the axis from the vertical        [rad]
phi    azimuth of the lean, hence of the contact point  [rad]
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .foreign_file import POSITION, QUATERNION, Array, Columns

# tilt below which the cylinder stands, in units of alpha; a measured azimuth means nothing there
STANDS = 1e-4
# samples at one time up to rounding [s]
SAME_TIME = 1e-9
# a step this much longer than the usual one is a gap
_GAP = 2.5
# of the length of a quaternion; digits printed, not another convention
_UNIT_LENGTH = 1e-2
# tilts of both kinds that differ by more come from two conventions, not from rounding [rad]
_SAME_TILT = 0.01


@dataclass(frozen=True, slots=True, eq=False)
class Poses:
    """What the file says at n samples; arrays of shape (n,) unless another is given.

    Attributes
    ----------
    time : ndarray
        From the start of the run [s].
    tilt : ndarray
        [rad]
    axis : ndarray, shape (n, 3)
        Axis of revolution, a unit vector.
    rolling_angle : ndarray
        Azimuth of the lean without jumps, kept where the cylinder stands [rad].
    followed : ndarray of bool
        Whether the change of azimuth up to the sample is known without a guess: less than a quarter turn.
    twist : ndarray or None
        [rad]; None without quaternions.
    position : ndarray, shape (n, 3), or None
        Of the mass centre from O [m].
    """

    time: Array
    tilt: Array
    axis: Array
    rolling_angle: Array
    followed: np.ndarray[tuple[int], np.dtype[np.bool_]]
    twist: Array | None
    position: Array | None


def poses_of(columns: Columns, stands: float, time_offset: float) -> Poses:
    """Return the poses of a file, its clock moved by `time_offset` [s]; below the tilt `stands` it stands.

    Raises
    ------
    ValueError
        If the time does not rise, has a gap or begins too late, a value is missing or impossible; with
        the number of the line.
    """
    time = _checked_time(columns, time_offset)
    twist = None
    if "qw" in columns.values:
        axis, twist = _from_quaternions(columns)
        tilt = np.arctan2(np.hypot(axis[:, 0], axis[:, 1]), axis[:, 2])
        if "tilt" in columns.values:
            apart = np.abs(tilt - columns.values["tilt"])
            if not bool((apart <= _SAME_TILT).all()):
                at = int(np.argmax(~(apart <= _SAME_TILT)))
                raise columns.refuse(
                    at,
                    f"tilt and quaternion must agree, got tilts of {columns.values['tilt'][at]:.4g} and "
                    f"{tilt[at]:.4g} rad; the quaternion must be qw, qx, qy, qz with z up",
                )
    else:
        tilt, axis = _from_angles(columns, stands)
    position = None
    if "x" in columns.values:
        position = np.column_stack([_complete(columns, name) for name in POSITION])
    angle, followed = unwrapped(axis, tilt > stands)
    return Poses(time, tilt, axis, angle, followed, twist, position)


def _checked_time(columns: Columns, offset: float) -> Array:
    time = _complete(columns, "time") + offset
    steps = np.diff(time)
    if bool((steps <= 0.0).any()):
        at = int(np.argmax(steps <= 0.0)) + 1
        raise columns.refuse(
            at, f"time must rise [s], got {time[at] - offset:g} after {time[at - 1] - offset:g}"
        )
    usual = float(np.median(steps))
    if bool((steps > _GAP * usual).any()):
        at = int(np.argmax(steps > _GAP * usual)) + 1
        raise columns.refuse(at, f"a gap of {steps[at - 1]:g} s where the usual step is {usual:g} s")
    if time[0] > 0.5 * usual:
        raise columns.refuse(
            0,
            f"the trajectory begins {time[0]:g} s after the start of the run, where its pose is not known; "
            "an offset of its time may be given",
        )
    if time[-1] <= usual:
        raise columns.refuse(len(time) - 1, f"the trajectory ends {time[-1]:g} s after the start of the run")
    return time


def _from_angles(columns: Columns, stands: float) -> tuple[Array, Array]:
    tilt, azimuth = _complete(columns, "tilt"), columns.values["azimuth"]
    if bool((tilt < 0.0).any()):
        at = int(np.argmax(tilt < 0.0))
        raise columns.refuse(at, f"tilt must not be negative, got {tilt[at]:.4g} rad")
    unknown = np.isnan(azimuth) & (tilt > stands)
    if bool(unknown.any()):
        at = int(np.argmax(unknown))
        raise columns.refuse(at, f"azimuth must be given where the tilt is {tilt[at]:.4g} rad")
    azimuth = np.where(np.isnan(azimuth), 0.0, azimuth)
    sine = np.sin(tilt)
    return tilt, np.column_stack([sine * np.cos(azimuth), sine * np.sin(azimuth), np.cos(tilt)])


def _from_quaternions(columns: Columns) -> tuple[Array, Array]:
    w, x, y, z = (_complete(columns, name) for name in QUATERNION)
    length = np.sqrt(w * w + x * x + y * y + z * z)
    if bool((np.abs(length - 1.0) > _UNIT_LENGTH).any()):
        at = int(np.argmax(np.abs(length - 1.0) > _UNIT_LENGTH))
        raise columns.refuse(at, f"a quaternion must have the length 1, got {length[at]:.4g}")
    w, x, y, z = w / length, x / length, y / length, z / length
    axis = np.column_stack([2.0 * (x * z + w * y), 2.0 * (y * z - w * x), 1.0 - 2.0 * (x * x + y * y)])
    # q and -q are one pose: both change the half angle by half a turn
    twist = np.unwrap(2.0 * np.arctan2(z, w))
    return axis, twist - 2.0 * np.pi * round(float(twist[0]) / (2.0 * np.pi))


def _complete(columns: Columns, name: str) -> Array:
    values = columns.values[name]
    if bool(np.isnan(values).any()):
        raise columns.refuse(int(np.argmax(np.isnan(values))), f"{name} is missing")
    return values


def unwrapped(
    axis: Array, leans: np.ndarray[tuple[int], np.dtype[np.bool_]]
) -> tuple[Array, np.ndarray[tuple[int], np.dtype[np.bool_]]]:
    """Return the azimuth of the axis without jumps, and whether each change is known without a guess.

    Between two samples the azimuth takes the shorter way round, unless that is more than a quarter turn:
    then the apex was passed between them, and which way is told by the sense in which the axis went round
    before and after (the area that its projection sweeps, which the passage of the apex conserves).

    Parameters
    ----------
    axis : ndarray, shape (n, 3)
    leans : ndarray of bool, shape (n,)
        Where the azimuth means something; elsewhere the angle waits.
    """
    count = len(axis)
    followed = np.ones(count, dtype=bool)
    tilted = np.flatnonzero(leans)
    if not len(tilted):
        return np.zeros(count), followed
    x, y = axis[tilted, 0], axis[tilted, 1]
    azimuth = np.arctan2(y, x)
    change = np.diff(azimuth)
    change -= 2.0 * np.pi * np.round(change / (2.0 * np.pi))
    swept = x[:-1] * y[1:] - x[1:] * y[:-1]
    guessed = np.abs(change) > 0.5 * np.pi
    for at in np.flatnonzero(guessed):
        around = [i for i in (at - 2, at - 1, at + 1, at + 2) if 0 <= i < len(change) and not guessed[i]]
        way = np.sign(swept[around].sum())
        if way and way != np.sign(change[at]):
            change[at] += 2.0 * np.pi * way
    followed[tilted[1:][guessed]] = False
    angles = azimuth[0] + np.concatenate([[0.0], np.cumsum(change)])
    # standing, the angle is that of the last lean; before the first, of the first
    last = np.searchsorted(tilted, np.arange(count), side="right") - 1
    return angles[np.maximum(last, 0)], followed
