"""Who agrees with whom, as tables: a row and a column for each motion on one support."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rockwobble.models import Run

from ...figures.comparison.view import rows_of
from ..table import Row, number

if TYPE_CHECKING:
    import pandas as pd


def matrix_tables(matrix: pd.DataFrame) -> list[dict[str, Any]]:
    """Return a table for each support: support, rows, and columns as templates have them.

    A cell says for one case how long two agree and by how much their tilts differ; for many in how many of
    them they agree to the end, and the median of the difference.
    """
    return [_table(str(support), part) for support, part in matrix.groupby("support", sort=False)]


def _table(support: str, part: pd.DataFrame) -> dict[str, Any]:
    labels = list(dict.fromkeys(part["run"]))
    cells = {pair: _cell(rows) for pair, rows in part.groupby(["run", "other"], sort=False)}
    rows: list[Row] = [
        {"run": _short(run, support), **{other: cells.get((run, other)) for other in labels}}
        for run in labels
    ]
    columns = [[label, _short(label, support), "words"] for label in labels]
    return {"support": support, "rows": rows, "columns": [["run", support, "words"], *columns]}


def _cell(rows: pd.DataFrame) -> str:
    difference = number(float(rows["tilt_rms_relative"].median()), ".1e")
    if len(rows) == 1:
        (row,) = rows_of(rows)
        return f"{row.agreement_time:.2f}{'' if row.diverged else '+'}, {difference}"
    return f"{int((~rows['diverged']).sum())} of {len(rows)}, {difference}"


def _short(label: str, support: str) -> str:
    return "model" if label == str(Run(None, support)) else label.removesuffix(f" {support}")
