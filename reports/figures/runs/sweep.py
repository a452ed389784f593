"""Peak tilts of a sweep: maps over size and scale of a grid, distributions over the cases of a suite."""

from __future__ import annotations

import math
from itertools import islice

import pandas as pd

from rockwobble.compare import Sweep
from rockwobble.compare.runs.labels import REDUCED

from ..ensemble import distributions
from ..heat import PEAKS, names, peak_map
from ..picture import Array, Axis, Panel, Picture

# maps of a picture, cells of a map: more are not to be seen, and a page holds them
_MOST_MAPS, _MOST_CELLS = 6, 20_000
_NAMED = 12  # so many values have a tick each


def pictures(found: Sweep) -> list[Picture]:
    """Return a map of each part of a grid, or of cases the distribution of their peaks by each run."""
    return [_maps(found) if "model" in found.table else _distributions(found.table)]


def _maps(found: Sweep) -> Picture:
    parts = found.table.groupby(found.keys, sort=False)
    step = math.ceil(math.sqrt(len(found.table) / len(parts) / _MOST_CELLS))
    panels = [_map(own, step) for _, own in islice(parts, _MOST_MAPS)]
    left_out = f" Of each {step} sizes and scales one is shown." if step > 1 else ""
    left_out += f" The first {_MOST_MAPS} of {len(parts)} maps." if len(parts) > _MOST_MAPS else ""
    return Picture(
        name="sweep",
        title="Peak tilt of sizes under scaled records",
        caption="Each cell is a run. What overturns has a colour of its own, what does not uplift none."
        + left_out,
        panels=panels,
        columns=min(2, len(panels)),
        shades=PEAKS,
    )


def _map(own: pd.DataFrame, step: int) -> Panel:
    first = own.iloc[0]
    # one row a cell, as in every map
    tilts, outcomes = (
        own.pivot(index="scale", columns="semidiagonal", values=value)  # noqa: PD010
        for value in ("peak_tilt_over_alpha", "outcome")
    )
    tilts, outcomes = tilts.iloc[::step, ::step], outcomes.iloc[::step, ::step]
    x, x_axis = _axis(tilts.columns, "R", "m")
    y, y_axis = _axis(tilts.index, "scale of the record", "-")
    return Panel(
        x=x_axis,
        y=y_axis,
        layers=[peak_map(x, y, tilts.to_numpy(float), (outcomes == "overturned").to_numpy())],
        title=f"{first['motion']}, {first['model']}, tan α = {first['tan_alpha']:g}",
        height=3.2,
    )


def _axis(values: pd.Index, label: str, unit: str) -> tuple[Array, Axis]:
    """Return the places of values and their axis: few are named, side by side."""
    known = values.to_numpy(float)
    places, ticks = names(known.tolist()) if len(known) <= _NAMED else (known, [])
    return places, Axis(label=label, unit=unit, ticks=ticks)


def _distributions(table: pd.DataFrame) -> Picture:
    members = table.drop(columns="peak_tilt").rename(
        columns={"run": "method", "case": "member", "peak_tilt_over_alpha": "peak_tilt"}
    )
    models = members.loc[members["engine"] == REDUCED, "method"].unique()
    return Picture(
        name="sweep",
        title="Distributions of peak tilt over the cases, by run",
        caption="Share of the cases whose peak tilt is at most that of the axis; what a curve lacks to 1 at "
        "the triangle overturns.",
        panels=[distributions(members, list(models), "cases")],
    )
