"""Where and how the cylinder stands at the end."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..case_view import CaseView
from .layout import new_figure

if TYPE_CHECKING:
    import plotly.graph_objects as go


def residual_chart(view: CaseView) -> list[tuple[str, go.Figure]]:
    """Return title and figure of residual displacement and of residual twist."""
    once = view.rows.drop_duplicates("run")
    runs = [str(run) for run in once["run"]]
    moved = [float(value) for value in once["residual_displacement"]]
    twisted = [abs(float(value)) for value in once["residual_twist"]]
    return [
        ("residual displacement", _bars(view, runs, moved, "displacement / b [-]", "b")),
        ("residual twist", _bars(view, runs, twisted, "twist [deg]", "°")),
    ]


def _bars(view: CaseView, runs: list[str], values: list[float], title: str, unit: str) -> go.Figure:
    import plotly.graph_objects as go

    figure = new_figure(title, "", height=90 + 34 * len(runs), showlegend=False)
    largest = max((value for value in values if value == value), default=1.0) or 1.0
    figure.add_trace(
        go.Bar(
            x=values,
            y=runs,
            orientation="h",
            marker={"color": [view.styles[run].colour if run in view.styles else "#999999" for run in runs]},
            text=[f"{value:.3g} {unit}" if value == value else "unknown" for value in values],
            textposition="outside",
            cliponaxis=False,
            hoverinfo="skip",
        )
    )
    # room for the numbers beside the bars
    figure.update_xaxes(range=[0.0, 1.35 * largest], rangemode="tozero", nticks=5)
    figure.update_yaxes(autorange="reversed")
    return figure
