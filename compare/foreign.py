"""A trajectory from a shake table or another code as one more run of a comparison."""

from __future__ import annotations

import math
from collections.abc import Collection, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from rockwobble.models import Case

from .foreign_file import Array, read_columns
from .foreign_measures import passes, peak, places, resampled, sample_times, uplift
from .foreign_pose import SAME_TIME, STANDS, Poses, poses_of

if TYPE_CHECKING:
    import pandas as pd

SUPPORT = "foreign"
# the side lies on the ground, as far as a measurement says [rad]
_FALLEN = 0.5 * math.pi - 0.01


@dataclass(frozen=True, slots=True, kw_only=True)
class Foreign:
    """A file of a trajectory, and how to read it; `rockwobble.compare.foreign_file` says what it may hold.

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
        Tilt below which the cylinder counts as standing [rad]. Default: 1e-4 alpha, for computed ones.

    Raises
    ------
    ValueError
        If the offset is not finite or the noise is not positive.
    """

    path: Path
    label: str = ""
    angle_unit: str | None = None
    time_offset: float = 0.0
    noise: float | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "path", Path(self.path))
        object.__setattr__(self, "label", self.label or self.path.stem)
        if not math.isfinite(self.time_offset):
            raise ValueError(f"time_offset must be finite [s], got {self.time_offset!r}")
        if self.noise is not None and not 0.0 < self.noise < 0.5 * math.pi:
            raise ValueError(f"noise must be above 0 and below pi/2 [rad], got {self.noise!r}")


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ForeignTrajectory:
    """A foreign trajectory at the sample times of the reduced models; fields as of an engine's trajectory.

    What the file does not tell is NaN: energy, computing time, contact resolution; the twist without
    quaternions; the residual displacement without positions, where contact point and mass centre are those
    of a cylinder in a recess with the same tilt and azimuth, equations (8) and (10).
    """

    engine: str
    time: Array
    tilt: Array
    rolling_angle: Array
    twist: Array
    contact_point: Array
    centre_of_mass: Array
    energy: Array
    passes: pd.DataFrame
    peak_tilt: float
    outcome: str
    message: str
    uplift_time: float
    uplift_direction: float
    time_step: float
    residual_displacement: float
    residual_twist: float
    support: str = SUPPORT
    engine_version: str = ""
    wall_time: float = math.nan
    contact_resolution: float = math.nan

    def to_frame(self) -> pd.DataFrame:
        """Return the sampled fields as a table with one row for each sample; SI units and radians."""
        import pandas as pd

        return pd.DataFrame(
            {
                "time": self.time,
                "tilt": self.tilt,
                "rolling_angle": self.rolling_angle,
                "twist": self.twist,
                "contact_x": self.contact_point[:, 0],
                "contact_y": self.contact_point[:, 1],
                "centre_x": self.centre_of_mass[:, 0],
                "centre_y": self.centre_of_mass[:, 1],
                "centre_z": self.centre_of_mass[:, 2],
            }
        )


def read_trajectory(foreign: Foreign | str | Path, case: Case) -> ForeignTrajectory:
    """Read a foreign trajectory of a case.

    Parameters
    ----------
    foreign : Foreign, str or Path
    case : Case
        The problem that it answers: cylinder and length.

    Raises
    ------
    ValueError
        If the file cannot be read, has gaps or times that do not rise, or does not cover the start of
        the run; the message names the file and the line.
    """
    given = foreign if isinstance(foreign, Foreign) else Foreign(path=Path(foreign))
    columns = read_columns(given.path, given.angle_unit)
    stands = STANDS * case.cylinder.alpha if given.noise is None else given.noise
    poses = _from_start_to_end(poses_of(columns, stands, given.time_offset), case.length)
    uplift_time, first = uplift(poses, stands)
    fell = bool(poses.tilt[-1] >= _FALLEN)
    time = sample_times(min(float(poses.time[-1]), case.length))
    tilt, angle, axis = resampled(poses, time)
    angle = np.where((tilt > stands) & (time >= uplift_time - SAME_TIME), angle, np.nan)
    contact, centre, moved = places(poses, time, axis, angle, case.cylinder)
    if fell:
        tilt[-1] = 0.5 * math.pi
    twist = np.full(len(time), np.nan) if poses.twist is None else np.interp(time, poses.time, poses.twist)
    return ForeignTrajectory(
        engine=given.label,
        time=time,
        tilt=tilt,
        rolling_angle=angle,
        twist=twist,
        contact_point=contact,
        centre_of_mass=centre,
        energy=np.full(len(time), np.nan),
        passes=passes(poses, uplift_time, stands),
        peak_tilt=0.5 * math.pi if fell else peak(poses),
        outcome="overturned" if fell else "rest" if bool((tilt[-100:] < stands).all()) else "completed",
        message=_message(poses, first),
        uplift_time=uplift_time,
        uplift_direction=math.nan if first is None else float(poses.rolling_angle[first]),
        time_step=float(np.median(np.diff(poses.time))),
        residual_displacement=moved,
        residual_twist=float(twist[-1]),
    )


def read_trajectories(
    foreign: Sequence[Foreign | str | Path], cases: Sequence[Case], *, taken: Collection[str] = ()
) -> dict[tuple[str, str], ForeignTrajectory]:
    """Read all trajectories that belong to the one case of a comparison.

    Parameters
    ----------
    foreign : sequence of Foreign, str or Path
    cases : sequence of Case
    taken : collection of str
        Labels of the other runs.

    Returns
    -------
    dict
        By the name of the case and the label.

    Raises
    ------
    ValueError
        What `read_trajectory` raises; or if there are several cases, or two runs would have one label.
    """
    if foreign and len(cases) > 1:
        raise ValueError(f"a trajectory belongs to one case, got {len(cases)} cases")
    found: dict[tuple[str, str], ForeignTrajectory] = {}
    for item in foreign:
        trajectory = read_trajectory(item, cases[0])
        label = trajectory.engine
        if label in taken or (cases[0].name, label) in found:
            raise ValueError(f"each run must have its own label, got {label!r} twice")
        found[cases[0].name, label] = trajectory
    return found


def _from_start_to_end(poses: Poses, length: float) -> Poses:
    """Cut to the run, and at the fall where there is one."""
    chosen = np.flatnonzero(poses.time > -0.5 * float(poses.time[1] - poses.time[0]))
    # one sample beyond the end, to interpolate up to it
    chosen = chosen[: int(np.searchsorted(poses.time[chosen], length - SAME_TIME)) + 1]
    fallen = np.flatnonzero(poses.tilt[chosen] >= _FALLEN)
    if len(fallen):
        chosen = chosen[: fallen[0] + 1]
    return Poses(
        poses.time[chosen],
        poses.tilt[chosen],
        poses.axis[chosen],
        poses.rolling_angle[chosen],
        poses.followed[chosen],
        None if poses.twist is None else poses.twist[chosen],
        None if poses.position is None else poses.position[chosen],
    )


def _message(poses: Poses, first: int | None) -> str:
    notes = []
    if first is not None and poses.position is None:
        notes.append("contact points and paths are those of a recess with this tilt and azimuth")
    guessed = int(np.count_nonzero(~poses.followed))
    if guessed:
        notes.append(f"{guessed} near pass{'es' if guessed > 1 else ''} fell between two samples")
    return "; ".join(notes)
