"""The figures of an advice: the trace and its spread, the peaks, other scales, and the friction."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from rockwobble.compare.metrics.tilt import overturned
from rockwobble.compare.studies.spectrum.series import PLANAR_X, PLANAR_Y, SPATIAL

from .charts.layout import TIME_TITLE, add_line, new_figure, reserve_legend, small
from .palette import Style, model_style, run_styles

if TYPE_CHECKING:
    import plotly.graph_objects as go

    from rockwobble.compare.studies.advice import Advice

_HEIGHT = 300
_BAND = "#cfe3f1"  # the pale of the first colour of runs
NAMES = {SPATIAL: "3D", PLANAR_X: "planar, x alone", PLANAR_Y: "planar, y alone"}
STANDS, FALLS = 1.2, 1.3  # [alpha] where tilts are cut, and where overturned runs are drawn


def advice_charts(advice: Advice) -> list[tuple[str, str, go.Figure]]:
    """Return title, explanation and figure of what there is to draw of an advice."""
    found = []
    if advice.moves:
        found.append(("Tilt", _tilt_text(advice), tilt_chart(advice)))
        found.append(
            (
                "Largest tilt of the perturbed starts",
                "Share of the starts that tilt no more than this; what a curve lacks to 1 overturns.",
                peaks_chart(advice),
            )
        )
    if advice.scan is not None:
        found.append(
            (
                "Other scales of this shaking",
                "Largest tilt; at the top what overturns. The dashed line is the case as given.",
                scales_chart(advice),
            )
        )
    if advice.moves:
        found.append(
            (
                "Friction needed",
                "Horizontal over normal force of the contact; the dashed line is what is available.",
                friction_chart(advice),
            )
        )
    return found


def tilt_chart(advice: Advice) -> go.Figure:
    """Return the tilt of reduced model and engine over the spread of perturbed starts."""
    import plotly.graph_objects as go

    figure = new_figure(TIME_TITLE, "tilt / α [-]", height=_HEIGHT)
    alpha, spread = advice.case.cylinder.alpha, advice.spread
    assert spread is not None
    figure.add_trace(
        go.Scatter(
            x=small(np.concatenate([spread.time, spread.time[::-1]])),
            y=small(np.minimum(np.concatenate([spread.high, spread.low[::-1]]), STANDS)),
            fill="toself",
            fillcolor=_BAND,
            line={"width": 0},
            name="90 % of the starts",
            hoverinfo="skip",
        )
    )
    lines: list[tuple[str, Any, Style, float]] = [
        (f"{advice.model} model", advice.response, model_style(advice.model), 1.2)
    ]
    if advice.verification is not None and advice.verification.trajectory is not None:
        label = advice.verification.label
        lines.insert(0, (label, advice.verification.trajectory, run_styles([label])[label], 1.8))
    for name, trace, style, width in lines:
        tilt = np.minimum(trace.tilt / alpha, STANDS)
        add_line(figure, trace.time, tilt, name, style, width=width, hovertemplate="%{y:.3f} α at %{x:.2f} s")
    if advice.trust.kind != "trace":
        figure.add_vline(x=advice.trust.until, line={"color": "#222222", "dash": "dash", "width": 1})
        figure.add_annotation(
            text="the trace holds until here",
            x=advice.trust.until,
            y=1.0,
            yref="paper",
            xanchor="left" if advice.trust.until < 0.6 * advice.case.length else "right",
            yanchor="top",
            showarrow=False,
            font={"size": 12},
            bgcolor="rgba(255,255,255,0.8)",
        )
    figure.update_yaxes(rangemode="nonnegative")
    return reserve_legend(figure, len(figure.data))


def peaks_chart(advice: Advice) -> go.Figure:
    """Return the empirical distributions of the largest tilt by both reduced models."""
    import plotly.graph_objects as go

    spread = advice.spread
    assert spread is not None
    figure = new_figure("largest tilt / α [-]", "share of the starts [-]", height=_HEIGHT)
    for model, peaks, fell, response in (
        (spread.model, spread.peaks, spread.overturned, advice.response),
        (spread.other, spread.other_peaks, spread.other_overturned, advice.other_response),
    ):
        known = np.isfinite(peaks)
        standing = np.sort(peaks[known & ~fell])
        if not known.any():
            continue
        style = model_style(model)
        figure.add_trace(
            go.Scatter(
                x=small(np.concatenate([[0.0], standing])),
                y=small(np.arange(len(standing) + 1) / known.sum()),
                name=f"{model} model",
                legendgroup=model,
                mode="lines",
                line={"color": style.colour, "dash": style.dash, "width": 1.6, "shape": "hv"},
                hovertemplate="%{x:.3f} α: %{y:.2f}",
            )
        )
        if response.outcome in ("completed", "rest"):
            peak = response.peak_tilt / advice.case.cylinder.alpha
            figure.add_trace(
                go.Scatter(
                    x=[peak],
                    y=[float(np.mean(np.where(fell, math.inf, peaks)[known] <= peak))],
                    mode="markers",
                    name=f"as given, {model}",
                    marker={
                        "color": style.colour,
                        "size": 11,
                        "symbol": "diamond" if model == spread.model else "diamond-open",
                    },
                    hovertemplate="as given: %{x:.3f} α",
                )
            )
    figure.update_yaxes(range=[0.0, 1.03])
    figure.update_xaxes(rangemode="tozero")
    return reserve_legend(figure, len(figure.data))


def scales_chart(advice: Advice) -> go.Figure:
    """Return the largest tilt over scales, in 3D and by planar analysis."""
    import plotly.graph_objects as go

    scan, alpha = advice.scan, advice.case.cylinder.alpha
    assert scan is not None
    figure = new_figure("scale of the ground motion [-]", "largest tilt / α [-]", height=_HEIGHT)
    planes = run_styles([PLANAR_X, PLANAR_Y])
    for name, peaks in scan.peaks.items():
        style = model_style(advice.model) if name == SPATIAL else planes[name]
        tilt = np.where(overturned(peaks), FALLS, np.minimum(peaks / alpha, STANDS))
        figure.add_trace(
            go.Scatter(
                x=small(scan.factors),
                y=small(tilt),
                name=NAMES[name],
                mode="lines+markers",
                line={"color": style.colour, "dash": style.dash, "width": 1.3},
                marker={"size": 4},
                hovertemplate="%{y:.3f} α at %{x:.3g} times",
            )
        )
    figure.add_vline(x=1.0, line={"color": "#222222", "dash": "dash", "width": 1})
    ticks = [0.25, 0.5, 1, 2, 4, 8, 16]
    figure.update_xaxes(type="log", tickvals=ticks, ticktext=[f"{tick:g}" for tick in ticks])
    levels = [0.0, 0.25, 0.5, 0.75, 1.0, FALLS]
    figure.update_yaxes(
        range=[-0.02, 1.4], tickvals=levels, ticktext=[*(f"{level:g}" for level in levels[:-1]), "falls"]
    )
    return reserve_legend(figure, len(figure.data))


def friction_chart(advice: Advice) -> go.Figure:
    """Return the friction needed over time, as far as it is worth drawing."""
    response, available = advice.response, advice.demands.friction
    figure = new_figure(TIME_TITLE, "friction needed [-]", height=_HEIGHT, showlegend=False)
    # what no friction supplies is drawn at the top
    top = 1.15 * max(available, min(advice.demands.friction_needed, 2.0 * available + 0.2))
    needed = np.where(response.tilt > 0.0, np.minimum(response.friction_needed, top), 0.0)
    add_line(
        figure,
        response.time,
        needed,
        "needed",
        model_style(advice.model),
        width=1.0,
        hovertemplate="%{y:.3f} at %{x:.2f} s",
    )
    figure.add_hline(y=available, line={"color": "#222222", "dash": "dash", "width": 1})
    figure.update_yaxes(range=[0.0, top])
    return figure


def _tilt_text(advice: Advice) -> str:
    text = "The case as given, over the band that holds 90 % of the perturbed starts at each time."
    return f"{text} Cut at {STANDS:g} α." if advice.overturned else text
