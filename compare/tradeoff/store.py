"""The tables of a measurement as files, and back."""

from __future__ import annotations

import io
import json
from pathlib import Path
from typing import TYPE_CHECKING

from .measure import Tradeoff

if TYPE_CHECKING:
    import pandas as pd

_TABLES = ("points", "scenes", "problems")


def tradeoff_tables(found: Tradeoff) -> dict[str, bytes]:
    """Return the files by name: points, scenes and problems as Parquet, the rest as JSON."""
    files = {f"{name}.parquet": _parquet(getattr(found, name)) for name in _TABLES}
    return files | {"about.json": (json.dumps(found.about, indent=2) + "\n").encode()}


def read_tradeoff(folder: str | Path) -> Tradeoff:
    """Return a measurement that was stored.

    Raises
    ------
    ValueError
        If a file is missing or is not what was stored.
    """
    import pandas as pd

    place = Path(folder)
    names = [f"{name}.parquet" for name in _TABLES] + ["about.json"]
    missing = [name for name in names if not (place / name).is_file()]
    if missing:
        raise ValueError(f"{place} holds no measurement of rockwobble tradeoff: {missing[0]} is missing")
    try:
        tables = {name: pd.read_parquet(place / f"{name}.parquet") for name in _TABLES}
        about = json.loads((place / "about.json").read_text())
    except (OSError, ValueError) as error:
        raise ValueError(f"{place} cannot be read: {error}") from None
    return Tradeoff(**tables, about=about)


def _parquet(table: pd.DataFrame) -> bytes:
    buffer = io.BytesIO()
    table.to_parquet(buffer, index=False)
    return buffer.getvalue()
