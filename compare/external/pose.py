"""Columns of an external trajectory as poses at its own samples: checked, and unwrapped."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from rockwobble.models import Case, RockingBody

from .motion import Pose, pose_of, scatter
from .table import POSITION, QUATERNION, Array, Mask, Table, name_list

# tilt below which the cylinder stands, in units of alpha; a measured azimuth has no meaning there
_STANDS = 1e-4
# the same in standard deviations of the noise: of 10,000 samples at rest none is expected above it
_ABOVE_NOISE = 5.0
# ratio to the usual step beyond which a step is a gap
_GAP = 2.5
# times since 1970 in these units, from 2001 to 2286, begin between this [s] and ten times it
_SINCE_1970 = {"s": 1.0, "ms": 1e3, "us": 1e6, "ns": 1e9}
_IN_2001 = 1e9
# longest step, over the time scale of rocking sqrt(R/g): a quarter period of small tilts is longer
_COARSE = 0.5
# shortest trajectory, over the length of the run
_SHORTEST = 2e-3
# tolerance of the length of a quaternion: printed digits, not another convention
_UNIT_LENGTH = 1e-2
# [rad] larger differences of the two tilts come from two conventions, not from rounding
_SAME_TILT = 0.01
# [rad] twist at the start beyond which the scalar of the quaternion may be its last number
_ANOTHER_ORDER = 0.75 * math.pi
# share of R by which the distance of mass centre and rim may differ: by rolling out, or a rough measurement
_FROM_RIM = 0.2
# scatter beyond noise, in units of alpha: the samples are of no smooth motion
_ROUGH = 0.02
# scatter of the tilt alone of a standing cylinder, the length of two components, over that of each
_OF_A_LENGTH = math.sqrt(2.0 - 0.5 * math.pi)
# [rad] twist at the start above which it is noted
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
        Position of the mass centre from O [m].
    stands : float
        Tilt below which the cylinder stands [rad].
    noise, position_noise : float
        Standard deviations of the noise of axis [rad] and position [m].
    given : tuple of str
        What the file gives of "tilt", "azimuth" and "path".
    notes : tuple of str
        What there is to know of the reading, in words.
    """

    time: Array
    tilt: Array
    axis: Array
    rolling_angle: Array
    followed: Mask
    twist: Array | None
    position: Array | None
    stands: float
    noise: float
    position_noise: float
    given: tuple[str, ...]
    notes: tuple[str, ...]

    def subset(self, chosen: NDArray[np.intp]) -> Poses:
        """Poses at the chosen samples alone."""
        names = ("time", "tilt", "axis", "rolling_angle", "followed", "twist", "position")
        arrays = {name: getattr(self, name) for name in names}
        return replace(self, **{name: each[chosen] for name, each in arrays.items() if each is not None})


def poses_of(table: Table, case: Case, *, noise: float | None = None, time_offset: float = 0.0) -> Poses:
    """Poses of a table; see `External` for noise [rad] and time_offset [s].

    Raises
    ------
    ValueError
        If the time does not rise, has a gap or begins too late, a value is missing or impossible; with
        the number of the line.
    """
    values, cylinder = table.values, case.cylinder
    time, notes = _from_start(table)
    time = _checked_time(table, time, time_offset, case)
    for name in values.keys() & {*POSITION, *QUATERNION}:
        table.complete(name)
    pose = pose_of(values, base_radius=cylinder.base_radius, mass_centre_height=cylinder.mass_centre_height)
    given = ["tilt", "azimuth"] if pose.azimuth_known else ["tilt"]
    if pose.twist is not None:
        notes += _checked_quaternions(table, pose.axis, pose.twist)
    elif "tilt" in values:
        notes += _checked_angles(table)
    else:
        _check_positions(table, pose, cylinder)
        given = []
        notes.append("tilt and azimuth are those of a cylinder in a recess with this mass centre")
    own_noise = scatter(time, pose.axis[:, :2])
    if given == ["tilt"]:
        own_noise /= _OF_A_LENGTH
    if own_noise > _ROUGH * cylinder.alpha:
        notes.append(
            f"the samples scatter by {own_noise / cylinder.alpha:.2g} alpha, which is no smooth motion"
        )
        own_noise = 0.0
    stands = max(_STANDS * cylinder.alpha, _ABOVE_NOISE * own_noise) if noise is None else noise
    if "azimuth" in values and "qw" not in values:
        known = ~np.isnan(values["azimuth"]) | (np.abs(values["tilt"]) <= stands)
        table.require(known, "azimuth must be given where the tilt is {:.4g} rad", values["tilt"])
    axis = np.where(np.isnan(pose.axis), 0.0, pose.axis)
    tilt = np.arctan2(np.hypot(axis[:, 0], axis[:, 1]), axis[:, 2])
    if pose.azimuth_known:
        angle, followed = unwrapped(axis, tilt > stands)
    else:
        angle, followed = np.full(len(time), np.nan), np.ones(len(time), dtype=bool)
    if table.lost:
        notes.append(f"{table.lost} lost sample{'s are' if table.lost > 1 else ' is'} left out")
    if table.ignored:
        notes.append(f"columns not read: {name_list(table.ignored)}")
    return Poses(
        time=time,
        tilt=tilt,
        axis=axis,
        rolling_angle=angle,
        followed=followed,
        twist=pose.twist,
        position=pose.position,
        stands=stands,
        noise=own_noise,
        position_noise=0.0 if pose.position is None else scatter(time, pose.position),
        given=(*given, *(() if pose.position is None else ("path",))),
        notes=tuple(notes),
    )


def unwrapped(axis: Array, leans: Mask) -> tuple[Array, Mask]:
    """Azimuth (n,) of the axis (n, 3) without jumps, and whether each change is certain.

    It means something where the axis `leans` (n,); elsewhere the angle waits. Between two samples it takes
    the shorter way round, unless that is more than a quarter turn: then upright was passed between them, and
    which way follows from the sense in which the axis went round before and after (the area that its
    projection sweeps, which the passage of upright conserves).
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
    # at rest the angle of the last tilt vector; before the first, that of the first
    last = np.searchsorted(tilted, np.arange(count), side="right") - 1
    return angles[np.maximum(last, 0)], followed


def _from_start(table: Table) -> tuple[Array, list[str]]:
    """Times of a table [s], from the first where they are since 1970, and notes on them."""
    time = table.complete("time")
    for unit, factor in _SINCE_1970.items():
        if _IN_2001 <= time[0] / factor < 10.0 * _IN_2001:
            return (time - time[0]) / factor, [
                f"times are since 1970 in {unit}: the first is the start of the run"
            ]
    return time, []


def _checked_time(table: Table, time: Array, offset: float, case: Case) -> Array:
    given, time = time, time + offset
    steps, count = np.diff(time, prepend=-math.inf), np.arange(len(time))
    before = np.roll(given, 1)
    table.require(steps > 0.0, "time must rise [s], got {:g} after {:g}", given, before)
    usual = float(np.median(steps[1:]))
    longest = _COARSE * math.sqrt(case.cylinder.semidiagonal / case.gravity)
    apart = "samples must be at most {:.2g} s apart for this cylinder, got {:g} s"
    table.require((count != 1) | (usual <= longest), apart, longest, usual)
    gap = "a gap of {:g} s where the usual step is {:g} s"
    table.require((count == 0) | (steps <= _GAP * usual), gap, steps, usual)
    table.require(
        (count > 0) | (time <= 0.5 * usual),
        "the trajectory begins {:g} s after the start of the run, where its pose is not known; "
        "if that is the start, give its time an offset of {:g} s",
        time,
        offset - time,
    )
    ends = (count < len(time) - 1) | (time > max(usual, _SHORTEST * case.length))
    table.require(ends, "the trajectory ends {:g} s after the start of the run", time)
    return time


def _checked_angles(table: Table) -> list[str]:
    """Remarks on a table of tilts and azimuths."""
    tilt = table.complete("tilt")
    table.require(np.abs(tilt) <= math.pi, "tilt must be between -pi and pi, got {:.4g} rad", tilt)
    negative = int(np.count_nonzero(tilt < 0.0))
    return [f"{negative} negative tilts are read as a lean to the other side"] if negative else []


def _checked_quaternions(table: Table, axis: Array, twist: Array) -> list[str]:
    """Remarks on a table of quaternions with this axis (n, 3) and twist (n,) [rad]."""
    length = np.sqrt(sum(table.values[name] ** 2 for name in QUATERNION))
    right = np.abs(length - 1.0) <= _UNIT_LENGTH
    table.require(right, "a quaternion must have the length 1, got {:.4g}", length)
    later, start = np.arange(len(twist)) > 0, math.degrees(abs(float(twist[0])))
    turned = "the quaternion must not be turned about the axis at the start, got {:.0f} deg"
    table.require(later | (start <= math.degrees(_ANOTHER_ORDER)), turned, start)
    upside_down = "the quaternion holds the cylinder upside down at the start"
    table.require(later | (axis[:, 2] >= 0.0), upside_down)
    if "tilt" in table.values:
        tilt, given = np.arctan2(np.hypot(axis[:, 0], axis[:, 1]), axis[:, 2]), table.values["tilt"]
        table.require(
            np.abs(tilt - np.abs(given)) <= _SAME_TILT,
            "tilt and quaternion must agree, got tilts of {:.4g} and {:.4g} rad; "
            "the quaternion must be qw, qx, qy, qz with z up",
            given,
            tilt,
        )
    note = f"turned by {math.degrees(float(twist[0])):.3g} deg about its axis at the start"
    return [note] if start > math.degrees(_TWISTED) else []


def _check_positions(table: Table, pose: Pose, cylinder: RockingBody) -> None:
    """Refuse a mass centre whose distance from the rim is not R."""
    assert pose.position is not None
    x, y, height = pose.position.T
    from_rim, radius = np.hypot(np.hypot(x, y) - cylinder.base_radius, height), cylinder.semidiagonal
    table.require(
        (np.abs(from_rim / radius - 1.0) <= _FROM_RIM) & (height >= 0.0),
        "the mass centre must be R = {:.4g} m from the rim and above the ground, got {:.4g} m and z = {:.4g} "
        "m; without a tilt x, y and z must be from the original base centre, z up, in the unit of the header",
        radius,
        from_rim,
        height,
    )
