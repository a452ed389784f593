"""Trajectories from a shake table or another code, as CSV files.

A header line names the columns, in any order, separated by commas, semicolons or tabs; lines that begin
with # are comments. Units stand behind a name in brackets: "time [s], tilt [deg], azimuth [deg]".

============== ============ =======================================================================
column         unit         meaning
============== ============ =======================================================================
run            none         name of the run, where a file holds several
time           s, ms        s where the header is silent
tilt           rad, deg     angle of the axis from the vertical; a negative one, as of a planar test,
                            leans to the side opposite to its azimuth
azimuth        rad, deg     direction of the lean, counter-clockwise from x (east) as seen from above;
                            may be empty where the cylinder stands
qw, qx, qy, qz none         turn from the upright cylinder to its pose, scalar first, z up
x, y, z        m, cm, mm    mass centre from the original base centre, which moves with the ground;
                            m where the header is silent
============== ============ =======================================================================

The run.csv of `rockwobble simulate` is read as it is: its names have one unit each, its rolling angle is the
azimuth, and its centre x, y and z.

There must be time, and one of: tilt, with or without azimuth; the quaternions; x, y and z. What is not there
is not compared. Other columns are not read, and named. A line with a time and nothing else is a sample that
was lost.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

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


def name_list(names: Sequence[str]) -> str:
    """Return names for a message, as many as fit and how many more there are.

    Examples
    --------
    >>> name_list(["strain", "force"]), name_list(["strain"] * 20)[-26:]
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
            f"got {name_list([title for title in header if title]) or 'none'}"
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
