"""Numbers of tables over the first column: the figures of results that have none of their own."""

from __future__ import annotations

from rockwobble.compare.storage.results import Results

from .picture import Axis, Line, Panel, Picture


def pictures(results: Results) -> list[Picture]:
    """Return a picture of each table that begins with numbers: a panel for each other column of them."""
    drawn = []
    for name, table in getattr(results, "tables", {}).items():
        numbers = table.select_dtypes("number").astype(float)
        if len(numbers.columns) < 2 or numbers.columns[0] != table.columns[0]:
            continue
        x, *others = ((Axis(label=str(key), unit="-"), numbers[key].to_numpy()) for key in numbers)
        panels = [Panel(x=x[0], y=axis, layers=[Line(x=x[1], y=values)]) for axis, values in others]
        drawn.append(Picture(name=str(name), title=str(name).replace("_", " "), caption="", panels=panels))
    return drawn
