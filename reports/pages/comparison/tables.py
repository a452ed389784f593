"""The tables of a comparison: main columns, all columns, many cases together, and the agreement matrix."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import pandas as pd

from rockwobble.compare import SUMMARY_COLUMNS
from rockwobble.compare.external.trajectory import SUPPORT as EXTERNAL
from rockwobble.compare.external.verdict import lists_in_words
from rockwobble.models import Run

from ...figures.comparison.view import CaseView, own_rows, rows_of
from ..table import Row, number
from ..words.cases import group_of
from .findings import CAUSES, cause_of


def main_rows(view: CaseView) -> list[Row]:
    """Return the main columns of the rows of a case; what overturned or failed has a word for its peak."""
    return [
        {
            **row._asdict(),
            "reference": row.reference.removesuffix(" model"),
            "peak": _peak(row.peak_tilt, row.outcome),
            "reference_peak": _peak(row.reference_peak_tilt, row.reference_outcome),
            "agrees": _until(row, row.reference_uplift_time),
            "predicted": min(row.reference_uplift_time + row.predicted_agreement_time, view.case.length),
            "cause": CAUSES[cause_of(view, row)] if row.diverged else None,
        }
        for row in rows_of(view.rows)
    ]


def _until(row: Any, start: float) -> str:
    """Return the end of an agreement within 1 % of alpha, in the time of the run; that of the run with +."""
    return f"{row.agreement_time + start:.2f}" if row.diverged else f"{row.agreement_time:.2f}+"


def _peak(value: float, outcome: str) -> float | str:
    return outcome if outcome in ("overturned", "failed") else value


def external_rows(summary: pd.DataFrame) -> list[Row]:
    """Return one line of numbers and codes for each external trajectory."""
    return [
        {
            **row._asdict(),
            "uplift": row.uplift_time_difference if math.isfinite(row.uplift_time_uncertainty) else None,
            "direction": _degrees(row.uplift_direction_difference, row.uplift_direction_uncertainty),
            "direction_uncertainty": _degrees(
                # beyond half a turn there is nothing left to know
                min(row.uplift_direction_uncertainty, math.pi),
                row.uplift_direction_uncertainty,
            ),
            "differs_in": "; ".join(row.differs_in) or None,
            "likely_mistake": "; ".join(
                f"{part}: {code}"
                for part, code in zip(row.likely_mistake_in, row.likely_mistake, strict=True)
            )
            or None,
        }
        for row in rows_of(summary[summary["support"] == EXTERNAL])
    ]


def _degrees(angle: float, uncertainty: float) -> float | None:
    return math.degrees(angle) if math.isfinite(uncertainty) else None


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
    columns = [[str(index), f"{row.run} − {row.reference}", ".4g"] for index, row in enumerate(found)]
    return lines, [["name", "column", "words"], *columns]


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
    return [
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
        for group in shortest.index
        for run, chosen in rows[rows["group"] == group].groupby("run", sort=False)
    ]


def worst_rows(summary: pd.DataFrame, lengths: Mapping[str, float]) -> list[Row]:
    """Return the worst run of each case, the worst case first, with the place of the case on the page."""
    rows = _with_shares(summary, lengths)
    worst = rows.sort_values(["share", "tilt_rms_relative"], ascending=[True, False], kind="stable")
    places = {name: place for place, name in enumerate(lengths)}
    return [
        {
            **row._asdict(),
            "place": places[row.case],
            "length": lengths[row.case],
            "peak": abs(row.peak_tilt_difference),
            "agrees": f"{row.within_tolerance_until:.2f}{'' if row.left_tolerance else '+'}",
        }
        for row in rows_of(worst.drop_duplicates("case"))
    ]


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
    difference = number(float(rows["tilt_rms_relative"].median()), "percent")
    if len(rows) == 1:
        (row,) = rows_of(rows)
        return f"{_until(row, row.other_uplift_time)} s, {difference}"
    return f"{int((~rows['diverged']).sum())} of {len(rows)}, {difference}"


def _short(label: str, support: str) -> str:
    return "model" if label == str(Run(None, support)) else label.removesuffix(f" {support}")
