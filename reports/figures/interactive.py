"""Pictures by plotly: a figure for each panel, to be read on a screen as wide as a phone or wider."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from .heat import NOTHING, Array, Heat, Shades
from .palette import DARK
from .picture import MOST_ENTRIES, Axis, Band, Bars, Line, Panel, Picture, Rule, Text
from .thinning import POINTS, kept_points

if TYPE_CHECKING:
    import plotly.graph_objects as go

CONFIG = {"responsive": True, "displaylogo": False, "modeBarButtonsToRemove": ["select2d", "lasso2d"]}
_FONT = "system-ui, -apple-system, 'Segoe UI', Roboto, sans-serif"
_PER_INCH = 125.0  # pixels of height
_ENTRY = 22  # pixels of a line of a legend
# a phone has room for one such name beside another
_LONG = 18


def plots(picture: Picture) -> list[tuple[str, str]]:
    """Return title and HTML element of each panel; the page has plotly.js."""
    elements = []
    for index, drawn in enumerate(figures(picture)):
        # on a small map the tool bar would hide the cells
        maps = any(isinstance(layer, Heat) for layer in picture.panels[index].layers)
        config = CONFIG | ({"displayModeBar": False} if maps else {})
        name = f"{picture.name}-{index}"
        element = drawn.to_html(full_html=False, include_plotlyjs=False, div_id=name, config=config)
        elements.append((picture.panels[index].title, str(element)))
    return elements


def figures(picture: Picture) -> list[go.Figure]:
    """Return the figure of each panel."""
    return [_figure(panel, picture) for panel in picture.panels]


def _figure(panel: Panel, picture: Picture) -> go.Figure:
    import plotly.graph_objects as go

    drawn = go.Figure(layout={"template": "none"})  # the default one takes 7 kB of a page, each time
    entries = panel.entries()
    rows = len(entries) if max(map(len, entries), default=0) > _LONG else (len(entries) + 1) // 2
    room = 8 + _ENTRY * rows
    drawn.update_layout(
        height=int(_PER_INCH * panel.height) + _ENTRY * rows,
        margin={"l": 8, "r": 12, "t": 10, "b": room},
        font={"family": _FONT, "size": 13, "color": DARK},
        paper_bgcolor="white",
        plot_bgcolor="white",
        hovermode="closest",
        dragmode="zoom",
        showlegend=bool(entries),
        barmode="overlay",
        # below the axes, where it takes no width on a phone
        legend={"orientation": "h", "yref": "container", "y": 0.0, "yanchor": "bottom", "x": 0.0},
        xaxis=_axis(panel.x),
        yaxis=_axis(panel.y),
        # what a page enlarges together
        meta={"link": picture.panels[0].x.title if picture.link_x else ""},
    )
    shown: set[str] = set()  # names in the legend
    for layer in panel.layers:
        if isinstance(layer, Line):
            _line(drawn, layer, panel, shown, picture.points)
        elif isinstance(layer, Band):
            _band(drawn, layer, shown)
        elif isinstance(layer, Bars):
            _bars(drawn, layer, shown)
        elif isinstance(layer, Rule):
            _rule(drawn, layer, panel, shown)
        elif isinstance(layer, Text):
            at = {"x": _exponent(layer.x, panel.x), "y": _exponent(layer.y, panel.y)}
            _words(drawn, layer.text, **at, xanchor=layer.anchor, yanchor="bottom", color=layer.colour)
        else:
            assert picture.shades is not None
            add_heat(drawn, layer, panel, picture.shades)
            for gap in layer.gaps:
                if gap.cells.any():
                    _swatch(drawn, gap.name, gap.colour, shown)
    if panel.equal:
        drawn.update_xaxes(constrain="domain")
        drawn.update_yaxes(scaleanchor="x", scaleratio=1, constrain="domain")
    if panel.second is not None:
        _second(drawn, panel, *panel.second)
    return drawn


def _axis(axis: Axis) -> dict[str, Any]:
    found: dict[str, Any] = {
        **{"showline": True, "linecolor": "#444444", "gridcolor": "#dddddd", "zerolinecolor": "#bbbbbb"},
        **{"ticks": "outside", "tickcolor": "#444444", "automargin": True},
        "title": {"text": axis.title, "standoff": 6},
    }
    ends = [None if end is None else _exponent(end, axis) for end in (axis.low, axis.high)]
    if ends != [None, None]:
        found["range"] = ends[::-1] if axis.reverse else ends
    elif axis.reverse:
        found["autorange"] = "reversed"
    if axis.log:
        # on a long axis the numbers of all decades would run into each other
        long = axis.low is not None and axis.high is not None and axis.high > 1e6 * axis.low
        found |= {"type": "log", "exponentformat": "power", "dtick": 2 if long else 1}
    if axis.ticks:
        places, words = zip(*axis.ticks, strict=True)
        words = tuple(word.replace("\n", "<br>") for word in words)
        found |= {"tickmode": "array", "tickvals": places, "ticktext": words}
    return found


def _exponent(value: float, axis: Axis) -> float:
    """Return where a value is for what takes the exponent on a logarithmic axis: ends, annotations."""
    return float(np.log10(value)) if axis.log else value


def _entry(name: str, shown: set[str]) -> dict[str, Any]:
    """Return what makes one entry in the legend of all that has one name."""
    if not name:
        return {"showlegend": False}
    first = name not in shown and len(shown) < MOST_ENTRIES
    shown.add(name)
    return {"name": name, "legendgroup": name, "showlegend": first}


def _line(drawn: go.Figure, line: Line, panel: Panel, shown: set[str], points: int) -> None:
    style = line.style
    keep = kept_points(line.x, line.y, points=POINTS if style.dash == "none" else points)
    symbol: str | list[str] = style.symbol or "circle"
    if style.symbol and line.filled is not True:
        filled = np.broadcast_to(line.filled, line.x.shape)[keep]
        symbol = [style.symbol if each else f"{style.symbol}-open" for each in filled]
    modes = [*([] if style.dash == "none" else ["lines"]), *(["markers"] if style.symbol else [])]
    notes = [line.notes[place].replace("\n", "<br>") for place in keep] if line.notes else None
    hover = f"%{{y:.4~g}}{_unit(panel.y)} at %{{x:.4~g}}{_unit(panel.x)}"
    marker = {"symbol": symbol, "color": style.colour, "size": 1.6 * line.size, "line": {"width": 1.0}}
    drawn.add_scatter(
        x=small(line.x[keep]),
        y=small(line.y[keep]),
        mode="+".join(modes),
        line={
            "color": style.colour,
            "dash": None if style.dash in ("none", "solid") else style.dash,
            "width": line.width,
            "shape": "hv" if line.steps else None,
        },
        marker=marker if style.symbol else None,
        opacity=None if line.opacity == 1.0 else line.opacity,
        cliponaxis=None if line.clip else False,
        text=notes,
        hovertemplate=hover + ("<br>%{text}" if notes else ""),
        **_entry(line.name, shown),
    )


def _unit(axis: Axis) -> str:
    return f" {axis.unit}" if axis.unit not in ("", "-") else ""


def _band(drawn: go.Figure, band: Band, shown: set[str]) -> None:
    drawn.add_scatter(
        x=small(np.concatenate([band.x, band.x[::-1]])),
        y=small(np.concatenate([band.high, band.low[::-1]])),
        fill="toself",
        fillcolor=band.colour,
        line={"width": 0},
        mode="lines",
        hoverinfo="skip",
        **_entry(band.name, shown),
    )


def _bars(drawn: go.Figure, bars: Bars, shown: set[str]) -> None:
    drawn.add_bar(
        base=bars.start,
        x=bars.end - bars.start,
        y=bars.places,
        orientation="h",
        width=0.78,
        marker={
            "color": list(bars.colours),
            "pattern": {"shape": bars.hatch, "fgcolor": "white", "size": 6, "solidity": 0.2},
        },
        text=list(bars.texts) or None,
        textposition="outside" if bars.texts else "none",
        cliponaxis=False,
        hovertemplate="%{x:.3g}",
        **_entry(bars.name, shown),
    )


def _rule(drawn: go.Figure, rule: Rule, panel: Panel, shown: set[str]) -> None:
    vertical = rule.axis == "x"
    if rule.until is None:
        line = {"color": rule.colour, "dash": rule.dash, "width": 1}
        (drawn.add_vline if vertical else drawn.add_hline)(rule.at, line=line)
    else:
        strip = drawn.add_vrect if vertical else drawn.add_hrect
        strip(rule.at, rule.until, fillcolor=rule.colour, line_width=0, layer="below")
    if rule.name:
        _swatch(drawn, rule.name, rule.colour, shown, dash=rule.dash if rule.until is None else "")
    if not rule.text:
        return
    left = rule.side == "left"
    where: dict[str, Any]
    if vertical:
        where = {"x": _exponent(rule.at, panel.x), "y": 1.0, "yref": "paper", "yanchor": "top"}
        where |= {"xanchor": "right" if left else "left"}
    else:
        where = {"x": 0.0 if left else 1.0, "xref": "paper", "y": _exponent(rule.at, panel.y)}
        where |= {"xanchor": "left" if left else "right", "yanchor": "bottom"}
    _words(drawn, rule.text, **where)


def _swatch(drawn: go.Figure, name: str, colour: str, shown: set[str], *, dash: str = "") -> None:
    """Add an entry to the legend for what plotly has none for: a line, or a coloured square."""
    mark = {"symbol": "square", "size": 10, "color": colour}
    line = {"color": colour, "dash": dash or "solid", "width": 1}
    mode = "lines" if dash else "markers"
    drawn.add_scatter(x=[None], y=[None], mode=mode, line=line, marker=mark, **_entry(name, shown))


def _words(drawn: go.Figure, text: str, *, color: str = DARK, **where: Any) -> None:
    drawn.add_annotation(
        text=text,
        showarrow=False,
        font={"size": 12, "color": color},
        bgcolor="rgba(255,255,255,0.8)",
        **where,
    )


def _second(drawn: go.Figure, panel: Panel, second: Axis, factor: float) -> None:
    if panel.y.low is None or panel.y.high is None:
        raise ValueError(f"a second axis needs the ends of the first, {panel.y.label!r}")
    drawn.add_scatter(x=[None], y=[None], yaxis="y2", showlegend=False)
    drawn.update_traces(colorbar_x=1.2, selector={"type": "heatmap"})
    ends = [_exponent(factor * end, panel.y) for end in (panel.y.low, panel.y.high)]
    # enlarging the first would leave the second behind
    drawn.update_layout(
        yaxis_fixedrange=True,
        yaxis2=_axis(second) | {"overlaying": "y", "side": "right", "range": ends, "fixedrange": True},
    )


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
