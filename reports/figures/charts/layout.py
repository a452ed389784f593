"""What all figures have in common."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ..palette import Style
from ..thinning import kept_samples

if TYPE_CHECKING:
    import plotly.graph_objects as go

FONT = "system-ui, -apple-system, 'Segoe UI', Roboto, sans-serif"
_GRID = "#dddddd"
TIME_TITLE = "time [s]"


def new_figure(x_title: str, y_title: str, *, height: int = 380, **layout: Any) -> go.Figure:
    """Return an empty figure in the style of the report."""
    import plotly.graph_objects as go

    axis = {"showline": True, "linecolor": "#444444", "gridcolor": _GRID, "zerolinecolor": "#bbbbbb"}
    axis |= {"ticks": "outside", "tickcolor": "#444444", "automargin": True}
    figure = go.Figure()
    figure.update_layout(
        height=height,
        margin={"l": 8, "r": 12, "t": 10, "b": 8},
        font={"family": FONT, "size": 13, "color": "#222222"},
        paper_bgcolor="white",
        plot_bgcolor="white",
        hovermode="closest",
        dragmode="zoom",
        showlegend=True,
        # below the axes, where it takes no width on a phone
        legend={"orientation": "h", "yref": "container", "y": 0.0, "yanchor": "bottom", "x": 0.0},
        xaxis={**axis, "title": {"text": x_title, "standoff": 6}},
        yaxis={**axis, "title": {"text": y_title, "standoff": 6}},
    )
    figure.update_layout(**layout)
    return figure


def add_line(
    figure: go.Figure,
    x: NDArray[np.float64],
    y: NDArray[np.float64],
    name: str,
    style: Style,
    *,
    width: float = 1.5,
    **trace: Any,
) -> None:
    """Add a line over x, thinned to what can be seen."""
    import plotly.graph_objects as go

    keep = kept_samples(y)
    figure.add_trace(
        go.Scatter(
            x=small(x[keep]),
            y=small(y[keep]),
            name=name,
            mode="lines",
            line={"color": style.colour, "dash": style.dash, "width": width},
            **trace,
        )
    )


def small(values: NDArray[np.float64]) -> NDArray[np.float32]:
    """Return what a page needs of an array: seven digits are more than a screen shows."""
    return values.astype(np.float32)


def reserve_legend(figure: go.Figure, entries: int) -> go.Figure:
    """Make the figure higher by what its legend takes on a phone, where it has the most rows."""
    rows = (entries + 1) // 2
    height = figure.layout.height + 22 * rows
    figure.update_layout(height=height, margin_b=8 + 22 * rows)
    return figure
