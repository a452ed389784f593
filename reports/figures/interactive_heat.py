"""Maps by plotly."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from .heat import NOTHING, Array, Heat, Shades
from .picture import Panel

if TYPE_CHECKING:
    import plotly.graph_objects as go

# numbers in cells as long as a phone has room for them
_MOST_WRITTEN = 42


def small(values: Array) -> NDArray[np.float32]:
    """Return what a page needs of an array: seven digits are more than a screen shows."""
    return np.asarray(values, dtype=np.float32)


def add_heat(drawn: go.Figure, heat: Heat, panel: Panel, shades: Shades) -> None:
    """Add a map to the figure of its panel."""
    edges = heat.edges(log_x=panel.x.log, log_y=panel.y.log)
    written = heat.written and heat.values.size <= _MOST_WRITTEN
    at, words = zip(*shades.ticks(), strict=True)
    drawn.add_heatmap(
        x=edges[0],
        y=edges[1],
        z=small(shades.place(heat.values)),
        texttemplate="%{customdata[3]}" if written else None,
        textfont={"size": 11},
        customdata=_said(heat, panel),
        hovertemplate=f"{panel.x.title}: %{{customdata[0]}}<br>{panel.y.title}: %{{customdata[1]}}<br>"
        f"{shades.title}: %{{customdata[2]}}<extra></extra>",
        zmin=0.0,
        zmax=1.0,
        colorscale=_colours(shades),
        colorbar={
            "thickness": 10,
            "tickvals": list(at),
            "ticktext": list(words),
            "title": {"text": shades.title, "side": "right"},
        },
    )
    for gap in heat.gaps:
        if gap.cells.any():
            layer = np.where(gap.cells, 0.0, np.nan)
            flat = {"colorscale": [[0.0, gap.colour], [1.0, gap.colour]], "showscale": False}
            drawn.add_heatmap(x=edges[0], y=edges[1], z=small(layer), **flat, hoverinfo="skip")
    drawn.update_layout(plot_bgcolor=NOTHING)
    drawn.update_xaxes(showgrid=False, tickangle=0)
    drawn.update_yaxes(showgrid=False)


def _said(heat: Heat, panel: Panel) -> list[list[list[str]]]:
    """Return what is said of each cell: x, y, its value or why there is none, and what is written there."""
    words = dict(panel.x.ticks), dict(panel.y.ticks)
    x, y = (
        [names.get(v, f"{v:.4g}") for v in each] for names, each in zip(words, (heat.x, heat.y), strict=True)
    )
    cells = []
    for (row, column), value in np.ndenumerate(heat.values):
        known = bool(np.isfinite(value))
        why = next((gap.name for gap in heat.gaps if gap.cells[row, column]), "none")
        cells.append([x[column], y[row], f"{value:.3g}" if known else why])
        cells[-1].append(format(value, heat.written) if known and heat.written else "")
    return [cells[i : i + len(x)] for i in range(0, len(cells), len(x))]


def _colours(shades: Shades) -> str | list[list[Any]]:
    from plotly.colors import sample_colorscale

    steps = shades.steps
    if not steps:
        return shades.colours
    colours = sample_colorscale(shades.colours, np.linspace(0.0, 1.0, steps))
    return [[end / steps, colours[i]] for i in range(steps) for end in (i, i + 1)]
