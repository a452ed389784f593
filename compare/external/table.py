"""Trajectories from a shake table or another code, as CSV files.

A header line names the columns, in any order, separated by commas, semicolons or tabs; lines that begin
with # are comments. Units stand behind a name in brackets: "time [s], tilt [deg], azimuth [deg]".

============== ============ =======================================================================
column         unit         meaning
============== ============ =======================================================================
run            none         name of the run, where a file holds several
time           s, ms        s where the header is silent; or since 1970, in s, ms, us or ns
tilt           rad, deg     angle of the axis from the vertical; a negative one, as of a planar test,
                            leans to the side opposite to its azimuth
azimuth        rad, deg     direction of the lean, counter-clockwise from x (east) as seen from above;
                            may be empty where the cylinder stands
qw, qx, qy, qz none         turn from the upright cylinder to its pose, scalar first, z up
x, y, z        m, cm, mm    mass centre from the original base centre, which moves with the ground;
                            m where the header is silent
============== ============ =======================================================================

A column that is not named so is read by the end of its title, as pose.orientation.w, Can_QX, posX or q0.
The run.csv of `rockwobble simulate` is read as it is: its names have one unit each, its rolling angle is the
azimuth, and its centre x, y and z.

There must be time, and one of: tilt, with or without azimuth; the quaternions; x, y and z. What is not there
is not compared. Other columns are not read, and named. A line with a time and nothing else is a sample that
was lost.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
Rows = Sequence[tuple[int, list[str]]]  # number and cells of each line
Stated = dict[str, tuple[int, str | None]]  # position and unit of each known column, by name
Values = dict[str, Array]  # columns of one run by name, in SI units and radians

QUATERNION = ("qw", "qx", "qy", "qz")
POSITION = ("x", "y", "z")
ANGLE_UNITS = {"rad": 1.0, "deg": math.pi / 180.0}
COLUMN_UNITS = {
    "time": {"s": 1.0, "sec": 1.0, "seconds": 1.0, "ms": 1e-3},
    "tilt": ANGLE_UNITS,
    "azimuth": ANGLE_UNITS,
    **{name: {"-": 1.0, "": 1.0} for name in QUATERNION},
    **{name: {"m": 1.0, "cm": 1e-2, "mm": 1e-3} for name in POSITION},
}
SILENT_UNITS = {"time": "s", **dict.fromkeys(QUATERNION, ""), **dict.fromkeys(POSITION, "m")}
# header names of a run table of rockwobble, and the columns they are here
OWN_TITLES = {
    "time": "time [s]",
    "tilt": "tilt [rad]",
    "rolling_angle": "azimuth [rad]",
    "centre_x": "x [m]",
    "centre_y": "y [m]",
    "centre_z": "z [m]",
}
# ends of titles, after a mark that is no letter
_BEFORE_AXIS = {
    QUATERNION: "q|quat|quaternion|ori|orientation|rot|rotation",
    POSITION: "t|pos|position|translation",
}
ENDS = {
    "time": "t|time|timestamp|seconds|elapsed",
    **{
        name: rf"(?:{before})[\W_]?{name[-1]}" + (f"|q{at}" if names == QUATERNION else "")
        for names, before in _BEFORE_AXIS.items()
        for at, name in enumerate(names)
    },
}
# columns named by an option, by their number, in this order
IN_ORDER = {
    len(names): names
    for names in (
        ("time", "tilt"),
        ("time", "tilt", "azimuth"),
        ("time", *POSITION),
        ("time", *QUATERNION),
        ("time", *QUATERNION, *POSITION),
    )
}
LISTED = 80  # characters of a list of names in a message
FEWEST_SAMPLES = 3


@dataclass(frozen=True, slots=True, eq=False)
class Table:
    """Samples of one run in a file.

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

    def require(self, holds: Mask, reason: str, *values: Array | float) -> None:
        """Refuse the first sample where a condition (n,) does not hold, with its line number.

        Raises
        ------
        ValueError
            With the `reason`, a format of the `values` at that sample.
        """
        if not holds.all():
            at = int(np.argmin(holds))
            there = (value[at] if isinstance(value, np.ndarray) else value for value in values)
            raise ValueError(f"{self.name}, line {self.lines[at]}: {reason.format(*there)}")

    def complete(self, column: str, where: Mask | None = None) -> Array:
        """Column with a value in each sample, or in those where `where` (n,) is true."""
        known = ~np.isnan(self.values[column])
        self.require(known if where is None else known | ~where, f"{column} is missing")
        return self.values[column]


def name_list(names: Sequence[str]) -> str:
    """Names for a message, as many as fit and the number of others.

    Examples
    --------
    >>> name_list(["strain", "force"]), name_list(["strain"] * 20)[-26:]
    ('strain, force', 'strain, strain and 10 more')
    """
    count = next((n for n in range(len(names), 1, -1) if len(", ".join(names[:n])) <= LISTED), len(names[:1]))
    more = f" and {len(names) - count} more" if count < len(names) else ""
    return ", ".join(name[:LISTED] for name in names[:count]) + more


def read_tables(path: Path, angle_unit: str | None = None, columns: Sequence[str] = ()) -> dict[str, Table]:
    """Runs of a CSV file by name, "" where it has no column `run`.

    Parameters
    ----------
    path : Path
    angle_unit : {"rad", "deg"}, optional
        Unit of angles where the header is silent.
    columns : sequence of str, optional
        Titles or numbers of the columns of `IN_ORDER`, each with its unit where the header is silent.

    Raises
    ------
    ValueError
        If the file cannot be read, a column is missing or in an unknown unit, or a cell is no number.
    """
    if angle_unit not in (None, *ANGLE_UNITS):
        raise ValueError(f"the unit of angles must be one of {', '.join(ANGLE_UNITS)}, got {angle_unit!r}")
    if path.is_char_device() or path.is_fifo():  # which may never end
        raise ValueError(f"cannot read the trajectory {path}: it is no file")
    try:
        lines = path.read_text(encoding="utf-8-sig").splitlines()
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or "it is no text"
        raise ValueError(f"cannot read the trajectory {path}: {reason}") from None
    file, rows = path.name, list(_rows(lines))
    header, stated, below = _chosen(file, rows, columns) if columns else _named(file, rows)
    places = {name: (at, _factor(file, name, unit, angle_unit)) for name, (at, unit) in stated.items()}
    run_at = header.index("run") if "run" in header else None
    samples: dict[str, list[tuple[int, list[float]]]] = {}
    for number, cells in rows[below:]:
        if len(cells) != len(header):
            raise ValueError(
                f"{file}, line {number}: expected {len(header)} cells as in the header, got {len(cells)}"
            )
        values = [_number(file, number, header[at], cells[at]) * unit for at, unit in places.values()]
        samples.setdefault("" if run_at is None else cells[run_at], []).append((number, values))
    read = {run_at, *(at for at, _ in places.values())}
    ignored = tuple(title for at, title in enumerate(header) if title and at not in read)
    return {run: _table(file, list(places), own, ignored) for run, own in (samples or {"": []}).items()}


def _table(
    name: str, columns: list[str], samples: list[tuple[int, list[float]]], ignored: tuple[str, ...]
) -> Table:
    arrays = np.array([values for _, values in samples]).reshape(-1, len(columns))
    known = np.isfinite(arrays)
    kept = ~known[:, columns.index("time")] | (known.sum(axis=1) > 1)
    if np.count_nonzero(kept) < FEWEST_SAMPLES:
        raise ValueError(f"{name} must hold at least {FEWEST_SAMPLES} samples, got {np.count_nonzero(kept)}")
    values = dict(zip(columns, arrays[kept].T, strict=True))
    lines = [line for (line, _), whole in zip(samples, kept, strict=True) if whole]
    return Table(name, lines, values, ignored, len(samples) - len(lines))


def _rows(lines: Sequence[str]) -> Iterator[tuple[int, list[str]]]:
    """Number and cells of each line that is neither empty nor a comment."""
    mark = ""
    for number, line in enumerate(lines, start=1):
        text = line.strip()
        if text and not text.startswith("#"):
            mark = mark or next((candidate for candidate in ";\t" if candidate in text), ",")
            yield number, [cell.strip().strip('"').strip() for cell in line.split(mark)]


def _title(text: str) -> tuple[str, str | None]:
    """Name and unit of a title, the unit in brackets; None without one."""
    match = re.fullmatch(r"(.*?)\s*(?:[\[(]\s*([^\])]*?)\s*[\])])?", text.strip())
    return (match[1], match[2]) if match else (text, None)


def _chosen(file: str, rows: Rows, columns: Sequence[str]) -> tuple[list[str], Stated, int]:
    """Header, position and unit of the columns named by an option, and the number of rows above.

    Raises
    ------
    ValueError
        If as many columns are none of `IN_ORDER`, or no line has them.
    """
    names, asked = IN_ORDER.get(len(columns)), [_title(column) for column in columns]
    if names is None:
        orders = "; ".join(", ".join(each) for each in IN_ORDER.values())
        raise ValueError(f"columns of a trajectory must be {orders}, got {len(columns)}")
    by_number = all(name.isdecimal() for name, _ in asked)
    header = list[str]()
    for at, (_, cells) in enumerate(rows):
        titles = [str(n + 1) if by_number else _title(cell)[0] for n, cell in enumerate(cells)]
        if all(titles.count(name) == 1 for name, _ in asked):
            places = [titles.index(name) for name, _ in asked]
            if by_number and len(header) != len(cells):
                header = [""] * len(cells)
            elif not by_number:
                header = cells
            if not by_number or all(re.fullmatch(r"[-+]?\.?\d.*", cells[place]) for place in places):
                units = [
                    unit or _title(header[place])[1] for (_, unit), place in zip(asked, places, strict=True)
                ]
                return (
                    header,
                    dict(zip(names, zip(places, units, strict=True), strict=True)),
                    at + (not by_number),
                )
        header = cells
    raise ValueError(f"{file} has no line with the columns {', '.join(columns)}, each once")


def _named(file: str, rows: Rows) -> tuple[list[str], Stated, int]:
    """Header, position and unit of its columns by name, and the number of rows above its samples."""
    if not rows:
        raise ValueError(f"the trajectory {file} is empty")
    header = rows[0][1]
    own = set(OWN_TITLES) <= set(header)
    titles = [_title(OWN_TITLES.get(given, given) if own else given) for given in header]
    named = [(name.lower(), at) for at, (name, _) in enumerate(titles) if name.lower() in COLUMN_UNITS]
    exact = {name for name, _ in named}
    for at, (title, _) in enumerate(titles):
        ends = (name for name, end in ENDS.items() if re.fullmatch(rf"(?:.*[\W_])?(?:{end})", title, re.I))
        named += [(name, at) for name in ends if name not in exact]
    known: Stated = {}
    for name, at in named:
        # some components of a quaternion or position without the others are other quantities
        group = next((each for each in (QUATERNION, POSITION) if name in each), (name,))
        if name not in exact and not set(group) <= {each for each, _ in named}:
            continue
        if name in known:
            both = f"{header[known[name][0]]!r} and {header[at]!r}"
            raise ValueError(f"{file} must have each column once, got {name} as {both}: name them by columns")
        known[name] = at, titles[at][1]
    for group in (QUATERNION, POSITION):
        missing = [name for name in group if name not in known]
        if missing and len(missing) < len(group):
            raise ValueError(f"{file} must have {', '.join(group)} together, got no {missing[0]}")
    if "azimuth" in known and "tilt" not in known:
        raise ValueError(f"{file} must have tilt where it has azimuth, got no tilt")
    if "time" not in known or not {"tilt", "qw", "x"} & set(known):
        raise ValueError(
            f"{file} must have columns time, and tilt and azimuth, or qw, qx, qy and qz, or x, y and z, "
            f"got {name_list([each for each in header if each]) or 'none'}; --trajectory-columns names them"
        )
    return header, known, 1


def _factor(file: str, name: str, given: str | None, angle_unit: str | None) -> float:
    """Factor of a column to SI units."""
    unit = SILENT_UNITS.get(name, angle_unit) if given is None else given
    if unit is None:
        raise ValueError(
            f"{file} does not say the unit of {name}: name the column '{name} [deg]' or "
            f"'{name} [rad]', or give the unit of angles"
        )
    if unit.lower() not in COLUMN_UNITS[name]:
        raise ValueError(f"{file}: {name} must be in {' or '.join(COLUMN_UNITS[name])}, got {unit!r}")
    return COLUMN_UNITS[name][unit.lower()]


def _number(file: str, line: int, title: str, cell: str) -> float:
    try:
        value = float(cell or "nan")
    except ValueError:
        raise ValueError(f"{file}, line {line}: {title} must be a number, got {cell[:40]!r}") from None
    if math.isinf(value):
        raise ValueError(f"{file}, line {line}: {title} must be finite, got {cell!r}")
    return value
