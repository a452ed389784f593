"""What a difference is made of: shares of all parts, and the parts against time."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rockwobble.compare import ErrorBudget

from ..case_view import CaseView
from ..palette import Style
from ..thinning import envelope
from .layout import TIME_TITLE, add_line, new_figure, reserve_legend
from .tilt import WINDOW

if TYPE_CHECKING:
    import plotly.graph_objects as go

# blue, pale orange and vermilion of Okabe and Ito: apart in every kind of colour vision and in grey
PARTS = {
    "model_form": ("model form", Style(colour="#0072B2", dash="solid"), "/"),
    "numerics": ("numerics", Style(colour="#E69F00", dash="dash"), ""),
    "unexplained": ("unexplained", Style(colour="#D55E00", dash="dot"), "x"),
}
WHOLE = Style(colour="#000000", dash="solid")
# a logarithm has no zero [alpha]
_SMALLEST = 1e-10


def part_shares(budget: ErrorBudget) -> dict[str, float]:
    """Return the RMS of each part over the sum of all three: signed parts may cancel, these may not."""
    sizes = {part: budget.rms(part) for part in PARTS}
    total = sum(sizes.values())
    return {part: size / total if total > 0.0 else 0.0 for part, size in sizes.items()}


def budget_bars(view: CaseView) -> go.Figure | None:
    """Return the stacked parts of each run and reference; None without budgets."""
    import plotly.graph_objects as go

    if not view.budgets:
        return None
    names = [f"{run} − {model}" for run, model in view.budgets]
    figure = new_figure("share of the parts [-]", "", height=120 + 36 * len(names), barmode="stack")
    for part, (name, style, pattern) in PARTS.items():
        figure.add_trace(
            go.Bar(
                x=[part_shares(budget)[part] for budget in view.budgets.values()],
                y=names,
                name=name,
                orientation="h",
                marker={
                    "color": style.colour,
                    "pattern": {"shape": pattern, "fgcolor": "white", "size": 6, "solidity": 0.2},
                },
                customdata=[budget.rms(part) for budget in view.budgets.values()],
                hovertemplate="%{customdata:.2e} α",
            )
        )
    for name, budget in zip(names, view.budgets.values(), strict=True):
        figure.add_annotation(
            x=1.01,
            y=name,
            text=f"{budget.rms('whole'):.1e} α",
            showarrow=False,
            xanchor="left",
            font={"size": 12},
        )
    figure.update_xaxes(range=[0.0, 1.22], tickvals=[0.0, 0.25, 0.5, 0.75, 1.0])
    figure.update_yaxes(autorange="reversed")
    return reserve_legend(figure, len(PARTS))


def budget_charts(view: CaseView, *, above: float = 0.0) -> list[tuple[str, go.Figure]]:
    """Return title and figure of the parts against time, for each run and reference.

    Only of differences whose RMS is at least `above` [alpha].
    """
    panels = []
    for (run, model), budget in view.budgets.items():
        if budget.rms("whole") < above:
            continue
        figure = new_figure(TIME_TITLE, "|part| / α [-]", height=300)
        figure.update_yaxes(type="log", exponentformat="power", dtick=2)
        lines = {"whole": ("whole", WHOLE, "")} | PARTS
        for part, (name, style, _) in lines.items():
            values = np.abs(getattr(budget, part))
            if not values.any():
                continue
            add_line(
                figure,
                budget.time,
                np.maximum(envelope(budget.time, values, WINDOW), _SMALLEST),
                name,
                style,
                width=1.0 if part == "whole" else 2.0,
                hovertemplate="%{y:.2e} α at %{x:.2f} s",
            )
        figure.add_vline(x=budget.covered, line={"color": "#888888", "dash": "dash", "width": 1})
        panels.append((f"{run} − {model}", reserve_legend(figure, 4)))
    return panels
