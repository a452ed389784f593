"""Ground motions of a folder of records: with a table records.csv, or as downloaded from PEER."""

from __future__ import annotations

import csv
import io
import re
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

from ..argument_kinds import with_argument_kinds
from ..ground_motion import GroundMotion
from .component import bytes_of
from .directions import DirectionError
from .files import ZERO, record_of
from .reading import Reading

TABLE = "records.csv"
PEER_TABLE = "_SearchResults.csv"
_COLUMNS = ("name", "record", "x", "y", "z", "scale", "level", "units")


#: Cells by column; surplus cells under None.
Row = Mapping[str | None, str | list[str]]


@with_argument_kinds
def read_records(
    folder: str | Path,
    reading: Reading | None = None,
) -> list[GroundMotion]:
    r"""Return the ground motions of a folder, as its records.csv lists them, or all of a download from PEER.

    A row of records.csv is a motion: columns x and y, the files of the two horizontal components beside the
    table ("zero" is a component of zeros) and maybe z (vertical), or record, a file or folder of all
    components; and maybe name, scale, level (see `read_records_by_level`) and units, which count before those
    given here.

    A folder without one that holds the _SearchResults.csv of PEER, or files named ``RSN6_...``, is read as it
    comes: the files of one record sequence number are one motion, unscaled, with its vertical component where
    that is there.

    Parameters
    ----------
    folder : str or Path
        Or the table itself.
    reading : Reading, optional
        How the files are read. Default: by what they say.

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
    path, reading = Path(folder), reading or Reading()
    if path.name.endswith(PEER_TABLE):
        return _peer_motions(path.parent, reading)
    if path.is_dir() and not (path / TABLE).exists() and any(_stations(path)):
        return _peer_motions(path, reading)
    path = path / TABLE if path.is_dir() else path
    columns, rows = _table(path)
    if set(columns) - set(_COLUMNS) or not ({"x", "y"} <= set(columns) or "record" in columns):
        raise ValueError(
            f"{path} must have the columns x and y, or record, and may have z, name, scale, level and units "
            f"(other options are those of all rows), got {', '.join(columns)[:100] or 'none'}"
        )
    if not rows:
        raise ValueError(f"{path} must list ground motions, one in a line, got none")
    motions: list[GroundMotion] = []
    for number, row in rows:
        try:
            _positive("level", row.get("level"))  # refused with its row
            motions.append(_motion(path.parent, row, reading))
        except ValueError as error:
            raise ValueError(f"{path.name}, line {number}: {error}") from None
    return motions


@with_argument_kinds
def read_records_by_level(
    folder: str | Path,
    reading: Reading | None = None,
) -> dict[float, list[GroundMotion]]:
    r"""Return the ground motions of a folder by the column level of its records.csv: multiple stripes.

    Parameters
    ----------
    folder : str or Path
        Or the table itself.
    reading : Reading, optional
        As of `read_records`.

    Returns
    -------
    dict of float to list of GroundMotion
        Empty where the table has no column level.

    Raises
    ------
    ValueError
        As of `read_records`; if a level is not positive, or some rows have one and others not.

    Examples
    --------
    >>> import tempfile
    >>> folder = Path(tempfile.mkdtemp())
    >>> _ = (folder / "east.csv").write_text("0.00, 0.0\n0.01, 0.5\n0.02, 0.0\n")
    >>> rows = "0.2,east.csv,zero,weak,m/s2\n0.6,east.csv,zero,strong,m/s2\n"
    >>> _ = (folder / "records.csv").write_text("level,x,y,name,units\n" + rows)
    >>> {level: motions[0].name for level, motions in read_records_by_level(folder).items()}
    {0.2: 'weak', 0.6: 'strong'}
    """
    table = Path(folder) / TABLE if Path(folder).is_dir() else Path(folder)
    if not table.exists() or table.name.endswith(PEER_TABLE):
        return {}
    columns, rows = _table(table)
    if "level" not in columns:
        return {}
    levels = [_positive("level", row.get("level")) for _, row in rows]
    if 0 < (without := levels.count(None)) < len(levels):
        raise ValueError(f"each row must have a level, or none: {without} of {len(levels)} have none")
    motions: dict[float, list[GroundMotion]] = {}
    for motion, level in zip(read_records(table, reading), levels, strict=True):
        if level is not None:
            motions.setdefault(level, []).append(motion)
    return motions


def _text(path: Path) -> io.StringIO:
    try:
        return io.StringIO(bytes_of(path).decode("utf-8-sig"), newline="")
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or error
        raise ValueError(f"the table of records {path} cannot be read: {reason}") from None


def _table(path: Path) -> tuple[list[str], list[tuple[int, Row]]]:
    """Columns of records.csv, and number and cells of each row."""
    text = _text(path)
    first = text.readline()
    text.seek(0)
    reader = csv.DictReader(text, delimiter=";" if ";" in first and "," not in first else ",")
    try:
        columns = [column.strip().lower() for column in reader.fieldnames or ()]
        reader.fieldnames = columns
        return columns, [(reader.line_num, dict(row)) for row in reader]
    except csv.Error as error:
        raise ValueError(f"the table of records {path} cannot be read: {error}") from None


def _motion(folder: Path, row: Row, reading: Reading) -> GroundMotion:
    beyond = list(row.get(None, ()))  # surplus cells, beyond the last column
    if any(cell.strip() for cell in beyond):
        raise ValueError(f"must have {len(row) - 1} cells, got {len(row) - 1 + len(beyond)}")
    cells = {name: (cell or "").strip() for name, cell in row.items() if isinstance(cell, str)}
    reading = replace(reading, units=cells.get("units") or reading.units)
    name = cells.get("name") or None
    if cells.get("record"):
        if any(cells.get(axis) for axis in "xyz"):
            raise ValueError("record holds all components, got x, y or z beside it")
        motion = record_of(folder / cells["record"], None, None, reading, name)
    else:
        parts = {axis: cells[axis] for axis in "xyz" if cells.get(axis)}
        if not {"x", "y"} <= parts.keys():
            raise ValueError("both horizontal components are needed, x and y")
        paths = {axis: part if part == ZERO else folder / part for axis, part in parts.items()}
        motion = record_of(paths["x"], paths["y"], paths.get("z"), reading, name)
    factor = _positive("scale", cells.get("scale"))
    return motion if factor is None else motion.scaled(factor)


def _positive(name: str, cell: object) -> float | None:
    """Return the number of a cell, None of an empty one."""
    text = str(cell or "").strip()
    if not text:
        return None
    try:
        value = float(text)
    except ValueError:
        value = 0.0
    if not 0.0 < value < float("inf"):
        raise ValueError(f"{name} must be a positive number, got {text!r}")
    return value


_RSN = re.compile(r"RSN(\d{1,6})_.*\.AT2", re.IGNORECASE)


def _stations(folder: Path) -> tuple[list[tuple[str, list[Path]]], bool]:
    """Name and AT2 files of each record of a PEER folder, and whether its table lists them."""
    paths = sorted(folder.iterdir())
    tables = [path for path in paths if path.name.endswith(PEER_TABLE)]
    if tables:
        return _listed_stations(tables[0]), True
    groups: dict[int, list[Path]] = {}
    for path in paths:
        if number := _RSN.fullmatch(path.name):
            groups.setdefault(int(number[1]), []).append(path)
    return [(f"RSN{number}", groups[number]) for number in sorted(groups)], False


def _listed_stations(table: Path) -> list[tuple[str, list[Path]]]:
    # a blank before a quoted name does not belong to it
    rows = [[cell.strip() for cell in row] for row in csv.reader(_text(table), skipinitialspace=True)]
    head = next((at for at, row in enumerate(rows) if any("filename" in cell.lower() for cell in row)), 0)

    def column(*words: str) -> int | None:
        titles = enumerate(rows[head] if rows else ())
        return next((at for at, title in titles if all(word in title.lower() for word in words)), None)

    number, event, station = column("sequence number"), column("earthquake"), column("station name")
    wanted = [column(place, "filename") for place in ("horizontal-1", "horizontal-2", "vertical")]
    if None in wanted[:2]:
        raise ValueError(
            f"{table} of PEER must have the columns 'Horizontal-1 Acc. Filename' and 'Horizontal-2 Acc. ...'"
        )
    places = [at for at in wanted if at is not None]
    here = {path.name.lower(): path for path in table.parent.iterdir()}
    entries: list[tuple[str, list[Path]]] = []
    for cells in rows[head + 1 :]:
        if len(cells) <= max(places):
            if entries:
                break  # end of this table, before the next
            continue
        names = [cells[at].replace("\\", "/").rpartition("/")[2] for at in places]
        files = [
            here.get(name.lower(), table.parent / name) for name in names if name.lower().endswith(".at2")
        ]
        words = [f"RSN{cells[number]}" if number is not None else ""]
        words += [cells[at].strip('"') for at in (event, station) if at is not None]
        entries.append((", ".join(filter(None, words)), files))
    return entries


def _peer_motions(folder: Path, reading: Reading) -> list[GroundMotion]:
    stations, listed = _stations(folder)
    if not stations:
        raise ValueError(f"the table of PEER in {folder} lists no records")
    # a download without any vertical component is one of horizontal motions
    verticals = any(path.exists() for _, paths in stations for path in paths[2:])
    motions = []
    for name, paths in stations:
        files = paths if verticals else paths[:2]
        try:
            motions.append(_of_station(files, name, reading, listed=listed))
        except ValueError as error:
            raise ValueError(f"{name}: {error}") from None
    return motions


def _of_station(paths: Sequence[Path], name: str, reading: Reading, *, listed: bool) -> GroundMotion:
    if not 2 <= len(paths) <= 3:
        raise ValueError(f"must have two or three files, got {', '.join(path.name for path in paths)[:120]}")
    try:
        return record_of(paths, None, None, reading, name)
    except DirectionError:
        if not listed:
            raise
    # titles such as L and T: the table distinguishes horizontal from vertical
    motion = record_of(paths[0], paths[1], paths[2] if paths[2:] else None, reading, name)
    order = "x is horizontal 1 and y horizontal 2 of the table, their azimuths are not stated"
    return motion.with_samples(motion.acceleration, order)
