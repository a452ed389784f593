"""A trajectory from a shake table or another code as one more run of a comparison."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from rockwobble.models import Case, Diagnostic, Run, Trace
from rockwobble.models.shown import Brief

from .file import Array, Columns, read_columns
from .measures import passes, peak, places, resampled, sample_times
from .motion import Motion, motion_of
from .pose import SAME_TIME, Poses, poses_of
from .uplift import uplift

SUPPORT = "external"
# the side lies on the ground, as far as a measurement says [rad]
_FALLEN = 0.5 * math.pi - 0.01


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class External(Brief):
    """A file of a trajectory, and how to read it; `rockwobble.compare.traces.file` says what it may hold.

    Parameters
    ----------
    path : Path
    label : str, optional
        For tables and figures. Default: the name of the file without its ending.
    angle_unit : {"rad", "deg"}, optional
        Of tilt and azimuth where the header does not say.
    time_offset : float, optional
        Added to the times of the file [s], so that the run starts at 0 with the ground motion or the release.
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
class Measurement(Brief):
    """Quantities that a file of an external trajectory gave: the source of its trace.

    The trace is at the sample times of the reduced models. What the file does not tell is NaN: energy,
    contact resolution; the twist without quaternions; rolling angle, contact point and mass centre with the
    tilt alone; the residual displacement without positions, where contact point and mass centre are those of
    a cylinder in a recess with the same tilt and azimuth, equations (8) and (10).

    Attributes
    ----------
    poses : Poses
        Its own samples, with what they tell and how they scatter.
    first_lean : float
        First of them that leans [s]; NaN if none does.
    given : External
    columns : Columns
        The file that it was read from.
    """

    poses: Poses
    first_lean: float
    given: External
    columns: Columns

    def sampled(self) -> Mapping[str, Array]:
        """Return nothing: a file tells neither energies nor forces."""
        return {}

    def assumptions(self, until: float) -> None:
        """Return nothing: a file does not tell."""
        return


def measurement(trace: Trace) -> Measurement:
    """Return the quantities that the file of an external trajectory gave.

    Raises
    ------
    TypeError
        If the trace comes from somewhere else.
    """
    if not isinstance(trace.source, Measurement):
        raise TypeError(f"the trace must be an external trajectory, got {trace!r}")
    return trace.source


def external_motion(trace: Trace) -> Motion:
    """Return the motion compared: tilt, azimuth, also where it follows from the path, and path."""
    poses = measurement(trace).poses
    known = bool(np.isfinite(trace.rolling_angle).any())
    names = (*(("azimuth",) if known else ()), *poses.told)
    return motion_of(trace, names, noise=poses.noise, path_noise=poses.position_noise)


def read_trajectory(external: External | str | Path, case: Case) -> Trace:
    """Read an external trajectory of the case that it answers.

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
        the run; the message names the file and the line.
    """
    given = external if isinstance(external, External) else External(path=Path(external))
    return trajectory_of(read_columns(given.path, given.angle_unit), given, case)


def trajectory_of(columns: Columns, given: External, case: Case) -> Trace:
    """Return the trajectory that the columns of a file hold; see `read_trajectory`."""
    poses = poses_of(columns, case, noise=given.noise, time_offset=given.time_offset)
    start = int(np.argmax(poses.time > -0.5 * float(poses.time[1] - poses.time[0])))
    columns.require(
        (np.arange(len(poses.time)) != start) | (poses.tilt < _FALLEN),
        lambda at: f"it must not lie at the start, got a tilt of {poses.tilt[at]:.4g} rad; is it in degrees?",
    )
    poses = _from_start_to_end(poses, start, case.length)
    stands = poses.stands
    begin = uplift(poses.time, poses.tilt, poses.rolling_angle, stands=stands)
    fell = bool(poses.tilt[-1] >= _FALLEN)
    time = sample_times(float(poses.time[-1]) if fell else min(float(poses.time[-1]), case.length))
    tilt, angle, axis = resampled(poses, time)
    angle = np.where((tilt > stands) & (time >= begin.time - SAME_TIME), angle, np.nan)
    contact, centre, moved = places(poses, time, axis, angle, case.cylinder)
    twist = np.full(len(time), np.nan) if poses.twist is None else np.interp(time, poses.time, poses.twist)
    first_lean = math.nan if begin.first is None else float(poses.time[begin.first]) if begin.first else 0.0
    return Trace(
        case=case,
        run=Run(given.label, SUPPORT),
        version="",
        time=time,
        tilt=tilt,
        tilt_rate=np.full(len(time), np.nan),
        rolling_angle=angle,
        twist=twist,
        contact_point=contact,
        centre_of_mass=centre,
        passes=passes(poses, begin.time, stands),
        peak_tilt=0.5 * math.pi if fell else peak(poses),
        outcome="overturned" if fell else "stands",
        rests=not fell and bool((tilt[-100:] < stands).all()),
        facts=tuple(_facts(poses)),
        uplift_time=begin.time,
        uplift_direction=begin.direction,
        time_step=float(np.median(np.diff(poses.time))),
        residual_displacement=moved,
        source=Measurement(poses=poses, first_lean=first_lean, given=given, columns=columns),
    )


def read_trajectories(
    external: Sequence[External | str | Path], cases: Sequence[Case], *, taken: Collection[str] = ()
) -> dict[tuple[str, str], Trace]:
    """Read the trajectories of a case, by its name and their labels; those in `taken` are of other runs.

    Raises
    ------
    ValueError
        What `read_trajectory` raises; or if there are several cases, or two runs would have one label.
    """
    if external and len(cases) > 1:
        raise ValueError(f"a trajectory belongs to one case, got {len(cases)} cases")
    found: dict[tuple[str, str], Trace] = {}
    for item in external:
        trajectory = read_trajectory(item, cases[0])
        label = str(trajectory.run.engine)
        if label in taken or (cases[0].name, label) in found:
            raise ValueError(f"each run must have its own label, got {label!r} twice")
        found[cases[0].name, label] = trajectory
    return found


def _from_start_to_end(poses: Poses, start: int, length: float) -> Poses:
    """Cut to the run, and at the fall where there is one."""
    chosen = np.arange(start, len(poses.time))
    tilt = poses.tilt[chosen]
    falls = np.flatnonzero((tilt[:-1] >= _FALLEN) & (np.diff(tilt) <= 0.0))
    landed = int(falls[0]) if len(falls) else len(chosen) - 1
    # one sample beyond the end, to interpolate up to it
    last = min(int(np.searchsorted(poses.time[chosen], length - SAME_TIME)), len(chosen) - 1)
    # a fall that began before the end is followed to the ground
    falling = tilt[landed] >= _FALLEN and bool((np.diff(tilt[last : landed + 1]) > 0.0).all())
    return poses.taken(chosen[: (landed if landed < last or falling else last) + 1])


def _facts(poses: Poses) -> Iterator[Diagnostic]:
    yield from (Diagnostic(code="note", detail=note) for note in poses.notes)
    guessed = np.flatnonzero(~poses.followed)
    if len(guessed):
        yield Diagnostic(code="missed_pass", time=float(poses.time[guessed[0]]), size=len(guessed))
