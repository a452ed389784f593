"""Error against computing time: interactive, and for a document."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ...figures.charts.layout import new_figure, reserve_legend
from ...figures.drawing import drawn, with_grid
from .marks import Mark, marks

if TYPE_CHECKING:
    import pandas as pd
    import plotly.graph_objects as go
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from rockwobble.compare.studies.tradeoff import Tradeoff

TIME_TITLE = "time / that of the reduced model [-]"
WHERE = {"recess": "in a recess", "flat": "on open ground"}
_BASE_COLOUR = "#888888"


def line_marks(found: Tradeoff) -> dict[str, Mark]:
    """Return the marks of all lines, the same in every figure."""
    return marks(list(zip(found.points["family"], found.points["line"], strict=True)))


def tradeoff_charts(found: Tradeoff) -> list[tuple[str, str, go.Figure]]:
    """Return title, explanation and figure for each problem and model."""
    styles = line_marks(found)
    charts = []
    for row in records(found.problems):
        chosen = _chosen(found, row)
        if chosen.empty:
            continue
        words = (
            f"The reference is the {row['source']}." if row["doubt"] else f"The reference is {row['source']}."
        )
        if row["doubt"]:
            words += f" Ten times less tight it changes by {row['doubt']:.0e}."
        if row["chance"] == row["chance"]:
            words += " Below the dotted line other earthquakes would change more than the method does."
        charts.append((f"{row['title']}, {WHERE[row['model']]}", words, _chart(chosen, row, styles)))
    return charts


def records(table: pd.DataFrame) -> list[dict[str, Any]]:
    """Return the rows of a table by the names of its columns."""
    return [{str(name): value for name, value in row.items()} for row in table.to_dict("records")]


def _chosen(found: Tradeoff, row: dict[str, Any]) -> pd.DataFrame:
    points = found.points
    chosen: pd.DataFrame = points.loc[
        (points["problem"] == row["problem"]) & (points["model"] == row["model"])
    ]
    shown: pd.DataFrame = chosen.loc[chosen["error"] > 0.0]
    return shown


def _chart(points: pd.DataFrame, row: dict[str, Any], styles: dict[str, Mark]) -> go.Figure:
    import plotly.graph_objects as go

    figure = new_figure(TIME_TITLE, row["error_title"], height=440)
    for line, members in points.groupby("line", sort=False):
        mark = styles[str(line)]
        ordered = members.sort_values("value", ascending=False)
        figure.add_trace(
            go.Scatter(
                x=ordered["ratio"].to_numpy(),
                y=ordered["error"].to_numpy(),
                name=str(line),
                mode="lines+markers",
                line={"color": mark.colour, "dash": mark.dash[0], "width": 1.5},
                marker={"symbol": mark.symbol[0], "size": 8, "color": mark.colour},
                customdata=ordered[["knob", "value", "milliseconds", "message"]].to_numpy(),
                hovertemplate="%{customdata[0]} %{customdata[1]:.0e}: error %{y:.1e}, %{x:.3g} times, "
                "%{customdata[2]:.3g} ms<br>%{customdata[3]}",
            )
        )
    for axis in (figure.update_xaxes, figure.update_yaxes):
        axis(type="log", exponentformat="power", dtick=1)
    # every decade would be too many on a tall scale
    figure.update_yaxes(dtick=2 if points["error"].max() > 1e6 * points["error"].min() else 1)
    if row["chance"] == row["chance"]:
        figure.add_hline(y=row["chance"], line={"color": _BASE_COLOUR, "dash": "dot", "width": 1.5})
    return reserve_legend(figure, points["line"].nunique())


def tradeoff_figure(found: Tradeoff) -> bytes:
    """Return the picture of all problems as SVG: a row for each, recess left and open ground right."""
    rows = {
        (row["problem"], row["model"]): row
        for row in records(found.problems)
        if not _chosen(found, row).empty
    }
    names = list(dict.fromkeys(name for name, _ in rows))
    styles = line_marks(found)

    def draw(figure: Figure) -> None:
        from matplotlib.lines import Line2D

        axes = figure.subplots(len(names), 2, squeeze=False, sharey="row")
        for place, name in enumerate(names):
            for side, model in enumerate(WHERE):
                _panel(axes[place][side], found, rows.get((name, model)), styles, bottom=name == names[-1])
        shown = [line for line in styles if (found.points["line"] == line).any()]
        handles = [
            Line2D([], [], color=styles[line].colour, linestyle=styles[line].dash[1],
                   marker=styles[line].symbol[1], markersize=4, linewidth=1.0, label=line)
            for line in shown
        ]  # fmt: skip
        figure.legend(handles=handles, loc="outside lower center", ncols=4, frameon=False, fontsize=7.5)

    return drawn(draw, 3.1 * len(names) + 1.2)


def _panel(
    axes: Axes, found: Tradeoff, row: dict[str, Any] | None, styles: dict[str, Mark], *, bottom: bool
) -> None:
    if row is None:
        axes.set_visible(False)
        return
    for line, members in _chosen(found, row).groupby("line", sort=False):
        mark = styles[str(line)]
        ordered = members.sort_values("value", ascending=False)
        axes.loglog(
            ordered["ratio"].to_numpy(),
            ordered["error"].to_numpy(),
            color=mark.colour,
            linestyle=mark.dash[1],
            marker=mark.symbol[1],
            markersize=3.5,
            linewidth=1.0,
        )
    if row["chance"] == row["chance"]:
        axes.axhline(row["chance"], color=_BASE_COLOUR, linestyle=":", linewidth=1.2)
    with_grid(axes)
    axes.set_title(f"{row['title']},\n{WHERE[row['model']]}", fontsize=9)
    if row["model"] == "recess":
        axes.set_ylabel(row["error_title"], fontsize=8)
    if bottom:
        axes.set_xlabel(TIME_TITLE, fontsize=8)
    axes.tick_params(labelsize=8)
