"""Paths of the centre of mass seen from above."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from rockwobble.compare import own_model

from ..case_view import CaseView
from ..palette import Style, model_style
from ..thinning import kept_samples
from .layout import new_figure, small

if TYPE_CHECKING:
    import plotly.graph_objects as go


def orbit_charts(view: CaseView) -> list[tuple[str, go.Figure]]:
    """Return title and figure for each run: its path over that of the model of its support.

    Both are drawn strongly until they part, and faintly from then on.
    """
    reach = _reach(view)
    panels = []
    for label, trace in view.trajectories.items():
        model = own_model(trace.support)
        if model not in view.responses:
            model = next(iter(view.responses))
        row = view.rows[(view.rows["run"] == label) & (view.rows["reference"] == model)].iloc[0]
        end = view.start(model) + row.agreement_time if row.diverged else float(trace.time[-1])
        figure = new_figure("east-west / b [-]", "north-south / b [-]", height=340)
        _add_path(figure, view, view.responses[model], f"{model} model", model_style(model), end, 2.6)
        _add_path(figure, view, trace, label, view.styles[label], end, 1.4)
        figure.update_xaxes(range=[-reach, reach], constrain="domain")
        figure.update_yaxes(range=[-reach, reach], scaleanchor="x", scaleratio=1, constrain="domain")
        figure.update_layout(height=400, margin_b=60)
        panels.append((f"{label} over the {model} model", figure))
    return panels


def _reach(view: CaseView) -> float:
    b = view.case.cylinder.base_radius
    traces = [*view.trajectories.values(), *view.responses.values()]
    # a fallen cylinder would leave nothing to be seen of the rest
    largest = max((_beyond(trace, view) for trace in traces), default=0.0)
    return min(1.08 * largest, 6.0 * view.case.cylinder.semidiagonal) / b or 1.0


def _beyond(trace: Any, view: CaseView) -> float:
    upright = trace.tilt <= 1.2 * view.case.cylinder.alpha
    return float(np.nanmax(np.abs(trace.centre_of_mass[upright, :2]), initial=0.0))


def _add_path(
    figure: go.Figure, view: CaseView, trace: Any, name: str, style: Style, end: float, width: float
) -> None:
    import plotly.graph_objects as go

    b = view.case.cylinder.base_radius
    path: NDArray[np.float64] = trace.centre_of_mass[:, :2] / b
    agreed = trace.time <= end
    for part, opacity, shown in ((agreed, 1.0, True), (~agreed, 0.25, False)):
        points = path[part]
        if len(points) < 2:
            continue
        keep = kept_samples(points[:, 0], points[:, 1])
        figure.add_trace(
            go.Scatter(
                x=small(points[keep, 0]),
                y=small(points[keep, 1]),
                customdata=small(trace.time[part][keep]),
                mode="lines",
                name=name,
                legendgroup=name,
                showlegend=shown,
                opacity=opacity,
                line={"color": style.colour, "width": width},
                hovertemplate="(%{x:.3f}, %{y:.3f}) b at %{customdata:.2f} s",
            )
        )
