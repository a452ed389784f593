"""All that a report on the limits is made from, as files, and back."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ...storage.origin import Origin, origin_now, pack_study, read_study, read_table
from .campaign import packed
from .extent import Extent
from .motions import ensemble_names, motion_named, source_of
from .parts import PARTS

if TYPE_CHECKING:
    import pandas as pd

KIND = "rockwobble validity"
FILE = "validity.json"


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Validity:
    """What was measured, and what made it.

    Parameters
    ----------
    tables : mapping
        Of all parts, by name.
    extent : Extent
    motions : mapping
        The title of each motion of the maps under shaking, by its name in the tables.
    records : str
        What the motions of the ensemble are.
    origin : Origin
    """

    tables: Mapping[str, pd.DataFrame]
    extent: Extent
    motions: Mapping[str, str]
    records: str
    origin: Origin


def validity_now(tables: Mapping[str, pd.DataFrame], extent: Extent, command: str) -> Validity:
    """Return what has just been measured here, with what made it."""
    return Validity(tables=tables, origin=origin_now(command), **planned(extent))


def planned(extent: Extent) -> dict[str, Any]:
    """Return what a measurement of `extent` takes here: extent, motions and records, by these names."""
    return {
        "extent": extent,
        "motions": {name: motion_named(name).name or name for name in extent.motions},
        "records": source_of(ensemble_names(extent.members)),
    }


def validity_tables(found: Validity) -> dict[str, bytes]:
    """Return the files by name: a table for each part as Parquet, the rest as JSON."""
    about = {"command": found.origin.command, "extent": found.extent.name}
    facts = {
        "extent": dataclasses.asdict(found.extent),
        "motions": dict(found.motions),
        "records": found.records,
    }
    return {
        **{f"{name}.parquet": packed(name, table, about) for name, table in found.tables.items()},
        FILE: pack_study(KIND, found.origin, facts),
    }


def read_validity(folder: str | Path) -> Validity:
    """Return a measurement that was stored; what is installed here has no part in it.

    Raises
    ------
    ValueError
        If a file is missing or is not what was stored.
    """
    place = Path(folder)
    origin, facts = read_study(place / FILE, KIND)
    try:
        extent = Extent(**{name: _frozen(value) for name, value in facts["extent"].items()})
        motions, records = facts["motions"], facts["records"]
    except (KeyError, TypeError, AttributeError) as error:
        raise ValueError(f"{place / FILE} cannot be read: {error}") from None
    tables = {part.name: read_table(place / f"{part.name}.parquet") for part in PARTS}
    return Validity(tables=tables, extent=extent, motions=motions, records=records, origin=origin)


def _frozen(value: Any) -> Any:
    return tuple(_frozen(each) for each in value) if isinstance(value, list) else value
