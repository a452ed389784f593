"""The result of many cases in a terminal: one line for each group of cases and run, the worst first."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from ...figures.case_view import own_rows
from ..case_words import group_of
from ..template import the

if TYPE_CHECKING:
    import pandas as pd
    from rich.table import Table

# cases shown by name below the groups
_NAMED = 10
_TITLES = ("cases\n[-]", "agree\n[-]", "least\n[%]", "RMS\n[%]", "worst\n[%]", "peak\n[α]", "time\n[s]")
LEGEND = (
    "Each run against the model of its support, in a ring against the recess model. agree: cases whose tilts "
    "differ by less than 1 % of alpha to the end. least: shortest agreement over the length of the run. RMS, "
    "worst: median and largest tilt difference over tilt. peak: largest difference of peak tilts. time: "
    "computing time of the engine."
)


def group_table(summary: pd.DataFrame, lengths: Mapping[str, float]) -> Table:
    """Return one line for each group of cases and run.

    Parameters
    ----------
    summary : DataFrame
        That of the comparison.
    lengths : mapping
        Length of the run of each case [s].
    """
    from rich import box
    from rich.table import Table
    from rich.text import Text

    table = Table(box=box.SIMPLE_HEAD, padding=0, show_edge=False)
    table.add_column("group of cases", overflow="fold")
    table.add_column("run", no_wrap=True)
    for title in _TITLES:
        # as a text, because brackets are markup
        table.add_column(Text(title), justify="right", no_wrap=True)
    rows = _with_shares(summary, lengths)
    shortest = rows.groupby("group")["share"].min().sort_values(kind="stable")
    for group in shortest.index:
        inside = rows[rows["group"] == group]
        for index, run in enumerate(inside["run"].unique()):
            # a group may have a name with brackets
            table.add_row(Text(group if index == 0 else ""), run, *_cells(inside[inside["run"] == run]))
    return table


def worst_cases(summary: pd.DataFrame, lengths: Mapping[str, float]) -> list[str]:
    """Return a line for each of the runs that part first, the worst first."""
    rows = _with_shares(summary, lengths)
    diverged = rows[rows["diverged"]].sort_values("share", kind="stable")
    lines = [
        f"{row.case}: {row.run} agrees with {the(row.reference)} for {row.agreement_time:.2f} s "
        f"of {lengths[row.case]:.4g} s"
        for _, row in diverged.head(_NAMED).iterrows()
    ]
    if len(diverged) > _NAMED:
        lines.append(f"and {len(diverged) - _NAMED} more, see summary.csv")
    return lines


def worst_first(summary: pd.DataFrame, lengths: Mapping[str, float]) -> list[dict[str, Any]]:
    """Return what the overview of a page says of each case: its worst run, and the worst case first."""
    rows = _with_shares(summary, lengths)
    order = {name: index for index, name in enumerate(lengths)}
    worst = rows.sort_values(["share", "tilt_rms_relative"], ascending=[True, False], kind="stable")
    return [
        {
            "case": row["case"],
            "index": order[row["case"]],
            "run": row["run"],
            "diverged": bool(row["diverged"]),
            "agrees": f"{row['agreement_time']:.2f}",
            "length": f"{lengths[row['case']]:.4g}",
            "rms": _number(100.0 * row["tilt_rms_relative"]),
            "peak": _number(abs(row["peak_tilt_difference"])),
        }
        for _, row in worst.drop_duplicates("case").iterrows()
    ]


def suite_headline(summary: pd.DataFrame) -> str:
    """Return how many runs agree to their end, and with what."""
    rows = own_rows(summary)
    agree, failed = int((~rows["diverged"]).sum()), int((rows["outcome"] == "failed").sum())
    words = f"{agree} of {len(rows)} runs stay within 1 % of alpha of the model of their support to the end"
    return f"{words}; {failed} failed." if failed else f"{words}."


def _with_shares(summary: pd.DataFrame, lengths: Mapping[str, float]) -> pd.DataFrame:
    """Add the group of each case, and the share of the run for which the tilts agree."""
    rows = own_rows(summary)
    share = (rows["agreement_time"] / rows["case"].map(lengths)).clip(upper=1.0)
    return rows.assign(group=rows["case"].map(group_of), share=share.where(rows["diverged"], 1.0))


def _cells(rows: pd.DataFrame) -> list[str]:
    rms = 100.0 * rows["tilt_rms_relative"]
    return [
        str(len(rows)),
        str(int((~rows["diverged"]).sum())),
        f"{100.0 * float(rows['share'].min()):.0f}",
        _number(float(rms.median())),
        _number(float(rms.max())),
        _number(float(rows["peak_tilt_difference"].abs().max())),
        f"{rows['wall_time'].sum():.0f}" if bool(rows["wall_time"].notna().any()) else "-",
    ]


def _number(value: Any) -> str:
    return f"{value:.2g}" if math.isfinite(value) else "-"
