"""The tables of a measurement as files, and back."""

from __future__ import annotations

from pathlib import Path

from ...storage.origin import pack_study, read_study, read_table
from ...storage.parquet_file import pack
from .measure import Tradeoff

KIND = "rockwobble tradeoff"
FILE = "tradeoff.json"
_TABLES = ("points", "scenes", "problems")


def tradeoff_tables(found: Tradeoff) -> dict[str, bytes]:
    """Return the files by name: points, scenes and problems as Parquet, the rest as JSON."""
    files = {f"{name}.parquet": pack(getattr(found, name), {"kind": KIND}) for name in _TABLES}
    return files | {FILE: pack_study(KIND, found.origin, {"rounds": found.rounds, "load": found.load})}


def read_tradeoff(folder: str | Path) -> Tradeoff:
    """Return a measurement that was stored.

    Raises
    ------
    ValueError
        If a file is missing or is not what was stored.
    """
    place = Path(folder)
    origin, facts = read_study(place / FILE, KIND)
    tables = {name: read_table(place / f"{name}.parquet") for name in _TABLES}
    try:
        before, after = facts["load"]
        return Tradeoff(**tables, rounds=facts["rounds"], load=(before, after), origin=origin)
    except (KeyError, TypeError, ValueError) as error:
        raise ValueError(f"{place / FILE} cannot be read: {error}") from None
