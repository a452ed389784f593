"""Matplotlib renderer: SVG, PDF or PNG with reproducible bytes, or a figure."""

from __future__ import annotations

import io
import textwrap
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Colormap, ListedColormap, Normalize
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.transforms import ScaledTranslation
from numpy.typing import NDArray

from .heat import NOTHING, Heat, Shades
from .palette import DARK, DASHES, SYMBOLS
from .picture import MOST_ENTRIES, Band, Bars, Line, Panel, Picture, Rule, Text, log_ticks
from .thinning import kept_points

Keywords = dict[str, Any]  # arguments of a function of matplotlib
# a column of text on a screen is some 830 pixels wide, 96 to the inch [inch]
WIDTH = 8.6
# limit of the points of a line: more than the pixels of such a column
_POINTS = 1600
_BELOW = -0.48  # offset of a legend from its panel [inch]
_GRID = "#dddddd"
_FRAME = "#888888"  # edge of an entry in a legend, which may be white
# no text is smaller than 8 pt at the width at which it is shown
_STYLE: Any = {
    "svg.hashsalt": "rockwobble",
    "svg.fonttype": "none",  # text that can be searched, and a third of the file
    "pdf.fonttype": 42,  # letters that journals accept
    # fix the layout, whatever the user has set
    "figure.autolayout": False,
    "figure.constrained_layout.use": False,
    "figure.figsize": (WIDTH, 1.0),
    "font.size": 9.5,
    "axes.titlesize": 10,
    "axes.titlelocation": "left",
    "axes.linewidth": 0.7,
    "axes.axisbelow": True,
    "xtick.labelsize": 8.5,
    "ytick.labelsize": 8.5,
    "legend.fontsize": 8.5,
    "legend.framealpha": 0.9,
    "hatch.linewidth": 0.5,
    "path.simplify_threshold": 0.3,
}
# type of a journal at the width of its columns, between 6 and 8 pt
_PRINTED: Any = {
    **_STYLE,
    "font.size": 7.5,
    "axes.titlesize": 8,
    "xtick.labelsize": 7,
    "ytick.labelsize": 7,
    "legend.fontsize": 6.5,
    "lines.linewidth": 1.0,
}
_LOWER = 0.65  # height of a panel in one column of a journal over that on a screen
_LEAST_COLUMNS = 5.0  # width from which panels have room beside each other [inch]
_BETWEEN = 4.0  # least distance of the words of two ticks [pixel]
_RASTER_DPI = 200  # resolution of maps, whose cells as paths would take ten times the room
_EDGED_CELLS = 2500  # a white edge would hide more cells than these
# more numbers than these would run into each other
_MOST_WRITTEN = 64
# range of the colour scale where white letters are read better
_DARK = 0.6
# without date, so that equal numbers give equal bytes
_METADATA: dict[str, dict[str, Any]] = {
    "svg": {"Date": None, "Creator": "rockwobble"},
    "pdf": {"CreationDate": None, "Creator": "rockwobble"},
    "png": {"Software": "rockwobble"},
}
_HATCHES = {"": "", "/": "//", "x": "xx", ".": ".."}


def svg(picture: Picture, *, titled: bool = False) -> bytes:
    """Picture as SVG, with its title if no document states it."""
    return image(picture, "svg", titled=titled)


def image(picture: Picture, form: str, *, titled: bool = False, width: float | None = None) -> bytes:
    """Picture as "svg", "pdf" or "png", see `figure`."""
    buffer = io.BytesIO()
    with mpl.rc_context(_STYLE):
        drawn = figure(picture, titled=titled, width=width)
        dpi = _RASTER_DPI if width is None else 600
        drawn.savefig(buffer, format=form, dpi=dpi, metadata=_METADATA[form])
    return buffer.getvalue()


def figure(picture: Picture, *, titled: bool = False, width: float | None = None) -> Figure:
    """Picture as a matplotlib figure, of a print `width` [inch] or of screen width."""
    if width is not None and width < _LEAST_COLUMNS:
        lower = [replace(panel, height=_LOWER * panel.height) for panel in picture.panels]
        picture = replace(picture, columns=1, panels=lower)
    heights = [max(panel.height for panel in row) for row in picture.rows]
    many = len(picture.panels) > 1
    with mpl.rc_context(_STYLE if width is None else {**_PRINTED, "figure.figsize": (width, 1.0)}):
        drawn = Figure(figsize=(_width(), sum(heights) + 0.7), layout="constrained")
        if titled:
            drawn.suptitle(picture.title, x=0.01, horizontalalignment="left", fontsize=12)
        places = drawn.subplots(
            len(heights),
            picture.columns,
            squeeze=False,
            height_ratios=heights,
            sharex="col" if picture.link_x else False,
        )
        for axes in places.flat[len(picture.panels) :]:
            axes.set_axis_off()
        for place, (axes, panel) in enumerate(zip(places.flat, picture.panels, strict=False)):
            _panel(axes, panel, picture)
            # labels that the panel below, or the one on the left, repeats
            below = picture.panels[place + picture.columns :][:1]
            left = picture.panels[place - 1 : place] if place % picture.columns else []
            axes.set_xlabel("" if [each.x.title for each in below] == [panel.x.title] else panel.x.title)
            axes.set_ylabel("" if [each.y.title for each in left] == [panel.y.title] else panel.y.title)
            letter = f"({chr(ord('a') + place)}) " if many and panel.title else ""
            axes.set_title(letter + panel.title)
        maps = (each for panel in picture.panels for each in panel.layers if isinstance(each, Heat))
        if picture.shades is not None and any(each.shaded for each in maps):
            _colour_bar(drawn, places, picture.shades)
        if picture.legend == "below" and picture.entries():
            _legend(drawn, list(places.flat[: len(picture.panels)]))
        _settle(drawn)
        # after the layout, as each label asks all others for their place; long names have their own room
        drawn.align_ylabels([axes for axes in drawn.axes if axes.get_ylabel()])
    return drawn


def _width() -> float:
    return float(mpl.rcParams["figure.figsize"][0])


def _small() -> float:
    """Font size inside panels [pt]."""
    return float(mpl.rcParams["font.size"]) - 1.5


def _settle(drawn: Figure) -> None:
    """Fix the axes at rounded layout positions, whose last digits vary between calls."""
    layout = drawn.get_layout_engine()
    assert layout is not None
    layout.execute(drawn)
    # any layout engine, even one that places nothing, makes saving draw everything twice
    drawn.set_layout_engine(None)
    for axes in drawn.axes:
        x, y, width, height = (round(each, 3) for each in axes.get_position(original=True).bounds)
        axes.set_position((x, y, width, height))
        _separate(axes)


def _separate(axes: Axes) -> None:
    """Remove x tick labels that would touch their predecessor."""
    free = -np.inf
    for words in axes.get_xticklabels():
        if not (words.get_visible() and words.get_text()):
            continue
        place = words.get_window_extent()
        words.set_visible(bool(place.x0 >= free))
        if words.get_visible():
            free = place.x1 + _BETWEEN


def _panel(axes: Axes, panel: Panel, picture: Picture) -> None:
    axes.grid(color=_GRID, linewidth=0.6)
    axes.margins(x=0.0 if picture.link_x else None)
    _scale(axes, panel)
    for layer in panel.layers:
        if isinstance(layer, Line):
            _line(axes, layer)
        elif isinstance(layer, Band):
            axes.fill_between(
                layer.x, layer.low, layer.high, color=layer.colour, linewidth=0.0, label=layer.name
            )
        elif isinstance(layer, Bars):
            _bars(axes, layer)
        elif isinstance(layer, Rule):
            _rule(axes, layer)
        elif isinstance(layer, Text):
            axes.text(layer.x, layer.y, layer.text, color=layer.colour, ha=layer.anchor, va="bottom",
                      fontsize=_small())  # fmt: skip
        else:
            assert picture.shades is not None
            _heat(axes, layer, panel, picture.shades)
    if picture.columns > 2 and not panel.x.log and not panel.x.ticks:
        axes.locator_params(axis="x", nbins=5)  # more numbers would touch in a narrow panel
    # last, as other artists would move them
    axes.set_xlim(panel.x.low, panel.x.high)
    axes.set_ylim(panel.y.low, panel.y.high)
    for given, axis in ((panel.x, axes.xaxis), (panel.y, axes.yaxis)):
        low, high = axis.get_view_interval()
        # matplotlib writes 2 x 10^-1 and 3 x 10^-1 over each other on an axis of less than two decades
        if given.log and not given.ticks and high < 100.0 * low:
            places = log_ticks(low, high)
            axis.set_ticks(places, [f"{place:g}" for place in places])
            axis.set_ticks([], minor=True)
    if panel.y.reverse:
        axes.invert_yaxis()
    if panel.equal:
        axes.set_aspect("equal")
    if panel.second is not None:
        second, factor = panel.second
        there, back = (lambda y: np.asarray(y) * factor), (lambda y: np.asarray(y) / factor)
        axes.secondary_yaxis("right", functions=(there, back)).set_ylabel(second.title)
    if picture.legend == "panels" and panel.entries():
        handles, words = _handles([axes])
        columns = _columns(words, _width() / picture.columns)
        # below the words of its axis, where it covers nothing
        below = axes.transAxes + ScaledTranslation(0.0, _BELOW, axes.figure.dpi_scale_trans)
        axes.legend(handles, words, loc="upper left", bbox_to_anchor=(0.0, 0.0), bbox_transform=below,
                    ncols=columns, fontsize=_small(), frameon=False, borderpad=0.0)  # fmt: skip


def _scale(axes: Axes, panel: Panel) -> None:
    axes.set_xscale("log" if panel.x.log else "linear")
    axes.set_yscale("log" if panel.y.log else "linear")
    for axis, set_ticks in ((panel.x, axes.set_xticks), (panel.y, axes.set_yticks)):
        if axis.ticks:
            places, words = zip(*axis.ticks, strict=True)
            set_ticks(places, words)
            set_ticks([], minor=True)


def _line(axes: Axes, line: Line) -> None:
    keep = kept_points(line.x, line.y, points=_POINTS)
    style, filled = line.style, np.broadcast_to(line.filled, line.x.shape)
    drawn: Keywords = {
        "color": style.colour,
        "linewidth": line.width,
        "alpha": line.opacity,
        "drawstyle": "steps-post" if line.steps else "default",
        "clip_on": line.clip,
    }
    if style.dash != "none":
        axes.plot(line.x[keep], line.y[keep], linestyle=DASHES[style.dash], **drawn, **_marker(line, True))
        return
    for inside in (True, False):
        chosen = keep[filled[keep] == inside]
        if len(chosen):
            axes.plot(line.x[chosen], line.y[chosen], linestyle="none", **drawn, **_marker(line, inside))


def _marker(line: Line, filled: bool) -> Keywords:
    symbol = SYMBOLS[line.style.symbol] if line.style.symbol else None
    inside = line.style.colour if filled and line.filled is not False else "white"
    return {"marker": symbol, "markersize": line.size, "markerfacecolor": inside, "label": line.name}


def _bars(axes: Axes, bars: Bars) -> None:
    axes.barh(
        bars.places,
        bars.end - bars.start,
        left=bars.start,
        height=0.78,
        color=list(bars.colours),
        hatch=_HATCHES[bars.hatch],
        edgecolor="white",
        label=bars.name,
    )
    for place, end, text in zip(bars.places, bars.end, bars.texts, strict=False):
        axes.annotate(text, (end, place), xytext=(4, 0), textcoords="offset points", va="center",
                      fontsize=_small())  # fmt: skip


def _rule(axes: Axes, rule: Rule) -> None:
    across = axes.axvline if rule.axis == "x" else axes.axhline
    if rule.until is None:
        across(rule.at, color=rule.colour, linewidth=0.9, linestyle=DASHES[rule.dash], label=rule.name)
    else:
        strip = axes.axvspan if rule.axis == "x" else axes.axhspan
        strip(rule.at, rule.until, color=rule.colour, linewidth=0.0, label=rule.name)
    if not rule.text:
        return
    left = rule.side == "left"
    if rule.axis == "x":
        place, at, coordinates = (4 if not left else -4, -4), (rule.at, 1.0), ("data", "axes fraction")
        where: Keywords = {"ha": "right" if left else "left", "va": "top"}
    else:
        place, at, coordinates = (4 if left else -4, 2), (0.0 if left else 1.0, rule.at), _ACROSS
        where = {"ha": "left" if left else "right", "va": "bottom"}
    axes.annotate(rule.text, at, xycoords=coordinates, xytext=place, textcoords="offset points",
                  fontsize=_small(), bbox=_BEHIND, **where)  # fmt: skip


_ACROSS = ("axes fraction", "data")
_BEHIND = {"facecolor": "white", "edgecolor": "none", "alpha": 0.8, "pad": 1.0}


def _heat(axes: Axes, heat: Heat, panel: Panel, shades: Shades) -> None:
    edges = heat.edges(log_x=panel.x.log, log_y=panel.y.log)
    place = shades.place(heat.values)
    few = heat.values.size <= _EDGED_CELLS
    drawn: Keywords = {"rasterized": True, "edgecolors": "white" if few else "none"}
    axes.grid(visible=False)
    axes.set_facecolor(NOTHING)
    axes.pcolormesh(*edges, np.ma.masked_invalid(place), cmap=colours(shades), vmin=0.0, vmax=1.0,
                    linewidth=0.5 if few else 0.0, **drawn)  # fmt: skip
    for gap in heat.gaps:
        if gap.cells.any():
            layer = np.ma.masked_where(~gap.cells, np.zeros(gap.cells.shape))
            axes.pcolormesh(*edges, layer, cmap=ListedColormap([gap.colour]), linewidth=0.0, **drawn)
            axes.fill_between(
                [], [], [], facecolor=gap.colour, edgecolor=_FRAME, linewidth=0.6, label=gap.name
            )
    if heat.written and heat.values.size <= _MOST_WRITTEN:
        sided = shades.centre is not None
        for (row, column), value in np.ndenumerate(heat.values):
            if np.isfinite(value):
                at = place[row, column]
                dark = abs(at - 0.5) > 0.5 * _DARK if sided else at > _DARK
                where = float(heat.x[column]), float(heat.y[row])
                axes.text(*where, format(value, heat.written), ha="center", va="center", fontsize=_small(),
                          color="white" if dark else "black", clip_on=True)  # fmt: skip


def colours(shades: Shades) -> Colormap:
    """Colour map of a scale, in steps where it has some."""
    colour_map: Colormap = mpl.colormaps[shades.colours]
    return colour_map.resampled(shades.steps) if shades.steps else colour_map


def _colour_bar(drawn: Figure, places: NDArray[np.object_], shades: Shades) -> None:
    scale = ScalarMappable(Normalize(0.0, 1.0), colours(shades))
    bar = drawn.colorbar(scale, ax=places, location="bottom", shrink=0.6, aspect=45, pad=0.02)
    at, words = zip(*shades.ticks(), strict=True)
    bar.set_ticks(at, labels=words)
    bar.set_label(shades.title)


def _handles(panels: Sequence[Axes]) -> tuple[list[Artist], list[str]]:
    """Artists and names of a legend, each name once, at most as many as can be distinguished."""
    entries: dict[str, Artist] = {}
    for axes in panels:
        for handle, name in zip(*axes.get_legend_handles_labels(), strict=True):
            entries.setdefault(name, handle)
    rest = len(entries) - MOST_ENTRIES
    shown = list(entries)[: MOST_ENTRIES - (rest > 0)]
    handles, words = [entries[name] for name in shown], [textwrap.fill(name, 60) for name in shown]
    if rest > 0:
        handles.append(Line2D([], [], linestyle="none"))
        words.append(f"and {rest + 1} more")
    return handles, words


def _legend(drawn: Figure, panels: Sequence[Axes]) -> None:
    handles, words = _handles(panels)
    columns = _columns(words, _width())
    drawn.legend(handles, words, loc="outside lower center", ncols=columns, frameon=False, labelcolor=DARK)


def _columns(words: Sequence[str], width: float) -> int:
    """Number of legend columns for a width [inch]; an entry of n letters takes about n/14 + 0.5."""
    return max(1, min(4, int(width / (max(map(len, words)) / 14.0 + 0.5))))
