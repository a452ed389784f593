"""The tables of a comparison: main columns, all columns, many cases together, and who agrees with whom."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import pandas as pd

from rockwobble.compare import SUMMARY_COLUMNS
from rockwobble.compare.external.verdict import lists_in_words
from rockwobble.models import Run

from ...figures.comparison.view import own_rows, rows_of
from ..table import Row, number
from ..words.cases import group_of


def main_rows(rows: pd.DataFrame, length: float) -> list[Row]:
    """Return the main columns of the summary; what fell or failed has a word for its peak.

    Parameters
    ----------
    rows : DataFrame
        Of the summary.
    length : float
        Of the run [s]; times are those of the run.
    """
    return [
        {
            **row._asdict(),
            "against": row.reference.removesuffix(" model").removesuffix("-ground"),
            "peak": _peak(row.peak_tilt, row.outcome),
            "reference_peak": _peak(row.reference_peak_tilt, row.reference_outcome),
            "agrees": _until(row, row.reference_uplift_time, open_end="+", other=" "),
            "predicted": min(row.reference_uplift_time + row.predicted_agreement_time, length),
        }
        for row in rows_of(rows)
    ]


def _until(row: Any, start: float, *, open_end: str, other: str = "") -> str:
    """Return the end of an agreement within 1 % of alpha in the time of the run, or of the run."""
    return f"{row.agreement_time + (start if row.diverged else 0.0):.2f}{other if row.diverged else open_end}"


def _peak(value: float, outcome: str) -> float | str:
    return outcome if outcome in ("overturned", "failed") else value


def all_columns(rows: pd.DataFrame) -> tuple[list[Row], list[list[str]]]:
    """Return a line for each column of the summary, and the columns of that table: one for each row."""
    found = list(rows_of(lists_in_words(rows)))
    lines: list[Row] = [
        {
            "all": "All numbers",
            "name": name.replace("_", " ") + (f" [{unit}]" if unit else ""),
            **{str(index): getattr(row, name) for index, row in enumerate(found)},
        }
        for name, (unit, _) in SUMMARY_COLUMNS.items()
        if name not in ("case", "run", "reference")
    ]
    columns = [[str(index), f"{row.run} against {row.reference}", ".4g"] for index, row in enumerate(found)]
    return lines, [["name", "column", "words"], *columns]


def meanings() -> list[Row]:
    """Return what each column of summary.csv means, and its unit."""
    return [
        {"all": "Columns of summary.csv", "name": name, "unit": unit or "-", "meaning": meaning}
        for name, (unit, meaning) in SUMMARY_COLUMNS.items()
    ]


def group_rows(summary: pd.DataFrame, lengths: Mapping[str, float]) -> list[Row]:
    """Return a line for each group of cases and run, the group with the shortest agreement first.

    Parameters
    ----------
    summary : DataFrame
        That of the comparison.
    lengths : mapping
        Length of the run of each case [s].
    """
    rows = _with_shares(summary, lengths)
    shortest = rows.groupby("group")["share"].min().sort_values(kind="stable")
    found: list[Row] = []
    for group in shortest.index:
        inside = rows[rows["group"] == group]
        for run in inside["run"].unique():
            chosen = inside[inside["run"] == run]
            found.append(
                {
                    "group": group,
                    "run": run,
                    "cases": len(chosen),
                    "agree": int((~chosen["left_tolerance"]).sum()),
                    "least": float(chosen["share"].min()),
                    "rms": float(chosen["tilt_rms_relative"].median()),
                    "worst": float(chosen["tilt_rms_relative"].max()),
                    "peak": float(chosen["peak_tilt_difference"].abs().max()),
                    "time": float(chosen["wall_time"].sum(min_count=1)),
                }
            )
    return found


def worst_first(summary: pd.DataFrame, lengths: Mapping[str, float]) -> list[Any]:
    """Return the worst run of each case, the worst case first; with its share and the length of its run."""
    rows = _with_shares(summary, lengths)
    worst = rows.sort_values(["share", "tilt_rms_relative"], ascending=[True, False], kind="stable")
    order = {name: index for index, name in enumerate(lengths)}
    once = worst.drop_duplicates("case")
    return list(rows_of(once.assign(length=once["case"].map(lengths), place=once["case"].map(order))))


def diverging_runs(summary: pd.DataFrame, lengths: Mapping[str, float]) -> list[Any]:
    """Return the runs that diverge from the model of their support, the first to do so first."""
    rows = _with_shares(summary, lengths)
    found = rows[rows["left_tolerance"]].sort_values("share", kind="stable")
    return list(rows_of(found.assign(length=found["case"].map(lengths))))


def _with_shares(summary: pd.DataFrame, lengths: Mapping[str, float]) -> pd.DataFrame:
    """Add the group of each case, and the share of the run for which the tilts agree."""
    rows = own_rows(summary)
    share = (rows["within_tolerance_until"] / rows["case"].map(lengths)).clip(upper=1.0)
    share = share.where(rows["left_tolerance"], 1.0)
    known = share.where(share.map(math.isfinite), 0.0)
    return rows.assign(group=rows["case"].map(group_of), share=known)


def matrix_tables(matrix: pd.DataFrame) -> list[dict[str, Any]]:
    """Return a table for each support: support, rows, and columns as templates have them.

    A cell says for one case how long two agree and by how much their tilts differ; for many in how many of
    them they agree to the end, and the median of the difference.
    """
    return [_matrix(str(support), part) for support, part in matrix.groupby("support", sort=False)]


def _matrix(support: str, part: pd.DataFrame) -> dict[str, Any]:
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
        return f"{_until(row, row.other_uplift_time, open_end='+')}, {difference}"
    return f"{int((~rows['diverged']).sum())} of {len(rows)}, {difference}"


def _short(label: str, support: str) -> str:
    return "model" if label == str(Run(None, support)) else label.removesuffix(f" {support}")
