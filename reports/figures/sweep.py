"""Peak tilts of a sweep: maps over size and scale of a grid, distributions over suite cases."""

from __future__ import annotations

import math
from itertools import islice

import numpy as np
import pandas as pd

from rockwobble.models.case import REDUCED
from rockwobble.studies import Sweep

from .ensemble import distributions
from .heat import PEAKS, names, peak_map
from .picture import Array, Axis, Panel, Picture, caption

# maps of a picture, cells of a map: more are not to be seen, and a page holds them
_MOST_MAPS, _MOST_CELLS = 6, 20_000
_NAMED = 12  # so many values have a tick each


def pictures(results: Sweep) -> list[Picture]:
    """Map of each part of a grid, or distribution of peaks by run for suite cases."""
    return [_maps(results) if "model" in results.table else _distributions(results.table)]


def _maps(results: Sweep) -> Picture:
    parts = results.table.groupby(results.keys, sort=False)
    sizes, scales = (results.table[name].nunique() for name in ("semidiagonal", "scale"))
    steps = _step(sizes, scales), _step(scales, sizes)
    shown = [own for _, own in islice(parts, _MOST_MAPS)]
    panels = [_map(own, *steps) for own in shown]
    motions = tuple(dict.fromkeys(str(own["motion"].iloc[0]) for own in shown))
    one_in = {
        f"count_{name}": step if step > 1 else None
        for name, step in zip(("sizes", "scales"), steps, strict=True)
    }
    maps = len(parts) if len(parts) > _MOST_MAPS else None
    return Picture(
        name="sweep",
        caption=caption("sweep_maps", names=motions, count=_MOST_MAPS, count_all=maps, **one_in),
        panels=panels,
        columns=min(2, len(panels)),
        shades=PEAKS,
    )


def _step(count: int, other: int) -> int:
    """Stride of the drawn values of an axis, given `other` values on the other axis."""
    side = math.isqrt(_MOST_CELLS)
    return math.ceil(count * min(max(other, 1), side) / _MOST_CELLS) if count > side else 1


def _map(own: pd.DataFrame, step_x: int, step_y: int) -> Panel:
    first = own.iloc[0]
    # one row per cell, as in every map
    tilts, outcomes = (
        own.pivot(index="scale", columns="semidiagonal", values=value)  # noqa: PD010
        for value in ("peak_tilt_over_alpha", "outcome")
    )
    tilts, outcomes = (each.iloc[::step_y, ::step_x] for each in (tilts, outcomes))
    x, x_axis = _axis(tilts.columns.to_numpy(float), "R", "m")
    y, y_axis = _axis(tilts.index.to_numpy(float), "scale of the record", "-")
    return Panel(
        x=x_axis,
        y=y_axis,
        layers=[peak_map(x, y, tilts.to_numpy(float), (outcomes == "overturned").to_numpy())],
        title=f"{first['motion']}, {first['model']}, tan α = {first['tan_alpha']:g}",
        height=3.2,
    )


def _axis(values: Array, label: str, unit: str) -> tuple[Array, Axis]:
    """Positions of values and their axis: few or uneven values are spaced evenly and labelled."""
    steps = np.diff(values)
    if len(values) > _NAMED and np.allclose(steps, steps[0]):
        return values, Axis(label=label, unit=unit)
    places, ticks = names(values.tolist())
    return places, Axis(label=label, unit=unit, ticks=ticks[:: math.ceil(len(ticks) / _NAMED)])


def _distributions(table: pd.DataFrame) -> Picture:
    members = table.drop(columns="peak_tilt").rename(
        columns={"run": "method", "case": "member", "peak_tilt_over_alpha": "peak_tilt"}
    )
    cases = table["case"].unique()
    models = members.loc[members["engine"] == REDUCED, "method"].unique()
    return Picture(
        name="sweep",
        caption=caption("sweep_shares", name=str(cases[0]), count=len(cases) - 1 or None),
        panels=[distributions(members, list(models), "cases")],
    )
