"""Ground motions of a folder of records with a table."""

from __future__ import annotations

import csv
from collections.abc import Mapping
from pathlib import Path

from ..ground_motion import GroundMotion
from .files import ZERO, read_record

TABLE = "records.csv"
_COLUMNS, _NEEDED = ("name", "x", "y", "z", "units", "scale"), ("x", "y")


def read_records(
    folder: str | Path, *, units: str | None = None, resample: bool = False
) -> list[GroundMotion]:
    r"""Return the ground motions of a folder, as its records.csv lists them.

    A row for each motion, with the columns x and y, the files of the two horizontal components beside the
    table (PEER AT2, two-column text or CSV; "zero" is a component of zeros), and maybe z (vertical), name,
    units and scale.

    Parameters
    ----------
    folder : str or Path
        Or the table itself.
    units : {"g", "m/s2", "cm/s2"}, optional
        Of the files that do not say, where the table has no units.
    resample : bool, optional
        Take components of different time steps at one that divides all, as `read_record` does.

    Returns
    -------
    list of GroundMotion

    Raises
    ------
    ValueError
        If there is no such table, a column is missing or unknown, or a record cannot be read: the row is
        named.

    Examples
    --------
    >>> import tempfile
    >>> from pathlib import Path
    >>> folder = Path(tempfile.mkdtemp())
    >>> _ = (folder / "east.csv").write_text("0.00, 0.0\n0.01, 0.5\n0.02, 0.0\n")
    >>> _ = (folder / "records.csv").write_text("x,y,name,units\neast.csv,zero,pulse,m/s2\n")
    >>> [(motion.name, motion.peak) for motion in read_records(folder)]
    [('pulse', 0.5)]
    """
    path = Path(folder)
    path = path / TABLE if path.is_dir() else path
    try:
        with path.open(newline="", encoding="utf-8-sig") as file:
            reader = csv.DictReader(file)
            columns = list(reader.fieldnames or ())
            rows = [(reader.line_num, row) for row in reader]
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        reason = getattr(error, "strerror", None) or error
        raise ValueError(f"the table of records {path} cannot be read: {reason}") from None
    wrong = [column for column in columns if column not in _COLUMNS]
    missing = [column for column in _NEEDED if column not in columns]
    if wrong or missing:
        raise ValueError(
            f"{path} must have the columns x and y, and may have z, name, units and scale, "
            f"got {', '.join(columns) or 'none'}"
        )
    if not rows:
        raise ValueError(f"{path} must list ground motions, one in a line, got none")
    motions = []
    for number, row in rows:
        try:
            motions.append(_motion(path.parent, row, units, resample))
        except ValueError as error:
            raise ValueError(f"{path.name}, line {number}: {error}") from None
    return motions


def _place(folder: Path, name: str | None) -> str | Path | None:
    return name if name == ZERO else folder / name if name else None


def _motion(
    folder: Path, row: Mapping[str | None, str | list[str]], units: str | None, resample: bool
) -> GroundMotion:
    beyond = list(row.get(None, ()))  # cells under no column
    if any(cell.strip() for cell in beyond):
        raise ValueError(f"must have {len(row) - 1} cells, got {len(row) - 1 + len(beyond)}")
    cells = {name: (cell or "").strip() for name, cell in row.items() if isinstance(cell, str)}
    if not (cells.get("x") and cells.get("y")):
        raise ValueError("both horizontal components are needed, x and y")
    x, y, z = (_place(folder, cells.get(name)) for name in ("x", "y", "z"))
    assert x is not None
    assert y is not None
    motion = read_record(
        x, y, z, units=cells.get("units") or units, name=cells.get("name") or None, resample=resample
    )
    if not cells.get("scale"):
        return motion
    try:
        factor = float(cells["scale"])
    except ValueError:
        factor = 0.0
    if not 0.0 < factor < float("inf"):
        raise ValueError(f"scale must be a positive number, got {cells['scale']!r}")
    return motion.scaled(factor)
