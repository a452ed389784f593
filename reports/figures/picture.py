"""Figures as data: two renderers draw them, `svg` for documents and `interactive` for pages."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, field, replace
from typing import Literal

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from rockwobble.models.finding import Finding, Value

from .heat import Heat, Shades
from .palette import DARK, GREY, Style, mark_styles
from .thinning import POINTS

Array = NDArray[np.float64]

MOST_ENTRIES = 8  # limit of a legend: more cannot be distinguished
_LINE = Style(colour=DARK, dash="solid")
_DECADES = tuple(digit * 10.0**power for power in range(-6, 7) for digit in (1.0, 2.0, 5.0))
_STEPS = (0.01, 0.02, 0.05, 0.1, 0.2, 0.5)
_MOST_TICKS = 7


@dataclass(frozen=True, slots=True, kw_only=True)
class Axis:
    """One axis.

    Attributes
    ----------
    label : str
        Quantity, or what the ticks name.
    unit : str
        "-" for a number; empty only where the ticks are names.
    log : bool
    low, high : float, optional
        Ends; default: those of what is drawn.
    ticks : sequence of (float, str)
        Places and what stands there; empty: numbers at round places.
    reverse : bool
        Whether it grows downwards, as in a list.
    """

    label: str
    unit: str
    log: bool = False
    low: float | None = None
    high: float | None = None
    ticks: Sequence[tuple[float, str]] = ()
    reverse: bool = False

    def __post_init__(self) -> None:
        if not self.unit and not self.ticks:
            raise ValueError(f'the axis {self.label!r} must have a unit ("-" for a number)')

    @property
    def title(self) -> str:
        """Label and unit."""
        return f"{self.label} [{self.unit}]" if self.unit else self.label


def log_ticks(low: float, high: float) -> list[float]:
    """Round tick values of a logarithmic axis, few enough for separate labels."""
    if high / low > 4.0:
        ticks = [tick for tick in _DECADES if low <= tick <= high]
        return ticks if len(ticks) <= _MOST_TICKS else [t for t in ticks if math.log10(t).is_integer()]
    step = next((s for s in _STEPS if (high - low) / s <= _MOST_TICKS), _STEPS[-1])
    first = math.ceil(low / step)
    return [round(index * step, 6) for index in range(first, math.floor(high / step) + 1)]


def list_axis(names: Sequence[str], label: str = "") -> Axis:
    """Y axis of a downward list, with names at 0, 1, 2, ..."""
    ticks = list(enumerate(names))
    return Axis(label=label, unit="", low=-0.6, high=len(ticks) - 0.4, ticks=ticks, reverse=True)


TIME = Axis(label="time", unit="s")
TILT = Axis(label="tilt / α", unit="-", low=0.0)
CUT = 1.5  # [balance tilt] where an axis ends if a tilt goes farther: a fall would leave nothing of the rest


def tilt_axis(tilts: Iterable[Array], balance: float) -> Axis:
    """Axis of tilts over alpha, cut above the range of standing bodies.

    `balance` is the balance tilt [alpha].
    """
    cut = CUT * balance
    beyond = any(float(np.nanmax(tilt, initial=0.0)) > cut for tilt in tilts)
    return replace(TILT, high=cut if beyond else None)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Line:
    """A line, marks on it, or marks alone.

    Attributes
    ----------
    x, y : ndarray, shape (n,)
        NaN is a gap.
    name : str
        In the legend, once for all lines of this name; empty: not there.
    style : Style
        Style of dash "none": marks alone. Without a symbol: no marks.
    width, size : float
        Width and size of line and marks [pt].
    opacity : float
    filled : bool or ndarray, shape (n,)
        Filled of the marks.
    steps : bool
        Whether y holds until the next x.
    clip : bool
        Whether marks at the edge are cut there; not those that stand for what is beyond it.
    notes : sequence of str
        What a page says at each point beside its numbers.
    """

    x: Array
    y: Array
    name: str = ""
    style: Style = _LINE
    width: float = 1.4
    size: float = 5.0
    opacity: float = 1.0
    filled: bool | NDArray[np.bool_] = True
    steps: bool = False
    clip: bool = True
    notes: Sequence[str] = ()


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Band:
    """Area between two curves over x, each (n,)."""

    x: Array
    low: Array
    high: Array
    name: str = ""
    colour: str = "#cfe3f1"


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Bars:
    """Horizontal bars at places of the y axis.

    Attributes
    ----------
    places, start, end : ndarray, shape (n,)
    colours : sequence of str
    hatch : {"", "/", "x", "."}
    texts : sequence of str
        On the right of each bar.
    """

    places: Array
    start: Array
    end: Array
    colours: Sequence[str]
    name: str = ""
    hatch: str = ""
    texts: Sequence[str] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class Rule:
    """A straight line across the panel at a value of x, or of y, or a strip up to `until`."""

    at: float
    axis: Literal["x", "y"]
    text: str = ""
    until: float | None = None
    colour: str = DARK
    dash: str = "dash"
    name: str = ""
    side: Literal["left", "right"] = "left"  # side of the panel, or of a vertical line, where its text is


@dataclass(frozen=True, slots=True, kw_only=True)
class Text:
    """Words at a point."""

    x: float
    y: float
    text: str
    colour: str = DARK
    anchor: Literal["left", "center", "right"] = "left"


Layer = Line | Band | Bars | Rule | Text | Heat


@dataclass(frozen=True, slots=True, kw_only=True)
class Panel:
    """One pair of axes and its contents, from back to front.

    Attributes
    ----------
    x, y : Axis
    layers : sequence of Layer
    title : str
    height : float
        [inch] in a document.
    equal : bool
        Whether both axes have the same scale, as on a map.
    second : (Axis, float), optional
        An axis on the right, and what it shows over what the left one shows.
    """

    x: Axis
    y: Axis
    layers: Sequence[Layer]
    title: str = ""
    height: float = 2.6
    equal: bool = False
    second: tuple[Axis, float] | None = None

    def entries(self) -> dict[str, Mapping[str, object]]:
        """Legend names, each once, with the style of their marks."""
        return {name: look for layer in self.layers for name, look in _entries(layer) if name}


def caption(key: str, /, **values: Value) -> Finding:
    """Caption of a picture as data."""
    return Finding(key=f"figure.{key}", values=values)


@dataclass(frozen=True, slots=True, kw_only=True)
class Picture:
    """Panels with a common title and a self-contained caption.

    Attributes
    ----------
    name : str
        Name of its file.
    caption : str or Finding
        A finding, see `caption`, is worded where the picture stands on a page.
    title : str
        Default: the short form of the caption.
    panels : sequence of Panel
    columns : int
        Columns of panels, in a document; a page has as many as fit.
    shades : Shades, optional
        Shades of the maps.
    legend : {"below", "panels"}
        One for all panels, or one in each.
    link_x : bool
        Whether the panels share their x axis: over time, say, where a page enlarges them together.
    points : int
        Most points of a curve on a page.
    """

    name: str
    panels: Sequence[Panel]
    caption: str | Finding = ""
    title: str = ""
    columns: int = 1
    shades: Shades | None = None
    legend: Literal["below", "panels"] = "below"
    link_x: bool = False
    points: int = POINTS
    rows: Sequence[Sequence[Panel]] = field(init=False)

    def __post_init__(self) -> None:
        if self.shades is None and any(isinstance(each, Heat) for p in self.panels for each in p.layers):
            raise ValueError(f"the picture {self.name!r} has a map and needs shades")
        rows = [self.panels[i : i + self.columns] for i in range(0, len(self.panels), self.columns)]
        object.__setattr__(self, "rows", rows)

    def entries(self) -> list[str]:
        """Legend names of all panels, each once."""
        return list(dict.fromkeys(name for panel in self.panels for name in panel.entries()))


def ecdf(values: Array, *, total: int | None = None, end: float | None = None) -> tuple[Array, Array]:
    """Return steps (k,), (k,) of the share of `total` values that are at most x.

    Parameters
    ----------
    values : ndarray, shape (n,)
    total : int, optional
        More than n where some have no value, such as runs that overturn. Default: n.
    end : float, optional
        To which x the last step is drawn.
    """
    x = np.concatenate([[0.0], np.sort(values), [] if end is None else [end]])
    counts = np.arange(len(values) + 1, dtype=np.float64)
    counts = counts if end is None else np.append(counts, counts[-1])
    return x, counts / max(len(values) if total is None else total, 1)


def table_line(
    rows: pd.DataFrame,
    x: str,
    y: str,
    name: str = "",
    style: Style = _LINE,
    width: float = 1.4,
    size: float = 5.0,
) -> Line:
    """A line over two columns of a table."""
    at, values = (rows[column].to_numpy(float) for column in (x, y))
    return Line(x=at, y=values, name=name, style=style, width=width, size=size)


def ticks_at(
    values: Iterable[float], low: float = -math.inf, high: float = math.inf
) -> list[tuple[float, str]]:
    """Ticks of an axis at some values within its ends."""
    return [(value, f"{value:g}") for value in values if low <= value <= high]


def group_lines(
    groups: Mapping[str, pd.DataFrame], x: str, y: str, *, lines: bool = True, filled: str = ""
) -> list[Line]:
    """Line with marks, or marks alone, of each group of rows by its name, over two of their columns.

    Parameters
    ----------
    groups : mapping of str to DataFrame
    x, y : str
        Columns.
    lines : bool, optional
    filled : str, optional
        Column of flags: marks without are open.
    """
    styles = mark_styles(list(groups), lines=lines)
    drawn = [table_line(rows, x, y, name, styles[name]) for name, rows in groups.items()]
    if not filled:
        return drawn
    flags = [rows[filled].to_numpy(bool) for rows in groups.values()]
    return [replace(line, filled=marks) for line, marks in zip(drawn, flags, strict=True)]


def bar_ends(first: Array, second: Array) -> Array:
    """Ends of bars one after the other, separated by NaN."""
    return np.column_stack([first, second, np.full(len(first), np.nan)]).ravel()


def _entries(layer: Layer) -> Iterator[tuple[str, Mapping[str, object]]]:
    if isinstance(layer, Line):
        yield layer.name, {**asdict(layer.style), "width": layer.width}
    elif isinstance(layer, Rule):
        dash = layer.dash if layer.until is None else ""
        yield layer.name, {"colour": layer.colour, "dash": dash, "width": 1}
    elif isinstance(layer, Band):
        yield layer.name, {"colour": layer.colour}
    elif isinstance(layer, Bars):
        yield layer.name, {"colour": layer.colours[0] if layer.colours else GREY}
    elif isinstance(layer, Heat):
        yield from ((gap.name, {"colour": gap.colour}) for gap in layer.gaps if gap.cells.any())
