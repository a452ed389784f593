"""Tilt against time, and how two tilts part."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rockwobble.compare import AGREEMENT, make_pair

from ..case_view import CaseView
from ..palette import Style
from ..thinning import envelope
from .layout import TIME_TITLE, add_line, new_figure, reserve_legend

if TYPE_CHECKING:
    import plotly.graph_objects as go

# smaller differences are drawn here: a logarithm has no zero [alpha]
SMALLEST = 1e-7
# the difference is drawn as its largest value within this time, about one swing [s]
WINDOW = 1.0


def tilt_chart(view: CaseView) -> go.Figure:
    """Return the tilt of all runs over each other."""
    figure = new_figure(TIME_TITLE, "tilt / α [-]")
    for label, trace in view.traces.items():
        add_line(
            figure,
            trace.time,
            trace.tilt / view.case.cylinder.alpha,
            label,
            view.styles[label],
            width=1.8 if label in view.runs else 1.0,
            hovertemplate="%{y:.4f} α at %{x:.2f} s",
        )
    figure.update_yaxes(rangemode="nonnegative")
    _add_choice(figure, view)
    return reserve_legend(figure, len(figure.data))


def _add_choice(figure: go.Figure, view: CaseView) -> None:
    """Add buttons that show the runs of one support alone, with the model of that support."""
    if len(view.supports) < 2:
        return
    buttons = [{"label": "all", "method": "restyle", "args": [{"visible": True}]}]
    for support in view.supports:
        chosen = {label for label, trace in view.runs.items() if trace.run.support == support}
        chosen |= {view.partner(label) for label in chosen}
        shown = [True if label in chosen else "legendonly" for label in view.traces]
        buttons.append({"label": f"only {support}", "method": "restyle", "args": [{"visible": shown}]})
    figure.update_layout(
        margin_t=48,
        updatemenus=[
            {
                "type": "buttons",
                "direction": "right",
                "buttons": buttons,
                "x": 0.0,
                "xanchor": "left",
                "y": 1.02,
                "yanchor": "bottom",
                "pad": {"b": 2},
                "showactive": True,
            }
        ],
    )


def difference_chart(view: CaseView) -> go.Figure:
    """Return the envelope of |tilt difference| of each row of the summary, with its horizon marked."""
    import plotly.graph_objects as go

    figure = new_figure(TIME_TITLE, "|tilt difference| / α [-]")
    figure.update_yaxes(type="log", range=[np.log10(SMALLEST), 0.5], exponentformat="power", dtick=1)
    figure.add_hline(y=AGREEMENT, line={"color": "#222222", "dash": "dash", "width": 1})
    figure.add_annotation(
        text="1 % of α",
        x=1.0,
        xref="paper",
        xanchor="right",
        y=np.log10(AGREEMENT),  # annotations take the exponent on a logarithmic axis
        yanchor="bottom",
        showarrow=False,
        font={"size": 12},
        bgcolor="rgba(255,255,255,0.8)",
    )
    for row, reference, trial in view.pairs():
        pair = make_pair(view.case.cylinder, reference, trial)
        style, other = view.styles[row.run], view.styles[row.reference]
        name = f"{row.run} − {row.reference}"
        add_line(
            figure,
            pair.time,
            np.maximum(envelope(pair.time, np.abs(pair.tilt_difference), WINDOW), SMALLEST),
            name,
            Style(colour=style.colour, dash=other.dash),
            width=1.6,
            legendgroup=name,
            hovertemplate="%{y:.2e} α at %{x:.2f} s",
        )
        if row.diverged:
            filled = other.dash == "solid"
            figure.add_trace(
                go.Scatter(
                    x=[view.divergence(row)],
                    y=[AGREEMENT],
                    mode="markers",
                    name=name,
                    legendgroup=name,
                    showlegend=False,
                    marker={
                        "color": style.colour,
                        "size": 12,
                        "symbol": "diamond" if filled else "diamond-open",
                        "line": {"color": "#000000" if filled else style.colour, "width": 1.5},
                    },
                    hovertemplate="%{x:.2f} s",
                )
            )
    return reserve_legend(figure, 2 * len(view.rows))  # long names: one row each on a phone
