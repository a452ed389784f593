"""The pages of a trade-off: HTML for the screen, Markdown with a picture for the repository."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..origin_words import made_by
from ..spectrum.page import markdown_table
from ..study_tables import grouped
from ..template import PLOT_CONFIG, render
from .charts import tradeoff_charts, tradeoff_figure
from .words import (
    COST_HEADINGS,
    PLATEAU_HEADINGS,
    SCENE_HEADINGS,
    closing,
    cost_rows,
    headline,
    plateau_rows,
    scene_rows,
    statements,
)

if TYPE_CHECKING:
    from rockwobble.compare.studies.tradeoff import Tradeoff

_TITLE = "Speed against accuracy"
_LEAD = (
    "Three problems on one cylinder, R = 6 m and tan α = 0.2, by the reduced model, by general solvers on "
    "its equations and by multibody engines. What does an error cost, and from where on is "
    "a smaller step wasted?"
)
_FIGURES = "Error against computing time"
_FIGURES_WORDS = (
    "Lower left is better. Along a line only the tolerance or the time step changes, from coarse on the left "
    "to fine on the right. Black: reduced models; pink: scipy; blue: MuJoCo; orange: PyBullet; green: Exudyn."
)
_COSTS = (
    "What an error costs",
    "The cheapest way of each family to an error that its next finer setting holds, too. Times are multiples "
    "of the reduced model at its default tolerance on the same problem.",
)
_PLATEAUS = (
    "Where smaller steps stop helping",
    "From the step named the error of a line stays within a factor of two, or rises again.",
)
_SCENES = (
    "What each part of a scene costs",
    "Choose the least scene that answers the question: everything here costs time at every step.",
)


def tradeoff_pages(found: Tradeoff) -> dict[str, bytes]:
    """Return the files by name: page, document and picture."""
    return {
        "tradeoff.html": tradeoff_page(found).encode(),
        "tradeoff.md": tradeoff_markdown(found).encode(),
        "tradeoff.svg": tradeoff_figure(found),
    }


def tradeoff_page(found: Tradeoff) -> str:
    """Return the page as HTML, plotly.js inside."""
    figures = [
        {
            "title": title,
            "words": words,
            "plot": figure.to_html(
                full_html=False, include_plotlyjs=False, div_id=f"tradeoff-{place}", config=PLOT_CONFIG
            ),
        }
        for place, (title, words, figure) in enumerate(tradeoff_charts(found))
    ]
    return render(
        "study.html.j2",
        title=_TITLE,
        css="",
        lead=_LEAD,
        headline=headline(found),
        statements=statements(found),
        figures_title=_FIGURES,
        figures_words=_FIGURES_WORDS,
        figures=figures,
        tables=[
            {
                "title": title,
                "words": words,
                "headings": headings[1:],
                "groups": grouped(rows),
                "folded": False,
            }
            for (title, words), headings, rows in _tables(found)
        ],
        origin=found.origin,
        closing=closing(found),
    )


def tradeoff_markdown(found: Tradeoff) -> str:
    """Return the page as Markdown; the picture is tradeoff.svg beside it."""
    tables = [
        part
        for (title, words), headings, rows in _tables(found)
        for part in (f"## {title}", words, markdown_table(headings, rows))
    ]
    return "\n\n".join(
        (
            f"# {_TITLE}",
            _LEAD,
            f"**{headline(found)}**",
            "![Error against computing time of all methods on three problems](tradeoff.svg)",
            _FIGURES_WORDS
            + " Below the dotted line other earthquakes would change more than the method does.",
            "\n".join(f"- {line}" for line in statements(found)),
            *tables,
            "All points are in points.parquet, the references in problems.parquet, the scenes in "
            f"scenes.parquet. {made_by(found.origin)} {closing(found)}",
            "",
        )
    )


def _tables(
    found: Tradeoff,
) -> list[tuple[tuple[str, str], tuple[str, ...], list[tuple[str, ...]]]]:
    return [
        (_COSTS, COST_HEADINGS, cost_rows(found)),
        (_PLATEAUS, PLATEAU_HEADINGS, plateau_rows(found)),
        (_SCENES, SCENE_HEADINGS, scene_rows(found)),
    ]
