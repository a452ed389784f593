"""pandas, imported with the first table (a third of a second), and columns of tables."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from importlib.resources import files
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import pandas as pd
else:

    class _Pandas:
        """Names of pandas on first use; a lazy module would show a second thread a part of its names."""

        def __getattr__(self, name: str) -> object:
            import pandas

            return getattr(pandas, name)

    pd = _Pandas()

__all__ = ["column_meanings", "pd"]


def column_meanings(package: str, table: str) -> Mapping[str, tuple[str, str]]:
    """Unit and meaning of each column of a table, as `columns.toml` of a package states them."""
    text = (files(package) / "columns.toml").read_text(encoding="utf-8")
    return {name: (unit, meaning) for name, (unit, meaning) in tomllib.loads(text)[table].items()}
