"""Trajectory from a shake table or another code as one more run of a comparison."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import NamedTuple

import numpy as np

from rockwobble.models import Case, Diagnostic, RockingBody, Run, Trace
from rockwobble.models.argument_kinds import with_argument_kinds
from rockwobble.models.bounds import OVERTURNED_TILT
from rockwobble.models.frames import pd
from rockwobble.models.shown import CompactRepr
from rockwobble.models.support import EXTERNAL
from rockwobble.models.trace_file import pass_table
from rockwobble.multibody.passes import TurningPoint, passes_between, turning_points

from ..runs.execution import SAMPLE_STEP
from .mistakes import readings
from .motion import SAME_TIME, Motion, motion_at
from .pose import Poses, poses_of
from .table import Array, Table, name_list, read_tables

# [rad] tolerance of a measured tilt of a cylinder on its side
_FALLEN = OVERTURNED_TILT - 0.01
# tolerance of the tilt at the start in another reading of a file, in units of alpha
_SAME_START = 0.1


@with_argument_kinds
@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class External(CompactRepr):
    """A file of a trajectory, and how to read it; `rockwobble.compare.external.table` says what it may hold.

    Parameters
    ----------
    path : Path
    label : str, optional
        For tables and figures. Default: the name of the file without its ending.
    angle_unit : {"rad", "deg"}, optional
        Angle unit of tilt and azimuth where the header does not say.
    time_offset : float, optional
        Added to the times of the file [s], so that the run starts at 0 with the ground motion or the release.
    columns : sequence of str, optional
        Titles or numbers of the columns of time and tilt; time, tilt and azimuth; time, x, y and z; time, qw,
        qx, qy and qz; or time, qw, qx, qy, qz, x, y and z. Default: by the names in the header.
    noise : float, optional
        Tilt below which the cylinder counts as standing [rad]. Default: what the scatter of the samples
        asks for, 5 standard deviations, and at least 1e-4 alpha.

    Raises
    ------
    ValueError
        If the offset is not finite or the noise is not positive.

    Examples
    --------
    >>> External(path="can.csv", angle_unit="deg", time_offset=-0.04).label
    'can'
    """

    path: Path
    label: str = ""
    angle_unit: str | None = None
    time_offset: float = 0.0
    noise: float | None = None
    columns: Sequence[str] = ()

    def __post_init__(self) -> None:
        object.__setattr__(self, "path", Path(self.path))
        object.__setattr__(self, "label", self.label or self.path.stem)
        if self.label.splitlines() != [self.label]:
            raise ValueError(f"the label of a trajectory must be one line, got {self.label!r}")
        if not math.isfinite(self.time_offset):
            raise ValueError(f"time_offset must be finite [s], got {self.time_offset!r}")
        if self.noise is not None and not 0.0 < self.noise < 0.5 * math.pi:
            raise ValueError(f"noise must be above 0 and below pi/2 [rad], got {self.noise!r}")


@dataclass(frozen=True, slots=True, kw_only=True, eq=False, repr=False)
class Measurement(CompactRepr):
    """Quantities measured in the file of an external trajectory: the source of its trace.

    The trace is at the sample times of the reduced models. What the file does not give is NaN: energy,
    contact resolution; the twist without quaternions; rolling angle, contact point and mass centre with the
    tilt alone; the displacement without positions, where contact point and mass centre are those of
    a cylinder in a recess with the same tilt and azimuth, equations (8) and (10).

    Attributes
    ----------
    poses : Poses
        Its own samples, with what they give and how they scatter.
    first_lean : float
        First of them that leans [s]; NaN if none does.
    given : External
    table : Table
        What the file holds.
    displacement : ndarray, shape (n, 2)
        Of the base centre [m]; NaN without positions.
    """

    poses: Poses
    first_lean: float
    given: External
    table: Table
    displacement: Array

    def quantities(self) -> Mapping[str, Array]:
        """The displacement: a file has neither energies nor forces."""
        return {"displacement": self.displacement}

    def assumptions(self, until: float) -> None:
        """Unknown: a file has no demands."""
        return


def measurement(trace: Trace) -> Measurement:
    """Measured quantities in the file of an external trajectory.

    Raises
    ------
    TypeError
        If the trace comes from somewhere else.
    """
    if not isinstance(trace.source, Measurement):
        raise TypeError(f"the trace must be an external trajectory, got {trace!r}")
    return trace.source


def external_motion(trace: Trace) -> Motion:
    """Motion for the comparison: tilt, azimuth, also where it follows from the path, and path."""
    poses = measurement(trace).poses
    azimuth = (
        trace.rolling_angle if np.isfinite(trace.rolling_angle).any() or "azimuth" in poses.given else None
    )
    path = trace.centre_of_mass if "path" in poses.given else None
    motion = motion_at(trace.time, trace.tilt, azimuth, path)
    return replace(motion, twist=twist_since_start(trace), noise=poses.noise, path_noise=poses.position_noise)


def twist_since_start(trace: Trace) -> Array | None:
    """Twist since the start, shape (n,) [rad]; None where unknown."""
    turn: Array = trace.twist - trace.twist[0]
    return turn if np.isfinite(turn).all() else None


def read_trajectory(external: External | str | Path, case: Case) -> Trace:
    """Read an external trajectory of a case.

    Parameters
    ----------
    external : External, str or Path
    case : Case

    Returns
    -------
    Trace

    Raises
    ------
    ValueError
        If the file cannot be read, has gaps or times that do not rise, or does not cover the start of
        the run; the message names the file, the line, and what makes it readable where that is known.
    """
    given = external if isinstance(external, External) else External(path=Path(external))
    tables = read_tables(given.path, given.angle_unit, given.columns)
    if len(tables) > 1:
        raise ValueError(f"{given.path.name} must hold one run, got {name_list(list(tables))}")
    (table,) = tables.values()
    try:
        return trajectory_of(table, given, case)
    except ValueError as error:
        start = 0.0 if case.initial is None else case.initial.tilt
        for change in readings(table.values):
            try:
                other = trajectory_of(replace(table, values=change.values(table.values)), given, case)
            except ValueError:
                continue
            if abs(float(other.tilt[0]) - start) < _SAME_START * case.cylinder.alpha:
                raise ValueError(f"{error}; likely mistake: {change.mistake.words}") from None
        raise


def trajectory_of(table: Table, given: External, case: Case) -> Trace:
    """Trajectory in a table; see `read_trajectory`."""
    poses = poses_of(table, case, noise=given.noise, time_offset=given.time_offset)
    start = int(np.argmax(poses.time > -0.5 * float(poses.time[1] - poses.time[0])))
    upright = (np.arange(len(poses.time)) != start) | (poses.tilt < _FALLEN)
    table.require(upright, "it must not lie at the start, got a tilt of {:.4g} rad", poses.tilt)
    poses = _from_start_to_end(poses, start, case.length)
    begin = uplift(poses.time, poses.tilt, poses.rolling_angle, stands=poses.stands)
    fell = bool(poses.tilt[-1] >= _FALLEN)
    time = _sample_times(float(poses.time[-1]) if fell else min(float(poses.time[-1]), case.length))
    tilt, angle, axis = _resampled(poses, time)
    angle = np.where((tilt > poses.stands) & (time >= begin.time - SAME_TIME), angle, np.nan)
    contact, centre, displacement = _places(poses, time, axis, angle, case.cylinder)
    twist = np.full(len(time), np.nan) if poses.twist is None else np.interp(time, poses.time, poses.twist)
    first_lean = math.nan if begin.first is None else float(poses.time[begin.first]) if begin.first else 0.0
    rests = bool((tilt[-100:] < poses.stands).all())
    return Trace(
        case=case,
        run=Run(given.label, EXTERNAL),
        version="",
        time=time,
        tilt=tilt,
        tilt_rate=np.full(len(time), np.nan),
        rolling_angle=angle,
        twist=twist,
        contact_point=contact,
        centre_of_mass=centre,
        passes=_passes(poses, begin.time),
        peak_tilt=OVERTURNED_TILT if fell else _peak(poses),
        outcome="overturned" if fell else "stands",
        rests=not fell and rests,
        facts=tuple(_facts(poses)),
        uplift_time=begin.time,
        uplift_direction=begin.direction,
        time_step=float(np.median(np.diff(poses.time))),
        source=Measurement(
            poses=poses, first_lean=first_lean, given=given, table=table, displacement=displacement
        ),
    )


def read_trajectories(
    external: Sequence[External | str | Path], cases: Sequence[Case], *, taken: Collection[str] = ()
) -> dict[tuple[str, str], Trace]:
    """Trajectories of a case, by its name and their labels; labels in `taken` are of other runs.

    Raises
    ------
    ValueError
        What `read_trajectory` raises; or if there are several cases, or two runs would have one label.
    """
    if external and len(cases) > 1:
        raise ValueError(f"a trajectory belongs to one case, got {len(cases)} cases")
    entries: dict[tuple[str, str], Trace] = {}
    for item in external:
        trajectory = read_trajectory(item, cases[0])
        label = str(trajectory.run.engine)
        if label in taken or (cases[0].name, label) in entries:
            raise ValueError(f"each run must have its own label, got {label!r} twice")
        entries[cases[0].name, label] = trajectory
    return entries


def _from_start_to_end(poses: Poses, start: int, length: float) -> Poses:
    """Samples cut to the run, and at the fall where there is one."""
    chosen = np.arange(start, len(poses.time))
    tilt = poses.tilt[chosen]
    falls = np.flatnonzero((tilt[:-1] >= _FALLEN) & (np.diff(tilt) <= 0.0))
    landed = int(falls[0]) if len(falls) else len(chosen) - 1
    # one sample beyond the end, for interpolation up to it
    last = min(int(np.searchsorted(poses.time[chosen], length - SAME_TIME)), len(chosen) - 1)
    # a fall that began before the end is followed to the ground
    falling = tilt[landed] >= _FALLEN and bool((np.diff(tilt[last : landed + 1]) > 0.0).all())
    return poses.subset(chosen[: (landed if landed < last or falling else last) + 1])


def _facts(poses: Poses) -> Iterator[Diagnostic]:
    yield from (Diagnostic(code="note", detail=note) for note in poses.notes)
    guessed = np.flatnonzero(~poses.followed)
    if len(guessed):
        yield Diagnostic(code="missed_pass", time=float(poses.time[guessed[0]]), size=len(guessed))


class Uplift(NamedTuple):
    """Uplift in the samples; NaN without one."""

    time: float = math.nan  # [s]; 0 where the first sample is tilted: a release
    direction: float = math.nan  # azimuth at the first tilted sample [rad]
    first: int | None = None  # that sample


def uplift(time: Array, tilt: Array, angle: Array, *, stands: float) -> Uplift:
    """Uplift from samples (n,): times [s], tilts and azimuths, NaN where unknown [rad].

    Up to the tilt `stands` [rad] the cylinder counts as standing. Where the ground acceleration rises through
    the threshold the tilt begins as theta = K t^3/6, so a lean is seen only some time after the uplift: the
    cube root of the first two leans is continued back to zero.
    """
    leaning = np.flatnonzero(tilt > stands)
    if not len(leaning):
        return Uplift()
    first = int(leaning[0])
    direction = float(angle[first])
    if first == 0 or first + 1 == len(time):
        return Uplift(float(time[first]) if first else 0.0, direction, first)
    t0, t1 = (float(value) for value in time[first : first + 2])
    s0, s1 = (float(value) ** (1.0 / 3.0) for value in tilt[first : first + 2])
    # not before the start
    begin = max(t0 - s0 * (t1 - t0) / (s1 - s0), 0.0) if s1 > s0 else t0
    return Uplift(begin, direction, first)


def _sample_times(end: float) -> Array:
    """Multiples of the sample step of a comparison, and the exact end [s]."""
    time: Array = SAMPLE_STEP * np.arange(math.floor(end / SAMPLE_STEP + SAME_TIME) + 1, dtype=np.float64)
    return time if end - time[-1] < SAME_TIME else np.append(time, end)


def _resampled(poses: Poses, time: Array) -> tuple[Array, Array, Array]:
    """Tilt, rolling angle and axis at other times: a local cubic through the axis, smooth at upright."""
    own = poses.time
    if len(own) == len(time) and bool((np.abs(own - time) < SAME_TIME).all()):
        return poses.tilt.copy(), poses.rolling_angle, poses.axis
    if not np.isfinite(poses.rolling_angle).any() and bool((poses.axis[:, 0] >= 0.0).all()):
        # an unsigned tilt alone has a corner at each pass, where its square is a parabola
        tilt = np.sqrt(np.maximum(_interpolated(own, poses.tilt**2, time), 0.0))
        axis = np.column_stack([np.sin(tilt), np.zeros_like(tilt), np.cos(tilt)])
        return tilt, np.full(len(time), np.nan), axis
    axis = _interpolated(own, poses.axis, time)
    axis /= np.linalg.norm(axis, axis=1)[:, None]
    tilt = np.arctan2(np.hypot(axis[:, 0], axis[:, 1]), axis[:, 2])
    azimuth = np.arctan2(axis[:, 1], axis[:, 0])
    # branch of the angle followed from sample to sample
    branch = np.round((np.interp(time, own, poses.rolling_angle) - azimuth) / (2.0 * np.pi))
    return tilt, azimuth + 2.0 * np.pi * branch, axis


def _interpolated(own: Array, values: Array, time: Array) -> Array:
    from scipy.interpolate import Akima1DInterpolator

    # rounding may put the first sample after the start
    return np.asarray(Akima1DInterpolator(own, values)(np.clip(time, own[0], own[-1])))


def _peak(poses: Poses) -> float:
    """Vertex of the parabola through the largest sample and its neighbours [rad]."""
    at = int(np.argmax(poses.tilt))
    if at in (0, len(poses.tilt) - 1):
        return float(poses.tilt[at])
    left, top, right = (float(value) for value in poses.tilt[at - 1 : at + 2])
    bend, slope = left - 2.0 * top + right, 0.5 * (right - left)
    return top - 0.5 * slope * slope / bend if bend < 0.0 else top


def _passes(poses: Poses, start: float) -> pd.DataFrame:
    """Tilt minima between two maxima; one next to an ambiguous change of azimuth is not resolved."""
    points = turning_points(poses.time, poses.tilt, poses.rolling_angle)
    if poses.tilt[0] > poses.stands and poses.tilt[0] >= poses.tilt[1]:  # released at rest: a maximum
        time, tilt, angle = (float(each[0]) for each in (poses.time, poses.tilt, poses.rolling_angle))
        points.insert(0, TurningPoint(time=time, tilt=tilt, rolling_angle=angle, is_maximum=True))
    found = passes_between(
        [point for point in points if point.time >= min(start, float(poses.time[0]))], poses.stands
    )
    guesses = poses.time[~poses.followed]
    near = 1.5 * float(np.median(np.diff(poses.time)))
    away = np.abs(found["time"][:, None] - guesses) >= near
    return pass_table(found, np.asarray(away.all(axis=1)))


def _places(
    poses: Poses, time: Array, axis: Array, angle: Array, cylinder: RockingBody
) -> tuple[Array, Array, Array]:
    """Contact point, mass centre and displacement of the base centre [m]."""
    b, h = cylinder.base_radius, cylinder.mass_centre_height
    rests = np.isnan(angle)[:, None]
    outward = np.column_stack([np.cos(angle), np.sin(angle)])
    if poses.position is not None:
        centre = _interpolated(poses.time, poses.position, time)
        base = centre - h * axis
        contact = np.where(rests, np.nan, base[:, :2] + b * axis[:, 2:] * outward)
        return contact, centre, base[:, :2]
    lean, rise = np.hypot(axis[:, 0], axis[:, 1]), 1.0 - axis[:, 2:]
    centre = np.column_stack([np.where(rests, 0.0, b * rise * outward), b * lean]) + h * axis
    if not np.isfinite(poses.rolling_angle).any():
        centre[:, :2] = np.nan  # the tilt alone gives its height, not its position
    return np.where(rests, np.nan, b * outward), centre, np.full((len(time), 2), np.nan)
