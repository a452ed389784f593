"""The page of an ensemble: its figures and its tables, in one file."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ...figures.ensemble_chart import ensemble_chart, ratio_chart
from ..provenance import made_by
from ..template import PLOT_CONFIG, render
from .words import CAPTION, INTRODUCTION, LEGEND, WORDS, facts, statements, tables

if TYPE_CHECKING:
    from rockwobble.compare import Ensemble


def ensemble_page(found: Ensemble) -> str:
    """Return the page as HTML, plotly.js inside."""
    headline, *sentences = statements(found)
    charts = {"ensemble": ensemble_chart(found), "ratios": ratio_chart(found)}
    return render(
        "ensemble.html.j2",
        pictures=[
            chart.to_html(full_html=False, include_plotlyjs=False, div_id=name, config=PLOT_CONFIG)
            for name, chart in charts.items()
            if chart is not None
        ],
        introduction=INTRODUCTION,
        caption=CAPTION,
        facts=facts(found),
        headline=headline,
        sentences=sentences,
        tables=tables(found),
        legend=LEGEND,
        words=WORDS,
        made_by=made_by(found.about["versions"], found.about.get("command")).replace("`", ""),
    )
