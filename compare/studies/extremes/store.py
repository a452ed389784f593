"""A scan of the extremes as files, and back."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from ...storage.origin import Origin, pack_study, read_study, read_table
from ...storage.parquet_file import pack

if TYPE_CHECKING:
    import pandas as pd

KIND = "rockwobble extremes"
FILE = "extremes.json"
_TABLE = "extremes.parquet"


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Extremes:
    """What a scan found, and what made it.

    Parameters
    ----------
    table : DataFrame
        See `measure_extremes`.
    origin : Origin
    """

    table: pd.DataFrame
    origin: Origin


def extremes_tables(found: Extremes) -> dict[str, bytes]:
    """Return the files by name: the table as Parquet, its origin as JSON."""
    return {_TABLE: pack(found.table, {"kind": KIND}), FILE: pack_study(KIND, found.origin, {})}


def read_extremes(folder: str | Path) -> Extremes:
    """Return a scan that was stored.

    Raises
    ------
    ValueError
        If a file is missing or is not what was stored.
    """
    place = Path(folder)
    origin, _ = read_study(place / FILE, KIND)
    return Extremes(table=read_table(place / _TABLE), origin=origin)
