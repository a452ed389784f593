"""The two shapes of the pictures of this report: lines over one pair of axes, and maps side by side."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ...figures.heat import Array, Heat, Shades, names
from ...figures.palette import Style, mark_styles, model_style
from ...figures.picture import Axis, Layer, Line, Panel, Picture

_MODELS = ("recess", "flat")
_LINE_HEIGHT, _MAP_HEIGHT = 3.4, 3.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Series:
    """One line, or marks without one."""

    name: str
    x: Array
    y: Array
    marks: bool = False
    steps: bool = False


def line_picture(
    *,
    name: str,
    title: str,
    caption: str,
    x: Axis,
    y: Axis,
    series: Sequence[Series],
    diagonal: str = "",
) -> Picture:
    """Return lines over one pair of axes; `diagonal` is what y = x stands for, if it is drawn."""
    styles = _styles(series)
    layers: list[Layer] = [
        Line(x=each.x, y=each.y, name=each.name, style=styles[each.name], steps=each.steps) for each in series
    ]
    if diagonal:
        known = np.concatenate([values for each in series for values in (each.x, each.y)])
        known = known[np.isfinite(known) & ((known > 0.0) | (not (x.log or y.log)))]
        ends = np.array([known.min(), known.max()]) if len(known) else np.array([1.0, 2.0])
        layers.append(Line(x=ends, y=ends, name=diagonal, width=0.8))
    panel = Panel(x=x, y=y, layers=layers, height=_LINE_HEIGHT)
    return Picture(name=name, title=title, caption=caption, panels=[panel])


def _styles(series: Sequence[Series]) -> dict[str, Style]:
    """Return the style of each line: that of the model where it is one."""
    found = mark_styles([each.name for each in series if each.name not in _MODELS])
    found |= {each.name: model_style(each.name) for each in series if each.name in _MODELS}
    for each in series:
        style = found[each.name]
        found[each.name] = replace(
            style, dash="none" if each.marks else style.dash, symbol="" if each.steps else style.symbol
        )
    return found


@dataclass(frozen=True, slots=True, kw_only=True)
class Map:
    """One map: values (len(y), len(x)) over numbers that stand at even distances."""

    title: str
    x: Sequence[float]
    y: Sequence[float]
    values: Array


def map_picture(
    *,
    name: str,
    title: str,
    caption: str,
    x: str,
    x_unit: str,
    y: str,
    y_unit: str,
    value: str,
    unit: str,
    maps: Sequence[Map],
    log: bool = False,
    smallest: float = 1e-3,
    largest: float = np.inf,
) -> Picture:
    """Return maps of one quantity; what is below `smallest` or above `largest` is drawn as it."""
    known = np.concatenate([each.values.ravel() for each in maps])
    known = np.clip(known[np.isfinite(known)], smallest if log else -np.inf, largest)
    low, high = (float(known.min()), float(known.max())) if len(known) else (1.0, 2.0)
    high = high if high > low else (10.0 * low if log else low + 1.0)
    panels = []
    for each in maps:
        x_places, x_ticks = names(each.x)
        y_places, y_ticks = names(each.y)
        panels.append(
            Panel(
                x=Axis(label=x, unit=x_unit, ticks=x_ticks),
                y=Axis(label=y, unit=y_unit, ticks=y_ticks),
                layers=[Heat(x=x_places, y=y_places, values=each.values, written=".2g")],
                title=each.title,
                height=_MAP_HEIGHT,
            )
        )
    shades = Shades(label=value, unit=unit, low=low, high=high, log=log)
    return Picture(name=name, title=title, caption=caption, panels=panels, columns=2, shades=shades)
