"""Empirical distributions of peak tilt over each other, on a page."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from .charts.layout import new_figure, reserve_legend, small
from .palette import model_style, run_styles

if TYPE_CHECKING:
    import plotly.graph_objects as go

    from rockwobble.compare import Ensemble

MODELS = ("recess", "rolling", "planar")


def ensemble_chart(found: Ensemble) -> go.Figure:
    """Return the share of the members whose peak tilt is at most that of the axis, by method.

    A curve that ends below 1 leaves the share that overturns.
    """
    import plotly.graph_objects as go

    figure = new_figure("peak tilt / α [-]", "share of the members [-]", height=420)
    methods = list(found.methods["method"])
    reach = end_of_axis(found)
    styles = run_styles([method for method in methods if method not in MODELS])
    for method in methods:
        runs = found.members[(found.members["method"] == method) & (found.members["outcome"] != "failed")]
        standing = runs.loc[runs["outcome"] != "overturned"].sort_values("peak_tilt")
        if not len(runs):
            continue
        style = model_style(method) if method in MODELS else styles[method]
        figure.add_trace(
            go.Scatter(
                x=small(np.concatenate([[0.0], standing["peak_tilt"].to_numpy(float), [reach]])),
                y=small(np.append(np.arange(len(standing) + 1), len(standing)) / len(runs)),
                name=method,
                mode="lines",
                line={"color": style.colour, "dash": style.dash, "width": 1.6, "shape": "hv"},
                text=["", *standing["member"], ""],
                hovertemplate="%{y:.2f} tilt at most %{x:.3f} α<br>%{text}",
            )
        )
    figure.update_xaxes(range=[0.0, reach])
    figure.update_yaxes(range=[0.0, 1.03])
    return reserve_legend(figure, len(figure.data))


def end_of_axis(found: Ensemble) -> float:
    """Return the peak tilt to which the curves are drawn, a little beyond the largest that stands [alpha]."""
    standing = found.members.loc[found.members["outcome"] != "overturned", "peak_tilt"]
    largest = float(standing.max(skipna=True)) if standing.notna().any() else 0.0
    return 1.05 * largest or 1.0
