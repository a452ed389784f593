"""The page of an advice: its verdict, its statements and four figures."""

from __future__ import annotations

import html
from typing import TYPE_CHECKING

from ...figures.advise_charts import advice_charts
from ..case_words import describe
from ..template import PLOT_CONFIG, render
from .statements import GRADE_WORDS, statements, verdict, verdict_grade

if TYPE_CHECKING:
    from rockwobble.compare.studies.advice import Advice


def advice_page(advice: Advice, command: str = "") -> str:
    """Return the page as HTML, plotly.js inside.

    Parameters
    ----------
    advice : Advice
    command : str, optional
        What made it, for the reader who wants to make it again.
    """
    return render(
        "advise.html.j2",
        command=command,
        name=advice.case.name,
        verdict=verdict(advice),
        grade=verdict_grade(advice),
        grade_words=GRADE_WORDS,
        statements=statements(advice),
        lines=[*describe(advice.case), problem_line(advice)],
        charts=[
            {
                "title": title,
                "text": text,
                "plot": figure.to_html(
                    full_html=False,
                    include_plotlyjs=False,
                    div_id=html.escape(f"advice-{index}"),
                    config=PLOT_CONFIG,
                ),
            }
            for index, (title, text, figure) in enumerate(advice_charts(advice))
        ],
        versions=advice.versions,
    )


def problem_line(advice: Advice) -> str:
    """Return what holds the cylinder: support, friction and the model that describes them."""
    return (
        f"Support: {advice.support}, friction {advice.case.friction:g}; the reduced model of it is the "
        f"{advice.model} model"
    )
