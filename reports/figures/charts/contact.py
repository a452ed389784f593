"""Where the rim touches: its azimuth, and how far it leaves the original circle."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from rockwobble.compare import TILTED
from rockwobble.models import Trace

from ..case_view import CaseView
from .layout import TIME_TITLE, add_line, new_figure, reserve_legend

if TYPE_CHECKING:
    import plotly.graph_objects as go


def azimuth_chart(view: CaseView) -> go.Figure:
    """Return the unwrapped azimuth of the contact point."""
    figure = new_figure(TIME_TITLE, "azimuth of contact [turns]")
    origin = _common_turn(view)
    for label, trace in view.traces.items():
        turns = trace.rolling_angle / (2.0 * np.pi)
        # azimuths are known up to whole turns: all start on the branch of the model
        start = turns[np.isfinite(turns)]
        offset = round(float(start[0]) - origin) if len(start) else 0
        add_line(
            figure,
            trace.time,
            turns - offset,
            label,
            view.styles[label],
            width=1.8 if label in view.runs else 1.0,
            hovertemplate="%{y:.3f} turns at %{x:.2f} s",
        )
    return reserve_legend(figure, len(figure.data))


def _common_turn(view: CaseView) -> float:
    for trace in view.references.values():
        if np.isfinite(trace.uplift_direction):
            return trace.uplift_direction / (2.0 * np.pi)
    return 0.0


def drift_charts(view: CaseView) -> list[tuple[str, go.Figure]]:
    """Return title and figure for each support: the contact point's distance from the original circle.

    One figure for each, because a guided and a free cylinder differ by orders of magnitude.
    """
    panels = []
    for support in view.supports:
        figure = new_figure(TIME_TITLE, "radial drift / b [%]", height=300)
        for label, trace in view.traces.items():
            # the recess model keeps to the circle: that line is zero
            if trace.run.support == support and (label in view.runs or support != "recess"):
                drift = 100.0 * _drift(trace)
                style, hover = view.styles[label], "%{y:.3g} % at %{x:.2f} s"
                add_line(figure, trace.time, drift, label, style, hovertemplate=hover)
        panels.append((f"support {support}", figure))
    entries = max((len(figure.data) for _, figure in panels), default=0)
    return [(title, reserve_legend(figure, entries)) for title, figure in panels]


def _drift(trace: Trace) -> NDArray[np.float64]:
    """(|T| - b)/b, NaN where the tilt is too small for a contact point to mean anything."""
    tilted = trace.tilt > TILTED * np.nanmax(trace.tilt)
    return np.where(tilted, trace.contact_offset / trace.case.cylinder.base_radius, np.nan)
