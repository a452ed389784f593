"""The pages of the extremes: HTML for the screen, Markdown with a picture for the repository."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from ...figures.drawing import drawn
from ..origin_words import made_by
from ..spectrum.page import markdown_table
from ..study_tables import grouped
from ..template import render
from .words import LEGEND, MEANINGS, cell, headline, matrix, rows_of, statements

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.figure import Figure

    from rockwobble.compare.studies.extremes import Extremes

_TITLE = "What breaks first"
_LEAD = (
    "One thing at a time is taken to its extreme, on a cylinder of R = 6 m and tan α = 0.2, by every model "
    "and engine. A run may be right, or say that it is not; it must never be wrong in silence."
)
# blue, yellow, grey, sky and vermilion of Okabe and Ito, pale, with the word in every cell
_COLOURS = {
    "fine": "#cfe6f5",
    "inaccurate": "#fbe3a6",
    "refused": "#dddddd",
    "caught": "#e6cfe0",
    "silent": "#f2946a",
    "n/a": "#ffffff",
}
_DETAIL_HEADINGS = ("value", "method", "verdict", "backed by", "what the run says")


def extremes_pages(found: Extremes) -> dict[str, bytes]:
    """Return the files by name: page, document and picture."""
    return {
        "extremes.html": extremes_page(found).encode(),
        "extremes.md": extremes_markdown(found).encode(),
        "extremes.svg": extremes_figure(found.table),
    }


def extremes_page(found: Extremes) -> str:
    """Return the page as HTML; it needs no script."""
    table = found.table
    methods, conditions = matrix(table)
    cells = [
        (
            *name.split(": ", 1),
            *(
                {"kind": _kind(row), "text": cell(row), "title": _tip(row)} if row is not None else ""
                for row in rows
            ),
        )
        for name, rows in conditions
    ]
    css = "\n".join(
        f".{verdict.replace('/', '')} {{ background: {colour}; white-space: nowrap; "
        "-webkit-print-color-adjust: exact; print-color-adjust: exact; }"
        for verdict, colour in _COLOURS.items()
    )
    return render(
        "study.html.j2",
        title=_TITLE,
        css=css,
        lead=_LEAD,
        headline=headline(table),
        statements=statements(table),
        figures=[],
        figures_title="",
        figures_words="",
        tables=[
            {
                "title": "All extremes, all methods",
                "words": MEANINGS,
                "headings": ("", *methods),
                "groups": grouped(cells),
                "folded": False,
            },
            {
                "title": "What backs each verdict",
                "words": "Each run with its error, what it was held against, and what it says itself.",
                "headings": _DETAIL_HEADINGS,
                "groups": _details(table),
                "folded": True,
            },
        ],
        origin=found.origin,
        closing="",
    )


def extremes_markdown(found: Extremes) -> str:
    """Return the page as Markdown; the picture is extremes.svg beside it."""
    table = found.table
    methods, conditions = matrix(table)
    rows = [(name, *(cell(row) or "–" for row in found)) for name, found in conditions]
    return "\n\n".join(
        (
            f"# {_TITLE}",
            _LEAD,
            f"**{headline(table)}**",
            "![Verdict of every method at every extreme](extremes.svg)",
            LEGEND,
            "\n".join(f"- {line}" for line in statements(table)),
            markdown_table(("extreme", *methods), rows),
            "Each run with what backs its verdict and what it says is in extremes.parquet. "
            + made_by(found.origin),
            "",
        )
    )


def _details(table: pd.DataFrame) -> list[tuple[str, list[Sequence[Any]]]]:
    """Return the runs of each extreme under its name, with the number of those that are not fine."""
    rows = [
        (
            row["extreme"],
            row["value"],
            row["method"],
            {"kind": _kind(row), "text": cell(row), "title": row["verdict"]},
            row["backed_by"] or "–",
            row["message"] or "–",
        )
        for row in rows_of(table.loc[table["verdict"] != "n/a"])
    ]
    return [
        (f"{name}: {len(own)} runs, {sum(run[2]['kind'] != 'fine' for run in own)} not fine", own)
        for name, own in grouped(rows)
    ]


def _kind(row: dict[str, Any]) -> str:
    return str(row["verdict"]).replace("/", "")


def _tip(row: dict[str, Any]) -> str:
    parts = (row["backed_by"] and f"against {row['backed_by']}", row["message"])
    return "; ".join(part for part in parts if part)


def extremes_figure(table: pd.DataFrame) -> bytes:
    """Return the table as a picture (SVG)."""
    methods, conditions = matrix(table)

    def draw(figure: Figure) -> None:
        axes = figure.subplots()
        axes.set_xlim(0.0, len(methods))
        axes.set_ylim(len(conditions), 0.0)
        for line, (_, rows) in enumerate(conditions):
            for column, row in enumerate(rows):
                verdict = "n/a" if row is None else row["verdict"]
                axes.fill_between([column, column + 1], line, line + 1, color=_COLOURS[verdict], lw=0.0)
                axes.text(column + 0.5, line + 0.5, cell(row), ha="center", va="center", fontsize=6.0)
        axes.set_xticks([each + 0.5 for each in range(len(methods))], [m.replace(" ", "\n") for m in methods])
        axes.set_yticks([each + 0.5 for each in range(len(conditions))], [name for name, _ in conditions])
        axes.tick_params(length=0.0, labelsize=7.0, labeltop=True, labelbottom=False)
        axes.hlines(range(len(conditions)), 0.0, len(methods), color="white", linewidth=0.8)
        axes.vlines(range(len(methods)), 0.0, len(conditions), color="white", linewidth=0.8)
        for side in axes.spines.values():
            side.set_visible(False)

    return drawn(draw, 0.19 * len(conditions) + 0.8)
