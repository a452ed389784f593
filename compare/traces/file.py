"""Trajectories from a shake table or another code, as CSV files.

A header line names the columns, in any order, separated by commas, semicolons or tabs; lines before it that
begin with # are comments. Units stand behind a name in brackets: "time [s], tilt [deg], azimuth [deg]".

============== ============ =======================================================================
column         unit         meaning
============== ============ =======================================================================
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
is not compared. Other columns are ignored. A line with a time and nothing else is a sample that was lost.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from rockwobble.models.number_checks import require_one_of

Array = NDArray[np.float64]

ANGLE_UNITS = {"rad": 1.0, "deg": math.pi / 180.0}
_UNITS = {
    "time": {"s": 1.0, "ms": 1e-3},
    "tilt": ANGLE_UNITS,
    "azimuth": ANGLE_UNITS,
    **{name: {"-": 1.0, "": 1.0} for name in ("qw", "qx", "qy", "qz")},
    **{name: {"m": 1.0, "cm": 1e-2, "mm": 1e-3} for name in ("x", "y", "z")},
}
_SILENT = {"time": "s", "x": "m", "y": "m", "z": "m", "qw": "", "qx": "", "qy": "", "qz": ""}
# what stands in the header of the table of a run of this project, and what it is here
_OWN = {
    "time": "time [s]",
    "tilt": "tilt [rad]",
    "rolling_angle": "azimuth [rad]",
    "centre_x": "x [m]",
    "centre_y": "y [m]",
    "centre_z": "z [m]",
}
_ROOM, _LONGEST = 80, 40  # of a list of names in a message, and of one of them
QUATERNION = ("qw", "qx", "qy", "qz")
POSITION = ("x", "y", "z")


@dataclass(frozen=True, slots=True, eq=False)
class Columns:
    """Columns of a file, in SI units and radians.

    Attributes
    ----------
    path : Path
    lines : list of int
        Line of each of the n samples, for messages.
    values : dict
        Array of shape (n,) of each known column; an empty cell is NaN.
    ignored : tuple of str
        Titles of the other columns.
    lost : int
        Number of lines with a time and nothing else, which are left out.
    """

    path: Path
    lines: list[int]
    values: dict[str, Array]
    ignored: tuple[str, ...] = ()
    lost: int = 0

    def require(self, holds: NDArray[np.bool_], reason: Callable[[int], str]) -> None:
        """Refuse the first sample where something (n,) does not hold, with the number of its line.

        Raises
        ------
        ValueError
            With the `reason` for that sample.
        """
        if not holds.all():
            at = int(np.argmin(holds))
            raise ValueError(f"{self.path.name}, line {self.lines[at]}: {reason(at)}")

    def complete(self, name: str) -> Array:
        """Return a column that must have a value in each sample."""
        self.require(~np.isnan(self.values[name]), lambda _: f"{name} is missing")
        return self.values[name]

    def scaled(self, factors: Mapping[str, float]) -> Columns:
        """Return the file as if its columns were in other units: values times the factor of their name."""
        values = {name: column * factors.get(name, 1.0) for name, column in self.values.items()}
        return replace(self, values=values)


def listed(names: Sequence[str]) -> str:
    """Return names for a message, as many as fit and how many more there are.

    Examples
    --------
    >>> listed(["strain", "force"]), listed(["strain"] * 20)[-26:]
    ('strain, force', 'strain, strain and 10 more')
    """
    short = [name if len(name) <= _LONGEST else f"{name[: _LONGEST - 3]}..." for name in names]
    count = next((n for n in range(len(short), 1, -1) if len(", ".join(short[:n])) <= _ROOM), len(short[:1]))
    return ", ".join(short[:count]) + (f" and {len(short) - count} more" if count < len(short) else "")


def read_columns(path: Path, angle_unit: str | None = None) -> Columns:
    """Read the known columns of a CSV file; `angle_unit` is that of angles where the header is silent.

    Raises
    ------
    ValueError
        If the file cannot be read, a column is missing or in an unknown unit, or a cell is no number.
    """
    if angle_unit is not None:
        require_one_of("the unit of angles", angle_unit, ANGLE_UNITS)
    rows = _rows(path)
    first, header = next(rows, (0, []))
    if not first:
        raise ValueError(f"the trajectory {path} is empty")
    known = _known_columns(path, header, angle_unit)
    lines: list[int] = []
    table: list[list[float]] = []
    for number, cells in rows:
        if len(cells) != len(header):
            raise ValueError(
                f"{path.name}, line {number}: expected {len(header)} cells as in the header, got {len(cells)}"
            )
        lines.append(number)
        table.append([_number(path, number, header[at], cells[at]) for at, _ in known.values()])
    columns = np.array(table, dtype=np.float64).reshape(len(table), len(known)).T
    values = {name: column * scale for (name, (_, scale)), column in zip(known.items(), columns, strict=True)}
    lost = ~np.isnan(values["time"])
    for name in known.keys() - {"time"}:
        lost &= np.isnan(values[name])
    lines = [line for line, left_out in zip(lines, lost, strict=True) if not left_out]
    if len(lines) < 3:
        raise ValueError(f"{path.name} must hold at least three samples, got {len(lines)}")
    read = {at for at, _ in known.values()}
    return Columns(
        path,
        lines,
        {name: column[~lost] for name, column in values.items()},
        tuple(title for at, title in enumerate(header) if title and at not in read),
        int(np.count_nonzero(lost)),
    )


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


def _known_columns(path: Path, header: list[str], angle_unit: str | None) -> dict[str, tuple[int, float]]:
    """Return place and factor to SI units of each known column, by name."""
    found: dict[str, tuple[int, float]] = {}
    own = set(_OWN) <= set(header)
    for at, given in enumerate(header):
        title = _OWN.get(given, given) if own else given
        match = re.fullmatch(r"(\w+)\s*(?:[\[(]\s*([^\])]*?)\s*[\])])?", title)
        name = match[1].lower() if match else ""
        if match is None or name not in _UNITS:
            continue
        if name in found:
            raise ValueError(f"{path.name} must have each column once, got {name} twice")
        unit = match[2] if match[2] is not None else _SILENT.get(name, angle_unit)
        if unit is None:
            raise ValueError(
                f"{path.name} does not say the unit of {name}: name the column '{name} [deg]' or "
                f"'{name} [rad]', or give the unit of angles"
            )
        if unit not in _UNITS[name]:
            raise ValueError(f"{path.name}: {name} must be in {' or '.join(_UNITS[name])}, got {unit!r}")
        found[name] = at, _UNITS[name][unit]
    _require_enough(path, list(found), header)
    return found


def _require_enough(path: Path, names: list[str], header: list[str]) -> None:
    for group in (QUATERNION, POSITION):
        given = [name for name in group if name in names]
        missing = [name for name in group if name not in names]
        if given and missing:
            raise ValueError(f"{path.name} must have {', '.join(group)} together, got no {missing[0]}")
    if "azimuth" in names and "tilt" not in names:
        raise ValueError(f"{path.name} must have tilt where it has azimuth, got no tilt")
    if "time" not in names or not {"tilt", "qw", "x"} & set(names):
        raise ValueError(
            f"{path.name} must have columns time, and tilt and azimuth, or qw, qx, qy and qz, or x, y and z, "
            f"got {listed([title for title in header if title]) or 'none'}"
        )


def _number(path: Path, line: int, title: str, cell: str) -> float:
    if not cell or cell.lower() == "nan":
        return math.nan
    try:
        value = float(cell)
    except ValueError:
        raise ValueError(f"{path.name}, line {line}: {title} must be a number, got {cell[:40]!r}") from None
    if not math.isfinite(value):
        raise ValueError(f"{path.name}, line {line}: {title} must be finite, got {cell!r}")
    return value
