"""The main columns of the summary, for a terminal."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import pandas as pd
    from rich.table import Table

# narrower than this, the table leaves out its least columns
WIDE = 96
MINIMUM_WIDTH = 100


def summary_table(summary: pd.DataFrame, width: int) -> Table:
    """Return the table for a terminal of `width` columns."""
    from rich import box
    from rich.table import Table
    from rich.text import Text

    wide = width >= WIDE
    chosen = [column for column in _COLUMNS if wide or column.always]
    table = Table(box=box.SIMPLE_HEAD, padding=0, show_edge=False)
    table.add_column("run", no_wrap=True)
    table.add_column("against", overflow="fold")
    for column in chosen:
        # as a text, because brackets are markup
        table.add_column(Text(f"{column.title}\n[{column.unit}]"), justify="right", no_wrap=True)
    for _, row in summary.iterrows():
        against = row.reference.removesuffix(" model").removesuffix("-ground")
        table.add_row(row.run, against, *(column.cell(row) for column in chosen))
    return table


def external_table(titles: Sequence[tuple[str, str]], lines: Sequence[Sequence[str]]) -> Table:
    """Return the table of external trajectories, of columns with a heading and a unit."""
    from rich import box
    from rich.table import Table
    from rich.text import Text

    table = Table(box=box.SIMPLE_HEAD, padding=0, show_edge=False)
    for title, unit in titles:
        # as a text, because brackets are markup
        heading = Text(f"{title}\n[{unit}]" if unit else title)
        table.add_column(heading, justify="right" if unit else "left", no_wrap=bool(unit))
    for cells in lines:
        table.add_row(*cells)
    return table


@dataclass(frozen=True, slots=True)
class _Column:
    title: str
    unit: str
    always: bool  # also in a narrow terminal
    cell: Callable[[Any], str]


def _tilt(value: float, outcome: str) -> str:
    if outcome in ("overturned", "failed"):
        return {"overturned": "over", "failed": "failed"}[outcome]
    return _fixed(value, 3)


def _fixed(value: float, digits: int) -> str:
    return f"{value:.{digits}f}" if math.isfinite(value) else "-"


def _per_cent(share: float) -> str:
    value = 100.0 * share
    return _fixed(value, 0 if value >= 10.0 else 1 if value >= 1.0 else 3)


def _powers(value: float) -> str:
    return _fixed(value, 3) if value >= 1e-3 else f"{value:.0e}" if math.isfinite(value) else "-"


_COLUMNS = (
    _Column("peak", "α", True, lambda row: _tilt(row.peak_tilt, row.outcome)),
    _Column("model", "α", True, lambda row: _tilt(row.reference_peak_tilt, row.reference_outcome)),
    _Column("RMS", "%", True, lambda row: _per_cent(row.tilt_rms_relative)),
    _Column("agrees", "s", True, lambda row: f"{row.agreement_time:.2f}{' ' if row.diverged else '+'}"),
    _Column("passes", "-", False, lambda row: str(row.agreed_passes)),
    _Column("predicted", "s", True, lambda row: _fixed(row.predicted_agreement_time, 2)),
    _Column("turn", "deg", False, lambda row: _fixed(row.turn_difference, 2)),
    _Column("moved", "b", True, lambda row: _powers(row.residual_displacement)),
    _Column("twist", "deg", True, lambda row: _fixed(row.residual_twist, 2)),
    _Column("time", "s", True, lambda row: _fixed(row.wall_time, 1)),
    _Column("ratio", "-", False, lambda row: _fixed(row.time_ratio, 0)),
)


LEGEND = (
    "peak, model: largest tilt of the run and of the reduced model. RMS: tilt difference over tilt. "
    "agrees: until the tilts differ by 1 % of alpha (+ they never do). predicted: when the "
    "reduced models say that they have to diverge. moved, twist: how the cylinder stands at the end. "
    "time: computing time of the engine. ratio: the same over that of the reduced model."
)
EXTERNAL_LEGEND = (
    "External trajectories against the model. azimuth, path: root mean square of the difference while the "
    "tilts agree, and from when it is above its bound (- it is not, or nothing is known). uplift, towards: "
    "difference of time and azimuth of the uplift, ± what the samples leave open. noise: scatter of samples."
)
