"""Pictures as plotly figures for the page."""

from __future__ import annotations

import html
from typing import TYPE_CHECKING

import numpy as np

from ...figures.charts.layout import new_figure, reserve_legend
from ..template import PLOT_CONFIG
from .picture import Array, LinePicture, MapPanel, MapPicture, Picture, series_styles

if TYPE_CHECKING:
    import plotly.graph_objects as go

# one hue from light to dark: read alike by every eye, and in black and white
_COLOURS = "Blues"
_NOTHING = "#d9d9d9"
# numbers in cells as long as a phone has room for them
_MOST_WRITTEN = 42


def plots(picture: Picture) -> list[dict[str, str]]:
    """Return title and element of each figure of a picture."""
    if isinstance(picture, LinePicture):
        return [{"title": "", "plot": _element(_lines(picture), picture.name)}]
    return [
        {"title": panel.title, "plot": _element(_map(picture, panel), f"{picture.name}-{index}")}
        for index, panel in enumerate(picture.panels)
    ]


def _element(figure: go.Figure, name: str) -> str:
    # on a small map the tool bar would hide the cells
    config = PLOT_CONFIG | ({"displayModeBar": False} if figure.data[0].type == "heatmap" else {})
    return str(
        figure.to_html(full_html=False, include_plotlyjs=False, div_id=html.escape(name), config=config)
    )


def _map(picture: MapPicture, panel: MapPanel) -> go.Figure:
    import plotly.graph_objects as go

    figure = new_figure(picture.x_label, picture.y_label, height=330, showlegend=False)
    low, high = picture.bounds()
    places, words = picture.ticks()
    written = panel.values.size <= _MOST_WRITTEN
    figure.add_trace(
        go.Heatmap(
            x=[f"{value:g}" for value in panel.x],
            y=[f"{value:g}" for value in panel.y],
            z=picture.shades(panel.values).astype(np.float32),
            text=_said(panel.values),
            texttemplate="%{text}" if written else None,
            textfont={"size": 10},
            zmin=low,
            zmax=high,
            colorscale=_COLOURS,
            xgap=1,
            ygap=1,
            hovertemplate=f"{picture.x_label}: %{{x}}<br>{picture.y_label}: %{{y}}<br>"
            f"{picture.value_label}: %{{text}}<extra></extra>",
            colorbar={
                "thickness": 10,
                "tickvals": places,
                "ticktext": words,
                "title": {"text": picture.value_label, "side": "right"},
            },
        )
    )
    figure.update_layout(plot_bgcolor=_NOTHING)
    # the numbers are names of cells, and stand at even distances
    figure.update_xaxes(type="category", showgrid=False, tickangle=0, tickfont_size=10)
    figure.update_yaxes(type="category", showgrid=False)
    return figure


def _said(values: Array) -> list[list[str]]:
    return [["" if np.isnan(value) else f"{value:.2g}" for value in row] for row in values]


def _lines(picture: LinePicture) -> go.Figure:
    import plotly.graph_objects as go

    figure = new_figure(picture.x_label, picture.y_label, height=380)
    styles = series_styles(picture.series)
    for index, line in enumerate(picture.series):
        style = styles[line.name]
        figure.add_trace(
            go.Scatter(
                x=line.x,
                y=line.y,
                name=line.name,
                mode="markers" if line.marks else "lines" if line.steps else "lines+markers",
                line={
                    "color": style.colour,
                    "dash": style.dash,
                    "width": 1.8,
                    "shape": "hv" if line.steps else "linear",
                },
                marker={"color": style.colour, "size": 8, "symbol": index},
            )
        )
    if picture.diagonal:
        ends = picture.diagonal_ends()
        figure.add_trace(
            go.Scatter(
                x=ends, y=ends, name=picture.diagonal, mode="lines", line={"color": "#000000", "width": 1}
            )
        )
    exponents = {"exponentformat": "power", "dtick": 1}
    farthest = max((float(line.x.max(initial=0.0)) for line in picture.series), default=0.0)
    if farthest > picture.x_end:
        figure.update_xaxes(range=[0.0, picture.x_end])
    if picture.log_x:
        figure.update_xaxes(type="log", **exponents)
    if picture.log_y:
        figure.update_yaxes(type="log", **exponents)
    return reserve_legend(figure, len(picture.series) + bool(picture.diagonal))
