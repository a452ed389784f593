"""The page of a comparison: one file that needs nothing else."""

from __future__ import annotations

import html
import math
from typing import TYPE_CHECKING, Any

from ...figures import charts
from ...figures.case_view import CaseView, case_views
from ...figures.playback import playback
from ..case_words import describe
from ..template import PLOT_CONFIG, render
from .budget_words import budget_lines, divergence_lines
from .findings import finding_sentences, headline

if TYPE_CHECKING:
    import plotly.graph_objects as go

    from rockwobble.compare import Comparison

_PLAYED = 4  # cases that are played in the page, 0.3 MB each; `rockwobble view` plays any other


def comparison_page(comparison: Comparison, command: str = "") -> str:
    """Return the page as HTML, plotly.js inside.

    Parameters
    ----------
    comparison : Comparison
    command : str, optional
        What made it, for the reader who wants to make it again.
    """
    from rockwobble.compare import SUMMARY_COLUMNS

    views = case_views(comparison)
    return render(
        "compare.html.j2",
        command=command,
        cases=[_case(view, index) for index, view in enumerate(views)],
        columns=[
            {"name": name, "unit": unit, "meaning": meaning}
            for name, (unit, meaning) in SUMMARY_COLUMNS.items()
            # results may be older than a column
            if name in comparison.summary and name not in ("case", "run")
        ],
        versions=comparison.versions,
    )


def _case(view: CaseView, index: int) -> dict[str, Any]:
    excitation = charts.excitation_chart(view)
    bars = charts.budget_bars(view)
    return {
        "name": view.case.name,
        "lines": describe(view.case),
        "headline": headline(view.rows, view.case.length),
        "findings": finding_sentences(view),
        "rows": [{name: _cell(value) for name, value in row.items()} for _, row in view.rows.iterrows()],
        "playback": playback(view) if index < _PLAYED else None,
        "divergence": divergence_lines(view.rows),
        "budget_words": budget_lines(view.rows),
        "budget": None if bars is None else _plot(bars, f"budget-{index}"),
        "budget_parts": _plots(charts.budget_charts(view), f"budget-part-{index}"),
        "tilt": _plot(charts.tilt_chart(view), f"tilt-{index}"),
        "difference": _plot(charts.difference_chart(view), f"difference-{index}"),
        "orbits": _plots(charts.orbit_charts(view), f"orbit-{index}"),
        "azimuth": _plot(charts.azimuth_chart(view), f"azimuth-{index}"),
        "drift": _plots(charts.drift_charts(view), f"drift-{index}"),
        "turns": _plot(charts.turn_chart(view), f"turns-{index}"),
        "residuals": _plots(charts.residual_chart(view), f"residual-{index}"),
        "excitation": None if excitation is None else _plot(excitation, f"excitation-{index}"),
    }


def _plots(panels: list[tuple[str, go.Figure]], name: str) -> list[dict[str, str]]:
    return [
        {"title": title, "plot": _plot(figure, f"{name}-{index}")}
        for index, (title, figure) in enumerate(panels)
    ]


def _plot(figure: go.Figure, name: str) -> str:
    """Return the element of a figure and the script that draws it."""
    return str(
        figure.to_html(full_html=False, include_plotlyjs=False, div_id=html.escape(name), config=PLOT_CONFIG)
    )


def _cell(value: Any) -> str:
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, float):
        return f"{value:.4g}" if math.isfinite(value) else "–"
    return str(value)
