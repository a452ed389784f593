"""What a picture of the report shows, before it is drawn for a page or for a document."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...figures.palette import Style, model_style, run_styles

Array = NDArray[np.float64]

_MODELS = ("recess", "flat")


@dataclass(frozen=True, slots=True, kw_only=True)
class MapPanel:
    """One map of a row of maps.

    Attributes
    ----------
    title : str
    x, y : sequence of float
        Of the cells, whatever their spacing.
    values : ndarray, shape (len(y), len(x))
        NaN where there is nothing to show.
    """

    title: str
    x: Sequence[float]
    y: Sequence[float]
    values: Array


@dataclass(frozen=True, slots=True, kw_only=True)
class MapPicture:
    """Maps of one quantity side by side, with one scale of colours.

    Attributes
    ----------
    name : str
        Of its file.
    title, caption, x_label, y_label, value_label : str
    panels : sequence of MapPanel
    log : bool
        Whether colours go by the logarithm.
    smallest : float
        Of a logarithmic scale: what is below is drawn as this.
    largest : float
        What is above is drawn as this.
    """

    name: str
    title: str
    caption: str
    x_label: str
    y_label: str
    value_label: str
    panels: Sequence[MapPanel]
    log: bool = False
    smallest: float = 1e-3
    largest: float = np.inf

    def shades(self, values: Array) -> Array:
        """Return what colours go by."""
        capped = np.minimum(values, self.largest)
        return np.log10(np.maximum(capped, self.smallest)) if self.log else capped

    def bounds(self) -> tuple[float, float]:
        """Return the ends of the scale of colours."""
        known = np.concatenate([self.shades(panel.values).ravel() for panel in self.panels])
        known = known[np.isfinite(known)]
        if not len(known):
            return 0.0, 1.0
        low, high = float(known.min()), float(known.max())
        return (low, high) if high > low else (low, low + 1.0)

    def ticks(self) -> tuple[list[float], list[str]]:
        """Return places on the scale of colours and what they stand for."""
        low, high = self.bounds()
        if not self.log:
            places = [float(value) for value in np.linspace(low, high, 5)]
            return places, [f"{value:.2g}" for value in places]
        decades = np.arange(np.ceil(low), np.floor(high) + 1.0)
        if len(decades) < 2:
            return [low, high], [f"{10.0**low:.2g}", f"{10.0**high:.2g}"]
        return [float(value) for value in decades], [f"{10.0**value:g}" for value in decades]


@dataclass(frozen=True, slots=True, kw_only=True)
class Series:
    """One line, or marks without one.

    Attributes
    ----------
    name : str
    x, y : ndarray, shape (n,)
    marks : bool
        Marks in place of a line.
    steps : bool
        A line of steps.
    """

    name: str
    x: Array
    y: Array
    marks: bool = False
    steps: bool = False


@dataclass(frozen=True, slots=True, kw_only=True)
class LinePicture:
    """Lines or marks over one pair of axes.

    Attributes
    ----------
    name : str
        Of its file.
    title, caption, x_label, y_label : str
    series : sequence of Series
    log_x, log_y : bool
    diagonal : str
        What the line y = x stands for; empty where there is none.
    x_end : float
        Where the axis ends at the latest.
    """

    name: str
    title: str
    caption: str
    x_label: str
    y_label: str
    series: Sequence[Series]
    log_x: bool = False
    log_y: bool = False
    diagonal: str = ""
    x_end: float = np.inf

    def diagonal_ends(self) -> tuple[float, float]:
        """Return the ends of the diagonal: those of all values."""
        values = np.concatenate([np.concatenate([line.x, line.y]) for line in self.series])
        values = values[np.isfinite(values) & ((values > 0.0) | (not (self.log_x or self.log_y)))]
        return (float(values.min()), float(values.max())) if len(values) else (1.0, 2.0)


Picture = MapPicture | LinePicture


def series_styles(series: Sequence[Series]) -> dict[str, Style]:
    """Return the style of each line: that of the model where it is one."""
    others = run_styles([line.name for line in series if line.name not in _MODELS])
    return others | {line.name: model_style(line.name) for line in series if line.name in _MODELS}
