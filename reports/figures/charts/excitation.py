"""The ground acceleration."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..case_view import CaseView
from ..palette import Style
from .layout import TIME_TITLE, add_line, new_figure, reserve_legend

if TYPE_CHECKING:
    import plotly.graph_objects as go

_AXES = (("x, east-west", "#0072B2"), ("y, north-south", "#D55E00"), ("z, up", "#009E73"))


def excitation_chart(view: CaseView) -> go.Figure | None:
    """Return the components of the ground acceleration in g, None where the ground is still."""
    motion, gravity = view.case.motion, view.case.gravity
    if motion is None:
        return None
    figure = new_figure(TIME_TITLE, "ground acceleration / g [-]", height=300)
    time = np.arange(len(motion.acceleration), dtype=np.float64) * motion.time_step
    for component, (name, colour) in zip(motion.acceleration.T, _AXES, strict=False):
        style = Style(colour=colour, dash="solid")
        add_line(
            figure,
            time,
            component / gravity,
            name,
            style,
            width=1.0,
            hovertemplate="%{y:.3f} g at %{x:.2f} s",
        )
    threshold = view.case.cylinder.tan_alpha
    for sign in (1.0, -1.0):
        figure.add_hline(y=sign * threshold, line={"color": "#222222", "dash": "dash", "width": 1})
    figure.add_annotation(
        text=f"uplift where |a| exceeds tan α = {threshold:g}",
        x=1.0,
        xref="paper",
        xanchor="right",
        y=threshold,
        yanchor="bottom",
        showarrow=False,
        font={"size": 12},
        bgcolor="rgba(255,255,255,0.8)",
    )
    peak = max(1.15 * threshold, 1.05 * float(np.abs(motion.acceleration).max()) / gravity)
    figure.update_yaxes(range=[-peak, peak])
    return reserve_legend(figure, len(figure.data))
