"""Judge the trajectory of a rocking cylinder against a case of this benchmark; needs Python 3.10 and numpy.

    python check.py CASE TRAJECTORY.csv [--label "my code 1.2"] [--out result.json]

CASE is a folder under cases/; README.md says what a trajectory file may hold. Exit code 0: satisfied, or
caution where not every criterion could be judged; 1: not satisfied; 2: not tested, the file cannot be judged.
"""

from __future__ import annotations

import argparse
import hashlib
import itertools
import json
import math
import re
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, field, replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
Values = dict[str, Array]  # of the columns of one run, in SI units and radians, by name

QUATERNION = ("qw", "qx", "qy", "qz")
POSITION = ("x", "y", "z")
ANGLE_UNITS = {"rad": 1.0, "deg": math.pi / 180.0}
COLUMN_UNITS = {
    "time": {"s": 1.0, "ms": 1e-3},
    "tilt": ANGLE_UNITS,
    "azimuth": ANGLE_UNITS,
    **{name: {"-": 1.0, "": 1.0} for name in QUATERNION},
    **{name: {"m": 1.0, "cm": 1e-2, "mm": 1e-3} for name in POSITION},
}
SILENT_UNITS = {"time": "s", **dict.fromkeys(QUATERNION, ""), **dict.fromkeys(POSITION, "m")}
# what stands in the header of the table of a run of rockwobble, and what it is here
OWN_TITLES = {
    "time": "time [s]",
    "tilt": "tilt [rad]",
    "rolling_angle": "azimuth [rad]",
    "centre_x": "x [m]",
    "centre_y": "y [m]",
    "centre_z": "z [m]",
}
LISTED, LONGEST_NAME = 80, 40  # characters of a list of names in a message, and of one of them
FEWEST_SAMPLES = 3


@dataclass(frozen=True, slots=True, eq=False)
class Table:
    """The samples of one run in a file.

    Attributes
    ----------
    name : str
        Name of the file.
    lines : list of int
        Line of each of the n samples, for messages.
    values : dict
        Array of shape (n,) of each known column, in SI units and radians; an empty cell is NaN.
    ignored : tuple of str
        Titles of the columns that are not read.
    lost : int
        Number of lines with a time and nothing else, which are left out.
    """

    name: str
    lines: list[int]
    values: Values
    ignored: tuple[str, ...] = ()
    lost: int = 0

    def require(self, holds: Mask, reason: Callable[[int], str]) -> None:
        """Refuse the first sample where something (n,) does not hold, with the number of its line.

        Raises
        ------
        ValueError
            With the `reason` for that sample.
        """
        if not holds.all():
            at = int(np.argmin(holds))
            raise ValueError(f"{self.name}, line {self.lines[at]}: {reason(at)}")

    def complete(self, column: str, where: Mask | None = None) -> Array:
        """Return a column that must have a value in each sample, or `where` (n,) is true."""
        known = ~np.isnan(self.values[column])
        self.require(known if where is None else known | ~where, lambda _: f"{column} is missing")
        return self.values[column]


def listed(names: Sequence[str]) -> str:
    """Return names for a message, as many as fit and how many more there are.

    Examples
    --------
    >>> listed(["strain", "force"]), listed(["strain"] * 20)[-26:]
    ('strain, force', 'strain, strain and 10 more')
    """
    short = [name if len(name) <= LONGEST_NAME else f"{name[: LONGEST_NAME - 3]}..." for name in names]
    count = next((n for n in range(len(short), 1, -1) if len(", ".join(short[:n])) <= LISTED), len(short[:1]))
    return ", ".join(short[:count]) + (f" and {len(short) - count} more" if count < len(short) else "")


def read_tables(path: Path, angle_unit: str | None = None) -> dict[str, Table]:
    """Read the runs of a CSV file by name, "" where it has no column `run`.

    Parameters
    ----------
    path : Path
    angle_unit : {"rad", "deg"}, optional
        Unit of angles where the header is silent.

    Raises
    ------
    ValueError
        If the file cannot be read, a column is missing or in an unknown unit, or a cell is no number.
    """
    if angle_unit not in (None, *ANGLE_UNITS):
        raise ValueError(f"the unit of angles must be one of {', '.join(ANGLE_UNITS)}, got {angle_unit!r}")
    rows = _rows(path)
    first, header = next(rows, (0, []))
    if not first:
        raise ValueError(f"the trajectory {path} is empty")
    known = _known_columns(path.name, header, angle_unit)
    column_of_run = header.index("run") if "run" in header else None
    samples: dict[str, list[tuple[int, list[float]]]] = {}
    for number, cells in rows:
        if len(cells) != len(header):
            raise ValueError(
                f"{path.name}, line {number}: expected {len(header)} cells as in the header, got {len(cells)}"
            )
        values = [_number(path.name, number, header[at], cells[at]) * unit for at, unit in known.values()]
        run = "" if column_of_run is None else cells[column_of_run]
        samples.setdefault(run, []).append((number, values))
    if not samples:
        raise ValueError(f"{path.name} must hold at least {FEWEST_SAMPLES} samples, got 0")
    read = {column_of_run, *(at for at, _ in known.values())}
    ignored = tuple(title for at, title in enumerate(header) if title and at not in read)
    return {run: _table(path.name, list(known), own, ignored) for run, own in samples.items()}


def _table(
    name: str, columns: list[str], samples: list[tuple[int, list[float]]], ignored: tuple[str, ...]
) -> Table:
    time = columns.index("time")
    kept = [
        (line, values)
        for line, values in samples
        if math.isnan(values[time])
        or any(not math.isnan(value) for at, value in enumerate(values) if at != time)
    ]
    if len(kept) < FEWEST_SAMPLES:
        raise ValueError(f"{name} must hold at least {FEWEST_SAMPLES} samples, got {len(kept)}")
    arrays = np.array([values for _, values in kept], dtype=np.float64).T
    values = dict(zip(columns, arrays, strict=True))
    return Table(name, [line for line, _ in kept], values, ignored, len(samples) - len(kept))


def _rows(path: Path) -> Iterator[tuple[int, list[str]]]:
    """Yield number and cells of each line that is neither empty nor a comment."""
    try:
        endless = path.is_char_device()
        lines = [] if endless else path.read_text(encoding="utf-8-sig").splitlines()
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or "it is no text"
        raise ValueError(f"cannot read the trajectory {path}: {reason}") from None
    if endless:
        raise ValueError(f"cannot read the trajectory {path}: it is a device, which may never end")
    mark = ""
    for number, line in enumerate(lines, start=1):
        text = line.strip()
        if not text or text.startswith("#"):
            continue
        if not mark:
            mark = next((candidate for candidate in ";\t" if candidate in text), ",")
        yield number, [cell.strip().strip('"').strip() for cell in line.split(mark)]


def _known_columns(file: str, header: list[str], angle_unit: str | None) -> dict[str, tuple[int, float]]:
    """Return place and factor to SI units of each known column, by name."""
    found: dict[str, tuple[int, float]] = {}
    own = set(OWN_TITLES) <= set(header)
    for at, given in enumerate(header):
        title = OWN_TITLES.get(given, given) if own else given
        match = re.fullmatch(r"(\w+)\s*(?:[\[(]\s*([^\])]*?)\s*[\])])?", title)
        name = match[1].lower() if match else ""
        if match is None or name not in COLUMN_UNITS:
            continue
        if name in found:
            raise ValueError(f"{file} must have each column once, got {name} twice")
        unit = match[2] if match[2] is not None else SILENT_UNITS.get(name, angle_unit)
        if unit is None:
            raise ValueError(
                f"{file} does not say the unit of {name}: name the column '{name} [deg]' or "
                f"'{name} [rad]', or give the unit of angles"
            )
        if unit not in COLUMN_UNITS[name]:
            raise ValueError(f"{file}: {name} must be in {' or '.join(COLUMN_UNITS[name])}, got {unit!r}")
        found[name] = at, COLUMN_UNITS[name][unit]
    for group in (QUATERNION, POSITION):
        missing = [name for name in group if name not in found]
        if missing and len(missing) < len(group):
            raise ValueError(f"{file} must have {', '.join(group)} together, got no {missing[0]}")
    if "azimuth" in found and "tilt" not in found:
        raise ValueError(f"{file} must have tilt where it has azimuth, got no tilt")
    if "time" not in found or not {"tilt", "qw", "x"} & set(found):
        raise ValueError(
            f"{file} must have columns time, and tilt and azimuth, or qw, qx, qy and qz, or x, y and z, "
            f"got {listed([title for title in header if title]) or 'none'}"
        )
    return found


def _number(file: str, line: int, title: str, cell: str) -> float:
    if not cell or cell.lower() == "nan":
        return math.nan
    try:
        value = float(cell)
    except ValueError:
        raise ValueError(f"{file}, line {line}: {title} must be a number, got {cell[:40]!r}") from None
    if not math.isfinite(value):
        raise ValueError(f"{file}, line {line}: {title} must be finite, got {cell!r}")
    return value


Complex = NDArray[np.complex128]

# of a normal distribution: median of the absolute value over the standard deviation
MEDIAN_OF_NORMAL = 0.6745
FEWEST_SCATTERED = 12  # samples without which their scatter is not known
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


def exceeds(time: Array, value: Array, level: float, power: float) -> float:
    """Return when a value first exceeds a level [s], inf if never; its root is linear between samples."""
    i = int(np.argmax(value > level))
    if i == 0:
        return float(time[0]) if value[0] > level else math.inf
    low, high = np.maximum(value[i - 1 : i + 1], 0.0) ** (1.0 / power)
    return float(time[i - 1] + (time[i] - time[i - 1]) * (level ** (1.0 / power) - low) / (high - low))


# of the length of the agreement, where the tilts diverge: towards its end the azimuths do already
BEFORE_DIVERGENCE = 0.8
# of the azimuth [rad]
AZIMUTH_BOUND = math.radians(3.0)
# of the path, over b, besides what that makes of it: R times 1 % of alpha is about as much
PATH_BOUND = 0.01
# of a difference, in standard deviations of the noise
ABOVE_NOISE = 5.0
# noise along the lean against that across it: that of a mass centre is larger across, by R/h at tan alpha 1
BOTH_DIRECTIONS = 1.4
# samples without which azimuth and path are not compared
FEWEST_COMPARED = 5
# what is left of a difference that is explained, of the difference
LEFT_OVER = 1.0 / 3.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Part:
    """One quantity, compared.

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
    """A motion compared with a reference.

    Attributes
    ----------
    start, end, covered : float
        Of the agreement of the tilts, and up to when azimuth and path are compared, in the time of the
        run [s].
    compared : float
        End of what both have in common [s].
    agreed_motion, agreed_peak : float
        Integral [rad s] and largest value [rad] of the tilt of the reference over the agreement.
    tilt, azimuth, path : Part or None
        None where they are not known, or the cylinder does not lean enough while the tilts agree.
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

    @property
    def differs_in(self) -> tuple[str, ...]:
        """What differs, of "tilt", "azimuth" and "path"."""
        parts = (("tilt", self.tilt), ("azimuth", self.azimuth), ("path", self.path))
        return tuple(name for name, part in parts if part is not None and part.differs)

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
        # to the sample: rounding must not take the last one away
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
        )

    def leaning(self, model: Motion, trial: Motion, within: Mask) -> Mask:
        """Return the samples at which an azimuth is compared: both lean far enough."""
        least = max(self.least_lean * float(model.tilt[within].max(initial=0.0)), ABOVE_NOISE * trial.noise)
        counts: Mask = within & (model.tilt > least) & (trial.tilt > least)
        return counts

    def noise_allowance(self, noise: float) -> float:
        """Return what noise [rad] adds to the bound of the tilt [alpha]; none where it is a tenth of that."""
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
        # the mean of few samples scatters itself, and noise is not the same in both directions
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
        # of three coordinates, and of samples that are few
        few = 1.0 + 3.0 / math.sqrt(6.0 * len(apart))
        noise = trial.path_noise / self.base_radius
        bound = math.hypot(PATH_BOUND, self.azimuth_bound * beside, math.sqrt(3.0) * noise * few)
        return _part(model.time[within], size, bound, apart > bound + ABOVE_NOISE * noise)


def explains(before: Part, after: Part | None) -> bool:
    """Whether a difference is gone, and not only just."""
    return after is not None and not after.differs and after.size <= LEFT_OVER * before.size


def _part(time: Array, size: float, bound: float, beyond: Mask) -> Part:
    """A mean that is above its bound differs from the first sample that is beyond its own, if one is."""
    first = float(time[np.argmax(beyond)]) if size > bound else math.nan
    return Part(first_time=first, size=size, bound=bound)


DEGREES = math.degrees(1.0)
LENGTH_FACTORS = (1e3, 1e2, 1e-2, 1e-3)
# what stands where qw, qx, qy and qz should; where z is reversed the axis of the body points down
QUATERNION_ORDERS = {
    "quaternion_scalar_last": ("qz", "qw", "qx", "qy"),
    "quaternion_inverse": ("qw", "-qx", "-qy", "-qz"),
    "z_reversed": ("-qx", "qw", "qz", "-qy"),
}

TURNS = {math.pi: "turned_back"}
MIRRORS = {
    0.0: "y_reversed",
    math.pi: "x_reversed",
    0.5 * math.pi: "axes_exchanged",
    -0.5 * math.pi: "axes_exchanged_reversed",
}
AXES_WORDS = {
    "turned_back": "turned by 180 deg, as where the side that lifts is given for the side it leans to, or "
    "the ground acceleration has the other sign",
    "x_reversed": "mirrored: x has the other sign",
    "y_reversed": "mirrored: y has the other sign, or azimuths are counted clockwise",
    "axes_exchanged": "mirrored: x and y are exchanged, or azimuths are counted clockwise from y (north)",
    "axes_exchanged_reversed": "mirrored: x and y are exchanged and have the other sign, as where x is "
    "north, y east and z down",
}
WORDS = {
    "z_reversed": "z points down",
    "y_up": "y points up",
    "quaternion_scalar_last": "the quaternion has its scalar last, not first",
    "quaternion_inverse": "the quaternion is inverse: from world to body",
}
LENGTH_WORDS = {
    1e3: "in mm, read as m",
    1e2: "in cm, read as m",
    1e-2: "in m, read as cm",
    1e-3: "in m, read as mm",
}


@dataclass(frozen=True, slots=True, kw_only=True)
class Mistake:
    """One likely mistake.

    Attributes
    ----------
    code : str
        "time_offset" (value: to be added to the times [s]), "time_scale" (value: the motion is slower by
        this factor), "time_unit", "angle_unit", "length_unit" (value: too large by this factor), "turned"
        (by value [deg], counter-clockwise), "turned_back" (by half a turn), "x_reversed", "y_reversed",
        "axes_exchanged", "axes_exchanged_reversed", "mirrored" (value: azimuth of the line [deg]),
        "z_reversed", "y_up", "quaternion_scalar_last", "quaternion_inverse", "origin" (value: its distance
        from the right one [m]).
    concerns : str
        "time", "tilt", "azimuth", "tilt and azimuth", "quaternion", "path", or "axes": azimuth and path.
    value : float
        NaN where there is none.
    """

    code: str
    concerns: str
    value: float = math.nan

    @property
    def changes_tilt(self) -> bool:
        """Whether tilts differ by it; horizontal axes, azimuth and the path beside a tilt change none."""
        return self.code == "y_up" or self.concerns not in ("azimuth", "path", "axes")

    @property
    def words(self) -> str:
        """The mistake in words."""
        value, concerns = self.value, self.concerns
        its = f"its {concerns} {'are' if ' and ' in concerns or concerns == 'axes' else 'is'}"
        match self.code:
            case "time_offset":
                late = "late" if value < 0.0 else "early"
                return f"its clock is {abs(value):.3f} s {late}: an offset of {value:.3f} s takes that back"
            case "time_scale":
                size, weight = 100.0 * (value**2 - 1.0), 100.0 * (value**-2 - 1.0)
                rate = f"{100.0 * abs(value - 1.0):.2f} % {'slower' if value > 1.0 else 'faster'}"
                return f"it moves {rate}, as with R {size:+.2f} %, g {weight:+.2f} % or another slenderness"
            case "time_unit":
                return f"times are in {'ms, read as s' if value > 1.0 else 's, read as ms'}"
            case "angle_unit":
                return f"{its} in {'degrees, read as radians' if value > 1.0 else 'radians, read as degrees'}"
            case "length_unit":
                return f"x, y and z are {LENGTH_WORDS[value]}"
            case "origin":
                return f"x, y and z are counted from a point {value:.3g} m from the original base centre"
            case "turned":
                return f"{its} turned by {value:.1f} deg (counter-clockwise)"
            case "mirrored":
                return f"{its} mirrored in the line at {value:.1f} deg, so that it rolls the other way round"
            case code:
                return WORDS.get(code) or f"{its} {AXES_WORDS[code]}"


@dataclass(frozen=True, slots=True, kw_only=True)
class Change:
    """Correction of a mistake: of the columns, or of the motion that they tell."""

    mistake: Mistake
    values: Callable[[Values], Values] = field(default=lambda values: values)
    motion: Callable[[Motion], Motion] = field(default=lambda motion: motion)
    frame: Frame | None = None  # axes that lean and path have in common


Read = Callable[[Values], Motion | None]  # the motion that columns tell; None where they tell none


def corrected(values: Values, read: Read, changes: Sequence[Change]) -> Motion | None:
    """Return the motion of columns after some changes."""
    for change in changes:
        values = change.values(values)
    motion = read(values)
    return None if motion is None else changed(motion, changes)


def changed(motion: Motion, changes: Sequence[Change]) -> Motion:
    """Return a motion after some changes, as far as they are of the motion."""
    for change in changes:
        motion = change.motion(motion)
    return motion


def readings(values: Values) -> Iterator[Change]:
    """Yield the mistakes in units, order and vertical axis of columns that change the pose."""

    def in_unit(code: str, concerns: str, names: Sequence[str], factor: float) -> Change:
        def taken_back(given: Values) -> Values:
            return given | {name: given[name] / factor for name in names}

        return Change(mistake=Mistake(code=code, concerns=concerns, value=factor), values=taken_back)

    def in_order(code: str, concerns: str, signed: dict[str, str]) -> Change:
        def taken_back(given: Values) -> Values:
            known = {name: own for name, own in signed.items() if name in given}
            return given | {
                name: -given[own[1:]] if own[0] == "-" else given[own] for name, own in known.items()
            }

        return Change(mistake=Mistake(code=code, concerns=concerns), values=taken_back)

    by_position = not {"qw", "tilt"} & set(values)
    if "qw" in values:
        for code, own in QUATERNION_ORDERS.items():
            yield in_order(code, "quaternion", dict(zip(QUATERNION, own, strict=True)))
    elif by_position:
        yield in_order("z_reversed", "path", {"z": "-z"})
        for factor in LENGTH_FACTORS:
            yield in_unit("length_unit", "path", POSITION, factor)
    else:
        for names in (("tilt", "azimuth"), ("azimuth",), ("tilt",)):
            if set(names) <= set(values):
                for factor in (DEGREES, 1.0 / DEGREES):
                    yield in_unit("angle_unit", " and ".join(names), names, factor)
    if "qw" in values or by_position:
        yield in_order("y_up", "axes", {"y": "-z", "z": "y", "qy": "-qz", "qz": "qy"})
    for factor in (1e3, 1e-3):
        yield in_unit("time_unit", "time", ("time",), factor)


def of_path(reading: Change) -> Change:
    """Return the change of a path alone that a reading of its columns is."""
    mistake = replace(reading.mistake, concerns="path")

    def taken_back(motion: Motion) -> Motion:
        assert motion.path is not None
        columns = reading.values(dict(zip(POSITION, motion.path.T, strict=True)))
        noise = motion.path_noise / (mistake.value if mistake.code == "length_unit" else 1.0)
        return replace(motion, path=np.column_stack([columns[name] for name in POSITION]), path_noise=noise)

    return Change(mistake=mistake, motion=taken_back)


def in_time_scale(rate: float) -> Change:
    """Return what takes back that a motion is slower by a factor."""
    mistake = Mistake(code="time_scale", concerns="time", value=rate)
    return Change(mistake=mistake, motion=partial(Motion.clocked, rate=1.0 / rate))


@dataclass(frozen=True, slots=True, kw_only=True)
class Frame:
    """Change of a motion into the axes of the reference: y reversed if mirrored, then a turn.

    A turn by beta multiplies the lean by exp(i beta); axes of the other sense, such as x and y exchanged, an
    azimuth counted clockwise or a mirrored table, conjugate it first. In planar motion both do the same.
    The angle is counter-clockwise, in (-pi, pi] [rad].
    """

    angle: float = 0.0
    mirrored: bool = False

    def apply(self, motion: Motion) -> Motion:
        """Return the motion in the axes of the reference."""
        return motion.turned(self.angle, mirrored=self.mirrored)

    def change(self, concerns: str) -> Change:
        """Return what takes the mistake back in "azimuth", "path", or "axes", which are both."""
        named = MIRRORS if self.mirrored else TURNS
        code = named.get(self.angle, "mirrored" if self.mirrored else "turned")
        value = {"turned": -math.degrees(self.angle), "mirrored": 0.5 * math.degrees(self.angle)}.get(
            code, math.nan
        )

        def taken_back(motion: Motion) -> Motion:
            other = self.apply(motion)
            if concerns == "azimuth":
                return replace(motion, lean=other.lean)
            return replace(motion, path=other.path) if concerns == "path" else other

        mistake = Mistake(code=code, concerns=concerns, value=value)
        return Change(mistake=mistake, motion=taken_back, frame=self if concerns == "axes" else None)


# how much more motion must agree without the mistake, and how far it must lean while it does, in bounds
MORE_MOTION, LEANING = 4.0, 5.0
# how long it must agree, over the time scale of rocking, or up to the end
LONG = 3.0
# windows in which the clock is fitted, over that scale: the first motion agrees best, and may be too little
WINDOWS = (3.0, 6.0, 12.0)
SHORTEST_DELAY = 0.01  # an offset of the clock that is named, over the time scale
SAME_OFFSET = 0.1  # difference of the offsets in several windows, over the largest: a clock has one
LARGEST_DELAY = 0.5  # the largest that is tried, over the length of the run
FINE = 40.0  # samples of the time scale in the first search of an offset
ALIKE = 1.5  # rocking repeats itself: of offsets whose misfit is at most this times the least, the smallest
SMALLEST_RATE, LARGEST_RATE = 2.5e-3, 0.15  # by which a rate that is named differs from 1
# what is left of the tilt difference in the right time scale: another tilt or spin at release leaves a fifth
SAME_MOTION = 0.1
FEWEST_FITTED = 3  # samples of a window
NO_MISFIT = 10.0  # of what is not there: more than any tilt [rad]
# an axis is meant where the fit comes so close to it, and the rest is another difference [rad]
NAMED_WITHIN = math.radians(1.5)
# a turn of the axes is the same all the time: that of each part of the motion may differ by this angle [rad],
# and by what noise and other small differences of the lean make of it
STEADY = math.radians(2.0)
SMALL_LEAN = 1e-3  # such differences, over the largest tilt
CONFIDENCE = 3.0  # standard deviations of the noise
OPEN = 0.5  # an angle that is known no better than this is not known [rad]
# two models that a first pass turned apart are off by the same angle in one swing, by chance in two
SWINGS = 3
FEWEST_LEANING = 8  # samples that lean without which there is no fit of the axes


@dataclass(frozen=True, slots=True, kw_only=True)
class Explanation:
    """Mistakes that explain a difference all together, if any, and what is left without them."""

    changes: tuple[Change, ...]
    left: Difference

    @property
    def mistakes(self) -> tuple[Mistake, ...]:
        """The likely mistakes."""
        return tuple(change.mistake for change in self.changes)


def explanations(values: Values, read: Read, reference: Reference) -> Iterator[Explanation]:
    """Yield what explains that columns differ from a reference, the likeliest first.

    The last explains the least, maybe nothing; there is none where the columns tell no motion.
    """
    search = _Search(values=values, read=read, reference=reference)
    motion = read(values)
    if motion is None:
        return
    for changes, other in search.tilt_explained(motion):
        for more, frame, turned in search.azimuth_explained(changes, other):
            of_axes = _path_explained(reference, turned, frame)
            if frame != Frame() and frame not in (change.frame for change in of_axes):
                of_axes = (frame.change("azimuth"), *of_axes)
            left = reference.difference(changed(turned, of_axes))
            yield Explanation(changes=(*changes, *more, *of_axes), left=left)


@dataclass(frozen=True, slots=True, kw_only=True)
class _Search:
    """The columns whose difference from a reference is to be explained."""

    values: Values
    read: Read
    reference: Reference

    def tilt_explained(self, motion: Motion) -> Iterator[tuple[tuple[Change, ...], Motion]]:
        """Yield changes with which the tilt follows the reference, fewest first; last none at all."""
        before = self.reference.difference(motion)
        if before.tilt.differs:
            otherwise = [(one, self.read(one.values(self.values))) for one in readings(self.values)]
            alone = [((change,), other) for change, other in otherwise if other is not None]
            clocks = [((clock,), clock.motion(motion)) for clock in _clocks(self.reference, motion)]
            yield from self._following(before, [*alone, *clocks])
            both = [
                ((*changes, clock), clock.motion(other))
                for changes, other in alone
                for clock in _clocks(self.reference, other)
            ]
            yield from self._following(before, both)
        yield (), motion

    def _following(
        self, before: Difference, tried: Sequence[tuple[tuple[Change, ...], Motion]]
    ) -> Iterator[tuple[tuple[Change, ...], Motion]]:
        """Yield those that follow the reference, the closest first."""
        found = [(changes, motion, self.reference.difference(motion)) for changes, motion in tried]
        for changes, motion, after in sorted(found, key=lambda one: one[2].tilt.size):
            by_rate = any(change.mistake.code == "time_scale" for change in changes)
            if self._follows(before, after, motion, by_rate=by_rate):
                first, frame, _ = next(self.azimuth_explained(changes, motion))
                # two motions that differ may have tilts that agree longer by chance, but not azimuths, too
                if after.azimuth is None or not after.azimuth.differs or first or frame != Frame():
                    yield changes, motion
            elif by_rate:
                # whose motion is another one, and no offset makes it the same
                return

    def _follows(self, before: Difference, after: Difference, motion: Motion, *, by_rate: bool) -> bool:
        """Whether the tilts agree over so much more motion that chance is no reason."""
        alpha, scale = self.reference.alpha, self.reference.time_scale
        if after.agreed_peak < LEANING * after.tilt.bound * alpha:
            return False
        # over as much of the run as was compared before
        to_the_end = not after.tilt.differs and after.compared >= 0.5 * before.compared
        if by_rate:
            noise = (1.0 + 3.0 / math.sqrt(2.0 * len(motion.time))) * motion.noise / alpha
            return to_the_end and after.tilt.size <= math.hypot(SAME_MOTION * before.tilt.size, noise)
        long_enough = to_the_end or after.length >= LONG * scale
        return long_enough and after.agreed_motion >= MORE_MOTION * before.agreed_motion

    def azimuth_explained(
        self, changes: tuple[Change, ...], motion: Motion
    ) -> Iterator[tuple[tuple[Change, ...], Frame, Motion]]:
        """Yield columns read otherwise, or axes, with which the azimuth follows; last none at all."""
        found = self.reference.difference(motion)
        part = found.azimuth
        if part is not None and part.differs:
            tried: list[tuple[tuple[Change, ...], Frame, Motion | None]] = []
            # columns are read otherwise once
            if all(change.mistake.concerns == "time" for change in changes):
                own = [
                    one for one in readings(self.values) if one.mistake.concerns in ("quaternion", "azimuth")
                ]
                tried = [((one,), Frame(), corrected(self.values, self.read, (*changes, one))) for one in own]
            fits = fitted_frames(self.reference, motion, start=found.start, end=found.covered)
            tried += [((), fit, motion) for fit in fits]
            for more, frame, other in tried:
                if other is not None:
                    left = self.reference.difference(frame.apply(other))
                    if explains(part, left.azimuth):
                        yield more, frame, other
        yield (), Frame(), motion


def _path_explained(reference: Reference, motion: Motion, axes: Frame) -> tuple[Change, ...]:
    """Return the fewest changes that explain a path; what is wrong with the axes of the lean is expected."""
    before = reference.difference(motion)
    part = before.path
    if motion.path is None or part is None or not (part.differs or axes != Frame()):
        return ()
    expected = (Frame(), axes)
    fits = fitted_frames(reference, _with_lean_of_path(motion), start=before.start, end=before.covered)
    own = [
        of_path(one)
        for one in readings(dict.fromkeys(POSITION, motion.time))
        if one.mistake.code != "time_unit"
    ]
    pairs = [pair for pair in itertools.combinations(own, 2) if len({one.mistake.code for one in pair}) == 2]
    read_otherwise = [(), *((one,) for one in own), *pairs]

    def count(trial: tuple[Frame, tuple[Change, ...], bool]) -> float:
        frame, changes, moved = trial
        # a constant offset has three numbers to fit: it comes after what has none
        return (frame not in expected) + len(changes) + 1.5 * moved

    frames = dict.fromkeys((*expected, *fits))
    tried = sorted(itertools.product(frames, read_otherwise, (False, True)), key=count)
    for _, alike in itertools.groupby(tried, key=count):
        passing: list[tuple[float, tuple[Change, ...]]] = []
        for frame, changes, moved in alike:
            turn = [frame.change("axes" if frame == axes else "path")] if frame != Frame() else []
            # y up is no horizontal axis
            changes = tuple(sorted((*turn, *changes), key=lambda one: one.mistake.code != "y_up"))
            changes += (_origin(reference, changed(motion, changes), before.covered),) if moved else ()
            left = reference.difference(changed(motion, changes)).path
            if left is not None and not left.differs and (explains(part, left) or not part.differs):
                passing.append((left.size, changes))
        if passing:
            return min(passing, key=lambda one: one[0])[1]
    return ()


def _origin(reference: Reference, motion: Motion, end: float) -> Change:
    """Return what takes back that a path is counted from elsewhere."""
    wanted, own = on_samples_of(reference.motion, motion)
    assert wanted.path is not None
    assert own.path is not None
    origin = np.median((own.path - wanted.path)[wanted.time <= end + SAME_TIME], axis=0)

    def taken_back(given: Motion) -> Motion:
        assert given.path is not None
        return replace(given, path=given.path - origin)

    mistake = Mistake(code="origin", concerns="path", value=float(np.linalg.norm(origin)))
    return Change(mistake=mistake, motion=taken_back)


def _with_lean_of_path(motion: Motion) -> Motion:
    """Return the motion with the direction of its mass centre for that of its axis."""
    assert motion.path is not None
    flat = motion.path[:, 0] + 1j * motion.path[:, 1]
    return replace(motion, lean=np.sin(motion.tilt) * np.exp(1j * np.angle(flat)))


def _clocks(reference: Reference, motion: Motion) -> Iterator[Change]:
    """Yield offsets and rates of the clock, as the tilts tell them."""
    offsets = fitted_offsets(reference, motion)
    if reference.is_free and offsets and max(offsets) - min(offsets) > SAME_OFFSET * max(map(abs, offsets)):
        # a fall and a near pass magnify what differs, and are later by more the longer they last
        offsets = []
    for offset in offsets:
        # a clock that is off by less than a sample cannot be told from what a model and noise make of samples
        if abs(offset) > max(motion.step, SHORTEST_DELAY * reference.time_scale):
            mistake = Mistake(code="time_offset", concerns="time", value=offset)
            yield Change(mistake=mistake, motion=partial(Motion.clocked, offset=offset))
    if reference.is_free:
        rate = fitted_rate(reference, motion)
        if abs(rate - 1.0) > SMALLEST_RATE:
            yield in_time_scale(rate)


def fitted_offsets(reference: Reference, motion: Motion) -> list[float]:
    """Return the offsets [s] that bring the tilt of a motion closest to the reference, smallest first."""
    found: list[float] = []
    largest = LARGEST_DELAY * float(reference.motion.time[-1])
    step = min(reference.time_scale / FINE, 0.5 * largest)
    tried = np.arange(-largest, largest + 0.5 * step, step)
    for window in WINDOWS:
        model = _beginning(reference, window)
        misfits = np.array([_misfit(model, motion, float(offset)) for offset in tried])
        inner = np.flatnonzero((misfits[1:-1] <= misfits[:-2]) & (misfits[1:-1] <= misfits[2:])) + 1
        # what leaves half of the motion is no fit
        if not len(inner) or misfits[inner].min() > 0.5 * math.sqrt(float(np.mean(model.tilt**2))):
            continue
        highest = float(model.tilt.max())
        near = inner[misfits[inner] <= 3.0 * misfits[inner].min() + 0.02 * highest]
        best = [_refined(partial(_misfit, model, motion), float(tried[at]), step) for at in near]
        enough = ALIKE * min(best)[0] + 1e-3 * highest
        offset = min((offset for value, offset in best if value <= enough), key=abs)
        # the windows are there because one of them may be misled
        if offset and all(abs(offset - other) > 1e-3 * reference.time_scale for other in found):
            found.append(offset)
    return sorted(found, key=abs)


def fitted_rate(reference: Reference, motion: Motion) -> float:
    """Return the factor by which a free motion is slower than the reference, fitted in longer windows."""
    rate, width = 1.0, LARGEST_RATE
    for window in (*WINDOWS, math.inf):
        misfit = partial(_misfit, _beginning(reference, window), motion, 0.0)
        rate = float(min(rate + width * np.linspace(-1.0, 1.0, 41), key=misfit))
        width *= 0.3
    return _refined(misfit, rate, width)[1]


def _beginning(reference: Reference, window: float) -> Motion:
    """The samples of the reference in so many time scales from its start."""
    motion, end = reference.motion, reference.start + window * reference.time_scale
    return motion.at(motion.time[(motion.time >= reference.start) & (motion.time <= end)])


def _misfit(model: Motion, motion: Motion, offset: float, slower: float = 1.0) -> float:
    """Root mean square difference of the tilts [rad] of a model and a motion that is late and slower."""
    time = (model.time - offset) * slower
    begin, end = int(time.searchsorted(motion.time[0])), int(time.searchsorted(motion.time[-1], side="right"))
    # most of the window must be there, or a few samples that agree by chance decide
    if end - begin < max(0.5 * len(time), FEWEST_FITTED):
        return NO_MISFIT
    apart = np.interp(time[begin:end], motion.time, motion.tilt) - model.tilt[begin:end]
    return math.sqrt(float(apart @ apart) / len(apart))


def _refined(misfit: Callable[[float], float], centre: float, width: float) -> tuple[float, float]:
    """Least misfit near a minimum, and where it is, by finer and finer steps."""
    least = math.inf
    for _ in range(5):
        least, centre = min((misfit(float(x)), float(x)) for x in centre + width * np.linspace(-1.0, 1.0, 7))
        width /= 3.0
    return least, centre


def fitted_frames(reference: Reference, motion: Motion, *, start: float, end: float) -> list[Frame]:
    """Return the turn and the mirroring that bring the lean of a motion closest to that of the reference.

    Only those that are the same in each part of the time from start to end [s]. A part is a quarter of it,
    or lies between two passes by the upright position: a difference that comes with a pass is none of the
    axes.
    """
    model, trial = on_samples_of(reference.motion, motion)
    if model.lean is None or trial.lean is None:
        return []
    within = (model.time >= start) & (model.time <= end + SAME_TIME)
    counts = reference.leaning(model, trial, within)
    if np.count_nonzero(counts) < FEWEST_LEANING:
        return []
    moves = np.flatnonzero(within & (np.abs(model.lean) > 0.0))
    swings = np.split(moves, np.searchsorted(moves, _minima(model.tilt[moves[0] : moves[-1] + 1]) + moves[0]))
    small = SMALL_LEAN * float(reference.motion.tilt.max())
    found = []
    for mirrored in (False, True):
        products = model.lean * (trial.lean if mirrored else trial.lean.conj())
        angle = float(np.angle(products[counts].sum()))
        quarters = np.array_split(np.flatnonzero(counts), 4)
        off = [
            _off(products[part], angle, model.lean[part], trial.noise, small)
            for part in (*quarters, *swings)
            if len(part)
        ]
        # a part whose angle noise leaves open tells nothing either way
        if any(apart > STEADY + doubt for apart, doubt in off if doubt < OPEN):
            continue
        known = [doubt < (OPEN if mirrored else min(OPEN, 0.5 * abs(angle))) for _, doubt in off[4:]]
        # before the first pass, or in so many swings that no pass can be the reason
        if known and not known[0] and sum(known) < SWINGS:
            continue
        named = MIRRORS if mirrored else TURNS
        near = [exact for exact in named if abs(math.remainder(angle - exact, 2.0 * math.pi)) < NAMED_WITHIN]
        found.append(Frame(angle=near[0] if near else angle, mirrored=mirrored))
    return found


def _off(products: Complex, angle: float, lean: Complex, noise: float, small: float) -> tuple[float, float]:
    """Return how far the turn of a part is from that of the whole, and how well it is known [rad]."""
    strength = math.sqrt(float(np.mean(np.abs(lean) ** 2)))
    doubt = (CONFIDENCE * noise / math.sqrt(len(lean)) + small) / strength
    return abs(float(np.angle(products.sum() * np.exp(-1j * angle)))), doubt


def _minima(tilt: Array) -> NDArray[np.intp]:
    """Return the samples of least tilt: a first pass may hardly be one, and still turn one of two motions."""
    return np.flatnonzero((tilt[1:-1] <= tilt[:-2]) & (tilt[1:-1] < tilt[2:])) + 1


LEVELS = ("exact", "good", "pass")
FEWEST_IN_WINDOW = 30
FITTED_SAMPLES = 7  # of the polynomial through a maximum of the tilt
FALLEN = 1.5  # [rad]: what fell ends early
ENOUGH = 4.0  # a mistake that is named reduces the error so many times
EXPLAINED_RUNS = 3  # of the worst runs, for whose mistakes all are tried
# differences that are explained: tilt [alpha] and azimuth [rad]
EXPLAINED_TILT, EXPLAINED_AZIMUTH = 3e-3, 1e-2
LEAST_LEAN = 0.05  # share of the largest tilt above which an azimuth is compared
Run = dict[str, Any]  # of case.json
Motions = dict[str, Motion]


@dataclass(frozen=True)
class Outcome:
    """One criterion: its largest error over the runs, and what exact, good and pass allow."""

    name: str
    unit: str
    error: float
    run: str  # empty where the file does not tell the error
    bounds: tuple[float, ...]

    @property
    def level(self) -> str:
        """The best level whose bound holds."""
        best = (one for one, bound in zip(LEVELS, self.bounds, strict=True) if self.error <= bound)
        return next(best, "fail") if self.run else "not given"


@dataclass(frozen=True)
class Judgement:
    """What is said of a file."""

    outcomes: tuple[Outcome, ...]
    mistakes: tuple[Mistake, ...]
    columns_not_read: tuple[str, ...]

    @property
    def judged(self) -> int:
        """Number of criteria that were judged."""
        return sum(bool(one.run) for one in self.outcomes)

    @property
    def verdict(self) -> str:
        """The lowest level of what was judged; without criteria the file is rejected."""
        levels = ("rejected", *LEVELS, "fail")
        return max((one.level for one in self.outcomes if one.run), key=levels.index, default="rejected")

    @property
    def grade(self) -> str:
        """The verdict as a grade."""
        passed = "satisfied" if self.judged == len(self.outcomes) else "caution"
        return {"fail": "not satisfied", "rejected": "not tested"}.get(self.verdict, passed)


def read_motion(run: Run, values: Values) -> Motion | None:
    """Return the motion that columns tell; None where a value is missing or the time does not rise."""
    size = {name: run[name] for name in ("base_radius", "mass_centre_height")}
    pose = pose_of(values, **size, recess=run["support"] == "recess")
    if not (np.all(np.diff(values["time"]) > 0.0) and np.isfinite(pose.axis).all()):
        return None
    return Motion(time=values["time"], tilt=pose.tilt, lean=pose.lean, path=pose.position)


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


def through(x: Array, X: Array, Y: NDArray[Any]) -> NDArray[Any]:
    """Return the cubic through the four nearest of evenly spaced samples; NaN outside them."""
    at = (x - X[0]) * (len(X) - 1) / (X[-1] - X[0])
    first = np.clip(np.floor(at).astype(int) - 1, 0, len(X) - 4)
    a, b, c, d = (at - first - k for k in range(4))
    weights = enumerate((-b * c * d / 6.0, a * c * d / 2.0, -a * b * d / 2.0, a * b * c / 6.0))
    total: NDArray[Any] = sum(weight * Y[first + k] for k, weight in weights)
    return np.where((at > -1e-6) & (at < len(X) - 1 + 1e-6), total, np.nan)


def measured(quantity: str, motion: Motion, run: Run, wanted: float) -> float:
    """Return a quantity of reference.json; NaN where it is not known, inf where it does not happen."""
    name, _, digits = quantity.rpartition("_")
    if digits.isdigit() and name in ("turn", "period", "maximum"):  # of the first so many tilt maxima
        found = [one for _, one in zip(range(int(digits)), maxima(motion), strict=False)]
        if len(found) < int(digits):
            return math.inf
        time, tilt, azimuth = found[-1]
        if name == "turn":  # samples do not tell revolutions apart: of all, the nearest to the reference
            off = azimuth - run["start"]["azimuth"] - int(digits) * wanted
            return wanted + (math.nan if math.isnan(off) else math.remainder(off, 2.0 * math.pi)) / int(
                digits
            )
        return float(time / int(digits) if name == "period" else tilt / run["alpha"])
    if quantity == "peak_tilt":
        peak = max([float(motion.tilt.max()), *(tilt for _, tilt, _ in maxima(motion))])
        return float(min(peak, 0.5 * math.pi) / run["alpha"])  # no more than the side on the ground
    if quantity == "slide_time":
        if motion.path is None:
            return math.nan
        moved = np.hypot(*(motion.path - motion.path[0]).T[:2])
        return exceeds(motion.time, moved, run["slide_level"] * run["base_radius"], 3.0)
    at = exceeds(motion.time, motion.tilt, run.get("lean_level", 0.0) * run["alpha"], 3.0)
    if quantity == "lean_time":
        return at
    if motion.lean is None:
        return math.nan
    if name == "revolutions":
        turned = np.abs(np.unwrap(np.angle(motion.lean)) - run["start"]["azimuth"])
        return exceeds(motion.time, turned, 2.0 * math.pi * int(digits), 1.0)
    azimuth = float(np.angle(motion.lean[int(np.argmax(motion.time >= at))]))
    return wanted + math.remainder(azimuth - wanted, 2.0 * math.pi)


class Case:
    """A folder of the benchmark, and what it asks for; distributions by Kolmogorov and Smirnov."""

    def __init__(self, folder: Path) -> None:
        self.digest = hashlib.sha256((folder / "reference.json").read_bytes()).hexdigest()
        texts = [(folder / f"{name}.json").read_text("utf-8") for name in ("case", "accept", "reference")]
        given, self.accept, reference = (json.loads(text) for text in texts)
        self.gravity = given["gravity"]
        self.runs: dict[str, Run] = {run["name"]: run for run in given["runs"]}
        self.wanted = {(one["name"], one["run"]): one["value"] for one in reference["quantities"]}
        titles = (folder / "reference.csv").read_text("utf-8").partition("\n")[0].split(",")
        table = np.loadtxt(folder / "reference.csv", delimiter=",", skiprows=1).T
        self.table = dict(zip(titles, table, strict=True))
        self.known = {name: self.reference(name) for name in self.runs if "alpha" in self.runs[name]}

    def reference(self, name: str) -> Motion | None:
        """Return the motion of reference.csv of a run; None where it has none."""
        run = self.runs[name]
        own = {
            key: self.table.get(f"{key}:{name}", self.table.get(key)) for key in ("tilt", "azimuth", "x", "y")
        }
        if own["tilt"] is None or own["azimuth"] is None:
            return None
        azimuth = np.where(own["tilt"] > 0.0, own["azimuth"], 0.0) + run.get("turned", 0.0)
        path = None
        if own["x"] is not None and own["y"] is not None:
            path = np.column_stack([own["x"], own["y"], np.full_like(own["x"], run["mass_centre_height"])])
        return motion_at(self.table["time"] * run.get("time_unit", 1.0), own["tilt"], azimuth, path)

    def judge(self, motions: Motions) -> tuple[Outcome, ...]:
        """Return the outcome of every criterion; what some runs only tell is not judged."""
        outcomes = []
        for one in self.accept["criteria"]:
            runs = [name for name in one.get("runs", self.runs) if name in motions]
            if one["kind"] == "trace":
                found = {name: self.difference(one, name, motions[name]) for name in runs}
            else:
                wanted = {name: self.wanted[one["name"], name] for name in runs}
                got = {n: measured(one["name"], motions[n], self.runs[n], wanted[n]) for n in runs}
                relative = one["unit"] == "relative"
                found = {n: abs(got[n] - wanted[n]) / (abs(wanted[n]) if relative else 1.0) for n in runs}
                if one["kind"] == "distribution" and runs:
                    both = [*wanted.values(), *got.values()]
                    below = [np.searchsorted(np.sort([*v.values()]), both, "right") for v in (wanted, got)]
                    found = {"all": float(np.max(np.abs(below[0] - below[1]))) / len(runs)}
            known = bool(found) and not any(math.isnan(error) for error in found.values())
            worst = max(found, key=lambda name: found[name]) if known else ""
            error, bounds = found.get(worst, 0.0), tuple(one[level] for level in LEVELS)
            outcomes.append(Outcome(one["name"], one["unit"], error, worst, bounds))
        return tuple(outcomes)

    def score(self, motions: Motions) -> float:
        """Return the largest error over its bound for a pass."""
        return max((one.error / one.bounds[-1] for one in self.judge(motions) if one.run), default=math.inf)

    def difference(self, one: dict[str, Any], name: str, motion: Motion) -> float:
        """Return the root mean square difference from the reference in the window of a criterion."""
        run, known = self.runs[name], self.known[name]
        assert known is not None  # a case that compares traces has them
        assert known.lean is not None
        low, high = (edge * run.get("time_unit", 1.0) for edge in one["window"])
        inside = (motion.time >= low - 1e-9) & (motion.time <= high + 1e-9)
        time = motion.time[inside]
        if one["name"] == "path":
            if motion.path is None or known.path is None:
                return math.nan
            place, wanted = ((path[:, 0] + 1j * path[:, 1]) for path in (motion.path[inside], known.path))
            apart = np.abs(place - through(time, known.time, wanted)) / run["base_radius"]
        elif one["name"] == "tilt":
            sine = np.minimum(np.abs(through(time, known.time, known.lean)), 1.0)
            apart = np.abs(motion.tilt[inside] - np.arcsin(sine)) / run["alpha"]
        elif motion.lean is None:
            return math.nan
        else:
            apart = np.abs(motion.lean[inside] - through(time, known.time, known.lean)) / math.sin(
                run["alpha"]
            )
        finite = np.isfinite(apart)
        if np.count_nonzero(finite) < FEWEST_IN_WINDOW or time[finite][-1] - time[finite][0] < 0.9 * (
            high - low
        ):
            return math.inf
        if one.get("measure") == "largest":
            return float(apart[finite].max())
        length = (np.concatenate([step := np.diff(time), [0.0]]) + np.concatenate([[0.0], step]))[finite]
        return math.sqrt(float(np.sum(length * apart[finite] ** 2) / np.sum(length)))

    def explanations(self, name: str, values: Values) -> Iterator[Explanation]:
        """Yield what explains the difference of one run from its reference."""
        run, known = self.runs[name], self.known[name]
        if known is None:
            return
        facts = Reference(
            motion=known,
            alpha=run["alpha"],
            base_radius=run["base_radius"],
            time_scale=math.sqrt(math.hypot(run["base_radius"], run["mass_centre_height"]) / self.gravity),
            start=float(known.time[int(np.argmax(known.tilt > 0.0))]),
            is_free=run["motion"]["kind"] == "still",
            tilt_bound=EXPLAINED_TILT,
            azimuth_bound=EXPLAINED_AZIMUTH,
            least_lean=LEAST_LEAN,
        )
        yield from explanations(values, partial(read_motion, run), facts)

    def candidates(self, tables: Mapping[str, Table], names: Sequence[str]) -> Iterator[tuple[Change, ...]]:
        """Yield what explains the difference of some runs, then what may explain that of all."""
        found = [one for name in names for one in self.explanations(name, tables[name].values)]
        alone = [one.mistakes[0] for one in found if len(one.mistakes) == 1]
        rates = [mistake.value for mistake in alone if mistake.code == "time_scale"]
        if rates:  # a spin that does not go with the size changes that of each run a little
            yield (in_time_scale(sum(rates) / len(rates)),)
        yield from (one.changes for one in found)
        # of peaks alone nothing but units can be told
        yield from ((change,) for change in readings(tables[names[0]].values))

    def mistakes(self, tables: Mapping[str, Table], motions: Motions) -> tuple[Mistake, ...]:
        """Return the fewest mistakes without which the case is passed, or as much better."""
        enough = min(1.0, self.score(motions) / ENOUGH)
        worst = sorted(motions, key=lambda name: -self.score({name: motions[name]}))[:EXPLAINED_RUNS]
        for changes in self.candidates(tables, worst):
            runs = {
                name: corrected(table.values, partial(read_motion, self.runs[name]), changes)
                for name, table in tables.items()
            }
            found = {name: motion for name, motion in runs.items() if motion is not None}
            if changes and len(found) == len(runs) and self.score(found) <= enough:
                return tuple(change.mistake for change in changes)
        return ()


def judged(case: Case, path: Path) -> Judgement:
    """Return what is said of a file.

    Raises
    ------
    ValueError
        If the file cannot be judged.
    """
    tables = read_tables(path, "rad")
    if set(tables) == {""} and len(case.runs) == 1:
        tables = {next(iter(case.runs)): tables[""]}
    if set(tables) - set(case.runs) or (case.accept["runs"] == "all" and len(tables) < len(case.runs)):
        raise ValueError(f"the column run must name {', '.join(case.runs)}; got {listed(list(tables))}")
    motions = {}
    for name, table in tables.items():
        steps = np.diff(table.values["time"], prepend=-math.inf)
        table.require(steps > 0.0, lambda _: "time must rise")
        for column in table.values:
            table.complete(column, where=table.values["tilt"] != 0.0 if column == "azimuth" else None)
        motion = read_motion(case.runs[name], table.values)
        assert motion is not None
        motions[name] = motion
    ignored = next(iter(tables.values())).ignored
    outcomes = case.judge(motions)
    if missing := set(case.accept["needed"]) - {one.name for one in outcomes if one.run}:
        unknown = f"; columns not read: {listed(ignored)}" if ignored else ""
        raise ValueError(
            f"the file does not give {', '.join(sorted(missing))}, which this case needs{unknown}"
        )
    found = Judgement(outcomes, (), ignored)
    mistakes = case.mistakes(tables, motions) if found.verdict != "exact" else ()
    short = [one.name for one in outcomes if one.unit in ("alpha", "b") and one.error == math.inf]
    if short and not mistakes and all(motion.tilt.max() < FALLEN for motion in motions.values()):
        raise ValueError(f"the samples do not cover the window of {', '.join(short)}")
    return replace(found, mistakes=mistakes)


def main() -> int:
    """Judge one file; return the exit code."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    cases = {one.parent.name: one.parent for one in Path(__file__).resolve().parent.glob("cases/*/case.json")}
    parser.add_argument("case", choices=sorted(cases))
    parser.add_argument("trajectory", type=Path)
    parser.add_argument("--label", default="", help="who made it: name, version and settings of the code")
    parser.add_argument("--out", type=Path, default=Path("result.json"))
    given = parser.parse_args()
    case, reason = Case(cases[given.case]), ""
    try:
        found = judged(case, given.trajectory)
    except ValueError as error:
        found, reason = Judgement((), (), ()), str(error)
    asked = len(case.accept["criteria"])
    print(f"{given.case}: {found.verdict} ({found.grade}), judged {found.judged} of {asked} criteria")
    notes = [reason, f"columns not read: {listed(found.columns_not_read)}" * bool(found.columns_not_read)]
    for one in found.outcomes:
        limits = "exact {:.2g}, good {:.2g}, pass {:.2g}".format(*one.bounds)
        value = f" {one.error:.3g} {one.unit} (run {one.run}; {limits})" if one.run else ""
        notes.append(f"{one.name}: {one.level}{value}")
    notes += [f"likely mistake: {mistake.words}" for mistake in found.mistakes]
    print(*(f"  {note}" for note in notes if note), sep="\n")
    criteria = [
        asdict(one) | {"level": one.level, "error": one.error if one.error < math.inf else None}
        for one in found.outcomes
    ]
    result = {
        "schema": "result/1",
        "case": given.case,
        "label": given.label,
        "verdict": found.verdict,
        "grade": found.grade,
        "judged": [found.judged, asked],
        "reason": reason,
        "criteria": criteria,
        "columns_not_read": found.columns_not_read,
        "likely_mistakes": [mistake.words for mistake in found.mistakes],
        "mistakes": [
            asdict(one) | {"value": None if math.isnan(one.value) else one.value} for one in found.mistakes
        ],
        "check": "2",
        "reference_sha256": case.digest,
    }
    given.out.write_text(json.dumps(result, indent=1) + "\n", "utf-8")
    return {"not satisfied": 1, "not tested": 2}.get(found.grade, 0)


if __name__ == "__main__":
    sys.exit(main())
