"""Paths of the centre of mass seen from above."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from rockwobble.models import Trace

from ..case_view import CaseView
from ..palette import Style
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
    ends = {(row.run, row.reference): view.divergence(row) for row, _, _ in view.pairs()}
    for label, trace in view.runs.items():
        other = view.partner(label)
        end = ends.get((label, other), math.inf)
        figure = new_figure("east-west / b [-]", "north-south / b [-]", height=340)
        _add_path(figure, view.traces[other], other, view.styles[other], end, 2.6)
        _add_path(figure, trace, label, view.styles[label], end, 1.4)
        figure.update_xaxes(range=[-reach, reach], constrain="domain")
        figure.update_yaxes(range=[-reach, reach], scaleanchor="x", scaleratio=1, constrain="domain")
        figure.update_layout(height=400, margin_b=60)
        panels.append((f"{label} over the {other}", figure))
    return panels


def _reach(view: CaseView) -> float:
    b = view.case.cylinder.base_radius
    traces = view.traces.values()
    # a fallen cylinder would leave nothing to be seen of the rest
    largest = max((_beyond(trace, view) for trace in traces), default=0.0)
    return min(1.08 * largest, 6.0 * view.case.cylinder.semidiagonal) / b or 1.0


def _beyond(trace: Trace, view: CaseView) -> float:
    upright = trace.tilt <= 1.2 * view.case.cylinder.alpha
    return float(np.nanmax(np.abs(trace.centre_of_mass[upright, :2]), initial=0.0))


def _add_path(figure: go.Figure, trace: Trace, name: str, style: Style, end: float, width: float) -> None:
    import plotly.graph_objects as go

    path: NDArray[np.float64] = trace.centre_of_mass[:, :2] / trace.case.cylinder.base_radius
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
