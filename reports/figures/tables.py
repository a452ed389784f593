"""Default figures of results: table columns over the first column."""

from __future__ import annotations

from rockwobble.compare.storage.results import Results

from .picture import Axis, Line, Panel, Picture


def pictures(results: Results) -> list[Picture]:
    """Picture of each table with a numeric first column: one panel per other numeric column."""
    drawn = []
    for name, table in getattr(results, "tables", {}).items():
        numbers = table.select_dtypes("number").astype(float)
        if len(numbers.columns) < 2 or numbers.columns[0] != table.columns[0]:
            continue
        x, *others = ((Axis(label=str(key), unit="-"), numbers[key].to_numpy()) for key in numbers)
        panels = [Panel(x=x[0], y=axis, layers=[Line(x=x[1], y=values)]) for axis, values in others]
        drawn.append(Picture(name=str(name), title=str(name).replace("_", " "), caption="", panels=panels))
    return drawn
