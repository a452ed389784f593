"""The angle of turn of each pass."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from rockwobble.reduced import limiting_angle_of_turn

from ..case_view import CaseView
from .layout import TIME_TITLE, new_figure, reserve_legend, small

if TYPE_CHECKING:
    import plotly.graph_objects as go

_SYMBOLS = ("circle", "square", "triangle-up", "triangle-down", "star", "hexagon")


def turn_chart(view: CaseView) -> go.Figure:
    """Return |angle of turn| of each pass, against its limit for vanishing spin."""
    import plotly.graph_objects as go

    figure = new_figure(TIME_TITLE, "|angle of turn| [deg]")
    figure.update_xaxes(range=[0.0, view.case.length])
    figure.update_yaxes(rangemode="tozero")
    limit = math.degrees(limiting_angle_of_turn(view.case.cylinder))
    figure.add_trace(
        go.Scatter(
            x=[0.0, view.case.length],
            y=[limit, limit],
            mode="lines",
            name=f"π √(A/J) = {limit:.2f}°, vanishing spin",
            line={"color": "#222222", "dash": "dash", "width": 1},
            hoverinfo="skip",
        )
    )
    for index, (label, trace) in enumerate(view.traces.items()):
        passes, colour = trace.passes, view.styles[label].colour
        model = label not in view.runs
        resolved = passes["resolved"].to_numpy(bool)
        symbol = (
            ("cross-thin" if "recess" in label else "x-thin") if model else _SYMBOLS[index % len(_SYMBOLS)]
        )
        figure.add_trace(
            go.Scatter(
                x=small(passes["time"].to_numpy(float)),
                y=small(np.abs(np.degrees(passes["angle_of_turn"].to_numpy(float)))),
                customdata=small(passes["minimum_tilt"].to_numpy(float) / view.case.cylinder.alpha),
                mode="markers",
                name=label,
                marker={
                    "symbol": symbol if model else np.where(resolved, symbol, f"{symbol}-open"),
                    "color": colour,
                    "size": 9,
                    "opacity": 0.85,
                    "line": {"color": colour, "width": 1.5},
                },
                hovertemplate="%{y:.2f}° at %{x:.2f} s, minimum tilt %{customdata:.2g} α",
            )
        )
    return reserve_legend(figure, len(view.traces) + 2)
