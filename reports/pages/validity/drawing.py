"""Pictures as SVG for a document."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ...figures.drawing import drawn, with_grid
from ...figures.palette import DASHES
from .picture import LinePicture, MapPanel, MapPicture, Picture, series_styles

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_COLOURS = "Blues"
_NOTHING = "#d9d9d9"
_COLUMNS = 2
_MAP_HEIGHT, _LINE_HEIGHT = 3.0, 3.6  # [inch]
_MARKS = "osD^vP"
# more numbers than these would run into each other
_MOST_WRITTEN = 64
# of the scale of colours: above it white letters are read better
_DARK = 0.6


def svg(picture: Picture) -> bytes:
    """Return a picture as SVG, the same bytes for the same numbers."""
    if isinstance(picture, LinePicture):
        return drawn(lambda figure: _lines(figure, picture), _LINE_HEIGHT)
    rows = -(-len(picture.panels) // _COLUMNS)
    return drawn(lambda figure: _maps(figure, picture, rows), 0.6 + _MAP_HEIGHT * rows)


def _maps(figure: Figure, picture: MapPicture, rows: int) -> None:
    panels = figure.subplots(rows, _COLUMNS, squeeze=False)
    mesh: Any = None
    for axes in panels.flat[len(picture.panels) :]:
        axes.set_axis_off()
    for axes, panel in zip(panels.flat, picture.panels, strict=False):
        mesh = _map(axes, picture, panel)
    places, words = picture.ticks()
    bar = figure.colorbar(mesh, ax=panels, location="bottom", shrink=0.6, aspect=45, pad=0.02)
    bar.set_ticks(places, labels=words)
    bar.set_label(picture.value_label)


def _map(axes: Axes, picture: MapPicture, panel: MapPanel) -> Any:
    low, high = picture.bounds()
    shades = picture.shades(panel.values)
    mesh = axes.pcolormesh(
        np.ma.masked_invalid(shades), cmap=_COLOURS, vmin=low, vmax=high, edgecolors="white", linewidth=0.5
    )
    axes.set_facecolor(_NOTHING)
    axes.set_title(panel.title)
    axes.set_xlabel(picture.x_label)
    axes.set_ylabel(picture.y_label)
    axes.set_xticks(np.arange(len(panel.x)) + 0.5, [f"{value:g}" for value in panel.x], fontsize=7.5)
    axes.set_yticks(np.arange(len(panel.y)) + 0.5, [f"{value:g}" for value in panel.y], fontsize=7.5)
    if panel.values.size <= _MOST_WRITTEN:
        for (row, column), value in np.ndenumerate(panel.values):
            if np.isfinite(value):
                dark = (shades[row, column] - low) / (high - low) > _DARK
                axes.text(
                    column + 0.5,
                    row + 0.5,
                    f"{value:.2g}",
                    ha="center",
                    va="center",
                    fontsize=7,
                    color="white" if dark else "black",
                )
    return mesh


def _lines(figure: Figure, picture: LinePicture) -> None:
    axes = figure.subplots()
    styles = series_styles(picture.series)
    for index, line in enumerate(picture.series):
        style = styles[line.name]
        axes.plot(
            line.x,
            line.y,
            label=line.name,
            color=style.colour,
            linestyle="none" if line.marks else DASHES[style.dash],
            drawstyle="steps-post" if line.steps else "default",
            marker=None if line.steps else _MARKS[index % len(_MARKS)],
            markersize=5,
            linewidth=1.4,
        )
    if picture.diagonal:
        ends = picture.diagonal_ends()
        axes.plot(ends, ends, color="black", linewidth=0.8, label=picture.diagonal)
    if max((float(line.x.max(initial=0.0)) for line in picture.series), default=0.0) > picture.x_end:
        axes.set_xlim(0.0, picture.x_end)
    if picture.log_x:
        axes.set_xscale("log")
    if picture.log_y:
        axes.set_yscale("log")
    axes.set_xlabel(picture.x_label)
    axes.set_ylabel(picture.y_label)
    with_grid(axes)
    axes.legend(loc="center left", bbox_to_anchor=(1.01, 0.5), frameon=False)
