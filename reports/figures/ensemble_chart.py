"""Peak tilts of an ensemble on a page: distributions over each other, and each member against itself."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import compress
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from rockwobble.compare.metrics.distributions import MARGIN

from .charts.layout import new_figure, reserve_legend, small
from .ensemble_ratios import ratio_rows, ratio_span, ratio_ticks
from .palette import Style, model_style, run_styles

if TYPE_CHECKING:
    import plotly.graph_objects as go

    from rockwobble.compare import Ensemble

MODELS = ("recess", "flat", "planar")
_BAR, _BEYOND = "#222222", "#D55E00"


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Curve:
    """The distribution of one method.

    Attributes
    ----------
    label : str
        Method, and how many of how many runs overturn.
    members : list of str
        Those that stand, in the order of the curve.
    tilt, share : ndarray, shape (k + 2,)
        Steps from 0 to the end of the axis: peak tilt [alpha], and share of the runs that did not fail [-].
    overturned : int
    style : Style
    """

    label: str
    members: list[str]
    tilt: NDArray[np.float64]
    share: NDArray[np.float64]
    overturned: int
    style: Style


def curves(found: Ensemble) -> list[Curve]:
    """Return the distribution of each method with runs that did not fail."""
    methods = list(found.methods["method"])
    reach = end_of_axis(found)
    styles = run_styles([method for method in methods if method not in MODELS])
    drawn = []
    for method in methods:
        runs = found.members[(found.members["method"] == method) & (found.members["outcome"] != "failed")]
        if not len(runs):
            continue
        standing = runs[runs["outcome"] != "overturned"].sort_values("peak_tilt")
        fallen = len(runs) - len(standing)
        drawn.append(
            Curve(
                label=f"{method} ({fallen} of {len(runs)} overturn)",
                members=list(standing["member"]),
                tilt=np.concatenate([[0.0], standing["peak_tilt"].to_numpy(float), [reach]]),
                share=np.append(np.arange(len(standing) + 1), len(standing)) / len(runs),
                overturned=fallen,
                style=model_style(method) if method in MODELS else styles[method],
            )
        )
    return drawn


def ensemble_chart(found: Ensemble) -> go.Figure:
    """Return the share of the members whose peak tilt is at most that of the axis, by method."""
    import plotly.graph_objects as go

    figure = new_figure("peak tilt / α [-]", "share of the members [-]", height=420)
    drawn = curves(found)
    for curve in drawn:
        marks = [*[0] * (len(curve.tilt) - 1), 10 if curve.overturned else 0]
        figure.add_trace(
            go.Scatter(
                x=small(curve.tilt),
                y=small(curve.share),
                name=curve.label,
                mode="lines+markers",
                line={"color": curve.style.colour, "dash": curve.style.dash, "width": 1.6, "shape": "hv"},
                marker={"symbol": "triangle-right", "size": marks, "color": curve.style.colour},
                cliponaxis=False,
                text=["", *curve.members, ""],
                hovertemplate="%{y:.2f} tilt at most %{x:.3f} α<br>%{text}",
            )
        )
    figure.update_xaxes(range=[0.0, end_of_axis(found)])
    figure.update_yaxes(range=[0.0, 1.03])
    return reserve_legend(figure, 2 * len(drawn))  # a line of the legend has room for one on a phone


def ratio_chart(found: Ensemble) -> go.Figure | None:
    """Return the ratios of the members, by pair of methods; None where no pair has any."""
    import plotly.graph_objects as go

    rows = ratio_rows(found)
    if not rows:
        return None
    low, high = ratio_span(rows)
    figure = new_figure("ratio of peak tilts [-]", "method / against [-]", height=190 + 60 * len(rows))
    figure.add_vrect(
        x0=1.0 / (1.0 + MARGIN), x1=1.0 + MARGIN, fillcolor="#e8eef4", line_width=0, layer="below"
    )
    for place, row in enumerate(rows):
        inside = (row.ratios > 0.0) & np.isfinite(row.ratios)
        figure.add_trace(
            go.Scatter(
                x=small(row.ratios[inside]),
                y=np.full(inside.sum(), place - 0.2),
                mode="markers",
                name="members",
                showlegend=place == 0,
                marker={"size": 6, "color": "#0072B2", "opacity": 0.6},
                text=list(compress(row.members, inside)),
                hovertemplate="%{text}: %{x:.3f}<extra></extra>",
            )
        )
        for edge, side, beyond in ((low, "left", row.ratios == 0.0), (high, "right", np.isinf(row.ratios))):
            if not beyond.any():
                continue
            figure.add_trace(
                go.Scatter(
                    x=[edge],
                    y=[place - 0.2],
                    mode="markers+text",
                    showlegend=False,
                    marker={"symbol": f"triangle-{side}", "size": 11, "color": _BEYOND},
                    cliponaxis=False,
                    text=[str(int(beyond.sum()))],
                    textposition="middle right" if side == "left" else "middle left",
                    textfont={"color": _BEYOND, "size": 12},
                    hovertext="<br>".join(compress(row.members, beyond)),
                    hovertemplate="%{hovertext}: one method alone overturns<extra></extra>",
                )
            )
        for ends, width, name in ((row.spread, 1.2, "5 to 95 %"), (row.ends, 5.0, "95 % of the median")):
            figure.add_trace(
                go.Scatter(
                    x=np.clip(ends, low, high),
                    y=[place + 0.2] * 2,
                    mode="lines",
                    name=name,
                    showlegend=place == 0,
                    line={"color": _BAR, "width": width},
                    hoverinfo="skip",
                )
            )
        figure.add_trace(
            go.Scatter(
                x=[row.median if low <= row.median <= high else None],
                y=[place + 0.2],
                mode="markers",
                name="median",
                showlegend=place == 0,
                marker={
                    "symbol": "diamond",
                    "size": 9,
                    "color": _BAR,
                    "line": {"color": "white", "width": 1},
                },
                hovertemplate="median %{x:.3f}<extra></extra>",
            )
        )
    ticks = ratio_ticks(low, high)
    figure.update_xaxes(
        type="log",
        range=[float(np.log10(low)), float(np.log10(high))],
        tickvals=ticks,
        ticktext=[f"{tick:g}" for tick in ticks],
    )
    figure.update_yaxes(
        range=[len(rows) - 0.4, -0.6],
        tickvals=list(range(len(rows))),
        ticktext=["<br>".join(row.label) for row in rows],
        showgrid=False,
        zeroline=False,
        ticks="",
        ticklabelstandoff=10,  # room for the triangles
    )
    return reserve_legend(figure, 4)


def end_of_axis(found: Ensemble) -> float:
    """Return the peak tilt to which the curves are drawn, a little beyond the largest that stands [alpha]."""
    standing = found.members.loc[found.members["outcome"] != "overturned", "peak_tilt"]
    largest = float(standing.max(skipna=True)) if standing.notna().any() else 0.0
    return 1.05 * largest or 1.0
